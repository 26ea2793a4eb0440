//! Bounds of a polynomial over the unit interval, by its Bernstein form.

/// Number of coefficients of a polynomial. The highest degree is 7: that of a path with only one piece, whose place,
/// rate, acceleration and jerk are given at both ends.
pub const COEFFICIENTS: usize = 8;

/// The Bernstein coefficients of a polynomial. Over the unit interval, the polynomial lies between the smallest and the
/// largest of them.
type Bernstein = [f64; COEFFICIENTS];

/// Bounds are accepted if they are outside the true range by at most this part of its width.
const ACCURACY: f64 = 0.01;

/// Largest number of halvings. Each one makes the bounds about four times as accurate.
const MOST_HALVINGS: u32 = 8;

/// Returns bounds of the polynomial with these coefficients of the powers 0 to 7, for arguments from 0 to 1.
pub fn bounds(powers: &[f64; COEFFICIENTS]) -> (f64, f64) {
    let whole = bernstein(powers);
    // The ends are values of the polynomial, so the true range contains them.
    let mut reached = (whole[0].min(whole[COEFFICIENTS - 1]), whole[0].max(whole[COEFFICIENTS - 1]));
    let mut found = reached;
    halve(&whole, MOST_HALVINGS, &mut reached, &mut found);
    found
}

/// Widens `found` to the range of the polynomial. `reached` is the range of the values computed so far.
fn halve(of: &Bernstein, halvings: u32, reached: &mut (f64, f64), found: &mut (f64, f64)) {
    let (low, high) =
        of.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)));
    let margin = ACCURACY * (reached.1 - reached.0).max(f64::MIN_POSITIVE);
    if halvings == 0 || (low >= reached.0 - margin && high <= reached.1 + margin) {
        *found = (found.0.min(low), found.1.max(high));
        return;
    }
    // De Casteljau's algorithm yields the Bernstein coefficients of both halves.
    let (mut first, mut second, mut row) = (*of, *of, *of);
    for step in 1..COEFFICIENTS {
        for index in 0..COEFFICIENTS - step {
            row[index] = 0.5 * (row[index] + row[index + 1]);
        }
        first[step] = row[0];
        second[COEFFICIENTS - 1 - step] = row[COEFFICIENTS - 1 - step];
    }
    let middle = row[0];
    *reached = (reached.0.min(middle), reached.1.max(middle));
    halve(&first, halvings - 1, reached, found);
    halve(&second, halvings - 1, reached, found);
}

fn bernstein(powers: &[f64; COEFFICIENTS]) -> Bernstein {
    const DEGREE: usize = COEFFICIENTS - 1;
    std::array::from_fn(|index| {
        (0..=index).map(|power| powers[power] * choose(index, power) / choose(DEGREE, power)).sum()
    })
}

fn choose(of: usize, count: usize) -> f64 {
    (0..count).map(|index| (of - index) as f64 / (index + 1) as f64).product()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_bounds_are_outside_the_range_by_at_most_a_hundredth(powers in prop::array::uniform8(-10.0..10.0f64)) {
            let value = |argument: f64| powers.iter().rev().fold(0.0, |sum, power| sum * argument + power);
            let values: Vec<f64> = (0..=1000).map(|step| value(f64::from(step) * 1e-3)).collect();
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let (low, high) = bounds(&powers);
            let margin = 0.01 * (most - least) + 1e-3;
            prop_assert!(low <= least + 1e-9 && high >= most - 1e-9, "{low} {least} {most} {high}");
            prop_assert!(low >= least - margin && high <= most + margin, "{low} {least} {most} {high}");
        }
    }
}
