//! Rows that push slowly and look at how far the tip gives way.

use crate::cases::{Case, Friction, axes};
use crate::closed_loop::{ClosedLoop, Held, Senses};
use crate::fits;
use crate::parallel::{each, least, worst};
use nalgebra::{Matrix3, Vector3};

/// How well a tip is its spring.
#[derive(Clone, Copy)]
pub struct Fidelity {
    /// Of the apparent stiffness, in the worst direction, against what the controller reports that it gives: a part of
    /// Kx.
    pub error: f64,
    /// That part: less than 1 where the tendons of the pose carry no more.
    pub scale: f64,
}

impl Fidelity {
    pub fn worst(of: &[Self]) -> Self {
        Self { error: worst(of.iter().map(|one| one.error)), scale: least(of.iter().map(|one| one.scale)) }
    }
}

/// The stiffness that the tip shows, about 1 mm; worst over poses and springs. No friction.
pub fn apparent_stiffness(case: &Case, senses: Senses) -> Fidelity {
    Fidelity::worst(&each(&case.poses_and_springs(), |_, (pose, kx)| {
        let finger = &case.finger(pose, Friction::None);
        fidelity(&Held { case, finger, belief: finger, pose, kx, senses })
    }))
}

/// The stiffness that one tip shows, about 1 mm.
pub fn fidelity(held: &Held) -> Fidelity {
    let Pushed { forces, deflections, scale } = pushed_about(held);
    Fidelity { error: fits::spring_error(&forces, &deflections, &(held.kx * scale)), scale }
}

/// What pushes came to.
pub struct Pushed {
    /// N.
    pub forces: Vec<Vector3<f64>>,
    /// How far the true tip went from the middle of each pair of pushes, cm.
    pub deflections: Vec<Vector3<f64>>,
    /// The part of Kx that was given, as reported.
    pub scale: f64,
}

/// Pushes that deflect Kx by 1 mm along every axis both ways.
///
/// Both pushes of a pair meet the same noise, so that most of it leaves their difference; the rest is averaged.
pub fn pushed_about(held: &Held) -> Pushed {
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

/// Error of the slope of a triangular force loop of +-2 mm in 3 s, friction on.
pub fn triangle(case: &Case, stiffness: f64) -> f64 {
    const AMPLITUDE: f64 = 0.2;
    worst(each(&case.poses(), |_, pose| {
        worst([Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| {
            let mut finger = ClosedLoop::at(case, pose, Friction::Default, &(Matrix3::identity() * stiffness));
            let cycles = finger.cycles(3.0);
            let points: Vec<(f64, f64)> = (0..cycles)
                .map(|cycle| {
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
                })
                .collect();
            (1.0 / fits::slope(&points) - 1.0).abs()
        }))
    }))
}

/// Error of the stiffness that the deflection along the push shows, when pushed from rest with Kx times `deflection` cm
/// for 3 s.
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
