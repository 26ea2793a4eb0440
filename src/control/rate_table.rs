//! Numbers that were tuned at a few rates, interpolated for any rate.

/// The numbers of one row of a table.
pub(super) trait Tuned: Copy {
    /// Computes each number of a new row by applying `number` to the corresponding numbers of two rows.
    fn combine(lower: &Self, upper: &Self, number: impl Fn(f64, f64) -> f64) -> Self;
}

/// A rate, Hz, and the numbers at that rate. No number is negative. The rates of a table increase from row to row.
pub(super) type Row<Numbers> = (f64, Numbers);

/// Returns the numbers of a table for `rate`, Hz. Between two rows each number is proportional to a power of the rate.
/// Below the first row and above the last row the numbers are constant.
///
/// The nearest row cannot be used instead: the gains of a higher rate are too large for the longer delay of a lower
/// rate. With them, the loop of Figure 10 was unstable in every pose tried.
pub(super) fn at<Numbers: Tuned>(table: &[Row<Numbers>], rate: f64) -> Numbers {
    let above = table.iter().position(|row| row.0 >= rate).unwrap_or(table.len() - 1);
    let ((low, lower), (high, upper)) = (table[above.saturating_sub(1)], table[above]);
    if rate <= low || rate >= high {
        return if rate <= low { lower } else { upper };
    }
    let part = (rate / low).ln() / (high / low).ln();
    Numbers::combine(&lower, &upper, |lower, upper| lower.powf(1.0 - part) * upper.powf(part))
}
