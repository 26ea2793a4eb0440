//! Computes the coefficients of a piece of a path from its places and motions at both ends.

use crate::model::path::bounds::COEFFICIENTS;
use nalgebra::{Matrix2x3, Vector3};

/// The rate and the acceleration at a knot, one in each row.
pub(super) type AtKnot = Matrix2x3<f64>;

/// Factors for the coefficients of the highest powers of a piece, one row for each power. With the lower powers alone,
/// the place, rate, acceleration and jerk at the end of the piece differ from the required ones. A coefficient is the
/// sum of these four differences, each multiplied by its factor in the row of the coefficient.
type EndFactors = &'static [[f64; 4]];

/// A piece between others: powers 3 to 5.
const BETWEEN: EndFactors = &[[10.0, -4.0, 0.5, 0.0], [-15.0, 7.0, -1.0, 0.0], [6.0, -3.0, 0.5, 0.0]];

/// The first piece: powers 4 to 6.
const FIRST: EndFactors = &[[15.0, -5.0, 0.5, 0.0], [-24.0, 9.0, -1.0, 0.0], [10.0, -4.0, 0.5, 0.0]];

/// The last piece: powers 3 to 6.
const LAST: EndFactors = &[
    [20.0, -10.0, 2.0, -1.0 / 6.0],
    [-45.0, 25.0, -5.5, 0.5],
    [36.0, -21.0, 5.0, -0.5],
    [-10.0, 6.0, -1.5, 1.0 / 6.0],
];

/// The only piece: powers 4 to 7.
const ONLY: EndFactors = &[
    [35.0, -15.0, 2.5, -1.0 / 6.0],
    [-84.0, 39.0, -7.0, 0.5],
    [70.0, -34.0, 6.5, -0.5],
    [-20.0, 10.0, -2.0, 1.0 / 6.0],
];

/// Returns the coefficients of a piece with these places and motions at its beginning and its end. `jerk` is the jerk
/// at the beginning if the piece is the first one. The last piece ends without jerk. `h` is the length of the piece, s.
pub(super) fn coefficients(
    (begin, end): (Vector3<f64>, Vector3<f64>),
    (from, to): (AtKnot, AtKnot),
    jerk: Option<Vector3<f64>>,
    last: bool,
    h: f64,
) -> [Vector3<f64>; COEFFICIENTS] {
    let (rates, accelerations) = ([from, to].map(|motion| motion.row(0).transpose() * h), [from, to]);
    let accelerations = accelerations.map(|motion| motion.row(1).transpose() * h.powi(2));
    let mut found = [Vector3::zeros(); COEFFICIENTS];
    let cubic = jerk.unwrap_or_default() * (h.powi(3) / 6.0);
    found[..4].copy_from_slice(&[begin, rates[0], accelerations[0] * 0.5, cubic]);
    let missing = [
        end - found[0] - found[1] - found[2] - found[3],
        rates[1] - found[1] - found[2] * 2.0 - found[3] * 3.0,
        accelerations[1] - found[2] * 2.0 - found[3] * 6.0,
        found[3] * -6.0,
    ];
    let (power, factors) = match (jerk.is_some(), last) {
        (false, false) => (3, BETWEEN),
        (true, false) => (4, FIRST),
        (false, true) => (3, LAST),
        (true, true) => (4, ONLY),
    };
    for (coefficient, factors) in found[power..].iter_mut().zip(factors) {
        *coefficient += missing.iter().zip(factors).map(|(missing, factor)| missing * *factor).sum::<Vector3<f64>>();
    }
    found
}
