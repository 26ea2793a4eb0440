//! What decides a finger's command in one cycle, beside its controller and that one's state. The servo and a replay
//! both go through [`ControlInput::run`].

use crate::control::{Activity, Controller, Feedback, MotorCommand, Report, State};
use crate::finger::Fading;
use serde::{Deserialize, Serialize};

/// What a controller is told in a cycle, besides the reply.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct ControlInput {
    /// The controller begins anew from this first: it was just adopted, or the finger was not seen for too long.
    pub anew_from: Option<Feedback>,
    /// What the finger is doing, with its set point.
    pub activity: Activity,
    /// Periods that will be skipped after this one, because the servo is late.
    pub skipped: u64,
    /// So many replies were lost in a row that the motors are led to rest.
    pub fading: Option<Fading>,
}

impl ControlInput {
    /// The command, and what the controller reports. `previous`: the controller before this one, where they change in
    /// this cycle. `feedback`: none where the reply was lost.
    pub fn run(
        &self,
        controller: &Controller,
        previous: Option<&Controller>,
        state: &mut State,
        feedback: Option<&Feedback>,
    ) -> (MotorCommand, Report) {
        if let Some(found) = &self.anew_from {
            *state = previous.unwrap_or(controller).start(found);
        }
        let (mut command, mut report) = match previous {
            None => controller.cycle(state, feedback, &self.activity),
            Some(previous) => controller.take_over(previous, state, feedback, &self.activity),
        };
        // Periods that will be skipped are periods without a reply: what differentiates and predicts must know of them.
        for _ in 0..self.skipped {
            // From numbers that are not finite no finite ones follow, and limits made of them are none.
            if !command.is_finite() {
                break;
            }
            (command, report) = controller.cycle(state, None, &self.activity);
        }
        if let Some(fading) = &self.fading {
            command.motor_torques = fading.torques(&command.motor_torques);
        }
        (command, report)
    }
}
