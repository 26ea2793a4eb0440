//! What goes in and comes out of one servo cycle.

pub use crate::model::configuration::Law;

use nalgebra::{Matrix3, Matrix6, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// What the board measured at one instant, as it measured it.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
pub struct Feedback {
    /// m_c of eq. 28: motor encoder counts, without wrap.
    pub motor_counts: [i32; 4],
    /// Strain gauge counts.
    pub gauge_counts: [u16; 4],
}

/// What the sensors say, in units: a [`Feedback`] with its scales, signs and zeros applied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// m_theta of eq. 28, rad; rising as the tendon is pulled in.
    pub motor_angles: Vector4<f64>,
    /// N.
    pub tensions: Vector4<f64>,
}

/// Where a fingertip's spring is anchored and how stiff it is. Taken over whole.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct SetPoint {
    /// theta_d: desired joint angles, rad. With the exact law it stands for the tip's pose there.
    pub joints: Vector3<f64>,
    /// How deflections become torques.
    pub law: Law,
    /// K of [`Contact::stiffness`](crate::model::Contact::stiffness) in the finger's frame; symmetric: rows and columns
    /// 0 to 2 translation, N/cm, 3 to 5 rotation, N cm/rad.
    pub stiffness: Matrix6<f64>,
    /// Damping relative to what the controller chooses from the stiffness: 1 is that.
    /// [`AdmissibleDamping`](crate::control::AdmissibleDamping) has the range.
    pub damping: f64,
}

impl SetPoint {
    /// A hard finger, so a spring of three dimensions: `stiffness` is Kx, N/cm. The report's law, the chosen damping.
    pub fn hard_finger(joints: Vector3<f64>, stiffness: Matrix3<f64>) -> Self {
        let stiffness = spatial(&stiffness);
        Self { joints, law: Law::Report, stiffness, damping: 1.0 }
    }
}

/// Kx, N/cm, as the stiffness of a set point: without rotation.
pub fn spatial(kx: &Matrix3<f64>) -> Matrix6<f64> {
    let mut stiffness = Matrix6::zeros();
    stiffness.fixed_view_mut::<3, 3>(0, 0).copy_from(kx);
    stiffness
}

/// What a finger is doing; decided by its servo thread.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[expect(clippy::large_enum_variant, reason = "a set point in a box would be allocated and freed in the servo")]
pub enum Activity {
    /// Every tendon is brought to the pretension of eq. 20 at zero joint torque, from whatever slack there is; the
    /// joints are held where they are.
    TakeUpSlack,
    /// The same by gauges that are known to show so much too much, N, and whatever the joints are. For calibration.
    Tighten(Vector4<f64>),
    /// The fingertip is a spring.
    Follow(SetPoint),
    /// Motor torques ramp to zero over so many seconds from the first such cycle.
    Release {
        /// Length of the ramp, s.
        ramp: f64,
    },
    /// Every tendon is brought to a tension of its own, N, from whatever slack there is. For calibration.
    Tense(Vector4<f64>),
    /// Every motor pulls so much at its tendon, N, against its damper only; negative lets out. For calibration.
    Pull(Vector4<f64>),
    /// Every motor gets this torque, N cm, as the board takes it: no sign, no feedback. For calibration.
    Turn(Vector4<f64>),
}

/// What the motors shall do.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct MotorCommand {
    /// m_tau of eq. 22, N cm, as the board takes it: a positive one pulls where `motor.sign` is +1.
    pub motor_torques: Vector4<f64>,
}

impl MotorCommand {
    /// Whether every torque is a finite number.
    pub fn is_finite(&self) -> bool {
        self.motor_torques.iter().all(|torque| torque.is_finite())
    }
}

/// What one cycle found and decided.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Report {
    /// Measured joint angles, corrected for tendon stretch, rad.
    pub joints: Vector3<f64>,
    /// Measured joint rates, rad/s.
    pub joint_rates: Vector3<f64>,
    /// Measured tensions, N.
    pub tensions: Vector4<f64>,
    /// Commanded tensions, N, with the dither of state feedback: never below t_min but while slack is taken up and
    /// during a release.
    pub desired_tensions: Vector4<f64>,
    /// Joint torques that the stiffness law asked for, N cm.
    pub joint_torques: Vector3<f64>,
    /// The part of `joint_torques` that the tension limits let through, 0 to 1; its direction is kept.
    pub torque_scale: f64,
    /// The part of the set point's stiffness that the pose can carry, 0 to 1.
    pub stiffness_scale: f64,
    /// Every tendon has at least 0.8 t_min, and the motors are at rest: slack is taken up. Not before the tensions have
    /// risen to where they shall be.
    pub under_tension: bool,
    /// While slack is taken up, the tendon that is farthest from being under tension, 0 to 3.
    pub slackest: usize,
    /// The command, N cm.
    pub motor_torques: Vector4<f64>,
}
