//! The direction in which the tendons last slid in their conduits.

use nalgebra::Vector4;

/// Least friction that is assumed, as a fraction of the tension. It keeps noise of the encoders from looking like a
/// change of direction.
const LEAST: f64 = 0.01;

/// For every tendon, the part of its conduit friction that acts: +1 after winding in, -1 after letting out, and a value
/// in between while the motor turns back. A motor that turns back first stretches or relaxes only its own end of the
/// tendon. The tendon slides again when the tension of that end has changed by twice the friction.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Winding {
    before: Option<Vector4<f64>>,
    pub friction: Vector4<f64>,
}

impl Winding {
    /// Updates the directions after the motors have moved to `travel`, cm, at `tensions`, N. `conduit` is the friction
    /// as a fraction of the tension, and `compliance` is the compliance of the tendons, cm/N.
    pub fn follow(
        &mut self,
        travel: &Vector4<f64>,
        tensions: &Vector4<f64>,
        conduit: &Vector4<f64>,
        compliance: &Vector4<f64>,
    ) {
        let moved = travel - self.before.replace(*travel).unwrap_or(*travel);
        for tendon in 0..4 {
            // Half of the compliance is taken to be on the motor's side of the friction.
            let reach = conduit[tendon].max(LEAST) * tensions[tendon].max(1.0) * compliance[tendon];
            self.friction[tendon] = (self.friction[tendon] + 2.0 * moved[tendon] / reach).clamp(-1.0, 1.0);
        }
    }
}
