//! One elastic contact with Coulomb friction, between a point and a surface.
//!
//! The contact has a spring and a damper normal to the surface, and another pair along the surface. The spring along
//! the surface holds a resting contact without creep: the point sticks until the friction limit is reached. A friction
//! force that depends only on the sliding speed would let a held object creep.

use nalgebra::Vector3;

/// How deep a point is below a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Indentation {
    /// Depth, m.
    pub depth: f64,
    /// Outward unit normal of the surface.
    pub outward: Vector3<f64>,
}

/// A contact with its memory: the stretch of the spring along the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrictionContact {
    /// Stiffness normal to the surface and along it, N/m.
    stiffness: f64,
    /// Damping normal to the surface and along it, N s/m.
    damping: f64,
    /// Coefficient of friction.
    friction: f64,
    /// Stretch of the spring along the surface, m.
    stretch: Vector3<f64>,
}

impl FrictionContact {
    pub fn new(stiffness: f64, damping: f64, friction: f64) -> Self {
        Self { stiffness, damping, friction, stretch: Vector3::zeros() }
    }

    /// Advances the contact by `step`, s. Returns the force on the point, N. `velocity` is the velocity of the point
    /// relative to the surface, m/s.
    pub fn advance(&mut self, touched: Option<Indentation>, velocity: &Vector3<f64>, step: f64) -> Vector3<f64> {
        let Some(Indentation { depth, outward }) = touched else {
            self.stretch = Vector3::zeros();
            return Vector3::zeros();
        };
        let leaving = velocity.dot(&outward);
        let along = velocity - outward * leaving;
        // The damper never pulls the point to the surface.
        let normal = (self.stiffness * depth - self.damping * leaving).max(0.0);
        let limit = self.friction * normal;
        // The surface may have turned since the last step, so the stretch may have a component normal to the surface.
        // This component is removed, which can only reduce the energy.
        let stretch = self.stretch - outward * self.stretch.dot(&outward) + along * step;
        self.stretch = stretch.cap_magnitude(limit / self.stiffness);
        let sideways = (self.stretch * self.stiffness + along * self.damping).cap_magnitude(limit);
        outward * normal - sideways
    }

    /// Returns the elastic energy at this depth, m, in J.
    pub fn energy(&self, depth: f64) -> f64 {
        0.5 * self.stiffness * (depth * depth + self.stretch.norm_squared())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 1e-4;
    const PRESSED: Indentation = Indentation { depth: 1e-3, outward: Vector3::new(0.0, 0.0, 1.0) };

    fn contact() -> FrictionContact {
        FrictionContact::new(5000.0, 5.0, 0.5)
    }

    #[test]
    fn a_resting_contact_holds_a_force_below_the_limit_without_creep() {
        let mut contact = contact();
        // A normal force of 5 N holds 2.5 N along the surface. A motion of 0.4 mm needs 2 N.
        for _ in 0..400 {
            contact.advance(Some(PRESSED), &Vector3::new(0.01, 0.0, 0.0), STEP);
        }
        for _ in 0..100_000 {
            let force = contact.advance(Some(PRESSED), &Vector3::zeros(), STEP);
            assert!((force - Vector3::new(-2.0, 0.0, 5.0)).amax() < 1e-9, "{force}");
        }
    }

    #[test]
    fn a_sliding_contact_has_the_friction_of_coulomb() {
        let mut contact = contact();
        let velocity = Vector3::new(0.03, 0.04, 0.0);
        let mut force = Vector3::zeros();
        for _ in 0..10_000 {
            force = contact.advance(Some(PRESSED), &velocity, STEP);
        }
        assert!((force - Vector3::new(-1.5, -2.0, 5.0)).amax() < 1e-9, "{force}");
        assert!(contact.energy(0.0) <= 0.5 * 5000.0 * (2.5f64 / 5000.0).powi(2) + 1e-12);
    }

    #[test]
    fn a_contact_pushes_and_never_pulls_and_forgets_when_it_is_lost() {
        let mut contact = contact();
        contact.advance(Some(PRESSED), &Vector3::new(1.0, 0.0, 0.0), STEP);
        assert_eq!(contact.advance(Some(PRESSED), &Vector3::new(0.0, 0.0, 10.0), STEP), Vector3::zeros());
        assert_eq!(contact.advance(None, &Vector3::new(1.0, 2.0, 3.0), STEP), Vector3::zeros());
        assert_eq!(contact.energy(0.0), 0.0);
    }
}
