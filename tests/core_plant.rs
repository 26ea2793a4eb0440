//! Tests the physics of the simulated finger against results that do not depend on its code.

#[allow(dead_code)]
mod core_lagrange;
#[path = "common/energy.rs"]
mod energy;

use core_lagrange::IndependentFinger;
use energy::{assert_gains_no_energy, steps};
use nalgebra::{Vector3, Vector4};
use proptest::prelude::*;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::model::configuration::Surface;
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant, Sensors};

fn frictionless() -> ConfiguredFinger {
    let mut finger = ConfiguredFinger::default();
    finger.simulation.joint_viscous_friction = [0.0; 3];
    finger.simulation.joint_coulomb_friction = [0.0; 3];
    finger.simulation.motor_viscous_friction = [0.0; 4];
    finger.simulation.motor_coulomb_friction = [0.0; 4];
    finger.simulation.shaft_friction = 0.0;
    finger
}

fn torque_for(tensions: [f64; 4]) -> [f64; 4] {
    tensions.map(|tension| tension * 0.0475 * 0.01)
}

#[test]
fn stays_at_its_homing_equilibrium() {
    let finger = ConfiguredFinger::default();
    let mut plant = Plant::new(&finger, Vector3::zeros()).unwrap();
    let start = plant.joints();
    let home = finger.tendons().unwrap().pretension(5.0);
    assert!((plant.tensions() - home).amax() < 1e-9);
    for braked in [true, false] {
        if !braked {
            plant.release_brake();
        }
        for _ in 0..5000 {
            plant.step(if braked { [0.0; 4] } else { torque_for(home.into()) });
        }
        assert!((plant.joints() - start).amax() < 1e-9);
        assert!((plant.tensions() - home).amax() < 1e-6);
    }
}

#[test]
fn a_brake_holds_against_any_torque_and_lets_go_once() {
    let mut plant = Plant::new(&ConfiguredFinger::default(), Vector3::zeros()).unwrap();
    let motors = plant.motor_angles();
    plant.step([0.04; 4]);
    assert_eq!(plant.motor_angles(), motors);
    plant.release_brake();
    plant.step([0.04; 4]);
    assert!((plant.motor_angles() - motors).min() > 0.0);
}

#[test]
fn tendons_pull_and_never_push() {
    let mut plant = Plant::new(&frictionless(), Vector3::zeros()).unwrap();
    plant.turn_motor(1, -1.0);
    assert_eq!(plant.tensions()[1], 0.0);
    // Tension is stiffness times radius times angle: 3 N over 300 N/cm is 0.01 cm.
    plant.turn_motor(0, 0.01 / 0.0475);
    let home = ConfiguredFinger::default().tendons().unwrap().pretension(5.0);
    assert!((plant.tensions()[0] - home[0] - 3.0).abs() < 1e-9);
}

#[test]
fn inertia_of_the_straight_finger_is_that_of_rods() {
    // About joint 0, straight links of radius 0 have the textbook inertia of thin rods that lie end to end.
    let mut finger = frictionless();
    finger.simulation.link_radii = [0.0; 3];
    finger.simulation.start_degrees = [0.0, 0.0, 0.0];
    finger.joints.minimum_degrees = [-60.0, -30.0, -5.0];
    let mut plant = Plant::new(&finger, Vector3::zeros()).unwrap();
    plant.set_external_force(Vector3::new(1.0, 0.0, 0.0));
    plant.step([0.0; 4]);
    let rod = |mass: f64, from: f64, to: f64| mass * (to.powi(3) - from.powi(3)) / (3.0 * (to - from));
    let links = rod(0.060, 0.0, 0.03556) + rod(0.045, 0.03556, 0.08636) + rod(0.025, 0.08636, 0.12636);
    let inertia = links + 0.005 * 0.12636f64.powi(2);
    let expected = 0.12636 / inertia * PLANT_STEP_SECONDS;
    assert!((plant.joint_rates()[0] / expected - 1.0).abs() < 1e-9);
}

