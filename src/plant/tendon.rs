//! The four tendons: one-sided springs between the pulleys of the motors and the joints.

use crate::model::TendonsError;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::{Matrix3x4, Vector3, Vector4};

/// Springs t = k max(0, r m - R^T theta + t_home / k). The motor angles are zero at theta = 0 with the homing
/// pretension.
#[derive(Clone, Debug)]
pub(super) struct ElasticTendons {
    /// R, m.
    r: Matrix3x4<f64>,
    /// Radii of the motor pulleys, m.
    pub radius: Vector4<f64>,
    /// Stiffness, N/m.
    stiffness: Vector4<f64>,
    /// Stretch at motor angle zero and theta = 0, m.
    home_stretch: Vector4<f64>,
    /// Torn tendons, which have no tension.
    cut: [bool; 4],
    /// Tension above which each tendon slips in its clamp, N. It is infinite for a tendon that cannot slip.
    grip: Vector4<f64>,
    /// Length that slipping has added to each tendon, m.
    slipped: Vector4<f64>,
}

impl ElasticTendons {
    pub fn new(finger: &ConfiguredFinger) -> Result<Self, TendonsError> {
        let tendons = finger.tendons()?;
        let stiffness = Vector4::from(finger.simulation.tendon_stiffness) * 100.0;
        Ok(Self {
            r: tendons.r * 0.01,
            radius: tendons.radius * 0.01,
            home_stretch: tendons.pretension(finger.tendon.minimum).component_div(&stiffness),
            stiffness,
            cut: [false; 4],
            grip: Vector4::repeat(f64::INFINITY),
            slipped: Vector4::zeros(),
        })
    }

    /// Returns the tensions, N, at joint angles and motor angles, rad. The tension of a slack tendon is zero.
    pub fn tensions(&self, theta: &Vector3<f64>, motor: &Vector4<f64>) -> Vector4<f64> {
        self.stretch(theta, motor).component_mul(&self.stiffness)
    }

    /// Tears a tendon, 0 to 3.
    pub fn cut(&mut self, tendon: usize) {
        self.cut[tendon] = true;
    }

    /// Loosens the clamp of a tendon, 0 to 3. From now on the tendon slips at tensions above `grip`, N.
    pub fn loosen(&mut self, tendon: usize, grip: f64) {
        self.grip[tendon] = grip;
    }

    /// Restores all tendons to their initial state.
    pub fn restore(&mut self) {
        self.cut = [false; 4];
        self.grip = Vector4::repeat(f64::INFINITY);
        self.slipped = Vector4::zeros();
    }

    /// Makes each tendon slip if its tension exceeds its grip.
    pub fn slip(&mut self, theta: &Vector3<f64>, motor: &Vector4<f64>) {
        if self.grip.min() == f64::INFINITY {
            return;
        }
        let beyond = (self.tensions(theta, motor) - self.grip).map(|beyond| beyond.max(0.0));
        self.slipped += beyond.component_div(&self.stiffness);
    }

    /// Returns tau = R t, eq. 13, N m.
    pub fn joint_torque(&self, tensions: &Vector4<f64>) -> Vector3<f64> {
        self.r * tensions
    }

    /// Returns the motor angles, rad, at which the finger has the joint angles `theta` with the homing pretension.
    pub fn motor_angles_at(&self, theta: &Vector3<f64>) -> Vector4<f64> {
        self.r.tr_mul(theta).component_div(&self.radius)
    }

    /// Returns the elastic energy, J.
    pub fn energy(&self, theta: &Vector3<f64>, motor: &Vector4<f64>) -> f64 {
        let stretch = self.stretch(theta, motor);
        0.5 * self.stiffness.dot(&stretch.component_mul(&stretch))
    }

    fn stretch(&self, theta: &Vector3<f64>, motor: &Vector4<f64>) -> Vector4<f64> {
        let stretch = self.radius.component_mul(motor) - self.r.tr_mul(theta) + self.home_stretch - self.slipped;
        Vector4::from_fn(|tendon, _| if self.cut[tendon] { 0.0 } else { stretch[tendon].max(0.0) })
    }
}
