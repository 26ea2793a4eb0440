//! The stiffness of the tip as ellipses, with the force of the tip.

use super::axis::Axis;
use super::figure::{Figure, Sign, subtitle};
use super::palette::{BLUE, INK, SKY, VERMILION};
use super::panel::{Mark, Panel};
use super::svg::Stroke;
use super::{Plot, Selection};
use crate::failure::Failure;
use crate::trace::Item;
use std::f64::consts::TAU;
use sun2xp::nalgebra::Matrix3;

const SENT: Stroke = Stroke::dashed(INK, 1.5);
const IN_FORCE: Stroke = Stroke::solid(BLUE, 2.0);
const FORCE: Stroke = Stroke::solid(VERMILION, 3.0);
const FORCES: Stroke = Stroke::solid(SKY, 1.0);

/// Height and width of the frame of a panel, pixels.
const SIDE: f64 = 300.0;

/// Number of points of an ellipse.
const POINTS: usize = 180;

/// The collected cycles.
#[derive(Default)]
pub struct Stiffness {
    rate: f64,
    forces: Vec<[f64; 3]>,
    newest: Option<Newest>,
}

/// The last cycle in which the finger is a spring.
struct Newest {
    time: f64,
    sent: Matrix3<f64>,
    in_force: Matrix3<f64>,
    force: [f64; 3],
    scale: f64,
}

impl Plot for Stiffness {
    fn take(&mut self, item: &Item, seconds: f64) {
        match item {
            Item::Finger(finger) => self.rate = finger.rate,
            Item::Cycle(row) => {
                let sample = &row.sample;
                let Some(kx) = sample.kx else { return };
                self.forces.push(sample.tip_force);
                let matrix = |rows: [[f64; 3]; 3]| Matrix3::from_fn(|row, column| rows[row][column]);
                self.newest = Some(Newest {
                    time: seconds,
                    sent: matrix(kx),
                    in_force: matrix(sample.stiffness),
                    force: sample.tip_force,
                    scale: sample.stiffness_scale,
                });
            }
            Item::Mark(_) | Item::Object(..) => {}
        }
    }

    fn draw(&self, selection: &Selection) -> Result<Figure, Failure> {
        let newest = self.newest.as_ref().ok_or(
            "the finger is not a spring in any cycle of the selected part of the recording: select another part or \
             finger (--from, --to, --finger), or record while the finger is a spring",
        )?;
        let Newest { time, sent, in_force, force, scale } = newest;
        let forces = self.forces.iter().chain([force]).flatten().map(|part| part.abs());
        let radius = |stiffness: &Matrix3<f64>| stiffness.row_iter().map(|row| row.norm()).fold(0.0, f64::max);
        let reach = forces.fold(radius(sent).max(radius(in_force)), f64::max).max(0.1);
        let axis = Axis::linear(-1.12 * reach, 1.12 * reach);
        let names = ["x", "y", "z"];
        let panel = |[i, j]: [usize; 2]| Panel {
            heading: format!("{} and {}", names[i], names[j]),
            note: String::new(),
            x: axis,
            y: axis,
            x_label: format!("{}, N", names[i]),
            y_label: format!("{}, N", names[j]),
            marks: vec![
                Mark::Area { points: ellipse(in_force, i, j), colour: BLUE, opacity: 0.13, stroke: IN_FORCE },
                Mark::Curve { name: format!("sent {i}{j}"), points: closed(ellipse(sent, i, j)), stroke: SENT },
                Mark::Curve {
                    name: format!("force {i}{j}"),
                    points: self.forces.iter().map(|force| [force[i], force[j]]).collect(),
                    stroke: FORCES,
                },
                Mark::Dot { at: [0.0, 0.0], radius: 3.0, colour: INK },
                Mark::Arrow { from: [0.0, 0.0], to: [force[i], force[j]], stroke: FORCE },
            ],
        };
        let legend = [
            (Sign::Line(SENT), "stiffness as it was sent".into()),
            (Sign::Line(IN_FORCE), format!("stiffness that takes effect in this pose ({scale:.2} of Kx)")),
            (Sign::Line(FORCE), "force of the tip at the end".into()),
            (Sign::Line(FORCES), "earlier forces of the tip".into()),
        ];
        let more = format!("after {time:.3} s  \u{b7}  each ellipse: the forces for all deflections of 1 cm");
        let subtitle = subtitle(selection, self.rate, &more);
        let mut figure = Figure::new("Stiffness and force of the fingertip", &subtitle, &legend, SIDE);
        figure.grid(&[vec![panel([0, 1]), panel([0, 2]), panel([1, 2])]], SIDE);
        Ok(figure)
    }
}

/// The outline, in the plane of two axes, of the forces K u for all deflections u of 1 cm. The forces form an
/// ellipsoid, and its projection onto the plane is an ellipse. If the matrix A consists of the rows of K for these two
/// axes, the ellipse has the matrix A A^T.
fn ellipse(stiffness: &Matrix3<f64>, i: usize, j: usize) -> Vec<[f64; 2]> {
    let (one, other) = (stiffness.row(i), stiffness.row(j));
    let (a, b, c) = (one.dot(&one), one.dot(&other), other.dot(&other));
    // The Cholesky factor of ((a, b), (b, c)) maps the unit circle to the ellipse.
    let l11 = a.sqrt();
    let l21 = if l11 > 0.0 { b / l11 } else { 0.0 };
    let l22 = (c - l21 * l21).max(0.0).sqrt();
    let point = |index: usize| {
        let (sine, cosine) = (TAU * index as f64 / POINTS as f64).sin_cos();
        [l11 * cosine, l21 * cosine + l22 * sine]
    };
    (0..POINTS).map(point).collect()
}

fn closed(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.extend(points.first().copied());
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use sun2xp::nalgebra::Vector3;

    /// The forces of all deflections of 1 cm are within the outline. The largest force in each direction is on it.
    #[test]
    fn the_outline_is_the_largest_force_in_every_direction() {
        let stiffness = Matrix3::new(4.0, 1.0, -0.5, 1.0, 2.0, 0.3, -0.5, 0.3, 3.0);
        let outline = ellipse(&stiffness, 0, 2);
        for angle in [0.0, 0.7, 2.0, 4.4_f64] {
            let direction = [angle.cos(), angle.sin()];
            let along = |point: &[f64; 2]| point[0] * direction[0] + point[1] * direction[1];
            let farthest = outline.iter().map(along).fold(0.0, f64::max);
            // The largest component of K u along d is |K d|, because K is symmetric.
            let expected = (stiffness * Vector3::new(direction[0], 0.0, direction[1])).norm();
            assert!((farthest - expected).abs() < 2e-3 * expected, "{farthest} {expected}");
        }
    }
}
