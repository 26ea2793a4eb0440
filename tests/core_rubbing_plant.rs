//! Tests the physics of a simulated finger that differs from the default finger: friction in conduits and on pulleys,
//! stiction, hardening, creep, wrong moment arms, gauges, torque ripple, and a held mass.

#[path = "common/energy.rs"]
mod energy;

use energy::{assert_gains_no_energy, steps};
use nalgebra::{Vector3, Vector4};
use proptest::prelude::*;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant, Sensors};

/// Returns a finger with these changes, released from its brake.
fn plant(change: impl Fn(&mut ConfiguredFinger)) -> Plant {
    let mut plant = Plant::new(&configured(change), Vector3::zeros()).expect("a usable finger");
    plant.release_brake();
    plant
}

fn configured(change: impl Fn(&mut ConfiguredFinger)) -> ConfiguredFinger {
    let mut finger = ConfiguredFinger::default();
    change(&mut finger);
    finger.check().expect("a usable finger");
    finger
}

/// Steps for `seconds` with motors that pull with these tensions, N.
fn pull(plant: &mut Plant, tensions: &Vector4<f64>, seconds: f64) {
    for _ in 0..(seconds / PLANT_STEP_SECONDS) as usize {
        plant.step((tensions * 0.0475 * 0.01).into());
    }
}

/// Winds every tendon in, such that the tensions rise without a joint torque.
fn wind(plant: &mut Plant) {
    for motor in 0..4 {
        plant.turn_motor(motor, 0.1 * pretension()[motor]);
    }
}

fn pretension() -> Vector4<f64> {
    ConfiguredFinger::default().tendons().expect("the default tendons").pretension(5.0)
}

#[test]
fn a_rubbing_finger_rests_without_any_motion() {
    let mut plant = plant(|finger| {
        finger.simulation.conduit_friction = 0.2;
        finger.simulation.pulley_friction = 0.1;
        finger.simulation.stiction_ratio = 2.0;
        finger.simulation.hardening = 0.5;
    });
    pull(&mut plant, &(pretension() * 1.5), 2.0);
    let (before, tensions) = (plant.joints(), plant.tensions());
    pull(&mut plant, &(pretension() * 1.5), 2.0);
    assert!((plant.joints() - before).amax() < 1e-12, "no chatter and no creep");
    assert!((plant.tensions() - tensions).amax() < 1e-9);
}

/// The joint does not notice a change of the tension at the gauge that stays within the pulleys' friction.
#[test]
fn pulleys_hide_a_change_of_the_tension_from_the_joint() {
    let tension_changes = |pulley_friction: f64| {
        let mut plant = plant(|finger| {
            finger.simulation.pulley_friction = pulley_friction;
            finger.simulation.shaft_friction = 0.0;
            finger.simulation.motor_coulomb_friction = [0.0; 4];
            finger.simulation.motor_viscous_friction = [1e-4; 4];
        });
        plant.hold(plant.joints());
        pull(&mut plant, &(pretension() * 1.5), 1.0);
        let (gauge, joint) = (plant.tensions(), plant.joint_tensions());
        // The tensions have risen, so each pulley already hides as much of a rise as its friction can. Therefore only a
        // fall can be hidden entirely.
        pull(&mut plant, &(pretension() * 1.5 * 0.95), 1.0);
        ((plant.tensions() - gauge).amax(), (plant.joint_tensions() - joint).amax())
    };
    let (gauge, joint) = tension_changes(0.1);
    assert!(gauge > 0.3 && joint < 0.01 * gauge, "{gauge} N at the gauge, {joint} N at the joint");
    let (gauge, joint) = tension_changes(0.0);
    assert!(gauge > 0.3 && (joint - gauge).abs() < 1e-9, "{gauge} N at the gauge, {joint} N at the joint");
}

#[test]
fn stiction_holds_more_than_sliding_friction() {
    let moved = |ratio: f64, newton: f64| {
        let mut plant = plant(|finger| {
            finger.simulation.stiction_ratio = ratio;
            finger.simulation.joint_coulomb_friction = [0.01; 3];
        });
        pull(&mut plant, &pretension(), 0.2);
        let before = plant.joints();
        plant.set_external_force(Vector3::new(newton, 0.0, 0.0));
        pull(&mut plant, &pretension(), 0.2);
        (plant.joints() - before)[0].abs()
    };
    // At the default start the tip is some 8 cm from the axis of joint 0: 0.18 N give 0.014 N m.
    assert!(moved(1.0, 0.18) > 10.0 * moved(2.0, 0.18), "{} {}", moved(1.0, 0.18), moved(2.0, 0.18));
    assert!(moved(2.0, 0.4) > 10.0 * moved(2.0, 0.18));
}

