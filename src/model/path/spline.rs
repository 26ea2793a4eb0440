//! The spline through timed places. It is continuous up to its fourth derivative between its ends, and ends at rest.
//!
//! Its pieces have degree 5, except at its ends. Of all curves through given places, with given rates and accelerations
//! at both ends, the one with the smallest mean square jerk consists of such pieces. The spline here also begins with a
//! given jerk, and ends without jerk. So its first and its last piece have degree 6, or its only piece has degree 7.
//! The mean square jerk of the spline is therefore larger.

use crate::model::path::hermite::{AtKnot, coefficients};
use crate::model::path::piece::Piece;
use nalgebra::{Matrix2, RowVector3, Vector3};

/// A place that the path passes at a given time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// Time since the beginning of the path, s.
    pub time: f64,
    /// The place.
    pub place: Vector3<f64>,
}

/// The place where the path begins at time 0, and the motion that it continues.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// The place.
    pub place: Vector3<f64>,
    /// The first derivative, per s.
    pub rates: Vector3<f64>,
    /// The second derivative, per s^2.
    pub accelerations: Vector3<f64>,
    /// The third derivative, per s^3.
    pub jerk: Vector3<f64>,
}

/// Jerk and snap at one end of a piece as a linear function of the rates and accelerations at its two ends.
struct EndMotion {
    constant: AtKnot,
    /// Factor of the rate and the acceleration at the same end.
    near: Matrix2<f64>,
    /// Factor of the rate and the acceleration at the other end.
    far: Matrix2<f64>,
}

/// Returns the pieces of the path that begins with `start` and passes the knots, and rests at the last one. The times
/// of the knots increase and are positive.
pub fn spline(start: &Start, knots: &[Knot]) -> Vec<Piece> {
    if knots.is_empty() {
        return vec![Piece::at_rest(start.place)];
    }
    let inner = motions_at_inner_knots(start, knots);
    let mut pieces = Vec::with_capacity(knots.len());
    let mut begin = Knot { time: 0.0, place: start.place };
    for (index, knot) in knots.iter().enumerate() {
        let length = knot.time - begin.time;
        let first = (index == 0).then_some(start.jerk);
        let from = if index == 0 { rows(&start.rates, &start.accelerations) } else { inner[index - 1] };
        let to = inner.get(index).copied().unwrap_or_else(AtKnot::zeros);
        let places = (begin.place, knot.place);
        let coefficients = coefficients(places, (from, to), first, index + 1 == knots.len(), length);
        pieces.push(Piece { begin: begin.time, length, coefficients });
        begin = *knot;
    }
    pieces
}

fn rows(rates: &Vector3<f64>, accelerations: &Vector3<f64>) -> AtKnot {
    AtKnot::from_rows(&[rates.transpose(), accelerations.transpose()])
}

/// Solves for rate and acceleration at every knot except the last one. The equations require continuous jerk and snap
/// at these knots. The system is block tridiagonal.
fn motions_at_inner_knots(start: &Start, knots: &[Knot]) -> Vec<AtKnot> {
    let count = knots.len() - 1;
    let place = |index: usize| if index == 0 { start.place } else { knots[index - 1].place };
    let time = |index: usize| if index == 0 { 0.0 } else { knots[index - 1].time };
    // Forward elimination: the motion at knot k is offset[k] - factor[k] times the motion at knot k + 1.
    let mut offsets: Vec<AtKnot> = Vec::with_capacity(count);
    let mut factors: Vec<Matrix2<f64>> = Vec::with_capacity(count);
    for knot in 1..=count {
        let before = time(knot) - time(knot - 1);
        let after = time(knot + 1) - time(knot);
        let arriving = match knot {
            1 => arriving_from_start(start, &place(1), before),
            _ => arriving(&(place(knot) - place(knot - 1)), before),
        };
        let leaving = match knot == count {
            true => leaving_to_rest(&(place(knot + 1) - place(knot)), after),
            false => leaving(&(place(knot + 1) - place(knot)), after),
        };
        let mut near = arriving.near - leaving.near;
        let mut constant = leaving.constant - arriving.constant;
        if let (Some(offset), Some(factor)) = (offsets.last(), factors.last()) {
            near -= arriving.far * factor;
            constant -= arriving.far * offset;
        }
        // `near` is a pivot of the elimination. If the two equations of each knot are written in the order (-snap,
        // jerk), the matrix of the whole system has a positive definite symmetric part, so every pivot is invertible.
        // The matrix is a sum over the pieces. For a piece of degree 5, half the integral of its squared jerk is a
        // quadratic function of the rates and accelerations at its ends, and the piece adds the Hessian of this
        // function, which is symmetric and positive semidefinite. The first and the last piece, of degree 6, add
        // matrices with positive definite symmetric parts.
        let inverse = near.try_inverse().unwrap_or_else(Matrix2::zeros);
        offsets.push(inverse * constant);
        factors.push(inverse * -leaving.far);
    }
    for knot in (0..count.saturating_sub(1)).rev() {
        let next = offsets[knot + 1];
        offsets[knot] -= factors[knot] * next;
    }
    offsets
}

