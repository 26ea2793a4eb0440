//! Inputs and outputs of one servo cycle.

pub use crate::model::configuration::Law;

use crate::control::contact::ContactEstimate;
use crate::control::motion::Motion;
use crate::control::spring::joint_spring::JointSpring;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// The measurements of the board at one instant, in counts.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
pub struct Feedback {
    /// m_c of eq. 28: motor encoder counts, extended to 32 bits.
    pub motor_counts: [i32; 4],
    /// Strain gauge counts.
    pub gauge_counts: [u16; 4],
}

/// Sensor values in physical units: a [`Feedback`] with its scales, signs and zeros applied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// m_theta of eq. 28, rad. It increases as the motor pulls its tendon in.
    pub motor_angles: Vector4<f64>,
    /// Tensions, N.
    pub tensions: Vector4<f64>,
}

/// The spring of a fingertip: its anchor, law, stiffness and damping. The servo always replaces the whole set point.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct SetPoint {
    /// theta_d: desired joint angles, rad. The exact law uses the pose of the tip at these angles.
    pub joints: Vector3<f64>,
    /// The law that converts deflections to torques.
    pub law: Law,
    /// K of [`Contact::stiffness`](crate::model::Contact::stiffness) in the finger's frame, symmetric. Rows and columns
    /// 0 to 2 are translation, N/cm, and 3 to 5 are rotation, N cm/rad.
    pub stiffness: Matrix6<f64>,
    /// Damping relative to the damping that the controller computes from the stiffness.
    /// [`AdmissibleDamping`](crate::control::AdmissibleDamping) defines the permitted range.
    pub damping: f64,
    /// The motion of `joints`; none for a set point at rest. With this motion, the controller follows the set point
    /// without a lag. Without it, the controller smooths each step of the set point.
    #[serde(default)]
    pub motion: Option<Motion>,
    /// The spring in joint angles that acts in addition to `stiffness`; none if there is no such spring.
    #[serde(default)]
    pub joint_spring: Option<JointSpring>,
}

impl SetPoint {
    /// Returns the set point of a hard finger, which has a spring with three dimensions. `stiffness` is Kx, N/cm. The
    /// law is the exact one, and the relative damping is 1.
    pub fn hard_finger(joints: Vector3<f64>, stiffness: Matrix3<f64>) -> Self {
        let stiffness = spatial(&stiffness);
        Self { joints, law: Law::Exact, stiffness, damping: 1.0, motion: None, joint_spring: None }
    }

    /// Replaces the stiffness by a stiffness of the fingertip, as in [`SetPoint::stiffness`]. The joint stiffness ends,
    /// and the constant joint torque stays.
    pub fn stiffen_tip(&mut self, stiffness: Matrix6<f64>) {
        self.stiffness = stiffness;
        if let Some(spring) = self.joint_spring {
            self.joint_spring = JointSpring { k_theta: Matrix3::zeros(), ..spring }.unless_zero();
        }
    }

    /// Replaces the stiffness by a stiffness of the joints, K_theta, N cm/rad. The stiffness of the fingertip ends, and
    /// the constant joint torque stays.
    pub fn stiffen_joints(&mut self, k_theta: Matrix3<f64>) {
        self.stiffness = Matrix6::zeros();
        self.joint_spring = JointSpring { k_theta, ..self.joint_spring.unwrap_or_default() }.unless_zero();
    }

    /// Replaces the constant joint torque, N cm. The stiffness stays.
    pub fn torque_joints(&mut self, torque: Vector3<f64>) {
        self.joint_spring = JointSpring { torque, ..self.joint_spring.unwrap_or_default() }.unless_zero();
    }
}

/// Returns Kx, N/cm, as the 6 x 6 stiffness of a set point. Its rotational part is zero.
pub fn spatial(kx: &Matrix3<f64>) -> Matrix6<f64> {
    let mut stiffness = Matrix6::zeros();
    stiffness.fixed_view_mut::<3, 3>(0, 0).copy_from(kx);
    stiffness
}

/// The activity of a finger in one cycle. The servo thread of the finger selects it.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[expect(clippy::large_enum_variant, reason = "a set point in a box would be allocated and freed in the servo")]
pub enum Activity {
    /// Brings every tendon to the pretension of eq. 20 at zero joint torque, from any amount of slack. The joints stay
    /// where they are.
    TakeUpSlack,
    /// Brings every tendon to the pretension of [`Activity::TakeUpSlack`], without gravity compensation. Once all
    /// tendons are taut at the same time, the joints are held at the angles of that moment. The given values, N, are
    /// the errors of the gauges (shown minus true tension). For calibration.
    Tighten(Vector4<f64>),
    /// Makes the fingertip the spring of this set point.
    Follow(SetPoint),
    /// Ramps the pulls of the motors to zero. The ramp starts in the first cycle of the release.
    Release {
        /// Length of the ramp, s.
        ramp: f64,
    },
    /// Brings every tendon to the given tension, N, from any amount of slack. For calibration.
    Tense(Vector4<f64>),
    /// Applies the given pull of each motor to its tendon, N. The only feedback is the damper of the motor. A negative
    /// pull lets the tendon out. For calibration.
    Pull(Vector4<f64>),
    /// Applies these motor torques, N cm, in the board's sign and without any feedback. For calibration.
    Turn(Vector4<f64>),
}

/// The command to the motors.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct MotorCommand {
    /// m_tau of eq. 22, N cm, in the board's sign: a positive torque pulls if `motor.sign` is +1.
    pub motor_torques: Vector4<f64>,
}

impl MotorCommand {
    /// Returns whether every torque is finite.
    pub fn is_finite(&self) -> bool {
        self.motor_torques.iter().all(|torque| torque.is_finite())
    }
}

/// The measurements and the results of one cycle.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Report {
    /// Measured joint angles, corrected for tendon stretch, rad.
    pub joints: Vector3<f64>,
    /// Measured joint rates, rad/s. With state feedback, these are the rates predicted for shortly before the next
    /// sample.
    pub joint_rates: Vector3<f64>,
    /// Measured tensions, N.
    pub tensions: Vector4<f64>,
    /// Commanded tensions, N, including the dither of state feedback. They are below t_min only while slack is taken
    /// up, during a release and in the activities for calibration.
    pub desired_tensions: Vector4<f64>,
    /// Desired joint torques, N cm. For a finger that follows a set point, they include the damper, the soft joint
    /// limits, the gravity compensation and the feed-forward.
    pub joint_torques: Vector3<f64>,
    /// The fraction of `joint_torques` that the tension bounds permit, 0 to 1. The direction of the torque is kept.
    pub torque_scale: f64,
    /// The fraction of the set point's stiffness that the pose supports, 0 to 1.
    pub stiffness_scale: f64,
    /// Whether every tendon has a tension of at least 0.8 t_min and the motors are at rest. During
    /// [`Activity::TakeUpSlack`], this is true only after the tensions have reached the pretension.
    pub under_tension: bool,
    /// The tendon that is farthest from being under tension, 0 to 3. This value is valid only during
    /// [`Activity::TakeUpSlack`] and [`Activity::Tighten`].
    pub slackest: usize,
    /// Commanded motor torques, N cm.
    pub motor_torques: Vector4<f64>,
    /// What the surroundings exert on the finger.
    pub contact: ContactEstimate,
}
