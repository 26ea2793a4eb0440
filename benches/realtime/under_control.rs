//! Whether a finger was under control to the end of a measurement.

use sun2xp::finger::Stage;

/// Checks that a finger is a spring.
///
/// # Errors
/// Says in which stage the finger is, or which fault has stopped it.
pub fn under_control(finger: usize, stage: &Stage) -> Result<(), String> {
    match stage {
        Stage::Running => Ok(()),
        Stage::Faulted(fault) => Err(format!("finger {finger} has stopped: {fault}")),
        other => Err(format!("finger {finger} is {}, not under control", other.name())),
    }
}