#[test]
fn creep_lets_the_tension_of_locked_motors_fall_by_its_share() {
    let finger = configured(|finger| {
        finger.simulation.creep = 0.1;
        finger.simulation.creep_time = 0.5;
    });
    // The brake is closed, and the start is in equilibrium, so further winding adds stretch that creeps.
    let mut plant = Plant::new(&finger, Vector3::zeros()).expect("a usable finger");
    plant.hold(plant.joints());
    let before = plant.tensions();
    wind(&mut plant);
    let wound = plant.tensions() - before;
    pull(&mut plant, &Vector4::zeros(), 5.0);
    let left = plant.tensions() - before;
    for tendon in 0..4 {
        // The stretch x falls to x / 1.1, because the creep is a tenth of the stretch that is left.
        assert!((left[tendon] / wound[tendon] - 1.0 / 1.1).abs() < 0.01, "{left} {wound}");
    }
}

#[test]
fn gauges_show_their_gain_their_offset_and_their_delay() {
    let finger = configured(|finger| {
        finger.simulation.gauge_noise = 0.0;
        finger.simulation.gauge_gain_ratio = [1.05, 0.95, 1.0, 1.0];
        finger.simulation.gauge_offset = [0.0, 0.0, 0.5, 0.0];
        finger.simulation.gauge_bandwidth = 10.0;
    });
    let mut plant = Plant::new(&finger, Vector3::zeros()).expect("a usable finger");
    plant.hold(plant.joints());
    let mut sensors = Sensors::new(&finger);
    let mut shown = |plant: &Plant| {
        let (_, counts) = sensors.read(plant);
        Vector4::from_fn(|gauge, _| {
            (f64::from(counts[gauge]) - finger.gauge.zero[gauge]) * finger.gauge.newton_per_count[gauge]
        })
    };
    let expected = |true_tensions: Vector4<f64>| {
        true_tensions.component_mul(&Vector4::new(1.05, 0.95, 1.0, 1.0)) + Vector4::new(0.0, 0.0, 0.5, 0.0)
    };
    let newton_per_count = finger.gauge.newton_per_count[0];
    assert!((shown(&plant) - expected(plant.tensions())).amax() <= 0.51 * newton_per_count);
    let before = plant.tensions();
    wind(&mut plant);
    // One time constant of 10 Hz is 15.9 ms.
    pull(&mut plant, &Vector4::zeros(), 0.0159);
    let after = plant.tensions();
    let filtered = before + (after - before) * (1.0 - (-1.0f64).exp());
    assert!((shown(&plant) - expected(filtered)).amax() < 0.05 * (after - before).amax());
}

#[test]
fn the_ratio_of_the_moment_arms_scales_r_and_gives_no_joint_torque() {
    let rate = |ratio: f64| {
        let plant = &mut plant(|finger| {
            finger.simulation.moment_arm_ratio[0] = [ratio; 4];
            finger.simulation.joint_coulomb_friction = [0.0; 3];
        });
        plant.set_external_force(Vector3::new(0.5, 0.0, 0.0));
        // The brake is off, so the motors yield too. One millisecond is too short for a noticeable effect.
        pull(plant, &pretension(), 0.001);
        plant.joint_rates()[0]
    };
    // In the first steps only the inertia counts. The pretension gives no joint torque, whatever the ratio.
    assert!((rate(1.05) / rate(1.0) - 1.0).abs() < 0.01);
    let finger = configured(|finger| finger.simulation.moment_arm_ratio[0] = [1.05; 4]);
    let r = finger.true_tendons().expect("usable tendons").r;
    assert!((r.row(0) / 1.05 - finger.r().row(0)).amax() < 1e-12 && r.row(1) == finger.r().row(1));
}

#[test]
fn a_held_mass_slows_the_tip() {
    let rate = |held_mass: f64| {
        let mut plant = plant(|finger| finger.simulation.held_mass = held_mass);
        plant.set_external_force(Vector3::new(3.0, 0.0, 0.0));
        pull(&mut plant, &pretension(), 0.005);
        plant.joint_rates()[0].abs()
    };
    assert!(rate(0.3) < 0.25 * rate(0.0), "{} {}", rate(0.3), rate(0.0));
}

#[test]
fn torque_ripple_changes_the_tension_with_the_angle_of_the_motor() {
    let tensions = |torque_ripple: f64| {
        let mut plant = plant(|finger| {
            finger.simulation.torque_ripple = torque_ripple;
            finger.simulation.motor_coulomb_friction = [0.0; 4];
            finger.simulation.shaft_friction = 0.0;
        });
        plant.hold(plant.joints());
        pull(&mut plant, &(pretension() * 2.0), 2.0);
        plant.tensions()
    };
    let change = (tensions(0.1) - tensions(0.0)).component_div(&tensions(0.0)).amax();
    assert!((0.01..=0.12).contains(&change), "{change}");
}

