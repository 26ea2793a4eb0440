//! Takes up slack while the joints stay where they are.
//!
//! The first tendon that comes taut moves a free finger until another tendon opposes it. So every motor winds in slowly
//! until its tendon only just comes taut, and at once pays out a fraction of a millimetre. The tension lasts for a few
//! milliseconds and hardly moves the finger. When every tendon has been taut once, the travels of the motors at these
//! moments determine the joint angles. All motors then wind in together to these travels, and further by a common
//! stretch until the tensions reach the pretension. The motors are under position control, so they hold the joints.

use crate::control::take_up::progress::{Phase, Slack, Slackness};
use crate::control::take_up::touch::Gauge;
use crate::control::take_up::travel_servo::{Targets, TravelServo};
use crate::model::Tendons;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;

/// Time for which the gauges are read before the motors move, s.
const TARING: f64 = 0.1;

/// Winding speed at the start, m/s of tendon. A lower speed gives a taut tendon more time to push the finger before it
/// is detected above the noise. A higher one gives it more tension before its motor reverses.
const SPEED: f64 = 0.0018;
/// Acceleration of the winding, m/s^2. Because of it, slack of 20 mm is taken up in 7 s.
const ACCELERATION: f64 = 0.0003;
/// Gauge noise, as a fraction of t_min, above which the winding is faster in proportion to the noise.
const QUIET: f64 = 0.006;

/// A tendon with more than this fraction of t_min is taut before its motor moves.
const TAUT: f64 = 0.06;
/// The same fraction where gravity acts, because such a tendon may hold the finger. It is not lower, because the zero
/// of a gauge drifts.
const HOLDS: f64 = 0.012;
/// Tendons that all have more than this fraction of t_min at the start need no winding.
const ALL_TAUT: f64 = 0.2;

/// Pull with which a motor reverses at a taut tendon, in multiples of t_min, outward.
const REVERSAL: f64 = 16.0;
/// Longest time of this pull, s, and distance from the taut tendon at which it ends, m.
const LONGEST_REVERSAL: f64 = 0.004;
const REVERSED: f64 = 1e-5;
/// Length that a motor pays out after its tendon has been taut, m.
const GAP: f64 = 0.0004;

/// Speed of the motors while they wind in together, m/s.
const TOGETHER: f64 = 0.001;
/// Gain from the missing fraction of the pretension to the speed of the common stretch, 1/s, from 1000 Hz up.
const GAIN: f64 = 20.0;
/// Largest speed of the common stretch, in multiples of the stretch at the pretension, 1/s.
const FASTEST: f64 = 3.0;
/// Missing fraction of the pretension at which the motors stop.
const REACHED: f64 = 0.03;
/// Missing fraction at which they move again, so that friction causes no limit cycle. Up to it the take-up is complete.
const COMPLETE: f64 = 0.1;
/// Excess fraction with which the take-up is complete too: at its stops a finger has other tensions.
const TOO_HIGH: f64 = 0.5;
/// Fraction of t_min that no tendon may be below, even if the common tension is right.
const LEAST: f64 = 0.9;

/// Fraction of the pretension by which a tendon must exceed its tare, so that it is not slack.
const SLACK: f64 = 0.08;
/// Largest stretch of tendons that pull while another tendon is slack, in multiples of the stretch at the pretension.
const LARGEST_UNOPPOSED: f64 = 2.0;
/// Largest common stretch while a tendon is slack, in the same multiples.
const LARGEST_COMMON: f64 = 4.0;

/// Largest pull while the tendons are slack, in multiples of t_min. It must exceed the friction of a motor.
const STRONGEST_SLACK: f64 = 2.0;
/// Largest pull later, in multiples of the pretension, and in addition `STRONGEST_SLACK`.
const STRONGEST: f64 = 1.5;

/// Distance from its target of a motor that does not follow, m.
const ASTRAY: f64 = 0.003;

/// Time constant of the low-pass filter on the tensions, s.
const SMOOTHING: f64 = 0.003;
/// Time constant of the filter for the question whether a tendon pulls at all, s.
const MORE_SMOOTHING: f64 = 0.02;

/// The constant part of the take-up.
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
    /// Gain from the missing fraction of the pretension to the speed of the common stretch, 1/s.
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
        let mut slack = Slack {
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
        };
        if tensions.min() > ALL_TAUT * self.minimum {
            slack.phase = Phase::Tightening;
            slack.common = self.common_part(&tensions);
            slack.taut_at = travel - self.stretch * slack.common;
            slack.waits_at = slack.taut_at.add_scalar(-GAP);
        }
        slack
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

    /// Runs one cycle. Returns the pulls, N. `weighs` is whether gravity acts on the finger.
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
                // Above more noise only the inertia of the finger makes a taut tendon visible.
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

    /// Changes the common stretch, and moves the targets to it.
    fn tighten(&self, slack: &mut Slack, travel: &Vector4<f64>) {
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
            // A tendon that was taut before its motor moved is not let out.
            let waits = slack.tensions[motor] < self.pretension[motor];
            let wanted = if waits { together[motor].max(slack.waits_at[motor]) } else { together[motor] };
            (wanted - slack.targets.travel[motor]).clamp(-reach, reach)
        });
        slack.targets.travel += steps;
        slack.targets.speed = steps / self.period;

        let taut = std::array::from_fn(|tendon| self.is_taut(slack, tendon));
        // A tendon that holds the finger against gravity does not pull it.
        let pulls = (0..4).any(|tendon| {
            taut[tendon] || !slack.holds[tendon] && slack.gauges[tendon].is_above_noise(slack.smoothed[tendon])
        });
        let slack_remains = taut != [true; 4];
        let rise = steps.component_div(&self.stretch).max();
        slack.unopposed = if slack_remains && pulls { slack.unopposed + rise } else { 0.0 };
        if slack_remains && (slack.unopposed > LARGEST_UNOPPOSED || slack.common > LARGEST_COMMON) {
            self.touch_again(slack, taut);
        }
    }

    /// Winds the tendons in again that are slack although they seemed to have been taut.
    fn touch_again(&self, slack: &mut Slack, taut: [bool; 4]) {
        slack.touched = taut;
        slack.holds = [false; 4];
        slack.gauges.iter_mut().for_each(Gauge::restart);
        slack.targets.integral = Vector4::zeros();
        slack.targets.travel = slack.waits_at;
        (slack.phase, slack.seconds) = (Phase::Touching, 0.0);
    }

    fn is_taut(&self, slack: &Slack, tendon: usize) -> bool {
        let tare = slack.gauges[tendon].tare.min(ALL_TAUT * self.minimum);
        slack.tensions[tendon] - tare > SLACK * self.pretension[tendon]
    }

    /// Returns the common part of the tensions as a fraction of the pretension.
    fn common_part(&self, tensions: &Vector4<f64>) -> f64 {
        self.pretension.dot(tensions) / self.pretension.norm_squared()
    }

    /// Returns the fraction of the pretension that is missing. It is negative if the tensions are too high.
    fn missing(&self, tensions: &Vector4<f64>) -> f64 {
        (1.0 - self.common_part(tensions)).max(LEAST - tensions.min() / self.minimum)
    }
}
