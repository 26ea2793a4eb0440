//! Hands that differ from their configuration, as real hands do.

use sun2xp::model::configuration::{ConfiguredFinger, ConfiguredSimulation, NamedHand};

/// A hand without a fault.
pub struct Truth {
    pub what: &'static str,
    /// Changes what is true of the simulated finger, and not what its controller assumes. Only the hand "motor friction
    /// believed to be zero" does the opposite.
    pub make: fn(&mut ConfiguredFinger),
}

/// Errors of 5 % of the moment arms, with two patterns of signs.
const ARMS: [[f64; 4]; 3] = [[1.05, 0.95, 1.05, 0.95], [0.95, 1.05, 1.05, 0.95], [1.05, 1.05, 0.95, 0.95]];
const OTHER_ARMS: [[f64; 4]; 3] = [[0.95, 0.95, 1.05, 1.05], [1.05, 0.95, 1.05, 0.95], [0.95, 1.05, 0.95, 1.05]];

/// A hand whose tendons rub in their conduits. The tests inject faults into this hand.
pub const RUBBING: Truth = Truth { what: "conduit 20 %", make: |finger| finger.simulation.conduit_friction = 0.2 };

pub fn truths() -> Vec<Truth> {
    let truth = |what, make| Truth { what, make };
    vec![
        truth("as configured", |_| {}),
        truth("conduit 10 %", |finger| finger.simulation.conduit_friction = 0.1),
        RUBBING,
        truth("pulley 5 %", |finger| finger.simulation.pulley_friction = 0.05),
        truth("k x0.7", |finger| finger.simulation.tendon_stiffness = [210.0; 4]),
        truth("k x1.3", |finger| finger.simulation.tendon_stiffness = [390.0; 4]),
        truth("hardening, k/2 to 1.5 k", |finger| finger.simulation.hardening = 0.5),
        truth("moment arms +-5 %", |finger| finger.simulation.moment_arm_ratio = ARMS),
        truth("moment arms +-5 %, other signs", |finger| finger.simulation.moment_arm_ratio = OTHER_ARMS),
        truth("gauges +5 %", |finger| finger.simulation.gauge_gain_ratio = [1.05; 4]),
        truth("gauges +-5 %", |finger| finger.simulation.gauge_gain_ratio = [1.05, 0.95, 1.05, 0.95]),
        truth("motor friction x0", |finger| motor_friction(finger, 0.0)),
        truth("motor friction x0.3", |finger| motor_friction(finger, 0.3)),
        truth("motor friction x3", |finger| motor_friction(finger, 3.0)),
        truth("motor friction believed to be zero", |finger| {
            (finger.friction.motor_coulomb, finger.friction.conduit) = ([0.0; 4], [0.0; 4]);
        }),
        truth("stiction x2", |finger| finger.simulation.stiction_ratio = 2.0),
        truth("everything slightly off, conduit 10 %, pulley 2 %", |finger| {
            finger.simulation = ConfiguredSimulation {
                conduit_friction: 0.1,
                pulley_friction: 0.02,
                stiction_ratio: 1.3,
                hardening: 0.2,
                tendon_stiffness: [270.0, 330.0, 280.0, 310.0],
                moment_arm_ratio: ARMS.map(|row| row.map(|ratio| 1.0 + 0.4 * (ratio - 1.0))),
                gauge_gain_ratio: [1.02, 0.98, 0.98, 1.02],
                ..ConfiguredSimulation::default()
            }
        }),
        truth("worn", |finger| finger.simulation = NamedHand::Worn.simulation()),
        truth("sheathed", |finger| finger.simulation = NamedHand::Sheathed.simulation()),
        truth("cheap", |finger| finger.simulation = NamedHand::Cheap.simulation()),
    ]
}

fn motor_friction(finger: &mut ConfiguredFinger, factor: f64) {
    let simulation = &mut finger.simulation;
    simulation.motor_coulomb_friction = simulation.motor_coulomb_friction.map(|friction| friction * factor);
    simulation.shaft_friction *= factor;
}
