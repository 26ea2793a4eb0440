//! Converts what the server reports into the structs of `sun2xp.h`. A value that the server does not report is NaN, or
//! 0 in an integer. Only `value` and `warning_value` of `sun2xp_fault` are 0 instead of NaN.

use sun2xp::capi::{sun2xp_event, sun2xp_fault, sun2xp_limits, sun2xp_status, sun2xp_tip};
use sun2xp_remote_client::{Event, FingerStatus, Record, Stage, Status};

/// SUN2XP_STATE_... of `sun2xp.h`.
fn state(stage: Stage) -> i32 {
    match stage {
        Stage::Running => 1,
        Stage::Faulted(_) => 2,
        Stage::Limp => 3,
        Stage::Calibrating => 4,
        Stage::Opening => 5,
        Stage::Closing | Stage::Closed => 6,
    }
}

/// SUN2XP_FAULT_..., 0 if there is none.
fn fault_number(stage: Stage) -> i32 {
    match stage {
        Stage::Faulted(fault) => fault.into(),
        _ => 0,
    }
}

/// `newest` is the newest record of the finger, and `measured_rate` is the measured rate of its servo, Hz.
pub(crate) fn status(hand: &Status, finger: &FingerStatus, newest: &Record, measured_rate: f64) -> sun2xp_status {
    sun2xp_status {
        size: 0,
        state: state(newest.stage),
        realtime: 0,
        rate: hand.rate,
        measured_rate,
        wake_up_median: f64::NAN,
        wake_up_p99: f64::NAN,
        wake_up_maximum: f64::NAN,
        torque_scale: f64::NAN,
        cycles: newest.cycle,
        skipped_periods: finger.skipped_periods,
        lost_replies: finger.lost_replies,
        damaged_replies: finger.corrupt_replies,
        calibration: finger.calibration,
        memory_locked: 0,
        on_core: 0,
        stiffness_scale: f64::NAN,
    }
}

/// A record has the force that follows from the tensions. It has no `contact_force`: the estimate that excludes
/// friction, weight and inertia of the finger.
pub(crate) fn tip(record: &Record) -> sun2xp_tip {
    sun2xp_tip {
        size: 0,
        force_directions: 0,
        position: record.tip,
        force: record.force,
        tensions: record.tensions,
        stiffness: [[f64::NAN; 3]; 3],
        contact_force: [f64::NAN; 3],
        slide_speed: f64::NAN,
        touching: record.touching.into(),
    }
}

pub(crate) fn limits(finger: &FingerStatus) -> sun2xp_limits {
    sun2xp_limits {
        size: 0,
        joint_minimum: finger.low,
        joint_maximum: finger.high,
        tension_minimum: f64::NAN,
        tension_maximum: f64::NAN,
        motor_torque: [f64::NAN; 4],
        stiffness: finger.stiffness_bound,
    }
}

pub(crate) fn fault(stage: Stage, finger: &FingerStatus) -> sun2xp_fault {
    sun2xp_fault {
        size: 0,
        number: fault_number(stage),
        part: 0,
        warning: 0,
        warning_part: 0,
        value: 0.0,
        warning_value: 0.0,
        warnings: finger.warnings.into(),
    }
}

/// `lost` is the number of events that were lost on the way or not taken in time.
pub(crate) fn event(event: &Event, lost: u64) -> sun2xp_event {
    sun2xp_event {
        size: 0,
        finger: event.finger.number().into(),
        kind: event.kind.into(),
        part: event.part.into(),
        cycle: event.cycle,
        lost,
        time: event.begin as f64 * 1e-9,
        values: event.values,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measured_rate::tests::record;

    #[test]
    fn what_a_record_does_not_have_is_not_a_number() {
        let found = tip(&Record { force: [1.0, 2.0, 3.0], touching: true, ..record(1, 1) });
        assert_eq!((found.force, found.touching), ([1.0, 2.0, 3.0], 1));
        let missing = found.contact_force.iter().chain(found.stiffness.iter().flatten()).chain([&found.slide_speed]);
        assert!(missing.copied().all(f64::is_nan), "{:?}", found.contact_force);
    }
}
