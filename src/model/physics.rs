//! Constants of the simulated physics. They determine which fingers a step of the simulation can integrate.

/// Length of a step, s.
pub(crate) const STEP: f64 = 1e-4;

/// Stiffness of the mechanical stop of a joint, N m/rad. A default motor at its torque limit deflects a stop by at most
/// 0.6 degrees.
pub(crate) const STOP_STIFFNESS: f64 = 100.0;

/// Damping of the mechanical stop of a joint, N m s/rad.
pub(crate) const STOP_DAMPING: f64 = 0.02;
