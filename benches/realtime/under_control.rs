//! A check that a finger is under control.

use sun2xp::finger::Stage;

/// Checks that a finger is under control: that its stage is [`Stage::Running`].
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
