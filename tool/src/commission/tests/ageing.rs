//! Fingers that were commissioned and have aged since.

use super::bench::{Wiring, World};
use super::finger::{Bench, Helper};
use super::kinds::right;
use crate::commission::desk::Desk;
use crate::commission::step::Step;
use crate::commission::vitals::Vitals;
use crate::health::comparison::compare;
use sun2xp::model::configuration::{ConfiguredFinger, ZeroingMethod};

/// Zeros and identifies a finger.
fn measured(truth: &ConfiguredFinger, belief: &ConfiguredFinger) -> (Vitals, ConfiguredFinger) {
    let world = World::new(truth, belief, Wiring::default());
    let (mut machine, mut person) = (Bench(world.clone()), Helper::new(&world));
    let (weights, vitals) = (Vec::new(), Vitals::default());
    let mut desk = Desk { machine: &mut machine, person: &mut person, finger: belief.clone(), weights, vitals };
    for step in [Step::Zeros, Step::Tendons] {
        let outcome = desk.carry_out(step).expect("carried out");
        assert!(outcome.passed(), "{step}: {outcome:?}");
    }
    (desk.vitals.clone(), desk.finger.clone())
}

/// A change of the true finger, and the complaint about it.
type Ageing = (fn(&mut ConfiguredFinger), &'static str, &'static str);

#[test]
fn aged_fingers_are_named_and_a_healthy_one_is_not() {
    let truth = right(0).truth;
    let mut belief = truth.clone();
    belief.zeroing.method = Some(ZeroingMethod::Stops);
    let (before, configured) = measured(&truth, &belief);
    let (again, found) = measured(&truth, &configured);
    assert_eq!(compare(&before, &configured, &again, &found), []);
    let ageings: [Ageing; 5] = [
        (|truth| truth.gauge.zero[2] += 100.0, "gauge_zero", "zero of gauge 3"),
        (|truth| truth.simulation.tendon_stiffness[1] = 240.0, "tendon_stiffness", "tendon 2"),
        (|truth| truth.simulation.motor_coulomb_friction[2] = 2.1e-3, "motor_friction", "friction of motor 3"),
        (|truth| truth.encoder.zero[3] -= 600, "encoder_slip", "zero of encoder 4"),
        // The tendon has become longer by 0.9 mm, so its motor winds it in farther.
        (|truth| truth.encoder.zero[0] += 600, "longer_tendon", "zero of encoder 1"),
    ];
    for (age, kind, part) in ageings {
        let mut aged = truth.clone();
        age(&mut aged);
        let (today, found) = measured(&aged, &configured);
        let complaints = compare(&before, &configured, &today, &found);
        let named: Vec<_> = complaints.iter().map(|one| (one.kind, one.part.as_str())).collect();
        assert_eq!(named, [(kind, part)], "{complaints:?}");
    }
}