#[test]
fn agrees_with_an_independent_integration_of_lagranges_equations() {
    let gravity = Vector3::new(1.0, -9.0, 2.0);
    let force = Vector3::new(0.25, -0.1, 0.15);
    let torque = torque_for([12.0, 14.0, 13.0, 11.0]);
    for start in [[0.0, 30.0, 60.0], [-20.0, 60.0, 40.0], [25.0, -5.0, 95.0]] {
        let mut finger = frictionless();
        finger.simulation.start_degrees = start;
        let mut plant = Plant::new(&finger, gravity).unwrap();
        plant.release_brake();
        plant.set_external_force(force);
        let mut other = IndependentFinger::new(start, gravity, force, torque);
        let (mut moved, mut apart): (f64, f64) = (0.0, 0.0);
        for _ in 0..500 {
            plant.step(torque);
            other.step(PLANT_STEP_SECONDS);
            moved = moved.max((other.joints() - Vector3::from(start.map(f64::to_radians))).amax());
            apart = apart.max((plant.joints() - other.joints()).amax());
            assert!((plant.motor_angles() - other.motors()).amax() < 0.03);
        }
        assert!(moved > 0.05, "the comparison needs a motion: {moved} rad");
        assert!(apart < 0.02 * moved, "{apart} rad apart in {moved} rad of motion from {start:?}");
    }
}

/// The step is too long for links that are so light, so the numbers grow without bound.
#[test]
fn a_simulation_that_diverges_does_not_panic() {
    let mut finger = ConfiguredFinger::default();
    finger.simulation.masses = [1e-6; 4];
    finger.simulation.rotor_inertia = [1e-8; 4];
    finger.simulation.stiction_ratio = 1.5;
    let mut plant = Plant::new(&finger, Vector3::new(0.0, 0.0, -9.81)).unwrap();
    plant.release_brake();
    (0..10_000).for_each(|_| plant.step(torque_for([10.0; 4])));
    assert!(!plant.joints().iter().chain(&plant.motor_angles()).all(|angle| angle.is_finite()), "{plant:?}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        ..Default::default()
    })]

    /// The motors have no torque. The finger is released from a state in which tendons, stops, a wall and gravity
    /// strain it.
    #[test]
    fn passive_parts_never_create_energy(
        joint_0 in -50.0..50.0f64, joint_1 in -25.0..95.0f64, joint_2 in 8.0..118.0f64,
        push in prop::array::uniform3(-6.0..6.0f64),
        unwound in prop::array::uniform4(-0.5..1.5f64),
        friction in 0.0..4.0f64, braked: bool, wall: bool, steps in steps(),
    ) {
        let mut finger = ConfiguredFinger::default();
        finger.simulation.start_degrees = [joint_0, joint_1, joint_2];
        finger.simulation.joint_coulomb_friction = [0.5e-3 * friction; 3];
        finger.simulation.joint_viscous_friction = [1e-4 * friction; 3];
        let mut plant = Plant::new(&finger, Vector3::new(0.0, -9.81, 0.0)).unwrap();
        if wall {
            let point = plant.tip().into();
            let normal = [0.1 - push[0], -push[1], -push[2]];
            plant.set_surface(Some(Surface::Wall { point, normal, stiffness: 100.0 }));
        }
        for (motor, angle) in unwound.into_iter().enumerate() {
            plant.turn_motor(motor, angle);
        }
        plant.set_external_force(Vector3::from(push));
        for _ in 0..100 {
            plant.step([0.0; 4]);
        }
        if !braked {
            plant.release_brake();
        }
        plant.set_external_force(Vector3::zeros());
        // Away from the stops, the stiffest mode is that of the last link, 2.1e-5 kg m^2 with the tip, between the wall
        // (16 N m/rad at 4 cm) and the tendons (2 N m/rad): 930 rad/s with the other links fixed. With free links it is
        // faster, but below 2000 rad/s. With steps of 0.1 ms, its energy error is at most 0.1 of the swinging energy
        // (see `assert_gains_no_energy`). A link at a stop (100 N m/rad) oscillates faster, but the damping of the stop
        // takes away more energy than the larger error adds.
        let start = (plant.energy(), plant.kinetic_energy());
        let step = || {
            plant.step([0.0; 4]);
            (plant.energy(), plant.kinetic_energy())
        };
        assert_gains_no_energy(start, step, 0.1, steps);
    }
}

#[test]
fn surfaces_push_along_their_normal_in_proportion_to_the_depth_of_the_tip() {
    let mut plant = Plant::new(&frictionless(), Vector3::zeros()).unwrap();
    let tip = plant.tip();
    let point = (tip + Vector3::new(0.0, 0.02, 0.0)).into();
    for length in [5.0, 1e-320, 1e-200, 1e200, f64::MAX] {
        plant.set_surface(Some(Surface::Wall { point, normal: [0.0, length, 0.0], stiffness: 100.0 }));
        assert!((plant.contact_force() - Vector3::new(0.0, 2.0, 0.0)).amax() < 1e-9, "a normal of length {length:e}");
    }
    plant.set_surface(Some(Surface::Wall { point, normal: [0.0, -1.0, 0.0], stiffness: 100.0 }));
    assert_eq!(plant.contact_force(), Vector3::zeros());
    let centre = (tip - Vector3::new(0.99, 0.0, 0.0)).into();
    plant.set_surface(Some(Surface::Ball { centre, radius: 1.0, stiffness: 50.0 }));
    assert!((plant.contact_force() - Vector3::new(0.5, 0.0, 0.0)).amax() < 1e-9);
}

