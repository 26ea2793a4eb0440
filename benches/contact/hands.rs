//! The fingers that are measured, and what their controllers assume about them.

use nalgebra::Vector3;
use sun2xp::model::configuration::{ConfiguredContact, ConfiguredFinger, NamedHand, Scheme};

/// A simulated finger and its controller's configuration.
pub struct Hand {
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

/// The rows of the tables of docs/contact.md.
pub const HANDS: [Hand; 15] = [
    Hand { name: "nominal", seconds: HOUR, gravity: NONE, make: |_, _| {} },
    Hand { name: "nominal, gravity", seconds: HOUR, gravity: ACROSS, make: |_, _| {} },
    Hand {
        name: "nominal, figure 9",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |_, own| scheme(own, Scheme::Figure9),
    },
    Hand {
        name: "nominal, figure 10",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |_, own| scheme(own, Scheme::Figure10),
    },
    Hand {
        name: "nominal, figure 11",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |_, own| scheme(own, Scheme::Figure11),
    },
    Hand { name: "masses 30 % higher", seconds: TEN_MINUTES, gravity: NONE, make: |finger, _| masses(finger, 1.3) },
    Hand { name: "masses 30 % lower", seconds: TEN_MINUTES, gravity: NONE, make: |finger, _| masses(finger, 0.7) },
    Hand {
        name: "masses 30 % higher, gravity",
        seconds: TEN_MINUTES,
        gravity: ACROSS,
        make: |finger, _| masses(finger, 1.3),
    },
    Hand {
        name: "masses 30 % lower, gravity",
        seconds: TEN_MINUTES,
        gravity: ACROSS,
        make: |finger, _| masses(finger, 0.7),
    },
    Hand { name: "worn", seconds: TEN_MINUTES, gravity: NONE, make: |finger, _| named(finger, NamedHand::Worn) },
    Hand {
        name: "sheathed",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |finger, _| named(finger, NamedHand::Sheathed),
    },
    Hand { name: "cheap", seconds: TEN_MINUTES, gravity: NONE, make: |finger, _| named(finger, NamedHand::Cheap) },
    Hand {
        name: "worn, calibrated",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |finger, own| calibrated(finger, own, NamedHand::Worn),
    },
    Hand {
        name: "sheathed, calibrated",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |finger, own| calibrated(finger, own, NamedHand::Sheathed),
    },
    Hand {
        name: "cheap, calibrated",
        seconds: TEN_MINUTES,
        gravity: NONE,
        make: |finger, own| calibrated(finger, own, NamedHand::Cheap),
    },
];

impl Hand {
    /// Returns the simulated finger and the configuration of its controller.
    pub fn finger(&self, contact: &ConfiguredContact, seed: u64) -> (ConfiguredFinger, ConfiguredFinger) {
        let mut finger = ConfiguredFinger::default();
        let mut own = ConfiguredFinger { contact: contact.clone(), ..ConfiguredFinger::default() };
        (self.make)(&mut finger, &mut own);
        finger.simulation.seed = seed;
        (finger, own)
    }
}

fn scheme(own: &mut ConfiguredFinger, scheme: Scheme) {
    own.controller.scheme = Some(scheme);
}

fn masses(finger: &mut ConfiguredFinger, ratio: f64) {
    finger.simulation.masses = finger.simulation.masses.map(|mass| mass * ratio);
}

fn named(finger: &mut ConfiguredFinger, hand: NamedHand) {
    finger.simulation = hand.simulation();
}

/// Configures the values that a calibration without errors would store.
fn calibrated(finger: &mut ConfiguredFinger, own: &mut ConfiguredFinger, hand: NamedHand) {
    named(finger, hand);
    let simulation = &finger.simulation;
    for tendon in 0..4 {
        let scale = finger.gauge.newton_per_count[tendon];
        own.gauge.newton_per_count[tendon] = scale / simulation.gauge_gain_ratio[tendon];
        own.gauge.zero[tendon] = finger.gauge.zero[tendon] + simulation.gauge_offset[tendon] / scale;
        for joint in 0..3 {
            own.geometry.r[joint][tendon] *= simulation.moment_arm_ratio[joint][tendon];
        }
    }
    own.tendon.stiffness = simulation.tendon_stiffness;
    own.friction.pulley = [simulation.pulley_friction; 4];
    own.friction.conduit = [simulation.shaft_friction + simulation.conduit_friction; 4];
    // The simulation has these values in N m, and the configuration of the controller has them in N cm.
    own.friction.motor_coulomb = simulation.motor_coulomb_friction.map(|friction| friction * 100.0);
    own.friction.joint_coulomb = simulation.joint_coulomb_friction.map(|friction| friction * 100.0);
}
