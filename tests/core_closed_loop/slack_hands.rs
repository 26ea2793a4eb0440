//! Taking up slack hardly moves the joints, on hands with little and with much friction.

use crate::rig::{Loop, poses_of};
use nalgebra::{Vector3, Vector4};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use sun2xp::control::Activity;
use sun2xp::model::configuration::{ConfiguredFinger, NamedHand};

/// Longest time until the tendons are under tension, s.
const LONGEST: f64 = 10.0;

/// A simulated hand, and the motion that is permitted on it.
struct Hand {
    name: &'static str,
    /// The named hand that the other values change.
    hand: NamedHand,
    /// True Coulomb friction of motors, motor shafts and joints, divided by that of the named hand.
    coulomb: f64,
    /// True viscous friction of motors and joints, divided by that of the named hand.
    viscous: f64,
    /// Gauge noise, divided by that of the named hand.
    noise: f64,
    /// Largest slack of a tendon, cm.
    slack: f64,
    /// Ratio of static to Coulomb friction, divided by that of the named hand.
    stiction: f64,
    /// Friction of the conduits and of the pulleys, fractions of the tension, in addition to that of the named hand.
    conduit: f64,
    pulley: f64,
    /// Gravity in the finger's frame, m/s^2.
    gravity: [f64; 3],
    /// Whether the controller compensates gravity.
    compensates: bool,
    /// Rate of the controller, Hz.
    rate: f64,
    /// Largest permitted motion of a joint from the start to the end, rad.
    limit: f64,
}

/// The default hand with tendons of up to 20 mm slack.
const DEFAULT: Hand = Hand {
    name: "friction x1",
    hand: NamedHand::Nominal,
    coulomb: 1.0,
    viscous: 1.0,
    noise: 1.0,
    slack: 2.0,
    stiction: 1.0,
    conduit: 0.0,
    pulley: 0.0,
    gravity: [0.0; 3],
    compensates: true,
    rate: 1000.0,
    limit: 0.01,
};

const HANDS: [Hand; 23] = [
    DEFAULT,
    Hand { name: "friction x3", coulomb: 3.0, viscous: 3.0, ..DEFAULT },
    Hand { name: "friction x0.3", coulomb: 0.3, viscous: 0.3, ..DEFAULT },
    Hand { name: "friction x0.1", coulomb: 0.1, viscous: 0.1, ..DEFAULT },
    Hand { name: "no Coulomb friction", coulomb: 0.0, limit: 0.03, ..DEFAULT },
    Hand { name: "friction x0.1, 2 mm", coulomb: 0.1, viscous: 0.1, slack: 0.2, ..DEFAULT },
    Hand { name: "no friction, 2 mm", coulomb: 0.0, viscous: 0.0, slack: 0.2, limit: 0.15, ..DEFAULT },
    Hand { name: "gauge noise x3", noise: 3.0, ..DEFAULT },
    Hand { name: "stiction x2", stiction: 2.0, ..DEFAULT },
    Hand { name: "conduit 20 %", conduit: 0.2, ..DEFAULT },
    Hand { name: "pulley 10 %", pulley: 0.1, ..DEFAULT },
    Hand { name: "both", conduit: 0.2, pulley: 0.1, ..DEFAULT },
    Hand { name: "500 Hz", rate: 500.0, ..DEFAULT },
    Hand { name: "2000 Hz", rate: 2000.0, ..DEFAULT },
    Hand { name: "worn", hand: NamedHand::Worn, ..DEFAULT },
    Hand { name: "worn, 2 mm", hand: NamedHand::Worn, slack: 0.2, ..DEFAULT },
    Hand { name: "sheathed", hand: NamedHand::Sheathed, ..DEFAULT },
    Hand { name: "sheathed, 2 mm", hand: NamedHand::Sheathed, slack: 0.2, ..DEFAULT },
    Hand { name: "cheap", hand: NamedHand::Cheap, limit: 0.015, ..DEFAULT },
    Hand { name: "cheap, 2 mm", hand: NamedHand::Cheap, slack: 0.2, limit: 0.015, ..DEFAULT },
    Hand { name: "hanging", gravity: [0.0, 0.0, 9.81], slack: 1.0, ..DEFAULT },
    Hand { name: "hanging, not compensated", gravity: [0.0, 0.0, 9.81], compensates: false, slack: 1.0, ..DEFAULT },
    Hand { name: "falling", gravity: [6.0, 2.0, -7.0], slack: 1.0, ..DEFAULT },
];

