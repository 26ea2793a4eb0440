//! The slowest mode of a freely decaying or growing motion.

use nalgebra::{Complex, DMatrix, DVector};

/// A sample counts as mere rounding error if it is at most this fraction of the largest sample.
const ROUNDING: f64 = 1e-6;
/// Number of samples to which a recurrence is fitted.
const WINDOW: usize = 80;
/// A recurrence explains the samples if its relative error is below this value.
const EXPLAINED: f64 = 1e-3;
const LARGEST_ORDER: usize = 8;
/// A root counts only if it contributes at least this fraction of the last sample.
const LEAST_SHARE: f64 = 0.01;

/// Returns the factor by which the slowest mode of a freely decaying or growing linear system changes from one sample
/// to the next. This factor is the largest modulus of the system's eigenvalues. `samples` has one vector of channels
/// for each instant, at equal intervals. The channels must be comparable in size.
///
/// After the fast modes have decayed, the last samples follow a short recurrence `y[k] = a1 y[k-1] + ... + ap y[k-p]`
/// with the same coefficients in every channel. The roots of this recurrence are the remaining eigenvalues (Prony). The
/// shortest recurrence that explains the samples has hardly any other roots, and those other roots do not contribute to
/// the motion. If no recurrence explains the samples, the roots mean nothing, and the mean change of the samples is
/// returned. For example, this happens if the samples are the difference of two motions, and only one of them reaches a
/// joint limit.
pub fn growth(samples: &[DVector<f64>]) -> f64 {
    slowest(samples, 0.0)
}

/// Returns [`growth`] for a system with directions in which nothing holds it. Displacements in these directions remain,
/// or change so slowly that their eigenvalues differ from 1 by less than `drift`. Such displacements are ignored.
///
/// The function evaluates the changes from one sample to the next. They contain no constant displacement, which would
/// hide the other modes.
pub(super) fn growth_besides_drift(samples: &[DVector<f64>], drift: f64) -> f64 {
    let changes: Vec<_> = samples.windows(2).map(|pair| &pair[1] - &pair[0]).collect();
    slowest(&changes, drift)
}

/// Returns [`growth`] without the modes whose eigenvalues differ from 1 by less than `drift`.
fn slowest(samples: &[DVector<f64>], drift: f64) -> f64 {
    if samples.iter().any(|sample| !sample.norm().is_finite()) {
        return f64::NAN;
    }
    let largest = samples.iter().map(|sample| sample.norm()).fold(0.0, f64::max);
    // The window ends before the first sample that is mere rounding error. All later samples are unusable too.
    let end = samples.iter().position(|sample| sample.norm() <= ROUNDING * largest).unwrap_or(samples.len());
    let window = &samples[end.saturating_sub(WINDOW)..end];
    for order in 1..=LARGEST_ORDER.min(window.len().saturating_sub(2)) {
        let Some((coefficients, missed)) = recurrence(window, order) else { break };
        if missed < EXPLAINED {
            let root = largest_root(window, &coefficients, drift);
            return if has_decayed(&samples[end..], root, ROUNDING * largest) { mean_change(window) } else { root };
        }
    }
    mean_change(window)
}

/// Returns whether the samples in `follows` contradict a root. The sample before `follows` is above `rounding`, and a
/// root that counts contributes at least the fraction `LEAST_SHARE` of it. The samples contradict the root if this
/// contribution would grow above `rounding` within `follows`, but no sample of `follows` is above `rounding`.
fn has_decayed(follows: &[DVector<f64>], root: f64, rounding: f64) -> bool {
    root.powi(follows.len() as i32) * LEAST_SHARE > 1.0 && follows.iter().all(|sample| sample.norm() <= rounding)
}

/// Returns the mean factor per sample, computed from the largest sample of each half of the window. Returns NaN for
/// fewer than two samples.
fn mean_change(window: &[DVector<f64>]) -> f64 {
    let half = window.len() / 2;
    if half == 0 {
        return f64::NAN;
    }
    let largest = |part: &[DVector<f64>]| part.iter().map(|sample| sample.norm()).fold(0.0, f64::max);
    (largest(&window[half..]) / largest(&window[..half])).powf(1.0 / half as f64)
}

/// Returns a1 .. ap, and the root mean square of the residual relative to the surrounding samples.
fn recurrence(window: &[DVector<f64>], order: usize) -> Option<(DVector<f64>, f64)> {
    let channels = window[0].len();
    let rows = (window.len() - order) * channels;
    let (mut before, mut now) = (DMatrix::zeros(rows, order), DVector::zeros(rows));
    for k in order..window.len() {
        // Every instant has the same weight, even after a long decay.
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

/// Returns the largest modulus among those roots of z^p - a1 z^(p-1) - ... - ap that contribute to the last sample and
/// differ from 1 by at least `drift`.
///
/// The slowest mode contributes most to the last sample. A larger root without a contribution fits rounding errors, and
/// does not belong to the motion.
fn largest_root(window: &[DVector<f64>], coefficients: &DVector<f64>, drift: f64) -> f64 {
    let order = coefficients.len();
    let companion = DMatrix::from_fn(order, order, |row, column| match (row, column) {
        (0, column) => coefficients[column],
        (row, column) => f64::from(row == column + 1),
    });
    let roots = companion.complex_eigenvalues();
    // sample[k] = sum of c_i z_i^k. Every instant has the same weight, and the powers of each root are scaled to a
    // maximum of 1.
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
    let share = |k: usize, root: usize| powers[(k, root)].norm() * parts.row(root).norm();
    // Rounding errors excite every mode at every instant. So a root whose share of the first sample is smaller than a
    // rounding error is no mode: it fits only the end of the window.
    let has_part = |root: usize| share(last, root) >= LEAST_SHARE && share(0, root) >= f64::EPSILON;
    let counts = |root: &usize| has_part(*root) && (roots[*root] - 1.0).norm() >= drift;
    (0..order).filter(counts).map(|root| roots[root].norm()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns [`growth`] for a decay of `length` samples with a tiny growing component. The samples `after` follow the
    /// decay.
    fn growing(length: i32, after: &[f64]) -> f64 {
        let decay = (0..length).map(|k| 0.8f64.powi(k) + 1e-14 * 1.3f64.powi(k));
        let samples: Vec<_> = decay.chain(after.iter().copied()).map(|sample| DVector::repeat(2, sample)).collect();
        growth(&samples)
    }

    #[test]
    fn a_root_that_later_samples_contradict_does_not_count() {
        assert!((growing(61, &[]) - 1.3).abs() < 1e-3);
        assert!((growing(61, &[0.0; 5]) - 1.3).abs() < 1e-3, "too few later samples");
        assert!((growing(61, &[0.0; 30]) - 0.8).abs() < 0.05);
        let grows: Vec<f64> = (61..91).map(|k| 1e-14 * 1.3f64.powi(k)).collect();
        assert!((growing(61, &grows) - 1.3).abs() < 1e-3);
    }

    #[test]
    fn a_root_that_fits_only_the_last_samples_does_not_count() {
        let with_end = |end: f64| -> Vec<_> {
            let samples = (0..80).map(|k| 0.99f64.powi(k) * if k == 79 { 1.0 + end } else { 1.0 });
            samples.map(|sample| DVector::repeat(2, sample)).collect()
        };
        assert!((growth(&with_end(0.0)) - 0.99).abs() < 1e-6);
        let found = growth(&with_end(0.02));
        assert!(found < 1.0, "{found}");
    }
}
