//! The shapes of the palm and of the bases of the fingers. The configuration contains only the positions and rotations
//! of the bases, so these shapes are only for display.

use super::geometry::Finger;
use super::shape::{Colour, Form, Shape};

/// Thickness of the plate, cm.
const THICKNESS: f64 = 1.2;
/// Distance from the axes of the joints 0 down to the upper side of the plate, cm.
const CLEARANCE: f64 = 1.4;
/// Distance from the outermost bases to the axes of the plate's round edges, along x and along y, cm.
const MARGIN: f64 = 1.6;

/// Returns the base of a finger, in the finger's frame: the shaft of joint 0 with its two supports. `radius` is that of
/// link 0, cm.
pub fn base(radius: f64) -> Vec<Shape> {
    let half = radius * 1.5;
    let support = |y: f64| Shape::capsule([0.0, y, 0.0], [0.0, y, -CLEARANCE - THICKNESS / 2.0], 0.55, Colour::BASE);
    vec![
        Shape::cylinder([0.0, -half, 0.0], [0.0, half, 0.0], radius * 0.6, Colour::JOINT),
        support(-half),
        support(half),
    ]
}

/// Returns the palm: a plate below the bases of the fingers, and the wrist below the plate.
pub fn shapes(fingers: &[Finger]) -> Vec<Shape> {
    let bound = |axis: usize, choose: fn(f64, f64) -> f64, start: f64| {
        fingers.iter().map(|finger| finger.base[axis]).fold(start, choose)
    };
    let lowest = [0, 1, 2].map(|axis| bound(axis, f64::min, f64::INFINITY));
    let highest = [0, 1, 2].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY));
    let centre = [0, 1].map(|axis| (lowest[axis] + highest[axis]) / 2.0);
    let size = [0, 1].map(|axis| highest[axis] - lowest[axis] + 2.0 * MARGIN);
    let top = lowest[2] - CLEARANCE;
    let middle = top - THICKNESS / 2.0;
    let mut shapes = plate(centre, size, middle);
    let [x, y] = centre;
    let wrist = size[0].min(size[1]) * 0.28;
    shapes.push(Shape::cylinder([x, y, top - THICKNESS], [x, y, top - THICKNESS - 0.5], wrist * 1.25, Colour::JOINT));
    shapes.push(Shape::cylinder([x, y, top - THICKNESS - 0.5], [x, y, top - THICKNESS - 4.0], wrist, Colour::BASE));
    shapes
}

/// Returns a plate with round edges.
fn plate(centre: [f64; 2], size: [f64; 2], z: f64) -> Vec<Shape> {
    let radius = THICKNESS / 2.0;
    let [x, y] = centre;
    let [along_x, along_y] = size.map(|size| size / 2.0);
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corner = |(side_x, side_y): (f64, f64)| [x + side_x * along_x, y + side_y * along_y, z];
    let block = Form::Box { centre: [x, y, z], size: [size[0], size[1], THICKNESS] };
    let edges = (0..4)
        .map(|first| Shape::capsule(corner(corners[first]), corner(corners[(first + 1) % 4]), radius, Colour::PALM));
    std::iter::once(Shape { form: block, colour: Colour::PALM }).chain(edges).collect()
}
