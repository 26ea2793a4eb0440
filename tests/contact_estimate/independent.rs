//! Tests the estimated force with a finger whose dynamics come from Lagrange's equations, and not from code of the
//! library.

use crate::core_lagrange::IndependentFinger;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;
use sun2xp::control::{Activity, Controller, Feedback, Measured, Report, SetPoint};
use sun2xp::model::configuration::{ConfiguredContact, ConfiguredFinger};

const PERIOD: f64 = 1e-3;

/// Converts measurements to counts. The state before the first cycle is constructed from counts.
fn counts(finger: &ConfiguredFinger, measured: &Measured) -> Feedback {
    let (encoder, gauge) = (&finger.encoder, &finger.gauge);
    Feedback {
        motor_counts: std::array::from_fn(|motor| {
            let scale = f64::from(encoder.sign[motor]) * f64::from(encoder.counts_per_revolution[motor]) / TAU;
            (measured.motor_angles[motor] * scale).floor() as i32 + encoder.zero[motor]
        }),
        gauge_counts: std::array::from_fn(|tendon| {
            (measured.tensions[tendon] / gauge.newton_per_count[tendon] + gauge.zero[tendon]).round() as u16
        }),
    }
}

/// Returns the reports of a finger without friction, 0.15 s after each force began to act. Nothing controls the
/// finger: the motors pull with constant torques, and each force accelerates the links further.
fn pushed(gravity: Vector3<f64>, forces: &[Vector3<f64>]) -> Vec<Report> {
    let mut configured = ConfiguredFinger::default();
    (configured.friction.joint_coulomb, configured.friction.joint_viscous) = ([0.0; 3], [0.0; 3]);
    // With these thresholds, every force after the first 0.2 s counts as a contact, so that no force is learned as an
    // error of the model.
    configured.contact = ConfiguredContact {
        force: 1e-3,
        force_per_rate: 0.0,
        torque: [1e-3; 3],
        mass_tolerance: 0.0,
        ..Default::default()
    };
    let controller = Controller::in_gravity(&configured, &gravity, 1.0 / PERIOD).expect("a controller");
    let torque = [5.0, 5.0 * 1.09 / 0.62, 5.0 * 1.09 / 0.62, 5.0].map(|tension| tension * 0.0475e-2);
    let mut independent = IndependentFinger::new([10.0, 30.0, 60.0], gravity, Vector3::zeros(), torque);
    let mut state = None;
    let mut cycle = |finger: &mut IndependentFinger| {
        let measured = Measured { motor_angles: finger.motors(), tensions: finger.tensions() };
        let state = state.get_or_insert_with(|| controller.start(&counts(&configured, &measured)));
        let set_point = SetPoint::hard_finger(finger.joints(), Matrix3::identity());
        let (_, report) = controller.cycle_measured(state, Some(&measured), &Activity::Follow(set_point));
        (0..10).for_each(|_| finger.step(PERIOD / 10.0));
        report
    };
    for _ in 0..210 {
        cycle(&mut independent);
    }
    let after = forces.iter().map(|&force| {
        independent.push(force);
        (0..150).map(|_| cycle(&mut independent)).last().expect("a report")
    });
    after.collect()
}

#[test]
fn the_force_is_found_while_it_accelerates_the_finger() {
    let forces = [Vector3::new(0.3, 0.0, 0.0), Vector3::new(-0.3, 0.2, 0.1), Vector3::new(0.0, -0.3, -0.2)];
    for gravity in [Vector3::zeros(), Vector3::new(0.0, 0.4, -0.3)] {
        for (force, report) in forces.iter().zip(pushed(gravity, &forces)) {
            let contact = report.contact;
            assert!(report.joint_rates.amax() > 0.3, "{}", report.joint_rates);
            assert!((contact.force - force).norm() < 0.15 * force.norm(), "{force} {}", contact.force);
        }
    }
}
