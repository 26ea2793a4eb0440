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
        // The hand has this finger, so the status of the finger can be read.
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
    let warnings = u32::try_from(hand.fault(number)?.warnings).unwrap_or(u32::MAX);
    Ok(FingerStatus {
        stage: stage(&report.stage),
        warnings,
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::time::{Duration, Instant};
    use sun2xp::Configuration;
    use sun2xp::realtime::now;

    fn wait_until(what: &str, holds: impl Fn() -> bool) {
        let begun = Instant::now();
        while !holds() {
            // The machine of the tests may be busy.
            assert!(begun.elapsed() < Duration::from_secs(60), "no {what} in time");
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    #[test]
    fn a_status_has_the_number_of_warnings_since_open() {
        let mut configuration = Configuration::default();
        // With this limit, the pushes below move joint 0 to its mechanical stop, which causes a warning.
        configuration.fingers[0].joints.maximum_degrees[0] = 5.0;
        let hand = Arc::new(Hand::open(configuration).expect("the simulated hand"));
        let limits = Limits { catch_ms: 100, end_ms: 1000, soft_stiffness: 1.0, lead_force: 10.0 };
        let desk = Desk::new(hand.clone(), limits, now());
        let given = || hand.fault(1).expect("finger 1").warnings;
        let cycles = || hand.report(1).expect("finger 1").losses.cycles;
        hand.push_simulated(1, [5.0, 0.0, 0.0]).expect("pushed");
        wait_until("warning", || given() >= 1);
        // A warning counts again after it has been absent for a second.
        hand.push_simulated(1, [0.0; 3]).expect("released");
        let released = cycles();
        wait_until("pause", || cycles() > released + 3000);
        hand.push_simulated(1, [5.0, 0.0, 0.0]).expect("pushed");
        wait_until("second warning", || given() >= 2);
        let before = given();
        let shown = status(&hand, &limits, &desk, now()).fingers[0].as_ref().map(|finger| u64::from(finger.warnings));
        assert!(shown.is_some_and(|shown| (before..=given()).contains(&shown)), "{shown:?}, not {before}");
    }
}
