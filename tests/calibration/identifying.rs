//! Identification of friction and stiffness.

use crate::bench::Bench;
use sun2xp::calibration::{Findings, Identified, Task};
use sun2xp::model::configuration::{ConfiguredFinger, GaugeReference};

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

/// Identifies a finger whose gauges show these fractions of the true tension, and whose motors give these fractions of
/// the commanded torque. Returns the finger and the findings.
fn with_gains(gauges: [f64; 4], motors: [f64; 4], reference: GaugeReference) -> (ConfiguredFinger, Identified) {
    let mut truth = ConfiguredFinger::default();
    for (scale, gain) in truth.gauge.newton_per_count.iter_mut().zip(gauges) {
        *scale /= gain;
    }
    truth.simulation.motor_constant_ratio = motors;
    let mut belief = ConfiguredFinger::default();
    belief.gauge.reference = reference;
    let mut bench = Bench::new(&truth, &belief, 1000.0).open();
    (truth, identified(&mut bench))
}

#[test]
fn gauges_are_compared_with_each_other() {
    let gauges = [1.1, 0.92, 1.0, 0.95];
    let mean = gauges.map(f64::recip).iter().sum::<f64>() / 4.0;
    let (_, found) = with_gains(gauges, [1.0; 4], GaugeReference::Gauges);
    println!("{found:.4?}");
    for (tendon, gauge) in gauges.into_iter().enumerate() {
        // Identification keeps the mean of the four scales, so every tension is wrong by the factor 1 / `mean`.
        let expected = 1.0 / gauge / mean;
        assert!((found.gauge_gain[tendon] / expected - 1.0).abs() < 0.01, "gauge {tendon}: {found:?}");
        assert!((found.tendon_stiffness[tendon] * mean / 300.0 - 1.0).abs() < 0.01, "tendon {tendon}: {found:?}");
    }
}

#[test]
fn motors_are_a_reference_for_the_scale_of_the_gauges() {
    let gauges = [1.2, 1.15, 1.1, 1.25];
    let (truth, found) = with_gains(gauges, [1.02, 0.98, 1.0, 1.0], GaugeReference::Motors);
    println!("{found:.4?}");
    for (tendon, gauge) in gauges.into_iter().enumerate() {
        let gain = found.gauge_gain[tendon] * gauge;
        assert!((gain - 1.0).abs() < 0.01, "gauge {tendon}: {gain}, {found:?}");
        assert!((found.tendon_stiffness[tendon] / 300.0 - 1.0).abs() < 0.01, "tendon {tendon}: {found:?}");
        let ratio = truth.simulation.motor_constant_ratio[tendon];
        assert!((found.motor_ratio[tendon] / ratio - 1.0).abs() < 0.01, "motor {tendon}: {found:?}");
        assert!((found.conduit[tendon] / 0.05 - 1.0).abs() < 0.15, "motor {tendon}: {found:?}");
    }
}

#[test]
fn the_mean_of_unequal_configured_gains_is_kept() {
    let mut belief = ConfiguredFinger::default();
    belief.gauge.newton_per_count[0] *= 1.3;
    let mut bench = Bench::new(&ConfiguredFinger::default(), &belief, 1000.0).open();
    let found = identified(&mut bench);
    let mut gains = belief.gauge.newton_per_count;
    let before = gains.iter().sum::<f64>();
    gains.iter_mut().zip(&found.gauge_gain).for_each(|(scale, gain)| *scale *= gain);
    assert!((gains.iter().sum::<f64>() / before - 1.0).abs() < 1e-9, "{found:?}");
    assert!((gains[0] / gains[1] - 1.0).abs() < 0.01, "{found:?}");
}

/// If the motors are the reference, gauges with a wrong gain lead to the same encoder zeros as gauges with the right
/// gain.
#[test]
fn the_encoder_zeros_do_not_depend_on_the_gain_of_gauges_that_the_motors_correct() {
    let zeros = |gauge: f64, reference: GaugeReference| {
        let mut truth = ConfiguredFinger::default();
        truth.simulation.moment_arm_ratio.iter_mut().for_each(|joint| joint[0] = 1.05);
        truth.simulation.gauge_gain_ratio = [gauge; 4];
        let mut belief = ConfiguredFinger::default();
        belief.gauge.reference = reference;
        let mut bench = Bench::new(&truth, &belief, 1000.0).open();
        identified(&mut bench).moment_arms.expect("other moment arms").encoder_zero
    };
    let right = zeros(1.0, GaugeReference::Gauges);
    let found = zeros(1.0 / 1.2, GaugeReference::Motors);
    println!("{right:?} {found:?}");
    for (motor, (right, found)) in right.into_iter().zip(found).enumerate() {
        assert!((right - found).abs() <= 4, "motor {motor}: {found} instead of {right}");
    }
}
