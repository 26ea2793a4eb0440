//! The progress of the take-up of slack, and the measurements that the take-up needs.

use crate::control::take_up::touch::Gauge;
use crate::control::take_up::travel_servo::Targets;
use nalgebra::Vector4;
use serde::{Deserialize, Serialize};

/// The progress of the take-up.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct Slack {
    pub(super) phase: Phase,
    pub(super) targets: Targets,
    pub(super) gauges: [Gauge; 4],
    /// Low-pass filtered tensions, N.
    pub(super) tensions: Vector4<f64>,
    /// Tensions, low-pass filtered with a longer time constant than `tensions`, N.
    pub(super) smoothed: Vector4<f64>,
    /// Time since the start of the phase, s.
    pub(super) seconds: f64,
    /// The length that every motor has wound in, m.
    pub(super) wound: Vector4<f64>,
    /// Whether each tendon was taut before its motor moved.
    pub(super) holds: [bool; 4],
    /// Whether each tendon has been taut.
    pub(super) touched: [bool; 4],
    /// Time for which each motor may still reverse, s.
    pub(super) reversing: Vector4<f64>,
    /// Travel of each motor at which its tendon comes taut, m.
    pub(super) taut_at: Vector4<f64>,
    /// Travel at which each motor waits for the other tendons, m.
    pub(super) waits_at: Vector4<f64>,
    /// Common stretch in multiples of the stretch at the pretension. A negative value is slack.
    pub(super) common: f64,
    /// How far the targets have advanced while some tendons pulled and another one was slack: the sum over the cycles
    /// of the largest step of a motor, in multiples of the stretch at the pretension.
    pub(super) unopposed: f64,
    /// Whether the common stretch is kept, because the tensions are at the pretension.
    pub(super) steady: bool,
    /// Whether slack tendons have been wound in again, because a slack tendon was taken for a taut one.
    pub(super) touches_again: bool,
}

impl Slack {
    /// Converts lengths and pulls to another motor radius. `ratio` is the old radius of each motor divided by the new
    /// one. The motor angles and the motor torques stay the same.
    pub fn change_radius(&mut self, ratio: &Vector4<f64>) {
        let Targets { travel, speed, integral } = &mut self.targets;
        for length in [travel, speed, &mut self.wound, &mut self.taut_at, &mut self.waits_at] {
            length.component_div_assign(ratio);
        }
        integral.component_mul_assign(ratio);
        for (gauge, ratio) in self.gauges.iter_mut().zip(ratio) {
            gauge.scale_travel(ratio.recip());
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub(super) enum Phase {
    /// The motors are at rest, and the gauges are read.
    Taring,
    /// Every motor winds in until its tendon has been taut, and waits for the others.
    Touching,
    /// All motors wind in together.
    Tightening,
}

/// The measurements of a cycle.
pub(crate) struct Slackness {
    /// Travel of the tendons at the motors, m, positive inward.
    pub travel: Vector4<f64>,
    /// Speeds of the tendons at the motors, m/s, positive inward.
    pub speeds: Vector4<f64>,
    /// Tensions, N.
    pub tensions: Vector4<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::take_up::slack::SlackTakeUp;
    use crate::model::configuration::ConfiguredFinger;

    #[test]
    fn the_targets_turn_no_motor_when_the_motor_radius_changes() {
        let finger = ConfiguredFinger::default();
        let take_up = SlackTakeUp::new(&finger, &finger.tendons().expect("regular"), 1000.0);
        let travel = Vector4::new(0.01, -0.02, 0.03, 0.0);
        let mut slack = take_up.start(&Slackness { travel, speeds: Vector4::zeros(), tensions: Vector4::repeat(0.5) });
        slack.change_radius(&Vector4::repeat(0.5));
        assert_eq!((slack.targets.travel, slack.taut_at, slack.waits_at), (travel * 2.0, travel * 2.0, travel * 2.0));
        assert_eq!(slack.targets.integral, Vector4::repeat(0.25));
    }
}
