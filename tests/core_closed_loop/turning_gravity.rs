//! A hand on an arm that turns: the true gravity changes all the time, and the planner sends it every 2 ms.

use super::rig::{Loop, SCHEMES, finger_with, spring};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use sun2xp::model::configuration::ConfiguredFinger;

const RATE: f64 = 1000.0;

/// Largest permitted difference between the [`deviation`] of a hand that turns and that of a hand at rest, cm, for each
/// scheme of [`SCHEMES`]. While the hand turns, the tensions change all the time, so the friction of the motors
/// reverses. Figure 9 and Figure 11 control the tensions with less gain, so their limits are larger.
const INCREASE: [f64; 4] = [0.03, 0.01, 0.08, 0.01];

/// Gravity of a hand that has turned by `angle`, rad, about an axis across the finger, m/s^2.
fn turned(angle: f64) -> Vector3<f64> {
    Vector3::new(2.0, 9.6 * angle.cos(), 9.6 * angle.sin())
}

/// Largest distance of the tip from its set point, cm, in the last 2 of 3 s. `gravity` returns the true gravity at a
/// time, s.
fn deviation(finger: &ConfiguredFinger, gravity: impl Fn(f64) -> Vector3<f64>) -> f64 {
    let mut servo = Loop::in_gravity(finger, finger, &gravity(0.0), RATE);
    let (pose, links) = (servo.plant.joints(), finger.links());
    let (target, place) = (spring(pose, 3.0), links.tip(&pose));
    let mut largest: f64 = 0.0;
    for cycle in 0..3000 {
        let now = gravity(f64::from(cycle) / RATE);
        servo.plant.set_gravity(now);
        if cycle % 2 == 0 {
            servo.set_gravity = Some(now);
        }
        servo.cycle(&target);
        assert!(!servo.report.contact.touching, "gravity is no contact: {:?}", servo.report.contact);
        if cycle >= 1000 {
            largest = largest.max((links.tip(&servo.plant.joints()) - place).norm());
        }
    }
    largest
}

#[test]
fn a_hand_that_turns_once_a_second_holds_its_pose_as_one_at_rest() {
    for (scheme, increase) in SCHEMES.into_iter().zip(INCREASE) {
        let finger = finger_with(scheme);
        let at_rest = (0..8).map(|part| deviation(&finger, |_| turned(f64::from(part) / 8.0 * TAU)));
        let at_rest = at_rest.fold(0.0, f64::max);
        let turning = deviation(&finger, |time| turned(TAU * time));
        println!("{scheme:?}: {turning:.4} cm, at rest {at_rest:.4} cm");
        assert!(turning < at_rest + increase, "{scheme:?}: {turning} cm while it turns, {at_rest} cm at rest");
        // Without compensation the finger sags.
        let uncompensated = {
            let mut finger = finger.clone();
            finger.controller.gravity_compensation = false;
            deviation(&finger, |time| turned(TAU * time))
        };
        assert!(uncompensated > at_rest + 0.1, "{scheme:?}: {uncompensated} cm without compensation");
    }
}
