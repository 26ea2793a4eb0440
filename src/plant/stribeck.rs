//! Dry friction that is larger at rest than in motion.

/// A friction F(v) = C (1 + (ratio - 1) exp(-(v / v_s)^2)): the Stribeck curve. C is the Coulomb friction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stribeck {
    /// Static friction divided by Coulomb friction, minus 1.
    excess: f64,
    /// v_s: speed at which the excess has fallen to 1/e.
    speed: f64,
}

impl Stribeck {
    pub fn new(ratio: f64, speed: f64) -> Self {
        Self { excess: ratio - 1.0, speed }
    }

    /// Returns F(v) / C.
    pub fn factor(&self, speed: f64) -> f64 {
        if self.excess == 0.0 {
            return 1.0;
        }
        1.0 + self.excess * (-(speed / self.speed).powi(2)).exp()
    }
}
