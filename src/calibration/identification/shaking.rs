//! Moves the joints back and forth in two directions and at two levels of common tension, and records the tensions and
//! the motor torques of the steady motion.
//!
//! The friction of the pulleys makes the gauges differ from the tensions at the joints, in proportion to the tension.
//! The two levels separate this friction from the Coulomb friction of the joints. The two directions are oblique: every
//! tendon moves in both, but the tendons that move toward their motors are not the same in both, so that each tendon's
//! share of the friction can be found.

use super::joint_friction::{JointFriction, STROKES, Stroke};
use super::motor_friction::MotorFriction;
use crate::calibration::instruments::Instruments;
use crate::calibration::joint_guide::JointGuide;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::Sample;
use nalgebra::{Vector3, Vector4};

/// Amplitude of the motion to either side, rad, of a joint that moves at full speed.
pub(super) const SWING: f64 = 0.3;
/// Speed of all motions except the first, rad/s, of a joint that moves at full speed.
const FAST: f64 = 0.4;
/// Speed of the first motion, rad/s. The difference between the two speeds shows the viscous friction of the joints.
const SLOW: f64 = 0.15;
/// The oblique directions, as parts of the full speed of each joint.
const DIRECTIONS: [[f64; 3]; 2] = [[1.0, 0.5, 1.0], [1.0, -0.5, -1.0]];
/// The motions back and forth: direction, whether at the higher level of tension, and speed.
const MOTIONS: [(usize, bool, f64); STROKES] =
    [(0, false, SLOW), (0, false, FAST), (0, true, FAST), (1, true, FAST), (1, false, FAST)];

/// The higher level of tension: that of the tendon with the largest pretension, as a fraction of t_max
/// (`tendon.maximum`).
const HIGH: f64 = 0.4;
/// Rate at which the common tension changes, N/s.
const RISING: f64 = 10.0;
/// A joint has overcome its friction when it has moved by this angle, rad. Until then the guide moves the anchor of
/// the joint's spring faster by the factor [`HASTE`], because the spring must first build up the torque.
const LOOSE: f64 = 0.02;
const HASTE: f64 = 3.0;
/// Samples are ignored over this distance after every reversal of the motion, rad, for a joint at full speed. The
/// finger oscillates there, and the tendons do not yet slide along their whole length.
const RUN_UP: f64 = 0.2;
/// A joint is blocked if its torque stays at the limit for this time, s.
const BLOCKED: f64 = 0.5;

#[derive(Clone, Copy, Debug)]
pub(super) struct Shaking {
    /// The pose about which the joints move, rad.
    pub centre: Vector3<f64>,
    motion: usize,
    /// 0: to the start of the motion. 1 and 2: back and forth.
    leg: usize,
    /// Joint angles at the beginning of the leg, rad.
    from: Option<Vector3<f64>>,
    /// Time for which the torque of a joint has been at its limit, s.
    strained_for: f64,
    pub joints: JointFriction,
    pub motors: MotorFriction,
}

impl Shaking {
    /// Creates a motion about the pose `centre`, rad, which must leave room of [`SWING`] on both sides.
    pub fn new(centre: Vector3<f64>) -> Self {
        Self {
            centre,
            motion: 0,
            leg: 0,
            from: None,
            strained_for: 0.0,
            joints: JointFriction::new(),
            motors: MotorFriction::new(),
        }
    }

    /// Returns the part that is done, 0 to 1.
    pub fn part(&self) -> f64 {
        (3 * self.motion + self.leg) as f64 / (3 * STROKES) as f64
    }

    /// Runs one cycle of the servo. Returns whether all motions are complete.
    pub fn step(
        &mut self,
        instruments: &Instruments,
        sample: &Sample,
        guide: &mut JointGuide,
    ) -> Result<bool, Obstacle> {
        let (direction, high, speed) = MOTIONS[self.motion];
        let direction = Vector3::from(DIRECTIONS[direction]);
        let level_reached = change_level(guide, instruments, high);
        let forward = self.leg != 1;
        let target = self.centre + direction * if forward { SWING } else { -SWING };
        let from = *self.from.get_or_insert(guide.joints);
        let heading = if forward { direction } else { -direction };
        // Only the motions back and forth are along the direction.
        let heading = if self.leg == 0 { (target - from).map(f64::signum) } else { heading };
        let moved = (guide.joints - from).component_mul(&heading.map(f64::signum));
        let left = (target - guide.joints).component_mul(&heading.map(f64::signum));
        for joint in 0..3 {
            if left[joint] > 0.0 {
                let haste = if self.leg > 0 && moved[joint] < LOOSE { HASTE } else { 1.0 };
                let beyond = target[joint] + heading[joint].signum();
                guide.advance(joint, beyond, haste * speed * heading[joint].abs() * instruments.period);
            }
        }
        let steady = (0..3).all(|joint| left[joint] > 0.0 && moved[joint] > RUN_UP * heading[joint].abs());
        if self.leg > 0 && steady {
            let stroke = Stroke { high, rates: heading * speed, direction: MOTIONS[self.motion].0 };
            self.joints.add(self.motion, self.leg - 1, stroke, instruments.tensions(sample.feedback));
            let speeds = instruments.tendons.r.tr_mul(&stroke.rates);
            self.motors.add(instruments, sample, &speeds, &fastest(instruments));
        }
        self.check_blocked(instruments, guide)?;
        if level_reached && left.max() <= 0.0 {
            (self.leg, self.from) = (self.leg + 1, None);
            if self.leg == 3 {
                (self.motion, self.leg) = (self.motion + 1, 0);
            }
        }
        Ok(self.motion == STROKES)
    }

    fn check_blocked(&mut self, instruments: &Instruments, guide: &JointGuide) -> Result<(), Obstacle> {
        let blocked = (0..3).find(|&joint| guide.strained(joint));
        self.strained_for = if blocked.is_some() { self.strained_for + instruments.period } else { 0.0 };
        match blocked.filter(|_| self.strained_for > BLOCKED) {
            Some(joint) => Err(Obstacle::JointBlocked { joint: joint as u8, returning: false }),
            None => Ok(()),
        }
    }
}

/// Changes the common tension toward its lower or higher level. Returns whether it has this level.
pub(super) fn change_level(guide: &mut JointGuide, instruments: &Instruments, high: bool) -> bool {
    let level = if high {
        (HIGH * instruments.maximum / instruments.pretension.max() - 1.0).max(0.0) * instruments.minimum
    } else {
        0.0
    };
    let rise = RISING * instruments.period;
    guide.common += (level - guide.common).clamp(-rise, rise);
    guide.common == level
}

/// Returns the largest speed of each tendon in all motions, cm/s.
fn fastest(instruments: &Instruments) -> Vector4<f64> {
    let speeds = DIRECTIONS.map(|direction| instruments.tendons.r.tr_mul(&Vector3::from(direction)).abs() * FAST);
    speeds[0].sup(&speeds[1])
}
