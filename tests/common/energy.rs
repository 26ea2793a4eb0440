//! Checks that simulated parts gain no energy while nothing supplies any.

use proptest::prelude::*;

/// Returns how many steps of 0.1 ms a case of a property takes: 30 ms, and 0.6 s in one case of 32.
///
/// Most defects show in the first steps after the start, because the initial state is drawn at random. Many short cases
/// find more of them than a few long cases do. Only long cases show a slow rise of the mean energy.
pub fn steps() -> impl Strategy<Value = usize> {
    prop_oneof![31 => Just(300usize), 1 => Just(6000usize)]
}

/// Takes this number of steps of 0.1 ms, and panics if energy is gained.
///
/// `start` is the pair of the total and the kinetic energy before the first step, J. `step` takes one step, and returns
/// the same pair after it.
///
/// With the total energy H, the potential energy V and the step h, semi-implicit Euler conserves H - h/2 dq/dt dV/dq,
/// not H. A mode of w rad/s therefore shows an energy error of up to e = w h/2 times the energy that swings in it.
/// `error` is e for the fastest mode. Over 100 ms this error averages out, except for two parts:
///
/// * Energy that moves from a slow to a fast mode raises the mean of H by the fraction e^2. The motion of a mode is
///   q_n = Q sin(n a) and p_n = Q w cos((n - 1/2) a) with sin(a/2) = e. So the mean of H is w^2 Q^2/2, the mean of
///   h/2 w^2 p q is e^2 times as large, and the conserved energy is the mean of H times 1 - e^2.
/// * The mean of h/2 dV/dt is h/2 times the change of V, divided by 100 ms.
pub fn assert_gains_no_energy(start: (f64, f64), mut step: impl FnMut() -> (f64, f64), error: f64, steps: usize) {
    /// Steps over which the mean energy is computed.
    const AVERAGED: usize = 1000;
    /// Rounding, J.
    const ROUNDING: f64 = 1e-7;
    let (start, mut fastest) = start;
    let energies: Vec<f64> = (0..steps)
        .map(|_| {
            let (whole, kinetic) = step();
            // f64::max ignores NaN, and with an infinite energy the permitted gain is infinite too. So without this
            // check, a simulation that has diverged would pass.
            assert!(
                whole.is_finite() && kinetic.is_finite(),
                "diverged: from {start} J to {whole} J, of which {kinetic} J are kinetic"
            );
            fastest = fastest.max(kinetic);
            whole
        })
        .collect();
    // The energy that moved from springs into motion or was lost to friction.
    let swing = fastest.max(start - energies.iter().copied().fold(start, f64::min));
    let highest = energies.iter().copied().fold(start, f64::max);
    let permitted = error * swing + ROUNDING;
    assert!(
        highest - start <= permitted,
        "energy is gained: from {start} J to {highest} J; {permitted} J is permitted"
    );
    let mean: Vec<f64> =
        energies.chunks_exact(AVERAGED).map(|part| part.iter().sum::<f64>() / AVERAGED as f64).collect();
    let rise = error * error + 0.5 / AVERAGED as f64;
    for pair in mean.windows(2) {
        let permitted = rise * swing + ROUNDING;
        assert!(pair[1] - pair[0] <= permitted, "mean energy rises by more than {permitted} J: {mean:?} J");
    }
}
