//! Makes the common tension oscillate at two frequencies while the guide moves the joints slowly.
//!
//! The common tension does not turn the joints. Only the motors turn, and stretch their tendons. At the frequencies of
//! this oscillation most of the pull accelerates the rotors. Before the oscillation, the common tension rises to a
//! higher level, which leaves room for it. The slow motion of the joints turns the motors through several periods of
//! their torque ripple, so that the ripple cancels.

use super::rotor_inertia::{Motors, Oscillation, inertia};
use super::shaking::change_level;
use crate::calibration::instruments::Instruments;
use crate::calibration::joint_guide::JointGuide;
use crate::calibration::step::Sample;
use nalgebra::{Vector3, Vector4};
use std::f64::consts::TAU;

/// The two frequencies, Hz. Heavy rotors reach a smaller amplitude at the higher frequency. It comes first, so that the
/// lower frequency can be given the same amplitude. Both are well above the resonance of the rotors with their tendons:
/// 17 Hz on the default finger. At higher frequencies a lag of the amplifiers matters more.
const FREQUENCIES: [f64; 2] = [60.0, 40.0];
/// Smallest number of servo cycles in a period of the oscillation. At a lower servo rate, the inertia is not measured.
const LEAST_CYCLES: f64 = 7.5;
/// The oscillation grows until every motor has this amplitude at its tendon, cm, and this many counts of its encoder.
/// The friction of a motor that turns so far is smaller than the force that accelerates its rotor.
const TRAVEL: f64 = 0.01;
const COUNTS: f64 = 10.0;
/// The oscillation also stops growing when the amplitude of a tension reaches this part of the tension's mean. Then no
/// tendon becomes slack.
const SWING: f64 = 0.4;
/// Largest amplitude of the commanded common tension as a part of its mean. It may exceed 1, because heavy rotors
/// hardly follow the command.
const LARGEST: f64 = 1.4;
/// Growth of the commanded amplitude in each period, as a part of the mean common tension.
const GROWTH: f64 = 0.04;
/// Duration of the motion of the joints, s: that of settling and measurement at both frequencies.
const MOVING: f64 = 1.2;
/// Number of periods with constant amplitude before the measurement, and number of periods in the measurement.
const SETTLING: usize = 5;
const MEASURED: usize = 24;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Stage {
    /// The common tension rises to its higher level.
    Rise,
    Grow,
    /// Contains the number of the present period, counted from 1. `Measure` contains such a number too.
    Settle(usize),
    Measure(usize),
    Fade,
    /// The common tension falls to the pretension.
    Fall,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Oscillating {
    stage: Stage,
    /// Index of the frequency.
    tone: usize,
    /// Number of the cycle in the period.
    cycle: usize,
    amplitude: f64,
    /// What the common tension adds to the smallest pretension of the tendons, N. The oscillation is not included.
    level: f64,
    /// Pose to which the joints move, rad, and their speed, rad/s.
    target: Vector3<f64>,
    speed: Vector3<f64>,
    /// Pull, tension and travel of the previous cycle.
    last: Option<[Vector4<f64>; 3]>,
    /// The present period.
    now: Oscillation,
    measured: [Oscillation; 2],
}

impl Oscillating {
    /// Creates an oscillation of a finger that moves from its present pose to `target`, rad.
    pub fn new(instruments: &Instruments, guide: &JointGuide, target: Vector3<f64>) -> Self {
        let measured = std::array::from_fn(|tone| Oscillation::new(TAU / cycles(instruments, tone) as f64));
        Self {
            stage: Stage::Rise,
            tone: 0,
            cycle: 0,
            amplitude: 0.0,
            level: 0.0,
            target,
            speed: (target - guide.joints).abs() / MOVING,
            last: None,
            now: measured[0],
            measured,
        }
    }

    /// Returns whether the rate of the servo is high enough.
    pub fn possible(instruments: &Instruments) -> bool {
        FREQUENCIES.iter().all(|frequency| 1.0 >= LEAST_CYCLES * frequency * instruments.period)
    }

    /// Returns the part that is done, 0 to 1.
    pub fn part(&self) -> f64 {
        let measured = self.tone + usize::from(matches!(self.stage, Stage::Fade | Stage::Fall));
        measured as f64 / FREQUENCIES.len() as f64
    }

    /// Runs one cycle of the motion. Returns whether it is complete.
    pub fn step(&mut self, instruments: &Instruments, sample: &Sample, guide: &mut JointGuide) -> bool {
        guide.common = self.level;
        match self.stage {
            Stage::Rise => {
                if change_level(guide, instruments, true) {
                    self.stage = Stage::Grow;
                }
            }
            Stage::Fall => {
                if change_level(guide, instruments, false) {
                    return true;
                }
            }
            _ => {
                self.oscillate(instruments, sample, guide);
                return false;
            }
        }
        self.level = guide.common;
        false
    }

    /// Returns the inertia of each rotor, kg m^2; none if it was not found. `ratio` is the ratio of commanded pull to
    /// tension.
    pub fn inertia(&self, instruments: &Instruments, ratio: &Vector4<f64>) -> [Option<f64>; 4] {
        let motors = Motors { ratio: *ratio, radius: instruments.radius, count: instruments.cm_per_count().abs() };
        inertia(&self.measured, &motors, instruments.period)
    }

    fn oscillate(&mut self, instruments: &Instruments, sample: &Sample, guide: &mut JointGuide) {
        let cycles = cycles(instruments, self.tone);
        let phase = TAU * self.cycle as f64 / cycles as f64;
        let (tensions, travel) = (instruments.tensions(sample.feedback), instruments.travel(sample.feedback));
        // The report is that of the previous cycle, whose command acts from this sample on.
        let pulls = sample.report.motor_torques.component_div(&instruments.signed_radius);
        let values = [pulls, tensions, travel];
        if let Some(last) = self.last.replace(values) {
            let changes = std::array::from_fn(|value| values[value] - last[value]);
            self.now.add(phase, &changes);
            if matches!(self.stage, Stage::Measure(_)) {
                self.measured[self.tone].add(phase, &changes);
            }
        }
        if matches!(self.stage, Stage::Settle(_) | Stage::Measure(_)) {
            for joint in 0..3 {
                guide.advance(joint, self.target[joint], self.speed[joint] * instruments.period);
            }
        }
        guide.common = self.level + (self.level + instruments.minimum) * self.amplitude * phase.sin();
        self.cycle += 1;
        if self.cycle == cycles {
            self.cycle = 0;
            self.finish_period(instruments);
        }
    }

    /// Begins the next period. The amplitude changes only here, where the sine is zero.
    fn finish_period(&mut self, instruments: &Instruments) {
        self.stage = match self.stage {
            Stage::Grow if self.large_enough(instruments) => Stage::Settle(1),
            Stage::Grow => {
                self.amplitude += GROWTH;
                Stage::Grow
            }
            Stage::Settle(SETTLING) => Stage::Measure(1),
            Stage::Settle(periods) => Stage::Settle(periods + 1),
            Stage::Measure(MEASURED) => Stage::Fade,
            Stage::Measure(periods) => Stage::Measure(periods + 1),
            Stage::Fade if self.amplitude > 0.0 => {
                // A sudden end would leave the rotors with a free oscillation that slackens the tendons.
                self.amplitude = (self.amplitude - 2.0 * GROWTH).max(0.0);
                Stage::Fade
            }
            Stage::Fade if self.tone + 1 < FREQUENCIES.len() => {
                self.tone += 1;
                Stage::Grow
            }
            Stage::Fade | Stage::Fall => Stage::Fall,
            Stage::Rise => Stage::Rise,
        };
        self.now = Oscillation::new(TAU / cycles(instruments, self.tone) as f64);
    }

    fn large_enough(&self, instruments: &Instruments) -> bool {
        let wanted = match self.tone {
            0 => instruments.cm_per_count().map(|count| TRAVEL.max(COUNTS * count.abs())),
            // Both frequencies have the same amplitude, because the part of a tendon that slides in its conduit depends
            // on the amplitude.
            _ => self.measured[0].travel(),
        };
        let mean = instruments.pretension * (1.0 + self.level / instruments.minimum);
        let far = self.now.travel().iter().zip(&wanted).all(|(travel, wanted)| travel >= wanted);
        let strong = self.now.tension().iter().zip(&mean).any(|(tension, mean)| *tension >= SWING * mean);
        far || strong || self.amplitude >= LARGEST
    }
}

/// Returns the number of servo cycles in a period of a frequency.
fn cycles(instruments: &Instruments, tone: usize) -> usize {
    (1.0 / (FREQUENCIES[tone] * instruments.period)).round().max(1.0) as usize
}
