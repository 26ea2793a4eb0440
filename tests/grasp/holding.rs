//! Grasps of an object: it is lifted and held without creep, and it slips if the friction is too low.

use crate::rig::{GraspingHand, RADIUS, START, around_a_ball};
use nalgebra::Vector3;
use sun2xp::finger::Stage;
use sun2xp::model::configuration::{ConfiguredSimulation, ObjectShape};

/// Depth of the anchors (the set points of the tips) below the surface of the object, cm. With 3 N/cm, each finger
/// presses with 2.3 N.
const SQUEEZE: f64 = 0.8;

/// Height of a lift, cm.
const HEIGHT: f64 = 1.5;

fn position(hand: &GraspingHand) -> Vector3<f64> {
    hand.object().position.into()
}

fn lifted(mut hand: GraspingHand) -> GraspingHand {
    hand.send_stiffness(3.0);
    hand.grasp(SQUEEZE);
    let on_table = position(&hand);
    assert!((on_table - START).xy().norm() < 0.1, "pushed aside: {on_table}");
    hand.lift(HEIGHT, SQUEEZE);
    assert!(hand.stages().iter().all(|stage| *stage == Stage::Running), "{:?}", hand.stages());
    hand
}

#[test]
fn a_ball_is_lifted_whatever_its_mass_its_friction_and_the_noise() {
    for (mass, friction) in [(0.02, 0.3), (0.02, 1.0), (0.1, 0.4), (0.1, 0.6), (0.25, 0.6), (0.25, 1.0)] {
        for seed in 1..=5 {
            let hand = lifted(GraspingHand::open(around_a_ball(mass, friction, seed)));
            let state = hand.object();
            // The fingers yield to the weight: three springs of 3 N/cm.
            let expected = START.z - HEIGHT + mass * 9.81 / 9.0;
            let off = Vector3::from(state.position) - Vector3::new(0.0, 0.0, expected);
            assert!(off.amax() < 0.1, "{mass} kg, friction {friction}, seed {seed}: {off}");
            let carried: Vector3<f64> = state.forces.iter().map(|&force| Vector3::from(force)).sum();
            let weight = Vector3::new(0.0, 0.0, -mass * 9.81);
            assert!((carried - weight).amax() < 0.2 * weight.norm() + 0.05, "{mass} kg: {carried}");
        }
    }
}

#[test]
fn a_held_ball_does_not_creep_in_a_minute() {
    let mut hand = lifted(GraspingHand::open(around_a_ball(0.1, 0.6, 3)));
    let start = (0..100).map(|_| after_a_cycle(&mut hand)).sum::<Vector3<f64>>() / 100.0;
    let mut farthest: f64 = 0.0;
    for _ in 0..60 {
        hand.run(900);
        let mean = (0..100).map(|_| after_a_cycle(&mut hand)).sum::<Vector3<f64>>() / 100.0;
        farthest = farthest.max((mean - start).norm());
    }
    assert!(farthest < 0.01, "{farthest} cm");
}

/// Runs a cycle and returns the position of the object, cm.
fn after_a_cycle(hand: &mut GraspingHand) -> Vector3<f64> {
    hand.run(1);
    position(hand)
}

#[test]
fn a_ball_with_too_little_friction_slips_and_stays_on_the_table() {
    let hand = lifted(GraspingHand::open(around_a_ball(0.25, 0.1, 1)));
    let state = hand.object();
    assert!(state.position[2] > START.z - 0.3, "{:?}", state.position);
}

#[test]
fn a_box_is_lifted_too() {
    let mut configuration = around_a_ball(0.1, 0.8, 2);
    if let Some(object) = &mut configuration.hand.simulated_object {
        object.shape = ObjectShape::Box { size: [2.6, 2.0, 2.0 * RADIUS] };
    }
    let hand = lifted(GraspingHand::open(configuration));
    let height = START.z - position(&hand).z;
    assert!((height - HEIGHT).abs() < 0.25, "{height} cm");
}

#[test]
fn two_runs_are_identical() {
    let run = || lifted(GraspingHand::open(around_a_ball(0.1, 0.6, 4))).object();
    assert_eq!(run(), run());
}

#[test]
fn the_other_fingers_hold_on_when_one_lets_go() {
    let mut hand = lifted(GraspingHand::open(around_a_ball(0.05, 0.8, 5)));
    hand.close_finger(0);
    hand.run(2000);
    let stages = hand.stages();
    assert!(stages[0] == Stage::Closed && stages[1] == Stage::Running && stages[2] == Stage::Running, "{stages:?}");
    assert!(hand.object().position.iter().all(|part| part.is_finite()));
    assert!(hand.object().time > 6.0);
}

#[test]
fn hands_with_rubbing_tendons_grasp_too() {
    for named in ["worn", "sheathed", "cheap"] {
        let mut configuration = around_a_ball(0.1, 0.6, 3);
        for finger in &mut configuration.fingers {
            let ConfiguredSimulation { start_degrees, seed, .. } = finger.simulation;
            let values = ConfiguredSimulation::named(named).expect("a named hand");
            finger.simulation = ConfiguredSimulation { start_degrees, seed, ..values };
        }
        let hand = lifted(GraspingHand::open(configuration));
        let height = START.z - position(&hand).z;
        assert!((height - HEIGHT).abs() < 0.25, "{named}: {height} cm");
    }
}
