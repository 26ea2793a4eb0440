//! Coulomb friction of the joints as impulses. Each impulse is as large as needed to stop its joint, but at most as
//! large as the friction torque allows in one step. The three impulses are computed together, because stopping one
//! joint moves its neighbour.

use nalgebra::{Matrix3, Vector3};

/// Largest number of sweeps of projected Gauss-Seidel. Each sweep leaves a part of the error, because joints 1 and 2
/// are coupled. With the default masses this part is three quarters or less. The iteration ends early when nothing
/// changes.
const SWEEPS: usize = 60;

/// Returns the joint rates after friction. `rates` are those without friction, and `bound` contains the largest impulse
/// of each joint, N m s.
pub(super) fn stop_by_friction(
    rates: Vector3<f64>,
    inverse_inertia: &Matrix3<f64>,
    bound: &Vector3<f64>,
) -> Vector3<f64> {
    let mut rates: Vector3<f64> = rates;
    let mut impulse: Vector3<f64> = Vector3::zeros();
    for _ in 0..SWEEPS {
        let mut largest: f64 = 0.0;
        for joint in 0..3 {
            let compliance: f64 = inverse_inertia[(joint, joint)];
            let wanted: f64 = impulse[joint] - rates[joint] / compliance;
            // The bound is NaN if the simulation has diverged, and f64::clamp would panic then.
            let most: f64 = bound[joint].max(0.0);
            let change: f64 = wanted.clamp(-most, most) - impulse[joint];
            impulse[joint] += change;
            rates += inverse_inertia.column(joint) * change;
            largest = largest.max((change * compliance).abs());
        }
        if largest < 1e-12 {
            break;
        }
    }
    rates
}
