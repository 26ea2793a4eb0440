//! Numbers that were tuned at a few rates, for any rate.

/// Numbers of one row of a table.
pub(super) trait Tuned: Copy {
    /// Computes every number from the same number of two rows.
    fn combine(lower: &Self, upper: &Self, number: impl Fn(f64, f64) -> f64) -> Self;
}

/// Rate, Hz, and numbers at that rate, none negative. The rates of a table rise.
pub(super) type Row<Numbers> = (f64, Numbers);

/// The numbers of a table for `rate`, Hz: between two rates each number is a power of the rate, beyond the last ones it
/// stays.
///
/// The nearest row will not do: gains of a higher rate act on a delay for which they are too large, and were unstable
/// in every pose tried.
pub(super) fn at<Numbers: Tuned>(table: &[Row<Numbers>], rate: f64) -> Numbers {
    let above = table.iter().position(|row| row.0 >= rate).unwrap_or(table.len() - 1);
    let ((low, lower), (high, upper)) = (table[above.saturating_sub(1)], table[above]);
    if rate <= low || rate >= high {
        return if rate <= low { lower } else { upper };
    }
    let part = (rate / low).ln() / (high / low).ln();
    Numbers::combine(&lower, &upper, |lower, upper| lower.powf(1.0 - part) * upper.powf(part))
}
