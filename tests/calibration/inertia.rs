//! Identification of the inertia of the rotors.

use crate::bench::Bench;
use sun2xp::calibration::{Findings, Identified, Task};
use sun2xp::model::configuration::{ConfiguredFinger, NamedHand};

/// Returns the inertia that identification finds for each rotor, as a fraction of the inertia that it should find. It
/// should find the true inertia divided by the ratio of true to commanded torque. All fractions are NaN if every rotor
/// keeps its configured inertia.
fn found(name: &str, rate: f64, change: impl Fn(&mut ConfiguredFinger)) -> [f64; 4] {
    let mut truth = ConfiguredFinger::default();
    change(&mut truth);
    let mut bench = Bench::new(&truth, &ConfiguredFinger::default(), rate).open();
    let result = bench.calibrate(Task::Identify);
    let Ok(Findings::Identified(Identified { rotor_inertia, .. })) = result else { panic!("{name}: {result:?}") };
    let simulation = &truth.simulation;
    let ratios = std::array::from_fn(|motor| {
        let inertia = simulation.rotor_inertia[motor] / simulation.motor_constant_ratio[motor];
        rotor_inertia.map_or(f64::NAN, |found| found[motor] / inertia)
    });
    eprintln!("{name}, {rate} Hz: {ratios:.3?}, {:.1} s, largest {:.1} N", bench.seconds, bench.largest_tension);
    assert_eq!(bench.belief.motor.inertia, rotor_inertia.map_or([6e-7; 4], Into::into), "{name}");
    ratios
}

fn check(name: &str, rate: f64, within: f64, change: impl Fn(&mut ConfiguredFinger)) {
    let ratios = found(name, rate, change);
    assert!(ratios.iter().all(|ratio| (ratio - 1.0).abs() <= within), "{name}, {rate} Hz: {ratios:?}");
}

fn keeps(name: &str, rate: f64, change: impl Fn(&mut ConfiguredFinger)) {
    let ratios = found(name, rate, change);
    assert!(ratios.iter().all(|ratio| ratio.is_nan()), "{name}, {rate} Hz: {ratios:?}");
}

fn rotors(factor: f64) -> impl Fn(&mut ConfiguredFinger) {
    move |truth| truth.simulation.rotor_inertia = [6e-7 * factor; 4]
}

#[test]
fn rotors_of_another_inertia_are_found() {
    for (rate, factors) in [(500.0, [1.5, 2.5]), (1000.0, [0.5, 2.5]), (2000.0, [0.5, 1.5])] {
        for factor in factors {
            check(&format!("rotors x{factor}"), rate, 0.03, rotors(factor));
        }
    }
}

#[test]
fn a_configured_inertia_that_is_right_stays() {
    for rate in [500.0, 1000.0] {
        keeps("nominal", rate, |_| {});
    }
    keeps("stiction x2", 1000.0, |truth| truth.simulation.stiction_ratio = 2.0);
    keeps("k x0.7", 1000.0, |truth| truth.simulation.tendon_stiffness = [210.0; 4]);
}

#[test]
fn every_rotor_has_its_own_inertia() {
    check("four rotors", 1000.0, 0.12, |truth| truth.simulation.rotor_inertia = [3e-7, 12e-7, 9e-7, 8e-7]);
}

#[test]
fn friction_and_lag_change_the_inertia_little() {
    check("motor friction x3", 1000.0, 0.05, |truth| {
        rotors(2.0)(truth);
        truth.simulation.motor_coulomb_friction = [2.1e-3; 4];
        truth.simulation.shaft_friction = 0.15;
    });
    check("conduit 20 %", 1000.0, 0.07, |truth| {
        rotors(2.0)(truth);
        truth.simulation.conduit_friction = 0.2;
    });
    for (name, lag, delay) in [("lag", 1.0, 0.0), ("delay", 0.0, 1.0)] {
        check(name, 1000.0, 0.1, |truth| {
            rotors(2.0)(truth);
            (truth.simulation.amplifier_lag_ms, truth.simulation.command_delay_ms) = (lag, delay);
        });
    }
}

#[test]
fn a_wrong_torque_constant_changes_the_inertia_as_the_controller_needs_it() {
    check("motor constants", 1000.0, 0.02, |truth| truth.simulation.motor_constant_ratio = [1.2, 0.8, 1.1, 0.85]);
}

#[test]
fn rotors_of_named_hands_are_found() {
    for hand in NamedHand::ALL {
        let named = |truth: &mut ConfiguredFinger| {
            truth.simulation = hand.simulation();
            // Zeroing comes before identification, and removes the offsets.
            truth.simulation.gauge_offset = [0.0; 4];
        };
        for rate in [500.0, 1000.0] {
            if hand == NamedHand::Cheap {
                check(hand.name(), rate, 0.04, named);
            } else {
                keeps(hand.name(), rate, named);
            }
        }
    }
}
