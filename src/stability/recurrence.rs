//! The slowest mode of a motion that decays or grows by itself.

use nalgebra::{DMatrix, DVector};

/// Below this part of the largest sample one is rounding.
const ROUNDING: f64 = 1e-6;
/// Samples that a recurrence is fitted to.
const WINDOW: usize = 80;
/// A recurrence that misses by less than this part explains the samples.
const EXPLAINED: f64 = 1e-3;
const LARGEST_ORDER: usize = 8;

/// By which factor the slowest mode of a freely decaying (or growing) linear system changes from one sample to the next: its
/// largest eigenvalue's modulus. `samples`: one vector of channels an instant, equally
/// spaced, the channels in proportion to one another.
///
/// After the fast modes have gone the last samples obey a short recurrence y[k] = a1 y[k-1] + ... + ap y[k-p], the same in
/// every channel, and its roots are the eigenvalues left (Prony). The shortest one that explains them has no others.
pub fn growth(samples: &[DVector<f64>]) -> f64 {
    if samples.iter().any(|sample| !sample.norm().is_finite()) {
        return f64::NAN;
    }
    let largest = samples.iter().map(|sample| sample.norm()).fold(0.0, f64::max);
    // What comes after the first sample that is lost in rounding is lost too.
    let end = samples.iter().position(|sample| sample.norm() <= ROUNDING * largest).unwrap_or(samples.len());
    let window = &samples[end.saturating_sub(WINDOW)..end];
    let mut found = f64::NAN;
    for order in 1..=LARGEST_ORDER.min(window.len().saturating_sub(2)) {
        let Some((coefficients, missed)) = recurrence(window, order) else { break };
        found = largest_root(&coefficients);
        if missed < EXPLAINED {
            break;
        }
    }
    found
}

/// a1 .. ap, and the root mean square of what they miss, relative to the samples around.
fn recurrence(window: &[DVector<f64>], order: usize) -> Option<(DVector<f64>, f64)> {
    let channels = window[0].len();
    let rows = (window.len() - order) * channels;
    let (mut before, mut now) = (DMatrix::zeros(rows, order), DVector::zeros(rows));
    for k in order..window.len() {
        // Every instant counts alike, however far the decay has gone.
        let weight = window[k - order..=k].iter().map(|sample| sample.norm()).fold(0.0, f64::max).recip();
        let row = (k - order) * channels;
        now.rows_mut(row, channels).copy_from(&(&window[k] * weight));
        for back in 0..order {
            before.view_mut((row, back), (channels, 1)).copy_from(&(&window[k - 1 - back] * weight));
        }
    }
    let coefficients = before.clone().svd(true, true).solve(&now, 1e-12).ok()?;
    let missed = (before * &coefficients - now).norm() / ((window.len() - order) as f64).sqrt();
    Some((coefficients, missed))
}

/// The largest modulus among the roots of z^p - a1 z^(p-1) - ... - ap.
fn largest_root(coefficients: &DVector<f64>) -> f64 {
    let order = coefficients.len();
    let companion = DMatrix::from_fn(order, order, |row, column| match (row, column) {
        (0, column) => coefficients[column],
        (row, column) => f64::from(row == column + 1),
    });
    companion.complex_eigenvalues().iter().map(|root| root.norm()).fold(0.0, f64::max)
}
