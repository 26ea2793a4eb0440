//! Winds all motors in together, from the travels at which the tendons came taut, until the tensions reach the
//! pretension.

use super::{ALL_TAUT, GAP, SlackTakeUp};
use crate::control::take_up::progress::{Phase, Slack};
use crate::control::take_up::touch::Gauge;
use nalgebra::Vector4;

/// Largest speed of the motors while they wind in together, m/s.
const TOGETHER: f64 = 0.001;
/// Largest speed of the common stretch, in multiples of the stretch at the pretension, 1/s.
const FASTEST: f64 = 3.0;
/// Missing fraction of the pretension at which the motors stop.
const REACHED: f64 = 0.03;
/// Missing fraction above which the motors move again. Up to this fraction, a completed take-up stays complete. The
/// difference from [`REACHED`] prevents a limit cycle by friction.
const COMPLETE: f64 = 0.1;
/// Largest excess over the pretension with which the take-up is complete, as a fraction of the pretension. The excess
/// is permitted because the tensions of a finger at its stops differ from the pretension.
const TOO_HIGH: f64 = 0.5;
/// A tension below this fraction of t_min is too low, even if the common part of the tensions is right.
const LEAST: f64 = 0.9;

/// A tendon is not slack if its tension exceeds its tare by more than this fraction of the pretension.
const SLACK: f64 = 0.08;
/// Largest stretch of tendons that pull while another tendon is slack, in multiples of the stretch at the pretension.
const LARGEST_UNOPPOSED: f64 = 2.0;
/// Largest common stretch while a tendon is slack, in multiples of the stretch at the pretension.
const LARGEST_COMMON: f64 = 4.0;

impl SlackTakeUp {
    /// Changes the common stretch, and moves the targets of the motors accordingly.
    pub(super) fn tighten(&self, slack: &mut Slack, travel: &Vector4<f64>) {
        let missing = self.missing(&slack.tensions);
        let was_steady = slack.steady;
        slack.steady = (-TOO_HIGH..=if was_steady { COMPLETE } else { REACHED }).contains(&missing);
        if slack.steady {
            if !was_steady {
                self.servo.stop(&mut slack.targets, travel);
            }
            return;
        }
        slack.common += (missing * self.gain).clamp(-FASTEST, FASTEST) * self.period;
        let reach = TOGETHER * self.period;
        let together = slack.taut_at + self.stretch * slack.common;
        let steps = Vector4::from_fn(|motor, _| {
            // A tendon below its pretension is not let out beyond `waits_at`.
            let waits = slack.tensions[motor] < self.pretension[motor];
            let wanted = if waits { together[motor].max(slack.waits_at[motor]) } else { together[motor] };
            (wanted - slack.targets.travel[motor]).clamp(-reach, reach)
        });
        slack.targets.travel += steps;
        slack.targets.speed = steps / self.period;

        let taut = std::array::from_fn(|tendon| self.is_taut(slack, tendon));
        // A tendon that holds the finger against gravity counts as pulling only if it is taut.
        let pulls = (0..4).any(|tendon| {
            taut[tendon] || !slack.holds[tendon] && slack.gauges[tendon].is_above_noise(slack.smoothed[tendon])
        });
        let slack_remains = taut != [true; 4];
        let rise = steps.component_div(&self.stretch).max();
        slack.unopposed = if slack_remains && pulls { slack.unopposed + rise } else { 0.0 };
        if slack_remains && (slack.unopposed > LARGEST_UNOPPOSED || slack.common > LARGEST_COMMON) {
            self.touch_again(slack, taut, travel);
        }
    }

    /// Some tendons seemed to be taut but are slack. Makes their motors wind in again.
    fn touch_again(&self, slack: &mut Slack, taut: [bool; 4], travel: &Vector4<f64>) {
        if !slack.gauges.iter().all(Gauge::is_tared) {
            // All tendons seemed to be taut at the start, so the tares of the gauges were not measured.
            *slack = Self::taring(*travel, slack.tensions);
            return;
        }
        slack.touched = taut;
        slack.holds = [false; 4];
        slack.gauges.iter_mut().zip(travel).for_each(|(gauge, &travel)| gauge.restart(travel));
        // The finger may have moved between the moments at which the tendons came taut. Their travels then belong to
        // different poses, and two tendons can pull against each other and hold the finger at a stop. This could happen
        // in every attempt. So from the second attempt on, the tendons that pull are let out from where they are now.
        let let_out = std::mem::replace(&mut slack.touches_again, true);
        for tendon in (0..4).filter(|&tendon| let_out && taut[tendon]) {
            let stretch = self.stretch[tendon] * slack.tensions[tendon] / self.pretension[tendon];
            slack.taut_at[tendon] = travel[tendon] - stretch;
            slack.waits_at[tendon] = slack.taut_at[tendon] - GAP;
        }
        slack.targets.integral = Vector4::zeros();
        slack.targets.travel = slack.waits_at;
        (slack.phase, slack.seconds) = (Phase::Touching, 0.0);
    }

    fn is_taut(&self, slack: &Slack, tendon: usize) -> bool {
        let tare = slack.gauges[tendon].tare.min(ALL_TAUT * self.minimum);
        slack.tensions[tendon] - tare > SLACK * self.pretension[tendon]
    }

    /// Returns the common part of the tensions as a fraction of the pretension.
    pub(super) fn common_part(&self, tensions: &Vector4<f64>) -> f64 {
        self.pretension.dot(tensions) / self.pretension.norm_squared()
    }

    /// Returns the fraction of the pretension that is missing. It is negative if the tensions are too high.
    fn missing(&self, tensions: &Vector4<f64>) -> f64 {
        (1.0 - self.common_part(tensions)).max(LEAST - tensions.min() / self.minimum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::take_up::progress::Slackness;
    use crate::model::configuration::ConfiguredFinger;

    /// Two tendons hold the finger at a stop against each other, at travels that belong to another pose.
    #[test]
    fn tendons_that_hold_the_finger_at_a_stop_are_let_out_in_the_second_attempt() {
        let finger = ConfiguredFinger::default();
        let take_up = SlackTakeUp::new(&finger, &finger.tendons().expect("regular"), 500.0);
        let travel = Vector4::new(0.003, 0.001, -0.002, -0.003);
        let tensions = Vector4::new(14.0, 0.0, 25.0, 0.0);
        let now = Slackness { travel, speeds: Vector4::zeros(), tensions };
        let mut slack = take_up.start(&now);
        for _ in 0..100 {
            take_up.step(&mut slack, &now, false);
        }
        slack.taut_at = travel.add_scalar(0.002);
        slack.waits_at = slack.taut_at.add_scalar(-GAP);
        let attempts = [false, true].map(|let_out| {
            assert_eq!(slack.touches_again, let_out);
            (slack.phase, slack.touched, slack.unopposed) = (Phase::Tightening, [true; 4], 2.0 * LARGEST_UNOPPOSED);
            while slack.phase != Phase::Touching {
                take_up.step(&mut slack, &now, false);
            }
            assert_eq!(slack.touched, [true, false, true, false]);
            [0, 2].map(|motor| slack.targets.travel[motor] - travel[motor])
        });
        assert!(attempts[0].iter().all(|&way| way > 0.001), "{attempts:?}");
        assert!(attempts[1].iter().all(|&way| way < -GAP), "{attempts:?}");
    }
}