#[test]
fn stops_hold_the_joints_against_a_motor() {
    let mut plant = Plant::new(&ConfiguredFinger::default(), Vector3::zeros()).unwrap();
    plant.release_brake();
    for _ in 0..20_000 {
        plant.step([0.0, 0.0475, 0.0, 0.0]);
    }
    let (_, upper) = ConfiguredFinger::default().joint_limits();
    let over = (plant.joints() - upper).map(f64::to_degrees);
    // Tendon 2 pulls all three joints up. The stops are 3 degrees beyond the soft limits.
    assert!(over.iter().all(|&degrees| (3.0..4.0).contains(&degrees)), "{over}");
    assert!(plant.joint_rates().amax() < 1e-3);
}

#[test]
fn friction_holds_a_small_force_and_yields_to_a_large_one() {
    let run = |newton: f64| {
        let mut plant = Plant::new(&ConfiguredFinger::default(), Vector3::zeros()).unwrap();
        let start = plant.tip();
        // Across the finger's plane, a friction of 0.5 mN m at a lever of 0.08 m holds about 6 mN.
        plant.set_external_force(Vector3::new(newton, 0.0, 0.0));
        for _ in 0..2000 {
            plant.step([0.0; 4]);
        }
        (plant.tip() - start).norm()
    };
    assert!(run(0.003) < 1e-9);
    assert!(run(0.5) > 0.01);
}

#[test]
fn counts_are_rounded_and_have_sign_and_zero() {
    let mut finger = ConfiguredFinger::default();
    finger.simulation.gauge_noise = 0.0;
    finger.encoder.sign = [1, -1, 1, 1];
    finger.encoder.zero = [0, 100, i32::MAX, -7];
    finger.gauge.zero = [0.0, 12.0, 0.0, 0.0];
    finger.simulation.start_degrees = [0.0; 3];
    let mut plant = Plant::new(&finger, Vector3::zeros()).unwrap();
    let step = std::f64::consts::TAU / 2000.0;
    for motor in 0..4 {
        plant.turn_motor(motor, 3.5 * step);
    }
    let (counts, gauges) = Sensors::new(&finger).read(&plant);
    assert_eq!(counts, [3, 96, i32::MIN + 2, -4]);
    let tension = plant.tensions();
    for tendon in 0..4 {
        let expected = tension[tendon] * 4095.0 / 100.0 + finger.gauge.zero[tendon];
        assert!((f64::from(gauges[tendon]) - expected).abs() <= 0.5);
    }
}

#[test]
fn the_same_seed_gives_the_same_finger() {
    let run = |seed: u64| {
        let mut finger = ConfiguredFinger::default();
        finger.simulation.seed = seed;
        let mut plant = Plant::new(&finger, Vector3::zeros()).unwrap();
        let mut sensors = Sensors::new(&finger);
        plant.release_brake();
        let readings: Vec<_> = (0..500)
            .map(|step| {
                plant.step([0.002, 0.003, 0.001, 0.002 + 1e-5 * f64::from(step)]);
                sensors.read(&plant)
            })
            .collect();
        (readings, plant.joints(), plant.tensions())
    };
    assert_eq!(run(7), run(7));
    assert_ne!(run(7).0, run(8).0);
    assert_eq!(run(7).1, run(8).1);
}

#[test]
fn gauge_noise_has_the_configured_size() {
    let finger = ConfiguredFinger::default();
    let plant = Plant::new(&finger, Vector3::zeros()).unwrap();
    let mut sensors = Sensors::new(&finger);
    let scale = finger.gauge.newton_per_count[0];
    let readings: Vec<Vector4<f64>> =
        (0..4000).map(|_| Vector4::from(sensors.read(&plant).1.map(|count| f64::from(count) * scale))).collect();
    let mean = readings.iter().sum::<Vector4<f64>>() / 4000.0;
    assert!((mean - plant.tensions()).amax() < 0.003);
    let squares = readings.iter().map(|reading| (reading - mean).component_mul(&(reading - mean)));
    let variance = squares.sum::<Vector4<f64>>() / 4000.0;
    // 0.03 N rms and the rounding of a count, scale / sqrt(12).
    let expected = 0.03f64.powi(2) + scale.powi(2) / 12.0;
    assert!(variance.iter().all(|found| (found / expected - 1.0).abs() < 0.15), "{variance}");
}
