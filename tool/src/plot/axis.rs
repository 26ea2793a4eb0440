//! Axes: ranges, and round numbers along them.

/// The scale of an axis, from values to places. The place 0 is the low end, and 1 is the high end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    pub low: f64,
    pub high: f64,
    /// Whether equal ratios have equal lengths. Then both ends are positive.
    pub logarithmic: bool,
}

/// Largest number of ticks of a logarithmic axis.
const MOST_POWERS: usize = 40;

/// Smallest range of an axis around values, as a fraction of their largest magnitude.
const NARROWEST: f64 = 1e-6;

impl Axis {
    pub fn linear(low: f64, high: f64) -> Self {
        Self { low, high, logarithmic: false }
    }

    /// A logarithmic axis that contains `low` and `high`. Both ends are powers of ten.
    pub fn logarithmic(low: f64, high: f64) -> Self {
        let power = |exponent: f64| 10f64.powf(exponent);
        let (low, high) = (power(low.log10().floor()), power(high.log10().ceil()));
        Self { low, high: if high > low { high } else { 10.0 * low }, logarithmic: true }
    }

    /// A linear axis that contains all finite values, with a margin at both ends, and is at least as long as `least`.
    pub fn around(values: impl IntoIterator<Item = f64>, least: f64) -> Self {
        let finite = values.into_iter().filter(|value| value.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        if low > high {
            return Self::linear(-least / 2.0, least / 2.0);
        }
        let least = least.max(NARROWEST * low.abs().max(high.abs()));
        let (middle, half) = ((low + high) / 2.0, ((high - low) / 2.0).max(least / 2.0));
        Self::linear(middle - 1.08 * half, middle + 1.08 * half)
    }

    /// The place of a value.
    pub fn place(&self, value: f64) -> f64 {
        match self.logarithmic {
            true => (value / self.low).ln() / (self.high / self.low).ln(),
            false => (value - self.low) / (self.high - self.low),
        }
    }

    /// Round numbers, as values and texts. A linear axis has at most `most` + 1 of them, for `most` from 2 up. A
    /// logarithmic axis has at most `MOST_POWERS`, whatever `most` is.
    pub fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        if self.logarithmic {
            let exponents = self.low.log10().round() as i32..=self.high.log10().round() as i32;
            return exponents
                .take(MOST_POWERS)
                .map(|exponent| (10f64.powi(exponent), power_of_ten(exponent)))
                .collect();
        }
        let raw = (self.high - self.low) / most.max(2) as f64;
        let magnitude = 10f64.powf(raw.log10().floor());
        let digit = [1.0, 2.0, 2.5, 5.0].into_iter().find(|&digit| digit * magnitude >= raw).unwrap_or(10.0);
        let step = digit * magnitude;
        let places = -step.log10().floor() + if digit == 2.5 { 1.0 } else { 0.0 };
        let decimals = places.max(0.0) as usize;
        let (first, last) = ((self.low / step).ceil() as i64, (self.high / step).floor() as i64);
        let text = |value: f64| format!("{value:.decimals$}").replace('-', "\u{2212}");
        // Adding 0 makes -0 positive.
        (first..=last).map(|index| index as f64 * step + 0.0).map(|value| (value, text(value))).collect()
    }
}

fn power_of_ten(exponent: i32) -> String {
    match exponent {
        0..=4 => 10i64.pow(exponent as u32).to_string(),
        -3..=-1 => format!("{:.*}", -exponent as usize, 10f64.powi(exponent)),
        _ => {
            let text = exponent.to_string();
            let digits = text.chars().map(|digit| match digit {
                '-' => '\u{207b}',
                '1' => '\u{b9}',
                '2' => '\u{b2}',
                '3' => '\u{b3}',
                digit => char::from_u32(0x2070 + digit as u32 - '0' as u32).unwrap_or(digit),
            });
            format!("10{}", digits.collect::<String>())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        let texts = |axis: Axis, most| axis.ticks(most).into_iter().map(|(_, text)| text).collect::<Vec<_>>();
        assert_eq!(texts(Axis::linear(-0.11, 0.32), 5), ["\u{2212}0.1", "0.0", "0.1", "0.2", "0.3"]);
        assert_eq!(texts(Axis::linear(0.0, 1990.0), 4), ["0", "500", "1000", "1500"]);
        assert_eq!(texts(Axis::logarithmic(3.0, 24_000.0), 4), ["1", "10", "100", "1000", "10000", "10\u{2075}"]);
    }

    #[test]
    fn an_endless_axis_has_a_limited_number_of_ticks() {
        assert!(Axis::logarithmic(1.0, f64::INFINITY).ticks(4).len() <= MOST_POWERS);
    }

    #[test]
    fn an_axis_contains_its_values_even_if_they_are_equal() {
        let axis = Axis::around([2.0, f64::NAN, 2.0], 0.5);
        assert!((axis.place(2.0) - 0.5).abs() < 1e-12 && axis.high - axis.low > 0.5);
        let axis = Axis::around([-1.0, 3.0], 0.0);
        assert!(axis.place(-1.0) > 0.0 && axis.place(3.0) < 1.0);
        assert!(Axis::around([], 1.0).place(0.0) == 0.5);
    }
}
