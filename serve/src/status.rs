//! The Status of the hand.

use crate::cycles::stage;
use crate::desk::Desk;
use crate::settings::Limits;
use sun2xp::{Hand, HandError, Stage};
use sun2xp_remote_protocol::{FINGERS, FaultText, FingerStatus, Status};

/// Returns the Status at `now`, ns. The caller has locked the desk, so that owner and counts belong together.
#[must_use]
pub fn status(hand: &Hand, limits: &Limits, desk: &Desk, now: u64) -> Status {
    let mut fingers = [const { None }; FINGERS];
    for number in hand.fingers().members() {
        // The hand has the finger, so it has a status.
        fingers[number.index()] = of_finger(hand, number.get()).ok();
    }
    Status {
        catch_ms: limits.catch_ms,
        end_ms: limits.end_ms,
        clients: desk.clients(),
        time: now,
        rate: hand.configuration().hand.rate,
        lead_force: limits.lead_force,
        soft_stiffness: limits.soft_stiffness,
        counts: *desk.counts(),
        fingers,
        owner: desk.owner().map(|owner| owner.client.clone()),
    }
}

fn of_finger(hand: &Hand, number: i32) -> Result<FingerStatus, HandError> {
    let report = hand.report(number)?;
    let limits = hand.limits(number)?;
    let status = hand.status(number)?;
    let fault_text = match report.stage {
        Stage::Faulted(fault) => FaultText::beginning_of(&fault.to_string()),
        _ => FaultText::default(),
    };
    Ok(FingerStatus {
        stage: stage(&report.stage),
        warnings: u32::from(hand.fault(number)?.warning.is_some()),
        cycles: status.losses.cycles,
        skipped_periods: status.losses.skipped_periods,
        lost_replies: status.losses.lost_replies,
        corrupt_replies: status.losses.damaged_frames,
        low: limits.joint_minimum,
        high: limits.joint_maximum,
        stiffness_bound: limits.stiffness,
        calibration: status.calibration.clamp(0.0, 1.0),
        fault_text,
    })
}
