//! The elasticity of a tendon: tension against stretch, for a whole tendon and for a section of it.

/// A spring t = k x, or one that hardens: its local stiffness is k (1 - h + c t), with c = 2 h / t_max. It is k (1 - h)
/// without tension and k (1 + h) at t_max. A section with the share s of the tendon's compliance has the tension
/// t(x / s) at its own stretch x.
#[derive(Clone, Copy, Debug)]
pub(super) struct Elasticity {
    /// k, N/m.
    pub stiffness: f64,
    /// 1 - h.
    soft: f64,
    /// c, 1/N.
    slope: f64,
}

/// Largest argument of the exponential function that gives the tension of a hardening spring. It bounds the tension of
/// a tendon that is stretched absurdly far.
const LARGEST_EXPONENT: f64 = 20.0;

impl Elasticity {
    /// `stiffness` is k, N/m. `hardening` is h, 0 to below 1. `maximum` is t_max, N.
    pub fn new(stiffness: f64, hardening: f64, maximum: f64) -> Self {
        Self { stiffness, soft: 1.0 - hardening, slope: 2.0 * hardening / maximum }
    }

    /// Returns the tension, N, at a stretch of the whole tendon, m. A slack tendon has no tension.
    pub fn tension(&self, stretch: f64) -> f64 {
        self.signed_tension(stretch).max(0.0)
    }

    /// Returns the tension, N, of a spring that could also push: negative where the tendon is slack.
    pub fn signed_tension(&self, stretch: f64) -> f64 {
        if self.slope == 0.0 || stretch < 0.0 {
            return stretch * (self.stiffness * self.soft);
        }
        self.soft / self.slope * self.exponent(stretch).exp_m1()
    }

    /// Returns the stretch of the whole tendon, m, at a tension, N.
    pub fn stretch(&self, tension: f64) -> f64 {
        if self.slope == 0.0 {
            return tension / self.stiffness;
        }
        (tension * self.slope / self.soft).ln_1p() / (self.slope * self.stiffness)
    }

    /// Returns the local stiffness of the whole tendon, N/m, at a tension, N, which may be negative.
    pub fn local_stiffness(&self, tension: f64) -> f64 {
        self.stiffness * (self.soft + self.slope * tension.max(0.0))
    }

    /// Returns the elastic energy, J, at a stretch of the whole tendon, m.
    pub fn energy(&self, stretch: f64) -> f64 {
        let stretch = stretch.max(0.0);
        if self.slope == 0.0 {
            return 0.5 * self.stiffness * stretch * stretch;
        }
        let per_stretch = self.slope * self.stiffness;
        self.soft / self.slope * (self.exponent(stretch).exp_m1() / per_stretch - stretch)
    }

    fn exponent(&self, stretch: f64) -> f64 {
        (self.slope * self.stiffness * stretch).min(LARGEST_EXPONENT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The derivative of the energy is the tension, and the derivative of the tension is the local stiffness.
    #[test]
    fn tension_energy_and_stiffness_belong_together() {
        for hardening in [0.0, 0.2, 0.5, 0.9] {
            let spring = Elasticity::new(3e4, hardening, 60.0);
            for newton in [0.1, 5.0, 30.0, 60.0] {
                let (x, d) = (spring.stretch(newton), 1e-7);
                assert!((spring.tension(x) - newton).abs() < 1e-9 * newton);
                let force = (spring.energy(x + d) - spring.energy(x - d)) / (2.0 * d);
                assert!((force / newton - 1.0).abs() < 1e-4, "{force} {newton}");
                let stiffness = (spring.tension(x + d) - spring.tension(x - d)) / (2.0 * d);
                assert!((stiffness / spring.local_stiffness(newton) - 1.0).abs() < 1e-4);
            }
            let ends = [0.0, 60.0].map(|newton| spring.local_stiffness(newton) / 3e4);
            assert!((ends[0] - (1.0 - hardening)).abs() < 1e-12 && (ends[1] - (1.0 + hardening)).abs() < 1e-12);
        }
    }
}
