//! The block (RM)^-T of Figure 9 of the report: joint angles from motor angles (eqs. 26-29), corrected for the stretch
//! of the tendons.

use crate::control::number_checks::positive;
use crate::model::Tendons;
use crate::model::configuration::{ConfiguredFinger, Unusable};
use nalgebra::{Matrix3x4, Vector3, Vector4};

/// theta is the upper three rows of R^-T (r m - (t - t_home) / k). R is the 4 x 4 matrix of the moment arms. Its fourth
/// row, the ghost row, is for a joint that does not exist, and makes R invertible (see [`Tendons`]). r are the motor
/// radii, m the motor angles, t the tensions, t_home the tensions at homing, and k the stiffnesses of the tendons.
///
/// Without the second term this is eq. 27. The encoders are on the motors and do not measure the stretch of the
/// tendons. Without the correction the fingertip would be 28 % too soft at 3 N/cm.
#[derive(Clone, Debug)]
pub(crate) struct JointPositions {
    /// (RM)^-T: motor angle, rad, to joint angle, rad.
    from_motors: Matrix3x4<f64>,
    /// Tension above the homing pretension, N, to joint angle, rad.
    from_tensions: Matrix3x4<f64>,
    /// Tensions at which the encoders are zeroed, N.
    home: Vector4<f64>,
}

impl JointPositions {
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons) -> Result<Self, Unusable> {
        positive("tendon.stiffness", &finger.tendon.stiffness)?;
        let from_travel = tendons.joints_from_travel();
        let scaled =
            |factors: Vector4<f64>| Matrix3x4::from_fn(|joint, tendon| from_travel[(joint, tendon)] * factors[tendon]);
        Ok(Self {
            from_motors: scaled(tendons.radius),
            from_tensions: scaled(Vector4::from(finger.tendon.stiffness).map(|stiffness| -1.0 / stiffness)),
            home: tendons.pretension(finger.tendon.minimum),
        })
    }

    /// Returns theta, rad. `tensions` must be low-pass filtered: the correction closes a positive feedback loop around
    /// the tendon controller. This loop is stable only if the correction is slow.
    #[inline]
    pub fn joints(&self, motor_angles: &Vector4<f64>, tensions: &Vector4<f64>) -> Vector3<f64> {
        self.from_motors * motor_angles + self.from_tensions * (tensions - self.home)
    }

    /// Returns theta_dot, rad/s, as measured at the motors, without the stretch of the tendons.
    #[inline]
    pub fn joint_rates(&self, motor_speeds: &Vector4<f64>) -> Vector3<f64> {
        self.from_motors * motor_speeds
    }
}
