//! Fingers that differ from the configuration of their controllers: the set of plants for which the controller is
//! designed.

use crate::cases::stiffen;
use sun2xp::model::configuration::{ConfiguredFinger, ConfiguredSimulation};

/// A difference between a finger and its configuration.
pub struct Truth {
    pub name: &'static str,
    pub differ: fn(&mut ConfiguredFinger),
}

const fn truth(name: &'static str, differ: fn(&mut ConfiguredFinger)) -> Truth {
    Truth { name, differ }
}

/// Multiplies the dry friction of the motors.
fn motor_friction(finger: &mut ConfiguredFinger, ratio: f64) {
    finger.simulation.motor_coulomb_friction.iter_mut().for_each(|friction| *friction *= ratio);
    finger.simulation.shaft_friction *= ratio;
}

/// Multiplies all masses of the links.
fn links(finger: &mut ConfiguredFinger, ratio: f64) {
    finger.simulation.masses.iter_mut().for_each(|mass| *mass *= ratio);
}

fn rotors(finger: &mut ConfiguredFinger, ratio: f64) {
    finger.simulation.rotor_inertia.iter_mut().for_each(|inertia| *inertia *= ratio);
}

const ALTERNATING: [f64; 4] = [1.0, -1.0, 1.0, -1.0];

fn arms(finger: &mut ConfiguredFinger, part: f64) {
    for (joint, row) in finger.simulation.moment_arm_ratio.iter_mut().enumerate() {
        for (tendon, ratio) in row.iter_mut().enumerate() {
            *ratio = 1.0 + part * ALTERNATING[(joint + tendon) % 4];
        }
    }
}

fn gauges(finger: &mut ConfiguredFinger, part: f64) {
    finger.simulation.gauge_gain_ratio = ALTERNATING.map(|sign| 1.0 + part * sign);
}

/// Gives the finger the properties of the simulated hand with this name.
fn named(finger: &mut ConfiguredFinger, name: &str) {
    let (start_degrees, seed) = (finger.simulation.start_degrees, finger.simulation.seed);
    let named = ConfiguredSimulation::named(name).expect("a named hand");
    finger.simulation = ConfiguredSimulation { start_degrees, seed, ..named };
}

pub static TRUTHS: [Truth; 37] = [
    truth("hand: nominal", |_| {}),
    truth("hand: worn", |finger| named(finger, "worn")),
    truth("hand: sheathed", |finger| named(finger, "sheathed")),
    truth("hand: cheap", |finger| named(finger, "cheap")),
    truth("everything slightly, 10 % conduit, 2 % pulleys", |finger| {
        links(finger, 1.2);
        rotors(finger, 1.2);
        motor_friction(finger, 1.5);
        finger.simulation.joint_coulomb_friction = [0.75e-3; 3];
        finger.simulation.stiction_ratio = 1.3;
        finger.simulation.conduit_friction = 0.1;
        finger.simulation.pulley_friction = 0.02;
        finger.simulation.hardening = 0.15;
        finger.simulation.gauge_offset = [0.1, -0.1, 0.05, -0.05];
        finger.simulation.gauge_bandwidth = 200.0;
        finger.simulation.motor_constant_ratio = [1.05, 0.95, 1.05, 0.95];
        stiffen(finger, &[0.95, 1.05, 0.95, 1.0]);
        arms(finger, 0.01);
        gauges(finger, 0.01);
    }),
    truth("links x0.5", |finger| links(finger, 0.5)),
    truth("links x2", |finger| links(finger, 2.0)),
    truth("rotor inertia x0.5", |finger| rotors(finger, 0.5)),
    truth("rotor inertia x2.5", |finger| rotors(finger, 2.5)),
    truth("motor constants x0.8", |finger| finger.simulation.motor_constant_ratio = [0.8; 4]),
    truth("motor constants x1.2", |finger| finger.simulation.motor_constant_ratio = [1.2; 4]),
    truth("motor friction x0", |finger| motor_friction(finger, 0.0)),
    truth("motor friction x0.3", |finger| motor_friction(finger, 0.3)),
    truth("motor friction x3", |finger| motor_friction(finger, 3.0)),
    truth("joint friction x3", |finger| finger.simulation.joint_coulomb_friction = [1.5e-3; 3]),
    truth("stiction x2", |finger| finger.simulation.stiction_ratio = 2.0),
    truth("k x0.7", |finger| stiffen(finger, &[0.7; 4])),
    truth("k x1.3", |finger| stiffen(finger, &[1.3; 4])),
    truth("hardening, k/2 to 1.5 k", |finger| finger.simulation.hardening = 0.5),
    truth("conduit friction 10 %", |finger| finger.simulation.conduit_friction = 0.1),
    truth("conduit friction 20 %", |finger| finger.simulation.conduit_friction = 0.2),
    truth("pulley friction 1 %", |finger| finger.simulation.pulley_friction = 0.01),
    truth("pulley friction 2 %", |finger| finger.simulation.pulley_friction = 0.02),
    truth("pulley friction 5 %", |finger| finger.simulation.pulley_friction = 0.05),
    truth("pulley friction 10 %", |finger| finger.simulation.pulley_friction = 0.1),
    truth("one more cycle of delay", |finger| finger.simulation.command_delay_ms = 1.0),
    truth("amplifier lag 1 ms", |finger| finger.simulation.amplifier_lag_ms = 1.0),
    truth("amplifier lag 2 ms", |finger| finger.simulation.amplifier_lag_ms = 2.0),
    truth("gauge low-pass 100 Hz", |finger| finger.simulation.gauge_bandwidth = 100.0),
    truth("gauge noise x3", |finger| finger.simulation.gauge_noise = 0.09),
    truth("gauges +5 %", |finger| finger.simulation.gauge_gain_ratio = [1.05; 4]),
    truth("gauges +-5 %", |finger| gauges(finger, 0.05)),
    truth("moment arms +-5 %", |finger| arms(finger, 0.05)),
    truth("torque ripple 5 %", |finger| finger.simulation.torque_ripple = 0.05),
    truth("creep 10 %", |finger| finger.simulation.creep = 0.1),
    truth("held mass 0.1 kg", |finger| finger.simulation.held_mass = 0.1),
    truth("held mass 0.3 kg", |finger| finger.simulation.held_mass = 0.3),
];
