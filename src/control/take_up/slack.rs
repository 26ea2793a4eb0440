//! Takes up slack while the joints stay where they are.
//!
//! The first tendon that comes taut moves a free finger until another tendon opposes it. So every motor winds in slowly
//! until its tendon has just become taut. The motor then immediately pays out a fraction of a millimetre. The tension
//! lasts for a few milliseconds and hardly moves the finger. When every tendon has been taut once, the travels of the
//! motors at these moments determine the joint angles. All motors then wind in together to these travels, and further
//! by a common stretch until the tensions reach the pretension. The motors are under position control, so they hold the
//! joints.

mod together;

use crate::control::take_up::progress::{Phase, Slack, Slackness};
use crate::control::take_up::touch::Gauge;
use crate::control::take_up::travel_servo::{Targets, TravelServo};
use crate::model::Tendons;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;

/// Time for which the gauges are read before the motors move, s.
const TARING: f64 = 0.1;

/// Winding speed at the start, m/s of tendon. At a lower speed, a taut tendon pushes the finger for longer before its
/// tension rises above the noise. At a higher speed, its tension is larger when its motor reverses.
const SPEED: f64 = 0.0018;
/// Acceleration of the winding, m/s^2. Because of it, slack of 20 mm is taken up in 7 s.
const ACCELERATION: f64 = 0.0003;
/// Gauge noise, as a fraction of t_min, above which the winding is faster in proportion to the noise.
const QUIET: f64 = 0.006;

/// A tendon with more than this fraction of t_min is taut before its motor moves. The zero of a gauge that was not
/// calibrated may be off by almost as much.
const TAUT: f64 = 0.12;
/// If gravity acts on the finger, a tendon with more than this fraction of t_min is taut before its motor moves. The
/// fraction is lower than `TAUT`, because a tendon with little tension may hold the finger against gravity. It is not
/// lower still, because the zero of a gauge drifts.
const HOLDS: f64 = 0.012;
/// If all tendons have more than this fraction of t_min at the start, the take-up begins with [`Phase::Tightening`].
const ALL_TAUT: f64 = 0.2;

/// When a tendon has become taut, its motor reverses with this pull in the paying-out direction, in multiples of t_min,
/// at 1000 Hz and above.
const REVERSAL: f64 = 16.0;
/// Longest time for which a motor reverses, s.
const LONGEST_REVERSAL: f64 = 0.004;
/// Paid-out length at which a motor stops reversing, m.
const REVERSED: f64 = 1e-5;
/// Length that a motor pays out after its tendon has been taut, m.
const GAP: f64 = 0.0004;

/// `SlackTakeUp::gain` at 1000 Hz and above, 1/s.
const GAIN: f64 = 20.0;
/// Largest pull in [`Phase::Touching`], while tendons are slack, in multiples of t_min. It must exceed the friction of
/// a motor.
const STRONGEST_SLACK: f64 = 2.0;
/// In all phases except [`Phase::Touching`], the largest pull is `STRONGEST` times the pretension, plus
/// `STRONGEST_SLACK` times t_min.
const STRONGEST: f64 = 1.5;

/// A motor does not follow its target if its distance from the target exceeds this value, m.
const ASTRAY: f64 = 0.003;

/// Time constant of the low-pass filter on the tensions, s.
const SMOOTHING: f64 = 0.003;
/// Time constant of the low-pass filter for the decision whether a tendon pulls at all, s.
const MORE_SMOOTHING: f64 = 0.02;

/// The parameters of the take-up. Its state is [`Slack`].
#[derive(Clone, Debug)]
pub(crate) struct SlackTakeUp {
    period: f64,
    servo: TravelServo,
    /// t_min, N.
    minimum: f64,
    /// Tensions of eq. 20 at zero joint torque, N.
    pretension: Vector4<f64>,
    /// Stretch of the tendons at the pretension, m.
    stretch: Vector4<f64>,
    /// Speed of the common stretch, divided by the missing fraction of the pretension, 1/s.
    gain: f64,
    /// Pull of a motor that reverses, N.
    reversal: f64,
}

