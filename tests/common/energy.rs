//! Whether a simulated finger gains energy although nothing supplies any.

use sun2xp::plant::Plant;

/// Lets a finger whose motors have no torque move for 0.6 s, and panics if it gains energy.
///
/// Semi-implicit Euler conserves H - h/2 dq/dt dV/dq, not H. A mode of w rad/s therefore shows an energy error of up to
/// w h/2 of the swinging energy. `error` is this factor for the stiffest mode. Over 100 ms the error averages out, and
/// the mean energy only falls.
pub fn assert_gains_no_energy(plant: &mut Plant, error: f64) {
    /// Rounding, J.
    const ROUNDING: f64 = 1e-7;
    let start = plant.energy();
    let mut fastest: f64 = 0.0;
    let energies: Vec<f64> = (0..6000)
        .map(|_| {
            plant.step([0.0; 4]);
            fastest = fastest.max(plant.kinetic_energy());
            plant.energy()
        })
        .collect();
    // The energy that moved from springs into motion or was lost to friction.
    let swing = fastest.max(start - energies.iter().copied().fold(start, f64::min));
    let highest = energies.iter().copied().fold(start, f64::max);
    assert!(highest - start <= error * swing + ROUNDING, "from {start} J to {highest} J; {swing} J swing");
    let mean: Vec<f64> = energies.chunks(1000).map(|part| part.iter().sum::<f64>() / 1000.0).collect();
    for pair in mean.windows(2) {
        assert!(pair[1] <= pair[0] + 0.05 * error * swing + ROUNDING, "{mean:?}");
    }
}
