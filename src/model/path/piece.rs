//! A polynomial piece of a path.

use crate::model::path::bounds::{COEFFICIENTS, bounds};
use nalgebra::Vector3;

/// Three polynomials of time, one for each coordinate. The coordinates are joint angles, rad, or the position of a tip,
/// cm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Time from the beginning of the path to the beginning of the piece, s.
    pub begin: f64,
    /// Length of the piece, s.
    pub length: f64,
    /// Coefficients of the powers of (time - `begin`) / `length`.
    pub coefficients: [Vector3<f64>; COEFFICIENTS],
}

/// The coordinates at one instant, and their first four derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PieceMotion {
    /// The coordinates.
    pub place: Vector3<f64>,
    /// The first derivative, per s.
    pub rates: Vector3<f64>,
    /// The second derivative, per s^2.
    pub accelerations: Vector3<f64>,
    /// The third derivative, per s^3.
    pub jerk: Vector3<f64>,
    /// The fourth derivative, per s^4.
    pub snap: Vector3<f64>,
}

impl Piece {
    /// Returns a piece that rests at `place`.
    pub fn at_rest(place: Vector3<f64>) -> Self {
        let mut coefficients = [Vector3::zeros(); COEFFICIENTS];
        coefficients[0] = place;
        Self { begin: 0.0, length: 1.0, coefficients }
    }

    /// Returns the time from the beginning of the path to the end of the piece, s.
    pub fn end(&self) -> f64 {
        self.begin + self.length
    }

    /// Returns the motion at `time`, s, counted from the beginning of the path.
    pub fn at(&self, time: f64) -> PieceMotion {
        let part = (time - self.begin) / self.length;
        // Horner's scheme. At its end, sums[n] is the polynomial's n-th derivative by `part`, divided by n factorial.
        let mut sums = [Vector3::zeros(); 5];
        for coefficient in self.coefficients.iter().rev() {
            for order in (1..5).rev() {
                sums[order] = sums[order] * part + sums[order - 1];
            }
            sums[0] = sums[0] * part + coefficient;
        }
        let per = 1.0 / self.length;
        PieceMotion {
            place: sums[0],
            rates: sums[1] * per,
            accelerations: sums[2] * (2.0 * per.powi(2)),
            jerk: sums[3] * (6.0 * per.powi(3)),
            snap: sums[4] * (24.0 * per.powi(4)),
        }
    }

    /// Returns lower and upper bounds of a derivative over the whole piece. `order` is 0 for the coordinates
    /// themselves, and up to 3 for the jerk. The bounds are never inside the true range, and are outside it by at most
    /// 1 % of its width.
    pub fn bounds(&self, order: usize) -> (Vector3<f64>, Vector3<f64>) {
        let scale = self.length.powi(-(order as i32));
        let of = |coordinate: usize| {
            let mut derived = [0.0; COEFFICIENTS];
            for power in order..COEFFICIENTS {
                let factor: f64 = (power - order + 1..=power).map(|factor| factor as f64).product();
                derived[power - order] = self.coefficients[power][coordinate] * factor * scale;
            }
            bounds(&derived)
        };
        let of_all = [of(0), of(1), of(2)];
        (Vector3::from(of_all.map(|(low, _)| low)), Vector3::from(of_all.map(|(_, high)| high)))
    }
}
