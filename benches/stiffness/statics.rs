//! Rows that push slowly and look at how far the tip gives way.

use crate::cases::{Case, Friction, axes};
use crate::closed_loop::ClosedLoop;
use nalgebra::{Matrix3, Vector3};

/// Apparent stiffness about 1 mm in the worst direction: the part by which C Kx differs from the unit matrix, C being the
/// compliance found by pushing along every axis, both ways. Sensors quantised and noisy, no friction.
pub fn apparent_stiffness(case: &Case) -> f64 {
    let mut worst: f64 = 0.0;
    for pose in case.poses() {
        for kx in case.springs() {
            worst = worst.max(error_of(&compliance(case, &pose, &kx), &kx));
        }
    }
    worst
}

/// The tip's displacement for a force, cm/N, measured.
pub fn compliance(case: &Case, pose: &Vector3<f64>, kx: &Matrix3<f64>) -> Matrix3<f64> {
    const DEFLECTION: f64 = 0.1;
    let pushed = |force: Vector3<f64>| {
        let mut finger = ClosedLoop::at(case, pose, Friction::None, kx);
        finger.push(force);
        finger.run(1.0);
        finger.mean_tip(3.0)
    };
    let columns: Vec<Vector3<f64>> = (0..3)
        .map(|axis| {
            // So that the tip gives way by about 1 mm, whatever the spring.
            let force = Vector3::ith(axis, DEFLECTION * kx[(axis, axis)]);
            (pushed(force) - pushed(-force)) / (2.0 * force[axis])
        })
        .collect();
    Matrix3::from_columns(&columns)
}

/// Largest singular value of C Kx - 1: how far the found displacement is from the wanted one, in the worst direction.
pub fn error_of(compliance: &Matrix3<f64>, kx: &Matrix3<f64>) -> f64 {
    (compliance * kx - Matrix3::identity()).singular_values().max()
}

/// Error of the slope of a triangular force loop of +-2 mm in 3 s, friction on; worst of Kx 3 and the bound.
pub fn triangle(case: &Case) -> f64 {
    const AMPLITUDE: f64 = 0.2;
    let mut worst: f64 = 0.0;
    for stiffness in [3.0, case.bound()] {
        for pose in case.poses() {
            for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
                let mut finger = ClosedLoop::at(case, &pose, Friction::Default, &(Matrix3::identity() * stiffness));
                let cycles = finger.cycles(3.0);
                let points = (0..cycles).map(|cycle| {
                    let phase = 4.0 * cycle as f64 / cycles as f64;
                    // Up to 1, down to -1 and back: it begins and ends at rest.
                    let wave = match phase {
                        ..1.0 => phase,
                        ..3.0 => 2.0 - phase,
                        _ => phase - 4.0,
                    };
                    let wanted = AMPLITUDE * wave;
                    finger.push(axis * (stiffness * wanted));
                    finger.cycle();
                    (wanted, (finger.plant.tip() - finger.anchor()).dot(&axis))
                });
                worst = worst.max((1.0 / slope(points) - 1.0).abs());
            }
        }
    }
    worst
}

/// Error of the deflection when pushed from rest with Kx times `deflection` cm for 3 s.
pub fn pushed_from_rest(case: &Case, friction: Friction, stiffnesses: &[f64], deflection: f64) -> f64 {
    let mut worst: f64 = 0.0;
    for &stiffness in stiffnesses {
        for pose in case.poses() {
            for direction in axes() {
                let mut finger = ClosedLoop::at(case, &pose, friction, &(Matrix3::identity() * stiffness));
                let rest = finger.plant.tip();
                finger.push(direction * (stiffness * deflection));
                finger.run(2.9);
                let moved = (finger.mean_tip(0.1) - rest).dot(&direction);
                worst = worst.max((deflection / moved - 1.0).abs());
            }
        }
    }
    worst
}

/// Least-squares slope of y over x.
fn slope(points: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut n, mut sx, mut sy, mut sxx, mut sxy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (x, y) in points {
        n += 1.0;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    (n * sxy - sx * sy) / (n * sxx - sx * sx)
}
