//! The slowest mode of a motion that decays or grows by itself.

use nalgebra::{Complex, DMatrix, DVector};

/// Below this part of the largest sample one is rounding.
const ROUNDING: f64 = 1e-6;
/// Samples that a recurrence is fitted to.
const WINDOW: usize = 80;
/// A recurrence that misses by less than this part explains the samples.
const EXPLAINED: f64 = 1e-3;
const LARGEST_ORDER: usize = 8;
/// Of the last sample: a root with less of it is none.
const PART: f64 = 0.01;

/// By which factor the slowest mode of a freely decaying (or growing) linear system changes from one sample to the
/// next: its largest eigenvalue's modulus. `samples`: one vector of channels an instant, equally spaced, the channels
/// in proportion to one another.
///
/// After the fast modes have gone the last samples obey a short recurrence y[k] = a1 y[k-1] + ... + ap y[k-p], the same
/// in every channel, and its roots are the eigenvalues left (Prony). The shortest one that explains them has hardly any
/// others, and of these the motion has no part. Where none explains them, as at a joint limit that one motion touches
/// and the other does not, roots say nothing, and the mean change of the samples does.
pub fn growth(samples: &[DVector<f64>]) -> f64 {
    if samples.iter().any(|sample| !sample.norm().is_finite()) {
        return f64::NAN;
    }
    let largest = samples.iter().map(|sample| sample.norm()).fold(0.0, f64::max);
    // What comes after the first sample that is lost in rounding is lost too.
    let end = samples.iter().position(|sample| sample.norm() <= ROUNDING * largest).unwrap_or(samples.len());
    let window = &samples[end.saturating_sub(WINDOW)..end];
    for order in 1..=LARGEST_ORDER.min(window.len().saturating_sub(2)) {
        let Some((coefficients, missed)) = recurrence(window, order) else { break };
        if missed < EXPLAINED {
            let root = largest_root(window, &coefficients);
            return if has_died(&samples[end..], root, ROUNDING * largest) { mean_change(window) } else { root };
        }
    }
    mean_change(window)
}

/// Whether what `follows` shows that a root is none: of a mode that grows so fast, with the least part that counts,
/// something would be left above `rounding`.
fn has_died(follows: &[DVector<f64>], root: f64, rounding: f64) -> bool {
    root.powi(follows.len() as i32) * PART > 1.0 && follows.iter().all(|sample| sample.norm() <= rounding)
}

/// From the largest sample of the first half to that of the second, as a factor from one to the next. NaN of less than
/// two.
fn mean_change(window: &[DVector<f64>]) -> f64 {
    let half = window.len() / 2;
    if half == 0 {
        return f64::NAN;
    }
    let largest = |part: &[DVector<f64>]| part.iter().map(|sample| sample.norm()).fold(0.0, f64::max);
    (largest(&window[half..]) / largest(&window[..half])).powf(1.0 / half as f64)
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

/// The largest modulus among those roots of z^p - a1 z^(p-1) - ... - ap that the last sample has a part of.
///
/// The slowest mode has most of it. A root beyond it fits a last digit somewhere, and would foretell a motion that is
/// not there.
fn largest_root(window: &[DVector<f64>], coefficients: &DVector<f64>) -> f64 {
    let order = coefficients.len();
    let companion = DMatrix::from_fn(order, order, |row, column| match (row, column) {
        (0, column) => coefficients[column],
        (row, column) => f64::from(row == column + 1),
    });
    let roots = companion.complex_eigenvalues();
    // sample[k] = sum of c_i z_i^k, every instant counting alike; every power's largest is 1.
    let weights: Vec<f64> = window.iter().map(|sample| sample.norm().recip()).collect();
    let mut powers = DMatrix::from_fn(window.len(), order, |k, root| roots[root].powi(k as i32) * weights[k]);
    for mut power in powers.column_iter_mut() {
        let largest = power.iter().map(|power| power.norm()).fold(0.0, f64::max);
        power.apply(|power| *power /= largest);
    }
    let samples =
        DMatrix::from_fn(window.len(), window[0].len(), |k, channel| Complex::from(window[k][channel] * weights[k]));
    let Ok(parts) = powers.clone().svd(true, true).solve(&samples, 1e-12) else { return f64::NAN };
    let last = window.len() - 1;
    let has_part = |root: &usize| powers[(last, *root)].norm() * parts.row(*root).norm() >= PART;
    (0..order).filter(has_part).map(|root| roots[root].norm()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A decay with a tiny part of something that grows, for so many samples, and then `after`.
    fn growing(length: i32, after: &[f64]) -> f64 {
        let decay = (0..length).map(|k| 0.8f64.powi(k) + 1e-14 * 1.3f64.powi(k));
        let samples: Vec<_> = decay.chain(after.iter().copied()).map(|sample| DVector::repeat(2, sample)).collect();
        growth(&samples)
    }

    #[test]
    fn a_root_that_what_follows_contradicts_is_none() {
        assert!((growing(61, &[]) - 1.3).abs() < 1e-3);
        assert!((growing(61, &[0.0; 5]) - 1.3).abs() < 1e-3, "too soon to tell");
        assert!((growing(61, &[0.0; 30]) - 0.8).abs() < 0.05);
        let grows: Vec<f64> = (61..91).map(|k| 1e-14 * 1.3f64.powi(k)).collect();
        assert!((growing(61, &grows) - 1.3).abs() < 1e-3);
    }
}
