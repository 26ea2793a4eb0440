//! Medians and percentiles.

/// Median, 99th and 99.9th percentiles and maximum, us.
#[derive(Clone, Copy, Default)]
pub struct Percentiles {
    pub median: f64,
    pub p99: f64,
    pub p999: f64,
    pub maximum: f64,
}

impl Percentiles {
    /// Computes the percentiles of times in ns.
    pub fn of(mut times: Vec<u64>) -> Self {
        times.sort_unstable();
        let at =
            |part: f64| times.get((times.len() as f64 * part) as usize).map_or(f64::NAN, |&time| time as f64 * 1e-3);
        Self {
            median: at(0.5),
            p99: at(0.99),
            p999: at(0.999),
            maximum: times.last().map_or(f64::NAN, |&time| time as f64 * 1e-3),
        }
    }
}

/// Returns the median, or NaN if there are no values.
pub fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.is_empty() {
        return f64::NAN;
    }
    if values.len() % 2 == 1 { values[middle] } else { 0.5 * (values[middle - 1] + values[middle]) }
}

/// Returns the text of a ratio with two decimals, or "-" if one side was not measured.
pub fn ratio(one: f64, other: f64) -> String {
    let ratio = one / other;
    if ratio.is_nan() { "-".into() } else { format!("{ratio:.2}") }
}
