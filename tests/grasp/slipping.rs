//! A ball that is pulled out of the grasp by a growing load. The grasp tightens when a contact is about to slip.

use crate::rig::{GraspingHand, around_a_ball, directions};
use nalgebra::Vector3;

const MASS: f64 = 0.1;
const FRICTION: f64 = 0.6;

/// Kx, N/cm.
const STIFFNESS: f64 = 5.0;

/// Depth of the anchors below the surface of the ball, cm. Each finger presses with 2.4 N.
const SQUEEZE: f64 = 0.5;

/// Largest force of a finger, N. In this pose the tendons can produce about 4.7 N. A finger at this limit of its
/// tendons is no longer a spring, and three such fingers turn the ball out of the grasp, however large the friction is.
const MOST: f64 = 4.2;

/// What happened to a ball whose load grew.
#[derive(Debug)]
struct Outcome {
    /// Load at which the ball was lost, N.
    lost_at: Option<f64>,
    /// Largest ratio of the tangential to the normal component of a finger's force on the ball.
    ratio: f64,
    /// Distance of the ball from the place to which the load would move it if the fingertips were springs that do not
    /// slip, cm.
    off: f64,
    /// Sum of the normal forces at the end, N.
    pressed: f64,
}

/// A ball in the grasp, with a load.
struct Held {
    hand: GraspingHand,
    /// Position of the ball without load, cm.
    rest: Vector3<f64>,
    /// Direction of the load.
    along: Vector3<f64>,
}

/// Grasps and lifts a ball. The event slip occurs at two thirds of the coefficient of friction.
fn lift(seed: u64, along: Vector3<f64>, tightens: bool) -> Held {
    let mut configuration = around_a_ball(MASS, FRICTION, seed);
    for finger in &mut configuration.fingers {
        finger.events.slip_friction = Some(FRICTION * 2.0 / 3.0);
    }
    let mut hand = GraspingHand::open(configuration);
    hand.send_stiffness(STIFFNESS);
    hand.grasp(SQUEEZE);
    if tightens {
        hand.tighten_on_slip(0.2, MOST);
    }
    hand.lift(1.5, SQUEEZE);
    let rest = hand.object().position.into();
    Held { hand, rest, along }
}

impl Held {
    /// Lets the load grow by `rate`, N/s, up to `heaviest`, N. It acts in addition to the weight.
    fn load(mut self, rate: f64, heaviest: f64) -> Outcome {
        let mut outcome = Outcome { lost_at: None, ratio: 0.0, off: 0.0, pressed: 0.0 };
        let mut load = 0.0;
        while load < heaviest && outcome.lost_at.is_none() {
            load += rate * 0.01;
            let gravity = Vector3::z() * 9.81 + self.along * (load / MASS);
            self.hand.scene(|scene| scene.object().set_gravity(gravity));
            self.hand.run(10);
            self.note(&mut outcome, load);
        }
        for _ in 0..100 {
            self.hand.run(10);
            self.note(&mut outcome, load);
        }
        outcome
    }

    fn note(&self, outcome: &mut Outcome, load: f64) {
        let state = self.hand.object();
        let yielded = self.along * (load / (3.0 * STIFFNESS));
        outcome.off = (Vector3::from(state.position) - self.rest - yielded).norm();
        if outcome.off > 0.5 {
            outcome.lost_at.get_or_insert(load);
            return;
        }
        let forces = state.forces.map(Vector3::from);
        let across = forces.iter().zip(directions()).map(|(force, outward)| -force.dot(&outward));
        outcome.pressed = across.clone().sum();
        let ratios =
            forces.iter().zip(across).map(|(force, across)| (force.norm_squared() / across.powi(2) - 1.0).sqrt());
        outcome.ratio = ratios.fold(outcome.ratio, f64::max);
    }
}

/// The grasp without reflexes loses the ball at 2.6 to 3.6 N.
#[test]
fn a_ball_that_is_pulled_out_is_held_by_a_grasp_that_tightens() {
    let directions = [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.5, 0.0, 1.0], [0.0, -0.5, 1.0], [0.0, -1.0, 0.0]];
    for (seed, along) in (1..).zip(directions.map(|along| Vector3::from(along).normalize())) {
        let loose = lift(seed, along, false).load(2.0, 6.0);
        println!("{along:?}: {loose:.3?}");
        assert!(loose.lost_at.is_some_and(|load| (2.4..3.9).contains(&load)), "{along}: {loose:?}");
        for rate in [0.5, 2.0, 8.0] {
            let held = lift(seed, along, true).load(rate, 4.3);
            println!("{rate} N/s: {held:.3?}");
            assert!(held.lost_at.is_none() && held.ratio < 0.9 * FRICTION, "{along}, {rate} N/s: {held:?}");
            // A sideways load moves the ball farther after one of the fingers has reached its largest force.
            assert!(held.off < 0.25 && held.pressed < 3.5 * MOST, "{along}, {rate} N/s: {held:?}");
        }
    }
}

#[test]
fn a_grasp_that_is_strong_enough_does_not_tighten() {
    let held = lift(6, Vector3::z(), true).load(0.5, 1.0);
    assert!(held.lost_at.is_none() && held.pressed < 7.4, "{held:?}");
}
