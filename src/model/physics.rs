//! Constants of the simulated physics. They determine which fingers a step of the simulation can integrate.

/// Length of a step, s.
pub(crate) const STEP: f64 = 1e-4;

/// Stiffness of the mechanical stop of a joint, N m/rad. A default motor at its torque limit deflects a stop by at most
/// 0.6 degrees.
pub(crate) const STOP_STIFFNESS: f64 = 100.0;

/// Damping of the mechanical stop of a joint, N m s/rad.
pub(crate) const STOP_DAMPING: f64 = 0.02;

/// Range of the inertia of a rotor, kg m^2.
pub(crate) const SMALLEST_INERTIA: f64 = 1e-8;
pub(crate) const LARGEST_INERTIA: f64 = 1.0;

/// Returns the smallest inertia, kg m^2, of a rotor whose motion a step can integrate. `stiffness` is that of its
/// tendon, N/cm, and `radius` is in cm.
pub(crate) fn least_inertia(stiffness: f64, radius: f64) -> f64 {
    // The factors 100 and 0.01 convert N/cm to N/m and cm to m.
    (stiffness * 100.0) * (radius * 0.01 * STEP).powi(2)
}

/// Returns the largest viscous friction, N m s/rad, with which a step can integrate a rotor. `inertia` is at least
/// `least`, the result of [`least_inertia`].
pub(crate) fn largest_viscous_friction(inertia: f64, least: f64) -> f64 {
    (inertia - least) / (2.0 * STEP)
}

/// Returns the smallest inertia, kg m^2, with which a step can integrate a rotor that has this viscous friction,
/// N m s/rad. `least` is the smallest inertia without friction, the result of [`least_inertia`].
pub(crate) fn inertia_for(viscous: f64, least: f64) -> f64 {
    least + 2.0 * STEP * viscous
}

/// Returns whether a step can integrate a rotor with this inertia, kg m^2, and this viscous friction, N m s/rad.
pub(crate) fn resolves_rotor(inertia: f64, stiffness: f64, radius: f64, viscous: f64) -> bool {
    let least = least_inertia(stiffness, radius);
    inertia >= least && viscous <= largest_viscous_friction(inertia, least)
}
