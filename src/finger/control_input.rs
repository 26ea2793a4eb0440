//! Everything that determines a finger's command in one cycle, except the controller, its state and the reply. Both the
//! servo and a replay compute with [`ControlInput::run`].

use crate::control::{Activity, Controller, Feedback, MotorCommand, Report, State};
use crate::finger::Fading;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// The input of a controller in one cycle, except the reply.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct ControlInput {
    /// If present, the controller first restarts from this feedback, but keeps the heat of the motors. It restarts
    /// after an order to restart, after a recovery from a fault, or after too many lost replies.
    pub anew_from: Option<Feedback>,
    /// The activity of the finger, with its set point.
    pub activity: Activity,
    /// Number of periods that will be skipped after this cycle, because the servo is late.
    pub skipped: u64,
    /// Present if so many replies in a row were lost that the motor torques fade to their final values.
    pub fading: Option<Fading>,
    /// Gravity in the finger's frame, m/s^2: that of the configuration until a planner sets another. Recordings of
    /// older libraries do not have it. Their controllers compensate the gravity with which they were constructed.
    #[serde(default)]
    pub gravity: Option<Vector3<f64>>,
    /// Whether a path begins in this cycle. Recordings of older libraries do not have it.
    #[serde(default)]
    pub path_begins: bool,
}

impl ControlInput {
    /// Returns the command and the controller's report. `previous` is the controller that `controller` replaces in this
    /// cycle. `feedback` is none if the reply was lost.
    pub fn run(
        &self,
        controller: &Controller,
        previous: Option<&Controller>,
        state: &mut State,
        feedback: Option<&Feedback>,
    ) -> (MotorCommand, Report) {
        if let Some(found) = &self.anew_from {
            *state = previous.unwrap_or(controller).start_anew(state, found);
        }
        if let Some(gravity) = &self.gravity {
            controller.approach_gravity(state, gravity);
        }
        if self.path_begins
            && let Activity::Follow(set_point) = &self.activity
        {
            previous.unwrap_or(controller).begin_path(state, set_point);
        }
        let (mut command, mut report) = match previous {
            None => controller.cycle(state, feedback, &self.activity),
            Some(previous) => controller.take_over(previous, state, feedback, &self.activity),
        };
        // A skipped period is a period without a reply. The differentiators and predictors must take it into account.
        for _ in 0..self.skipped {
            // Numbers that are not finite stay so in every further cycle. A further cycle could also panic, because
            // `clamp` panics if a limit is NaN.
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
