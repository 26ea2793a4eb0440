//! The shapes of an object, in the frame of the object. Lengths are in m.

use super::friction_contact::Indentation;
use crate::model::configuration::ObjectShape;
use nalgebra::{UnitQuaternion, Vector3};

/// Largest number of points of an object that touch a table: the corners of a box.
pub(super) const CORNERS: usize = 8;

/// A ball or a box.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shape {
    Ball { radius: f64 },
    Box { half: Vector3<f64> },
}

impl Shape {
    /// Converts a configured shape from cm.
    pub fn new(configured: &ObjectShape) -> Self {
        match *configured {
            ObjectShape::Ball { radius } => Self::Ball { radius: radius * 0.01 },
            ObjectShape::Box { size } => Self::Box { half: Vector3::from(size) * 0.005 },
        }
    }

    /// Returns the principal moments of inertia, kg m^2.
    pub fn inertia(&self, mass: f64) -> Vector3<f64> {
        match *self {
            Self::Ball { radius } => Vector3::repeat(0.4 * mass * radius * radius),
            Self::Box { half } => {
                let square = half.component_mul(&half) * (mass / 3.0);
                Vector3::new(square.y + square.z, square.x + square.z, square.x + square.y)
            }
        }
    }

    /// Returns how deep a point is inside the object. `None`: it is outside. The depth is continuous, so a point gains
    /// no energy where the nearest face changes.
    pub fn indented_by(&self, point: &Vector3<f64>) -> Option<Indentation> {
        match *self {
            Self::Ball { radius } => {
                let distance = point.norm();
                // At the centre of a ball, every direction points outward.
                let outward = if distance > 0.0 { point / distance } else { Vector3::z() };
                (distance < radius).then_some(Indentation { depth: radius - distance, outward })
            }
            Self::Box { half } => {
                let depths = half - point.abs();
                let (axis, depth) = depths.argmin();
                let mut outward = Vector3::zeros();
                outward[axis] = f64::copysign(1.0, point[axis]);
                (depth > 0.0).then_some(Indentation { depth, outward })
            }
        }
    }

    /// Returns the points that can touch a plane with the unit normal `up`. They are relative to the centre of the
    /// object, in the frame in which the object has this rotation. A ball has one such point.
    pub fn lowest(&self, rotation: &UnitQuaternion<f64>, up: &Vector3<f64>) -> impl Iterator<Item = Vector3<f64>> {
        let (rotation, up, shape) = (*rotation, *up, *self);
        let count = match shape {
            Self::Ball { .. } => 1,
            Self::Box { .. } => CORNERS,
        };
        (0..count).map(move |corner| match shape {
            Self::Ball { radius } => -up * radius,
            Self::Box { half } => {
                let side = |axis: usize| if corner >> axis & 1 == 0 { half[axis] } else { -half[axis] };
                rotation * Vector3::new(side(0), side(1), side(2))
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_and_a_box_have_the_inertia_of_the_textbook() {
        let ball = Shape::new(&ObjectShape::Ball { radius: 3.0 });
        assert!((ball.inertia(0.5) - Vector3::repeat(0.4 * 0.5 * 9e-4)).amax() < 1e-15);
        let brick = Shape::new(&ObjectShape::Box { size: [2.0, 4.0, 6.0] });
        let expected = Vector3::new(16.0 + 36.0, 4.0 + 36.0, 4.0 + 16.0) * (0.5 / 12.0 * 1e-4);
        assert!((brick.inertia(0.5) - expected).amax() < 1e-15);
    }

    #[test]
    fn depths_are_those_below_the_nearest_surface() {
        let ball = Shape::new(&ObjectShape::Ball { radius: 2.0 });
        let touched = ball.indented_by(&Vector3::new(0.0, -0.015, 0.0)).expect("inside");
        assert!((touched.depth - 0.005).abs() < 1e-12 && touched.outward == -Vector3::y());
        assert_eq!(ball.indented_by(&Vector3::new(0.0, -0.021, 0.0)), None);
        let brick = Shape::new(&ObjectShape::Box { size: [2.0, 4.0, 6.0] });
        let touched = brick.indented_by(&Vector3::new(0.002, -0.018, 0.01)).expect("inside");
        assert!((touched.depth - 0.002).abs() < 1e-12 && touched.outward == -Vector3::y());
        assert_eq!(brick.indented_by(&Vector3::new(0.0, 0.0, 0.031)), None);
    }
}
