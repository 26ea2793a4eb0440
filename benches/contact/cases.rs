//! The fingers that are measured, and what their controllers assume about them.

use nalgebra::Vector3;
use sun2xp::model::configuration::{ConfiguredContact, ConfiguredFinger, NamedHand, Scheme};

/// A simulated finger and its controller's configuration.
pub struct Case {
    pub name: &'static str,
    /// Simulated time in which false alarms are counted, s.
    pub seconds: f64,
    /// Gravity in the finger's frame, m/s^2.
    pub gravity: Vector3<f64>,
    /// Changes the simulated finger and the configuration of its controller.
    make: fn(&mut ConfiguredFinger, &mut ConfiguredFinger),
}

/// Gravity across the finger, so that it loads joints 1 and 2.
const ACROSS: Vector3<f64> = Vector3::new(0.0, 9.81, 0.0);
const NONE: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);
const HOUR: f64 = 3600.0;
const TEN_MINUTES: f64 = 600.0;

/// The cases of docs/contact.md.
pub const CASES: [Case; 15] = [
    Case { name: "nominal", seconds: HOUR, gravity: NONE, make: |_, _| {} },
    Case { name: "nominal, gravity", seconds: HOUR, gravity: ACROSS, make: |_, _| {} },
    Case {
        name: "nominal, figure 9",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |_, belief| scheme(belief, Scheme::Figure9),
    },
    Case {
        name: "nominal, figure 10",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |_, belief| scheme(belief, Scheme::Figure10),
    },
    Case {
        name: "nominal, figure 11",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |_, belief| scheme(belief, Scheme::Figure11),
    },
    Case { name: "masses 30 % higher", seconds: TEN_MINUTES, gravity: NONE, make: |finger, _| masses(finger, 1.3) },
    Case { name: "masses 30 % lower", seconds: TEN_MINUTES, gravity: NONE, make: |finger, _| masses(finger, 0.7) },
    Case {
        name: "masses 30 % higher, gravity",
        seconds: TEN_MINUTES,
        gravity: ACROSS,
        make: |finger, _| masses(finger, 1.3),
    },
    Case {
        name: "masses 30 % lower, gravity",
        seconds: TEN_MINUTES,
        gravity: ACROSS,
        make: |finger, _| masses(finger, 0.7),
    },
    Case { name: "worn", seconds: TEN_MINUTES, gravity: NONE, make: |finger, _| named(finger, NamedHand::Worn) },
    Case {
        name: "sheathed",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |finger, _| named(finger, NamedHand::Sheathed),
    },
    Case { name: "cheap", seconds: TEN_MINUTES, gravity: NONE, make: |finger, _| named(finger, NamedHand::Cheap) },
    Case {
        name: "worn, calibrated",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |finger, belief| calibrated(finger, belief, NamedHand::Worn),
    },
    Case {
        name: "sheathed, calibrated",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |finger, belief| calibrated(finger, belief, NamedHand::Sheathed),
    },
    Case {
        name: "cheap, calibrated",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |finger, belief| calibrated(finger, belief, NamedHand::Cheap),
    },
];

impl Case {
    /// Returns the simulated finger and the configuration of its controller.
    pub fn finger(&self, contact: &ConfiguredContact, seed: u64) -> (ConfiguredFinger, ConfiguredFinger) {
        let mut finger = ConfiguredFinger::default();
        let mut belief = ConfiguredFinger { contact: contact.clone(), ..ConfiguredFinger::default() };
        (self.make)(&mut finger, &mut belief);
        finger.simulation.seed = seed;
        (finger, belief)
    }
}

fn scheme(belief: &mut ConfiguredFinger, scheme: Scheme) {
    belief.controller.scheme = Some(scheme);
}

fn masses(finger: &mut ConfiguredFinger, ratio: f64) {
    finger.simulation.masses = finger.simulation.masses.map(|mass| mass * ratio);
}

fn named(finger: &mut ConfiguredFinger, hand: NamedHand) {
    finger.simulation = hand.simulation();
}

/// Configures the values that a calibration without errors would store.
fn calibrated(finger: &mut ConfiguredFinger, belief: &mut ConfiguredFinger, hand: NamedHand) {
    named(finger, hand);
    let simulation = &finger.simulation;
    for tendon in 0..4 {
        let scale = finger.gauge.newton_per_count[tendon];
        belief.gauge.newton_per_count[tendon] = scale / simulation.gauge_gain_ratio[tendon];
        belief.gauge.zero[tendon] = finger.gauge.zero[tendon] + simulation.gauge_offset[tendon] / scale;
        for joint in 0..3 {
            belief.geometry.r[joint][tendon] *= simulation.moment_arm_ratio[joint][tendon];
        }
    }
    belief.tendon.stiffness = simulation.tendon_stiffness;
    belief.friction.pulley = [simulation.pulley_friction; 4];
    belief.friction.conduit = [simulation.shaft_friction + simulation.conduit_friction; 4];
    // The simulation has these values in N m, and the configuration of the controller has them in N cm.
    belief.friction.motor_coulomb = simulation.motor_coulomb_friction.map(|friction| friction * 100.0);
    belief.friction.joint_coulomb = simulation.joint_coulomb_friction.map(|friction| friction * 100.0);
}
