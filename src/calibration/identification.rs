//! Identifies the gains of the gauges, the friction of joints, pulleys and motors, the inertia of the rotors, the
//! stiffness of the tendons, and their moment arms.

mod joint_friction;
mod least_squares;
mod moment_arms;
mod motor_friction;
mod oscillating;
mod phases;
mod pressing;
mod ranges;
mod results;
mod rotor_inertia;
mod shaking;
mod tendon_stiffness;
mod winding;

use super::findings::Identified;
use super::instruments::Instruments;
use super::joint_guide::JointGuide;
use super::step::{Sample, Stepped};
use super::stop_search::StopSearch;
use super::take_up::TakeUp;
use crate::model::configuration::{ConfiguredFinger, GaugeReference};
use joint_friction::{FreeFinger, JointFriction};
use moment_arms::MomentArms;
use motor_friction::{MotorFriction, MotorFrictionFound};
use nalgebra::{RowVector4, Vector3, Vector4};
use oscillating::Oscillating;
use pressing::Pressing;
use ranges::Ranges;
use shaking::Shaking;
use tendon_stiffness::TendonStiffness;

#[derive(Clone, Debug)]
pub(super) struct Identification {
    /// Largest torque that moves a joint to its stop, N cm, in addition to the friction that was found.
    torque: f64,
    /// Speed of a joint on the way to its stop, rad/s.
    speed: f64,
    /// Configured angles of the lower and the upper stops, rad.
    stops: (Vector3<f64>, Vector3<f64>),
    /// Whether the angles of the stops are known exactly.
    stops_known: bool,
    /// The pose in which the encoders are zeroed, rad, if the stops are not known.
    pose: Vector3<f64>,
    /// `encoder.zero`, counts.
    zero: [i32; 4],
    /// The configured ghost row of eq. 15.
    ghost: Option<RowVector4<f64>>,
    reference: GaugeReference,
    /// Joint angles at the beginning, rad.
    start: Vector3<f64>,
    /// Tensions and motor torques of the free finger. They are evaluated again when the moment arms are known.
    joint_friction: JointFriction,
    motor_friction: MotorFriction,
    /// The results for the free finger with the configured moment arms.
    free: FreeFinger,
    motors: MotorFrictionFound,
    /// Configured inertia, kg m^2, and viscous friction, N m s/rad, of every rotor.
    rotors: (Vector4<f64>, Vector4<f64>),
    /// The inertia of every rotor that could be measured, kg m^2.
    rotor_inertia: [Option<f64>; 4],
    moment_arms: Option<MomentArms>,
    phase: Phase,
}

// The servo does not use the heap, so every phase has the size of the largest one.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Copy, Debug)]
enum Phase {
    Tighten(TakeUp),
    Shake { guide: JointGuide, shaking: Shaking },
    Oscillate { guide: JointGuide, oscillating: Oscillating },
    Seek { guide: JointGuide, joint: usize, search: StopSearch },
    Range { guide: JointGuide, ranges: Ranges },
    Press { pressing: Pressing, stiffness: TendonStiffness },
    Return { guide: JointGuide, joint: usize, strained: f64, found: Identified },
}

impl Identification {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        Self {
            torque: finger.zeroing.torque,
            speed: finger.zeroing.speed,
            stops: finger.stops(),
            stops_known: finger.stops_known(),
            pose: Vector3::from(finger.zeroing.pose_degrees.map(f64::to_radians)),
            zero: finger.encoder.zero,
            ghost: finger.geometry.ghost_row.map(RowVector4::from),
            reference: finger.gauge.reference,
            start: Vector3::zeros(),
            joint_friction: JointFriction::new(),
            motor_friction: MotorFriction::new(),
            free: FreeFinger {
                gains: Vector4::repeat(1.0),
                gain_uncertainty: 0.0,
                coulomb: Vector3::zeros(),
                viscous: Vector3::zeros(),
                pulley: Vector4::zeros(),
            },
            motors: MotorFrictionFound {
                coulomb: Vector4::zeros(),
                conduit: Vector4::zeros(),
                ratio: Vector4::repeat(1.0),
            },
            rotors: (finger.motor.inertia.into(), finger.motor.viscous_friction.into()),
            rotor_inertia: [None; 4],
            moment_arms: None,
            phase: Phase::Tighten(TakeUp::new()),
        }
    }

    /// Runs one cycle of the current phase. The phases follow each other in the order of the match arms. `Oscillate` is
    /// left out if the rate of the servo is too low for it. `Seek` and `Return` process one joint after the other.
    pub fn step(&mut self, instruments: &mut Instruments, sample: &Sample) -> Stepped {
        match self.phase {
            Phase::Tighten(take_up) => self.take_up_slack(take_up, instruments, sample),
            Phase::Shake { guide, shaking } => self.shake_joints(guide, shaking, instruments, sample),
            Phase::Oscillate { guide, oscillating } => self.oscillate(guide, oscillating, instruments, sample),
            Phase::Seek { guide, joint, search } => self.seek_stop(guide, joint, search, instruments, sample),
            Phase::Range { guide, ranges } => self.move_between_stops(guide, ranges, instruments, sample),
            Phase::Press { pressing, stiffness } => self.press_against_stops(pressing, stiffness, instruments, sample),
            Phase::Return { guide, joint, strained, found } => {
                self.return_to_start(guide, joint, strained, found, instruments, sample)
            }
        }
    }
}