/// The largest values over all seeds and poses of a hand.
#[derive(Default)]
struct Found {
    /// Motion of a joint from the start to the end, rad.
    end: f64,
    /// Motion of a joint from the start to any time, rad.
    ever: f64,
    /// Time until the tendons are under tension, s.
    seconds: f64,
    /// Difference of a true tension from the pretension, N.
    error: f64,
}

fn finger_of(hand: &Hand, pose: &Vector3<f64>, seed: u64) -> ConfiguredFinger {
    let mut finger = ConfiguredFinger { simulation: hand.hand.simulation(), ..ConfiguredFinger::default() };
    let simulation = &mut finger.simulation;
    simulation.motor_coulomb_friction = simulation.motor_coulomb_friction.map(|value| value * hand.coulomb);
    simulation.joint_coulomb_friction = simulation.joint_coulomb_friction.map(|value| value * hand.coulomb);
    simulation.motor_viscous_friction = simulation.motor_viscous_friction.map(|value| value * hand.viscous);
    simulation.joint_viscous_friction = simulation.joint_viscous_friction.map(|value| value * hand.viscous);
    simulation.shaft_friction *= hand.coulomb;
    simulation.stiction_ratio *= hand.stiction;
    simulation.conduit_friction += hand.conduit;
    simulation.pulley_friction += hand.pulley;
    simulation.gauge_noise *= hand.noise;
    simulation.seed = seed;
    simulation.start_degrees = pose.map(f64::to_degrees).into();
    finger
}

fn take_up(hand: &Hand, pose: &Vector3<f64>, seed: u64, found: &mut Found) {
    let finger = finger_of(hand, pose, seed);
    let mut belief = ConfiguredFinger::default();
    belief.controller.gravity_compensation = hand.compensates;
    let mut servo = Loop::in_gravity(&finger, &belief, &hand.gravity.into(), hand.rate);
    let mut random = Pcg64::seed_from_u64(seed);
    for motor in 0..4 {
        let slack = 0.03 + hand.slack * f64::from(random.next_u32()) / 4294967296.0;
        servo.plant.turn_motor(motor, -slack / finger.geometry.motor_radius[motor]);
    }
    if hand.gravity != [0.0; 3] {
        // The finger falls until it hangs, lies at its stops, or is held by a tendon.
        servo.run(3.0, &Activity::Turn(Vector4::zeros()));
    }
    if finger.simulation.gauge_bandwidth > 0.0 {
        // The gauges still show the tensions that the tendons had before the motors were turned.
        servo.run(0.05, &Activity::Turn(Vector4::zeros()));
    }
    let mut servo = servo.restart();
    let start = servo.plant.joints();
    let (mut tight, mut cycles) = (0.0, 0.0);
    while tight < 0.05 * hand.rate {
        servo.cycle(&Activity::TakeUpSlack);
        found.ever = found.ever.max((servo.plant.joints() - start).amax());
        tight = if servo.report.under_tension { tight + 1.0 } else { 0.0 };
        cycles += 1.0;
        assert!(cycles < LONGEST * hand.rate, "{}, seed {seed}: {}", hand.name, servo.plant.tensions());
    }
    let pretension: Vector4<f64> = belief.tendons().expect("regular").pretension(belief.tendon.minimum);
    found.seconds = found.seconds.max(cycles / hand.rate);
    found.end = found.end.max((servo.plant.joints() - start).amax());
    found.error = found.error.max((servo.plant.tensions() - pretension).amax());
}

/// The environment variable `SEEDS` sets the number of seeds, by default 1. Each seed has 12 poses and slacks. If the
/// environment variable `HAND` is set, only hands whose names contain its value are tested.
#[test]
fn the_joints_stay_on_every_hand() {
    let seeds = std::env::var("SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(1);
    let only = std::env::var("HAND").unwrap_or_default();
    assert!(HANDS.iter().any(|hand| hand.name.contains(&only)), "no hand has {only:?} in its name");
    for hand in HANDS.iter().filter(|hand| hand.name.contains(&only)) {
        let mut found = Found::default();
        for seed in 1..=seeds {
            for (index, pose) in poses_of(seed).iter().take(12).enumerate() {
                take_up(hand, pose, seed * 100 + index as u64, &mut found);
            }
        }
        let Found { end, ever, seconds, error } = found;
        println!("{:20} end {end:.4} rad, ever {ever:.4} rad, {seconds:.2} s, {error:.2} N", hand.name);
        assert!(end <= hand.limit, "{}: a joint moves by {end} rad", hand.name);
    }
}
