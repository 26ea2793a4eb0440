//! Feed-forward of the Coulomb friction of motors and conduits. It acts before the observer has found the friction.

use crate::control::motors::motor_friction::MotorFriction;
use nalgebra::Vector4;

/// The full share is fed forward if the motor side of a tendon moves at least at this speed, m/s. A step at zero speed
/// would cause chatter.
const CREEP: f64 = 0.001;

/// Computes the pull that is fed forward, N at the tendon: share sat(v / creep) (coulomb + conduit t), where t is the
/// tension.
///
/// v is the observed speed. If v were the speed of the reference, a limit cycle would remain at high stiffness because
/// of friction. The observer must receive the pull without this feed-forward. Otherwise the disturbance that it
/// estimates would compensate the same friction a second time.
#[derive(Clone, Debug)]
pub(crate) struct FrictionFeedForward {
    pub friction: MotorFriction,
    /// The part of the friction that is fed forward. A finger hunts if the whole configured friction is fed forward and
    /// the true friction is smaller.
    pub share: f64,
}

impl FrictionFeedForward {
    /// Returns the pulls, N, from motor speeds, m/s at the tendon, and tensions, N.
    pub fn pulls(&self, speeds: &Vector4<f64>, tensions: &Vector4<f64>) -> Vector4<f64> {
        Vector4::from_fn(|tendon, _| {
            let friction = self.friction.at(tendon, tensions[tendon].max(0.0));
            (speeds[tendon] / CREEP).clamp(-1.0, 1.0) * self.share * friction
        })
    }
}