/// Jerk and snap at the end of a piece of degree 5 that covers the distance `way` in `length` s.
fn arriving(way: &Vector3<f64>, length: f64) -> EndMotion {
    let (h, row) = (length, way.transpose());
    EndMotion {
        constant: AtKnot::from_rows(&[row * (60.0 / h.powi(3)), row * (360.0 / h.powi(4))]),
        near: Matrix2::new(-36.0 / h.powi(2), 9.0 / h, -192.0 / h.powi(3), 36.0 / h.powi(2)),
        far: Matrix2::new(-24.0 / h.powi(2), -3.0 / h, -168.0 / h.powi(3), -24.0 / h.powi(2)),
    }
}

/// Jerk and snap at the beginning of a piece of degree 5 that covers the distance `way` in `length` s.
fn leaving(way: &Vector3<f64>, length: f64) -> EndMotion {
    reversed(arriving(&-way, length))
}

/// Jerk and snap at the end of the first piece, of degree 6.
fn arriving_from_start(start: &Start, place: &Vector3<f64>, length: f64) -> EndMotion {
    let h = length;
    let (rates, accelerations) = (start.rates * h, start.accelerations * h.powi(2));
    let jerk = start.jerk * h.powi(3);
    // The contribution of the motion at the start is subtracted from the place, rate and acceleration at the end. The
    // other coefficients must produce the differences. The unit of time is the length of the piece.
    let place = (place - start.place - rates - accelerations * 0.5 - jerk / 6.0).transpose();
    let rate = -(rates + accelerations + jerk * 0.5).transpose();
    let acceleration = -(accelerations + jerk).transpose();
    let row = |of_place: f64, of_rate: f64, of_acceleration: f64| {
        place * of_place + rate * of_rate + acceleration * of_acceleration
    };
    let constant_jerk: RowVector3<f64> = jerk.transpose() + row(120.0, -60.0, 12.0);
    EndMotion {
        constant: AtKnot::from_rows(&[constant_jerk / h.powi(3), row(1080.0, -480.0, 72.0) / h.powi(4)]),
        near: Matrix2::new(-60.0 / h.powi(2), 12.0 / h, -480.0 / h.powi(3), 72.0 / h.powi(2)),
        far: Matrix2::zeros(),
    }
}

/// Jerk and snap at the beginning of the last piece, of degree 6, which ends at rest.
fn leaving_to_rest(way: &Vector3<f64>, length: f64) -> EndMotion {
    reversed(arriving_from_start(&Start::default(), &-way, length))
}

