//! Friction and stiffness.

use crate::bench::Bench;
use sun2xp::control::calibration::{Findings, Identified, Task};
use sun2xp::model::configuration::ConfiguredFinger;

pub fn identified(bench: &mut Bench) -> Identified {
    match bench.calibrate(Task::Identify) {
        Ok(Findings::Identified(found)) => found,
        other => panic!("{other:?}"),
    }
}

#[test]
fn stiffness_is_found_to_one_per_cent_and_friction_closely() {
    for rate in [500.0, 1000.0, 2000.0] {
        let mut truth = ConfiguredFinger::default();
        truth.simulation.tendon_stiffness = [330.0, 270.0, 315.0, 285.0];
        let mut bench = Bench::new(&truth, &ConfiguredFinger::default(), rate).open();
        let found = identified(&mut bench);
        eprintln!("{rate} Hz: {found:.4?} largest {:.1}", bench.largest_tension);
        for tendon in 0..4 {
            let ratio = found.tendon_stiffness[tendon] / truth.simulation.tendon_stiffness[tendon];
            assert!((ratio - 1.0).abs() < 0.01, "{rate} Hz, tendon {tendon}: {found:?}");
            assert!((found.motor_coulomb[tendon] / 0.07 - 1.0).abs() < 0.15, "{rate} Hz, motor {tendon}: {found:?}");
            assert!((found.conduit[tendon] / 0.05 - 1.0).abs() < 0.15, "{rate} Hz, motor {tendon}: {found:?}");
            assert!((found.motor_ratio[tendon] - 1.0).abs() < 0.02, "{rate} Hz, motor {tendon}: {found:?}");
        }
        for joint in 0..3 {
            assert!((found.joint_coulomb[joint] / 0.05 - 1.0).abs() < 0.15, "{rate} Hz, joint {joint}: {found:?}");
        }
        assert!(bench.largest_tension < 0.7 * truth.tendon.maximum, "{}", bench.largest_tension);
    }
}

#[test]
fn motors_with_other_constants_change_no_stiffness_and_are_reported() {
    let mut truth = ConfiguredFinger::default();
    truth.simulation.tendon_stiffness = [330.0; 4];
    truth.simulation.motor_constant_ratio = [1.2, 0.8, 1.1, 0.9];
    let mut bench = Bench::new(&truth, &ConfiguredFinger::default(), 1000.0).open();
    let found = identified(&mut bench);
    for tendon in 0..4 {
        assert!((found.tendon_stiffness[tendon] / 330.0 - 1.0).abs() < 0.01, "tendon {tendon}: {found:?}");
        let ratio = truth.simulation.motor_constant_ratio[tendon];
        assert!((found.motor_ratio[tendon] / ratio - 1.0).abs() < 0.02, "motor {tendon}: {found:?}");
    }
}

#[test]
fn harsh_joint_friction_is_found() {
    let mut truth = ConfiguredFinger::default();
    truth.simulation.joint_coulomb_friction = [2e-3; 3];
    let mut bench = Bench::new(&truth, &ConfiguredFinger::default(), 1000.0).open();
    let found = identified(&mut bench);
    for joint in 0..3 {
        assert!((found.joint_coulomb[joint] / 0.2 - 1.0).abs() < 0.15, "joint {joint}: {found:?}");
    }
}
