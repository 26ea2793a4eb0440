//! The Coulomb friction of the motors and their conduits, cancelled before the observer has to find it.

use crate::control::motors::motor_friction::MotorFriction;
use nalgebra::Vector4;

/// Motor speed at the tendon from which its friction is fed forward whole, m/s. A step at zero would chatter.
const CREEP: f64 = 0.001;

/// sat(v / creep) (Coulomb + conduit t), N at the tendon.
///
/// v is the observed speed: with the speed of the reference in its place friction leaves a limit cycle at high
/// stiffness. The observer must be told the pull without this, or its disturbance would compensate the same friction a
/// second time.
#[derive(Clone, Debug)]
pub(crate) struct FrictionFeedForward(pub MotorFriction);

impl FrictionFeedForward {
    /// Motor speeds, m/s; tensions, N.
    pub fn pulls(&self, speeds: &Vector4<f64>, tensions: &Vector4<f64>) -> Vector4<f64> {
        Vector4::from_fn(|tendon, _| {
            let friction = self.0.at(tendon, tensions[tendon].max(0.0));
            (speeds[tendon] / CREEP).clamp(-1.0, 1.0) * friction
        })
    }
}
