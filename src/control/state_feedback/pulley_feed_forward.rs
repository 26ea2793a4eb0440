//! Feed-forward of the friction of the pulleys while the reference moves. The gauges do not measure this friction.

use nalgebra::Vector4;

/// The feed-forward is s p t sat(v / c), N. s is the share of the friction that is fed forward, p the friction of the
/// pulleys as a fraction of the tension t, and c the speed from which the share is fed forward in full.
///
/// v is the speed that a tendon has at the joints if they follow the reference. If v were the observed speed, the
/// feed-forward would be a negative damping for a finger that a person pushes. Only configured friction is fed forward:
/// on a finger without this friction, a feed-forward makes steps overshoot.
///
/// The dither of the tensions makes the mean friction of a slow tendon proportional to its speed. Feed-forward of the
/// full friction with the sign of v would therefore be too much near the end of a motion.
#[derive(Clone, Debug)]
pub(crate) struct PulleyFeedForward {
    /// The fraction of each tension that is fed forward.
    fraction: Vector4<f64>,
    /// Reciprocal of the speed from which it is fed forward in full, s/m.
    per_creep: f64,
}

impl PulleyFeedForward {
    /// `pulley` is the friction of the pulleys as a fraction of the tension. `creep` is in m/s. Returns None if there
    /// is nothing to feed forward.
    pub fn new(pulley: &Vector4<f64>, share: f64, creep: f64) -> Option<Self> {
        let fraction = pulley * share;
        (fraction.max() > 0.0).then(|| Self { fraction, per_creep: creep.recip() })
    }

    /// Returns the additional tensions at the joints, N, from the speeds of the tendons, m/s, and the tensions, N.
    pub fn tensions(&self, speeds: &Vector4<f64>, tensions: &Vector4<f64>) -> Vector4<f64> {
        Vector4::from_fn(|tendon, _| {
            (speeds[tendon] * self.per_creep).clamp(-1.0, 1.0) * self.fraction[tendon] * tensions[tendon]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_of_the_friction_acts_in_the_direction_of_the_motion() {
        let law = PulleyFeedForward::new(&Vector4::new(0.1, 0.1, 0.1, 0.0), 0.5, 0.004).expect("there is friction");
        let found = law.tensions(&Vector4::new(1.0, -1.0, 0.002, 1.0), &Vector4::repeat(10.0));
        assert!((found - Vector4::new(0.5, -0.5, 0.25, 0.0)).amax() < 1e-12, "{found}");
        assert!(PulleyFeedForward::new(&Vector4::zeros(), 0.5, 0.004).is_none());
    }
}
