//! The object of the simulated hand in real time: three servo threads, three ports, one ball.

use nalgebra::{Point3, Vector3};
use std::thread::sleep;
use std::time::{Duration, Instant};
use sun2xp::hand::{Fingers, Hand, HandError};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, ConfiguredObject, FINGERS, ObjectShape};

/// Radius of the ball, cm.
const RADIUS: f64 = 1.5;

/// Position of the ball on the table, in the palm's frame, cm. The palm faces down.
const START: Vector3<f64> = Vector3::new(0.0, 0.0, 10.5);

/// Depth of the anchors (the rest positions of the fingertips' springs) below the surface of the ball, cm.
const SQUEEZE: f64 = 0.8;

fn around_a_ball() -> Configuration {
    let mut configuration = Configuration::default();
    configuration.hand.gravity = [0.0, 0.0, 9.81];
    configuration.hand.simulated_object = Some(ConfiguredObject {
        shape: ObjectShape::Ball { radius: RADIUS },
        position: START.into(),
        table: Some(START.z + RADIUS),
        ..Default::default()
    });
    for finger in &mut configuration.fingers {
        finger.simulation.start_degrees = [0.0, -25.0, 80.0];
    }
    configuration
}

/// Sets the anchors of the fingertips around a point of the palm's frame, at this distance from it, cm.
fn send_around(hand: &Hand, middle: Vector3<f64>, distance: f64) {
    let (sine, cosine) = 60.0f64.to_radians().sin_cos();
    let directions: [[f64; 3]; FINGERS] = [[sine, cosine, 0.0], [-sine, cosine, 0.0], [0.0, -1.0, 0.0]];
    for (number, direction) in FingerNumber::ALL.into_iter().zip(directions) {
        let in_palm = Point3::from(middle + Vector3::from(direction) * distance);
        let tip = around_a_ball().finger_to_palm(number).inverse_transform_point(&in_palm);
        hand.send_tip(number.get(), tip.coords.into()).expect("within reach");
    }
}

/// Waits for this simulated time, s. The simulated time passes more slowly than real time on a busy machine.
fn wait(hand: &Hand, seconds: f64) {
    let (begun, start) = (Instant::now(), hand.object().expect("an object").time);
    while hand.object().expect("an object").time < start + seconds {
        assert!(begun.elapsed() < Duration::from_secs(60), "the simulation stands still");
        sleep(Duration::from_millis(2));
    }
}

/// Moves the anchors in ten steps.
fn glide(hand: &Hand, from: (Vector3<f64>, f64), to: (Vector3<f64>, f64)) {
    for step in 1..=10 {
        let part = f64::from(step) / 10.0;
        send_around(hand, from.0.lerp(&to.0, part), from.1 + (to.1 - from.1) * part);
        wait(hand, 0.06);
    }
}

fn grasp(hand: &Hand) {
    for number in 1..=3 {
        hand.send_stiffness(number, [[3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]]).expect("admissible");
    }
    send_around(hand, START, RADIUS + 0.4);
    wait(hand, 0.8);
    glide(hand, (START, RADIUS + 0.4), (START, RADIUS - SQUEEZE));
    wait(hand, 0.3);
}

fn lift(hand: &Hand, height: f64) {
    let high = START - Vector3::z() * height;
    glide(hand, (START, RADIUS - SQUEEZE), (high, RADIUS - SQUEEZE));
    wait(hand, 0.8);
}

#[test]
fn three_fingers_lift_a_ball_and_put_it_down_again() {
    let hand = Hand::open(around_a_ball()).expect("open");
    grasp(&hand);
    let state = hand.object().expect("an object");
    assert!(state.forces.iter().all(|&force| Vector3::from(force).norm() > 1.0), "{state:?}");
    lift(&hand, 1.5);
    let state = hand.object().expect("an object");
    // The fingers yield by 0.11 cm to the weight of 0.98 N.
    let expected = START - Vector3::z() * (1.5 - 0.11);
    assert!((Vector3::from(state.position) - expected).amax() < 0.15, "{state:?}");
    let high = START - Vector3::z() * 1.5;
    glide(&hand, (high, RADIUS - SQUEEZE), (START, RADIUS - SQUEEZE));
    glide(&hand, (START, RADIUS - SQUEEZE), (START, RADIUS + 0.4));
    wait(&hand, 0.5);
    let state = hand.object().expect("an object");
    assert_eq!(state.forces, [[0.0; 3]; FINGERS]);
    assert!((Vector3::from(state.position) - START).amax() < 0.3, "{state:?}");
}

#[test]
fn a_faulted_finger_stops_neither_the_others_nor_the_object() {
    let hand = Hand::open(around_a_ball()).expect("open");
    grasp(&hand);
    hand.push_simulated(2, [300.0, -300.0, 300.0]).expect("simulated");
    let begun = Instant::now();
    while hand.position(2).is_ok() {
        assert!(begun.elapsed() < Duration::from_secs(30), "finger 2 does not fault");
        sleep(Duration::from_millis(5));
    }
    hand.push_simulated(2, [0.0; 3]).expect("simulated");
    for _ in 0..10 {
        wait(&hand, 0.1);
        assert!(hand.position(1).is_ok() && hand.position(3).is_ok());
    }
    assert!(hand.object().expect("an object").position.iter().all(|part| part.is_finite()));
}

#[test]
fn fingers_that_are_not_opened_do_not_touch_the_object() {
    let fingers = Fingers::only(1).expect("finger 1");
    let hand = Hand::open_limp(around_a_ball(), None, fingers).expect("open");
    wait(&hand, 0.2);
    let state = hand.object().expect("an object");
    assert_eq!(state.forces[1..], [[0.0; 3]; FINGERS - 1], "fingers 2 and 3 are not opened");
    assert!((Vector3::from(state.position) - START).amax() < 0.1, "{state:?}");
}

#[test]
fn the_object_of_a_hand_without_one_is_refused() {
    let fingers = Fingers::only(1).expect("finger 1");
    let hand = Hand::open_limp(Configuration::default(), None, fingers).expect("open");
    assert!(matches!(hand.object(), Err(HandError::NoObject)));
}