/// Calls `change` on the default finger, with the largest ratio that the check of the configuration admits, and returns
/// this finger. The ratio is found to within 1 %. With a larger ratio, the check refuses the key `key`.
fn last_admitted(change: fn(&mut ConfiguredFinger, f64), key: &str) -> ConfiguredFinger {
    let changed = |ratio| {
        let mut finger = ConfiguredFinger::default();
        change(&mut finger, ratio);
        finger
    };
    let (mut admitted, mut refused): (f64, f64) = (1.0, 1000.0);
    while refused > 1.01 * admitted {
        let middle = (admitted * refused).sqrt();
        match changed(middle).check() {
            Ok(()) => admitted = middle,
            Err(unusable) => {
                assert_eq!(unusable.key, key);
                refused = middle;
            }
        }
    }
    assert!(refused < 1000.0, "{key}: nothing is refused");
    changed(admitted)
}

#[test]
fn the_simulation_of_a_finger_that_is_just_admitted_does_not_diverge() {
    let light = last_admitted(
        |finger, ratio| {
            finger.simulation.masses = finger.simulation.masses.map(|mass| mass / ratio);
            finger.simulation.joint_viscous_friction = [0.0; 3];
        },
        "simulation.masses",
    );
    let viscous = last_admitted(
        |finger, ratio| finger.simulation.joint_viscous_friction = [5e-4 * ratio; 3],
        "simulation.joint_viscous_friction",
    );
    let pushes = [[6.0, 0.0, 0.0], [-6.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, -6.0, 0.0], [0.0, 0.0, 6.0], [3.0; 3]];
    for (finger, braked) in [(&light, true), (&light, false), (&viscous, true), (&viscous, false)] {
        let (low, high) = finger.joint_limits();
        let mut plant = Plant::new(finger, Vector3::new(0.0, -9.81, 0.0)).expect("a usable finger");
        if !braked {
            plant.release_brake();
        }
        for push in pushes {
            plant.set_external_force(Vector3::from(push));
            for _ in 0..1000 {
                plant.step([0.0; 4]);
                let joints = plant.joints();
                // The stops are 0.05 rad beyond the limits. A blow deflects them further.
                let at_stop = |joint: usize| (low[joint] - 0.5..high[joint] + 0.5).contains(&joints[joint]);
                assert!((0..3).all(at_stop), "{push:?}, braked: {braked}, {joints}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        ..Default::default()
    })]

    /// The motors have no torque. The finger is released from a strained state.
    #[test]
    fn rubbing_tendons_never_create_energy(
        joints in (-50.0..50.0f64, -25.0..95.0f64, 8.0..118.0f64),
        push in prop::array::uniform3(-6.0..6.0f64),
        unwound in prop::array::uniform4(-0.5..1.5f64),
        conduit_friction in 0.0..0.4f64, pulley_friction in 0.0..0.2f64,
        hardening in 0.0..0.6f64, stiction_ratio in 1.0..3.0f64, held_mass in 0.0..0.3f64,
        steps in steps(),
    ) {
        let finger = configured(|finger| {
            let simulation = &mut finger.simulation;
            simulation.start_degrees = [joints.0, joints.1, joints.2];
            (simulation.conduit_friction, simulation.pulley_friction) = (conduit_friction, pulley_friction);
            (simulation.hardening, simulation.stiction_ratio) = (hardening, stiction_ratio);
            simulation.held_mass = held_mass;
        });
        let mut plant = Plant::new(&finger, Vector3::new(0.0, -9.81, 0.0)).expect("a usable finger");
        for (motor, angle) in unwound.into_iter().enumerate() {
            plant.turn_motor(motor, angle);
        }
        plant.set_external_force(Vector3::from(push));
        pull(&mut plant, &Vector4::zeros(), 0.01);
        plant.release_brake();
        plant.set_external_force(Vector3::zeros());
        // See `passive_parts_never_create_energy` in core_plant.rs. A section between pulley and joint is five times as
        // stiff as the whole tendon, and hardening adds 60 %. The stiffest mode is below 4000 rad/s. With steps of
        // 0.1 ms, its energy error is at most 0.2 of the swinging energy (see `assert_gains_no_energy`).
        let start = (plant.energy(), plant.kinetic_energy());
        let step = || {
            plant.step([0.0; 4]);
            (plant.energy(), plant.kinetic_energy())
        };
        assert_gains_no_energy(start, step, 0.2, steps);
    }
}