impl SlackTakeUp {
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons, rate: f64) -> Self {
        let minimum = finger.tendon.minimum;
        let pretension = tendons.pretension(minimum);
        let slower = (rate / 1000.0).min(1.0);
        Self {
            period: 1.0 / rate,
            gain: GAIN * slower * slower,
            servo: TravelServo::new(rate),
            minimum,
            pretension,
            stretch: pretension.component_div(&(Vector4::from(finger.tendon.stiffness) * 100.0)),
            // At a low rate the motor reverses for longer before its encoder is read.
            reversal: -REVERSAL * minimum * slower,
        }
    }

    pub fn start(&self, now: &Slackness) -> Slack {
        let Slackness { travel, tensions, .. } = *now;
        let mut slack = Self::taring(travel, tensions);
        if tensions.min() > ALL_TAUT * self.minimum {
            slack.phase = Phase::Tightening;
            slack.common = self.common_part(&tensions);
            slack.taut_at = travel - self.stretch * slack.common;
            slack.waits_at = slack.taut_at.add_scalar(-GAP);
        }
        slack
    }

    /// Returns the state in which the motors hold their travel, m, and the gauges are read.
    fn taring(travel: Vector4<f64>, tensions: Vector4<f64>) -> Slack {
        Slack {
            phase: Phase::Taring,
            // The motors hold the tensions that tendons already have.
            targets: Targets { travel, speed: Vector4::zeros(), integral: tensions.map(|tension| tension.max(0.0)) },
            gauges: [Gauge::default(); 4],
            tensions,
            smoothed: tensions,
            seconds: 0.0,
            wound: Vector4::zeros(),
            holds: [false; 4],
            touched: [false; 4],
            reversing: Vector4::zeros(),
            taut_at: travel,
            waits_at: travel,
            common: 0.0,
            unopposed: 0.0,
            steady: false,
            touches_again: false,
        }
    }

    /// Returns the tendon that is farthest from being under tension, 0 to 3.
    pub fn slackest(&self, slack: &Slack, now: &Slackness) -> usize {
        // A motor with a wrong sign does not follow its target, and makes other tendons slack too.
        let astray = (slack.targets.travel - now.travel).abs();
        if astray.max() > ASTRAY {
            return astray.imax();
        }
        let untouched = (0..4).filter(|&motor| slack.phase == Phase::Touching && !slack.touched[motor]);
        untouched
            .max_by(|&one, &other| slack.wound[one].total_cmp(&slack.wound[other]))
            .unwrap_or_else(|| slack.tensions.component_div(&self.pretension).imin())
    }

    /// Returns whether all motors wind in together.
    pub fn tightens(&self, slack: &Slack) -> bool {
        slack.phase == Phase::Tightening
    }

    /// Returns whether the tensions have reached the pretension.
    pub fn is_complete(&self, slack: &Slack) -> bool {
        self.tightens(slack) && slack.steady
    }

    /// Runs one cycle. Returns the pulls, N. `weighs` is true if gravity acts on the finger.
    pub fn step(&self, slack: &mut Slack, now: &Slackness, weighs: bool) -> Vector4<f64> {
        slack.tensions += (now.tensions - slack.tensions) * (self.period / SMOOTHING).min(1.0);
        slack.smoothed += (now.tensions - slack.smoothed) * (self.period / MORE_SMOOTHING).min(1.0);
        slack.targets.speed = Vector4::zeros();
        slack.seconds += self.period;
        match slack.phase {
            Phase::Taring => self.tare(slack, now, if weighs { HOLDS } else { TAUT }),
            Phase::Touching => self.touch(slack, now),
            Phase::Tightening => self.tighten(slack, &now.travel),
        }
        let mut strongest = Vector4::repeat(STRONGEST_SLACK * self.minimum);
        if slack.phase != Phase::Touching {
            strongest += self.pretension * STRONGEST;
        }
        let mut pulls = self.servo.pulls(&mut slack.targets, &now.travel, &now.speeds, &strongest);
        for motor in 0..4 {
            if now.travel[motor] < slack.taut_at[motor] - REVERSED {
                slack.reversing[motor] = 0.0;
            }
            if slack.reversing[motor] > 0.0 {
                slack.reversing[motor] -= self.period;
                pulls[motor] = self.reversal;
            }
        }
        pulls
    }

    fn tare(&self, slack: &mut Slack, now: &Slackness, taut: f64) {
        for (gauge, &tension) in slack.gauges.iter_mut().zip(&now.tensions) {
            gauge.tare(tension, self.minimum);
        }
        if slack.seconds < TARING {
            return;
        }
        for motor in 0..4 {
            let tension = slack.gauges[motor].tare;
            if tension > taut * self.minimum {
                slack.holds[motor] = true;
                slack.touched[motor] = true;
                slack.taut_at[motor] -= tension / self.pretension[motor] * self.stretch[motor];
            }
        }
        // If a tension rises from the first sample on, its tendon came taut at this travel, before the motor turned.
        slack.gauges.iter_mut().zip(&now.travel).for_each(|(gauge, &travel)| gauge.restart(travel));
        (slack.phase, slack.seconds) = (Phase::Touching, 0.0);
    }

    /// Advances every motor whose tendon has not yet been taut.
    fn touch(&self, slack: &mut Slack, now: &Slackness) {
        for motor in 0..4 {
            if slack.touched[motor] {
                continue;
            }
            let gauge = &mut slack.gauges[motor];
            if let Some(travel) = gauge.taut_at(now.tensions[motor], slack.smoothed[motor], now.travel[motor]) {
                slack.touched[motor] = true;
                slack.reversing[motor] = LONGEST_REVERSAL;
                slack.taut_at[motor] = travel;
                slack.waits_at[motor] = travel - GAP;
                slack.targets.travel[motor] = travel - GAP;
                slack.targets.integral[motor] = 0.0;
            } else {
                // A free finger yields to a taut tendon. Only the inertia of the finger makes the tension rise above
                // strong noise, and it makes the tension rise higher if the motor winds faster.
                let noise = (gauge.noise / (QUIET * self.minimum)).max(1.0);
                let speed = (SPEED + ACCELERATION * slack.seconds) * noise;
                slack.targets.speed[motor] = speed;
                slack.targets.travel[motor] += speed * self.period;
                slack.wound[motor] += speed * self.period;
            }
        }
        if slack.touched == [true; 4] {
            (slack.phase, slack.seconds) = (Phase::Tightening, 0.0);
            slack.common = -GAP / self.stretch.max();
            slack.unopposed = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The finger moves while its gauges are read, and pulls a tendon taut before the motors turn.
    #[test]
    fn a_tendon_that_is_taut_in_the_first_sample_came_taut_where_its_motor_is() {
        let finger = ConfiguredFinger::default();
        let take_up = SlackTakeUp::new(&finger, &finger.tendons().expect("regular"), 1000.0);
        let travel = Vector4::new(0.01, -0.02, 0.03, 0.005);
        let with_first = |tension: f64| Slackness {
            travel,
            speeds: Vector4::zeros(),
            tensions: Vector4::new(tension, 0.0, 0.0, 0.0),
        };
        let mut slack = take_up.start(&with_first(0.0));
        while slack.phase == Phase::Taring {
            take_up.step(&mut slack, &with_first(0.0), false);
        }
        take_up.step(&mut slack, &with_first(0.5), false);
        assert_eq!(slack.touched, [true, false, false, false]);
        assert_eq!((slack.taut_at[0], slack.targets.travel[0]), (travel[0], travel[0] - GAP));
    }
}