/// Reverses the time: rate and jerk change their signs.
fn reversed(motion: EndMotion) -> EndMotion {
    let EndMotion { mut constant, mut near, mut far } = motion;
    constant.set_row(0, &-constant.row(0));
    for factor in [&mut near, &mut far] {
        factor[(0, 1)] = -factor[(0, 1)];
        factor[(1, 0)] = -factor[(1, 0)];
    }
    EndMotion { constant, near, far }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::path::piece::PieceMotion;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    fn vector() -> impl Strategy<Value = Vector3<f64>> {
        prop::array::uniform3(-1.0..1.0f64).prop_map(Vector3::from)
    }

    fn path() -> impl Strategy<Value = (Start, Vec<Knot>)> {
        let start = (vector(), vector(), vector(), vector());
        (start, prop::collection::vec((0.2..1.0f64, vector()), 1..12)).prop_map(|(start, steps)| {
            let (place, rates, accelerations, jerk) = start;
            let mut time = 0.0;
            let knots = steps.into_iter().map(|(length, place)| {
                time += length;
                Knot { time, place }
            });
            (Start { place, rates, accelerations, jerk }, knots.collect())
        })
    }

    fn gap(one: &PieceMotion, other: &PieceMotion) -> [f64; 5] {
        [
            (one.place - other.place).amax(),
            (one.rates - other.rates).amax(),
            (one.accelerations - other.accelerations).amax(),
            (one.jerk - other.jerk).amax(),
            (one.snap - other.snap).amax(),
        ]
    }

    proptest! {
        #[test]
        fn it_passes_every_knot_and_is_continuous_through_snap((start, knots) in path()) {
            let pieces = spline(&start, &knots);
            prop_assert_eq!(pieces.len(), knots.len());
            let Start { place, rates, accelerations, jerk } = start;
            let begin = pieces[0].at(0.0);
            let expected = PieceMotion { place, rates, accelerations, jerk, snap: begin.snap };
            prop_assert!(gap(&begin, &expected).iter().all(|gap| *gap < 1e-6), "{:?}", gap(&begin, &expected));
            for (pair, knot) in pieces.windows(2).zip(&knots) {
                let (before, after) = (pair[0].at(knot.time), pair[1].at(knot.time));
                prop_assert!((before.place - knot.place).amax() < 1e-9);
                let scale = 1e-9 * (1.0 + before.snap.amax());
                prop_assert!(gap(&before, &after).iter().all(|gap| *gap < scale), "{:?}", gap(&before, &after));
            }
            let (last, end) = (pieces[knots.len() - 1], knots[knots.len() - 1]);
            let rest = last.at(end.time);
            let scale = 1e-9 * (1.0 + last.at(last.begin).snap.amax());
            let expected = PieceMotion { place: end.place, snap: rest.snap, ..PieceMotion::default() };
            prop_assert!(gap(&rest, &expected).iter().all(|gap| *gap < scale), "{:?}", gap(&rest, &expected));
        }
    }

    #[test]
    fn derivatives_are_slopes_of_each_other() {
        let knot = |time: f64| Knot { time, place: Vector3::new(time.sin(), time * time, 1.0 / (1.0 + time)) };
        for piece in spline(&Start::default(), &[knot(0.3), knot(0.8), knot(1.1)]) {
            let (step, middle) = (1e-5 * piece.length, piece.begin + 0.4 * piece.length);
            let (one, other, at) = (piece.at(middle - step), piece.at(middle + step), piece.at(middle));
            let slope = |of: fn(&PieceMotion) -> Vector3<f64>| (of(&other) - of(&one)) / (2.0 * step);
            for (slope, value) in [
                (slope(|motion| motion.place), at.rates),
                (slope(|motion| motion.rates), at.accelerations),
                (slope(|motion| motion.accelerations), at.jerk),
                (slope(|motion| motion.jerk), at.snap),
            ] {
                assert!((slope - value).amax() < 1e-6 * (1.0 + value.amax()), "{slope} {value}");
            }
        }
    }

    /// With 16 knots in each turn, the spline deviates from a circle by less than 1e-4 of the radius. The last of the
    /// three turns is not checked, because the spline comes to rest at the end of this turn.
    #[test]
    fn it_follows_a_circle_between_its_knots() {
        let on_circle = |time: f64| Vector3::new((TAU * time).cos(), (TAU * time).sin(), 0.0);
        let knots: Vec<Knot> =
            (1..=48).map(|index| f64::from(index) / 16.0).map(|time| Knot { time, place: on_circle(time) }).collect();
        let start = Start {
            place: Vector3::x(),
            rates: Vector3::y() * TAU,
            accelerations: -Vector3::x() * TAU.powi(2),
            jerk: -Vector3::y() * TAU.powi(3),
        };
        let pieces = spline(&start, &knots);
        for piece in &pieces[..32] {
            for step in 0..10 {
                let time = piece.begin + piece.length * f64::from(step) * 0.1;
                let error = (piece.at(time).place - on_circle(time)).norm();
                assert!(error < 1e-4, "{error} at {time}");
            }
        }
    }
}
