//! The parameters of the named simulated hands. They model the tendons and sensors of real hands.
//! `docs/real-tendons.md` lists the published figures on which the values are based.

use super::named_hand::NamedHand;
use super::simulation::ConfiguredSimulation;

impl ConfiguredSimulation {
    /// Returns the parameters of a finger of the hand with this name: `"nominal"`, `"worn"`, `"sheathed"` or
    /// `"cheap"`. Returns None for any other name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        NamedHand::ALL.into_iter().find(|hand| hand.name() == name).map(NamedHand::simulation)
    }
}

impl NamedHand {
    /// Returns the parameters of a finger of this hand.
    #[must_use]
    pub fn simulation(self) -> ConfiguredSimulation {
        match self {
            Self::Nominal => ConfiguredSimulation::default(),
            Self::Worn => worn(),
            Self::Sheathed => sheathed(),
            Self::Cheap => cheap(),
        }
    }
}

fn worn() -> ConfiguredSimulation {
    ConfiguredSimulation {
        hand: NamedHand::Worn,
        joint_viscous_friction: [1e-3; 3],
        joint_coulomb_friction: [1e-3; 3],
        motor_viscous_friction: [4e-6; 4],
        motor_coulomb_friction: [1.4e-3; 4],
        shaft_friction: 0.1,
        conduit_friction: 0.05,
        pulley_friction: 0.02,
        stiction_ratio: 1.5,
        // The mean is 270 N/cm. Each tendon differs from it by up to 6 %.
        tendon_stiffness: [285.0, 255.0, 262.0, 278.0],
        creep: 0.05,
        creep_time: 60.0,
        // Tendons 1 and 4 do not reach joint 2, so their ratios in the last row do not matter.
        moment_arm_ratio: [[1.02, 0.98, 1.01, 0.99], [0.98, 1.01, 0.99, 1.02], [1.0, 0.99, 1.02, 1.0]],
        gauge_gain_ratio: [1.02, 0.98, 0.99, 1.01],
        gauge_offset: [0.3, 0.1, 0.2, 0.0],
        ..ConfiguredSimulation::default()
    }
}

fn sheathed() -> ConfiguredSimulation {
    ConfiguredSimulation {
        hand: NamedHand::Sheathed,
        conduit_friction: 0.15,
        pulley_friction: 0.03,
        stiction_ratio: 1.5,
        hardening: 0.2,
        creep: 0.1,
        creep_time: 60.0,
        ..ConfiguredSimulation::default()
    }
}

fn cheap() -> ConfiguredSimulation {
    ConfiguredSimulation {
        hand: NamedHand::Cheap,
        rotor_inertia: [9e-7; 4],
        motor_constant_ratio: [1.1, 0.9, 1.05, 0.95],
        torque_ripple: 0.05,
        amplifier_lag_ms: 0.3,
        command_delay_ms: 0.1,
        gauge_gain_ratio: [1.03, 0.97, 1.02, 0.98],
        gauge_offset: [0.4, 0.2, 0.3, 0.1],
        gauge_bandwidth: 200.0,
        gauge_noise: 0.1,
        ..ConfiguredSimulation::default()
    }
}
