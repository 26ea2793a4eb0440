//! Measurements for the table and the plots: a constant or slowly changing force pushes the tip, and the deflection of
//! the tip is measured.

use crate::cases::{Case, Friction, axes};
use crate::closed_loop::{ClosedLoop, Held, Senses};
use crate::fits;
use crate::parallel::{each, least, worst};
use nalgebra::{Matrix3, Vector3};

/// How accurately a tip behaves as its spring.
#[derive(Clone, Copy)]
pub struct Fidelity {
    /// Error of the apparent stiffness in the worst direction, relative to the stiffness that the controller reports.
    pub error: f64,
    /// The reported stiffness as a fraction of Kx. It is less than 1 if the tendons cannot carry Kx in this pose.
    pub scale: f64,
}

impl Fidelity {
    pub fn worst(of: &[Self]) -> Self {
        Self { error: worst(of.iter().map(|one| one.error)), scale: least(of.iter().map(|one| one.scale)) }
    }
}

/// Measures the apparent stiffness for deflections of 1 mm, without friction. Returns the worst of all poses and
/// springs.
pub fn apparent_stiffness(case: &Case, senses: Senses) -> Fidelity {
    Fidelity::worst(&each(&case.poses_and_springs(), |_, (pose, kx)| {
        let finger = &case.finger(pose, Friction::None);
        fidelity(&Held { case, finger, belief: finger, pose, kx, senses })
    }))
}

/// Measures the apparent stiffness of one tip for deflections of 1 mm.
pub fn fidelity(held: &Held) -> Fidelity {
    let Pushed { forces, deflections, scale } = pushed_along_axes(held);
    Fidelity { error: fits::spring_error(&forces, &deflections, &(held.kx * scale)), scale }
}

/// The results of the pushes.
pub struct Pushed {
    /// Forces, N.
    pub forces: Vec<Vector3<f64>>,
    /// For each pair of opposite pushes: half of the difference between the two positions of the true tip, cm.
    pub deflections: Vec<Vector3<f64>>,
    /// The reported stiffness as a fraction of Kx.
    pub scale: f64,
}

/// Pushes with the forces that deflect a spring Kx by 1 mm along every axis, in both directions.
///
/// Both pushes of a pair have the same noise, so that most of it cancels in their difference. The rest is averaged.
pub fn pushed_along_axes(held: &Held) -> Pushed {
    const DEFLECTION: f64 = 0.1;
    let (settled, averaged) = if held.senses == Senses::Exact { (2.5, 0.5) } else { (1.0, 3.0) };
    let mut scales = 0.0;
    let mut tip = |force: Vector3<f64>| {
        let mut run = ClosedLoop::new(held);
        run.push(force);
        run.run(settled);
        let mean = run.mean_tip(averaged);
        scales += run.report.stiffness_scale;
        mean
    };
    let (forces, deflections) = [Vector3::x(), Vector3::y(), Vector3::z()]
        .into_iter()
        .map(|axis| {
            let force = held.kx * axis * DEFLECTION;
            (force, (tip(force) - tip(-force)) / 2.0)
        })
        .unzip();
    Pushed { forces, deflections, scale: scales / 6.0 }
}

/// Pushes the tip with a triangular wave of 3 s, with friction. The largest force deflects the spring by 2 mm in either
/// direction. Computes the stiffness from the slope of the deflection over the force, and returns its error relative to
/// `stiffness`.
pub fn triangle(case: &Case, stiffness: f64) -> f64 {
    const AMPLITUDE: f64 = 0.2;
    worst(each(&case.poses(), |_, pose| {
        worst([Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| {
            let mut finger = ClosedLoop::at(case, pose, Friction::Default, &(Matrix3::identity() * stiffness));
            let cycles = finger.cycles(3.0);
            let points: Vec<(f64, f64)> = (0..cycles)
                .map(|cycle| {
                    let phase = 4.0 * cycle as f64 / cycles as f64;
                    // The wave rises to 1, falls to -1 and returns, so that the force begins and ends at 0.
                    let wave = match phase {
                        ..1.0 => phase,
                        ..3.0 => 2.0 - phase,
                        _ => phase - 4.0,
                    };
                    let wanted = AMPLITUDE * wave;
                    finger.push(axis * (stiffness * wanted));
                    finger.cycle();
                    (wanted, (finger.plant.tip() - finger.anchor()).dot(&axis))
                })
                .collect();
            (1.0 / fits::slope(&points) - 1.0).abs()
        }))
    }))
}

/// Pushes the finger from rest with Kx times `deflection` cm for 3 s. Computes the stiffness from the deflection along
/// the push, and returns its error relative to `stiffness`.
pub fn pushed_from_rest(case: &Case, friction: Friction, stiffness: f64, deflection: f64) -> f64 {
    worst(each(&case.poses(), |_, pose| {
        worst(axes().map(|direction| {
            let mut finger = ClosedLoop::at(case, pose, friction, &(Matrix3::identity() * stiffness));
            let rest = finger.plant.tip();
            finger.push(direction * (stiffness * deflection));
            finger.run(2.9);
            let moved = (finger.mean_tip(0.1) - rest).dot(&direction);
            (deflection / moved - 1.0).abs()
        }))
    }))
}
