//! The bound of Kx: the search finds it, and detects controllers and plants that are unstable. The default bound is
//! correct for every controller and rate.

use nalgebra::{Matrix3, Vector3};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use sun2xp::control::AdmissibleDamping;
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};
use sun2xp::stability::{Limit, OneCycleMap, Rest, Search, StiffnessBound, Variant};

const SEARCH: Search = Search { samples: 60, seed: 5, walls: false };

const SCHEMES: [Scheme; 4] = [Scheme::Figure9, Scheme::Figure10, Scheme::Figure11, Scheme::StateFeedback];

fn finger(scheme: Scheme) -> ConfiguredFinger {
    let mut finger = ConfiguredFinger::default();
    finger.controller.scheme = Some(scheme);
    finger
}

fn nominal(finger: &ConfiguredFinger, rate: f64) -> StiffnessBound {
    SEARCH.bound(finger, rate, &Variant::NOMINAL).unwrap()
}

#[test]
fn the_default_finger_supports_its_documented_stiffness() {
    for scheme in SCHEMES {
        for (rate, least) in [(500.0, 5.0), (1000.0, 6.0)] {
            let found = nominal(&finger(scheme), rate);
            assert!(found.stiffness >= least, "{scheme:?} at {rate} Hz: {found:?}");
            assert!(found.least_scale >= 0.5 && found.samples > 35 && found.uncovered.is_empty());
        }
    }
}

/// Number of rates, which are from 500 to 5000 Hz. Most do not divide 10 kHz, the rate of the plant's steps, and are
/// far from the rates for which gains were determined.
const RATES: usize = 40;

/// Number of random poses at each rate. The pose that supports the least stiffness is tested in addition. The tips are
/// at least 3 cm from the axis of joint 0, because no stiffness of a tip on this axis holds joint 0.
const POSES: usize = 4;

/// Tests the initial Kx of a finger and its default bound, each with the least damping, with the damping that the
/// controller chooses, and with the most damping.
fn stable_at_every_rate(scheme: Scheme) {
    let finger = finger(scheme);
    let links = finger.links();
    let (low, high) = finger.joint_limits();
    let mut random = Pcg64::seed_from_u64(1990);
    let mut part = || f64::from(random.next_u32()) / 4294967296.0;
    for step in 0..RATES {
        let rate = 500.0 * 10f64.powf((step as f64 + part()) / RATES as f64);
        let map = OneCycleMap::new(&finger, rate).unwrap();
        let stretched = Vector3::new(-47.0, -4.0, 6.0).map(f64::to_radians);
        let anywhere = std::iter::repeat_with(|| low.zip_map(&high, |low, high| low + (high - low) * part()));
        let poses: Vec<_> = anywhere.filter(|joints| links.reach(joints).abs() >= 3.0).take(POSES).collect();
        for joints in poses.into_iter().chain([stretched]) {
            for stiffness in [3.0, finger.stiffness_bound(rate)] {
                let deflection = Vector3::from_fn(|_, _| 0.01 * (part() + 0.5));
                let (least, most) = AdmissibleDamping::new(&finger, rate).range(stiffness);
                for damping in [least, 1.0, most] {
                    let rest = Rest::hard_finger(joints, deflection, &(Matrix3::identity() * stiffness));
                    let rest = Rest { damping, ..rest };
                    let largest = map.largest_eigenvalue(&rest);
                    assert!(
                        largest.is_some_and(|modulus| modulus < 1.0),
                        "{scheme:?} at {rate:.1} Hz, {stiffness} N/cm, damping {damping}, {:.1?} degrees: {largest:?}",
                        joints.map(f64::to_degrees).as_slice()
                    );
                }
            }
        }
    }
}

#[test]
fn figure_9_is_stable_at_every_rate() {
    stable_at_every_rate(Scheme::Figure9);
}

#[test]
fn figure_10_is_stable_at_every_rate() {
    stable_at_every_rate(Scheme::Figure10);
}

#[test]
fn figure_11_is_stable_at_every_rate() {
    stable_at_every_rate(Scheme::Figure11);
}

#[test]
fn state_feedback_is_stable_at_every_rate() {
    stable_at_every_rate(Scheme::StateFeedback);
}

#[test]
fn the_map_is_that_of_the_requested_rate() {
    // The usual step of the plant, 100 us, does not divide the period of 740 Hz. The map must nevertheless not be the
    // map of a neighbouring rate whose period is a multiple of the step.
    let kx = Matrix3::identity() * 3.0;
    let rest = Rest::hard_finger(Vector3::new(0.1, 0.5, 1.0), Vector3::new(0.01, 0.01, 0.01), &kx);
    let largest = |rate| OneCycleMap::new(&finger(Scheme::Figure10), rate).unwrap().largest_eigenvalue(&rest).unwrap();
    let [lower, asked, higher] = [10_000.0 / 14.0, 740.0, 10_000.0 / 13.0].map(largest);
    assert!((asked - lower).abs() > 1e-6 && (asked - higher).abs() > 1e-6, "{lower} {asked} {higher}");
}

#[test]
fn a_loop_with_too_little_damping_or_no_damper_is_detected() {
    let whole = nominal(&finger(Scheme::Figure10), 1000.0).stiffness;
    let mut less_damped = finger(Scheme::Figure10);
    less_damped.controller.rate_time = Some(0.002);
    let found = nominal(&less_damped, 1000.0);
    let limited = found.stiffness < whole && matches!(found.limit, Limit::Unstable(_));
    assert!(limited || !found.uncovered.is_empty(), "{found:?}");
    let mut undamped = finger(Scheme::Figure10);
    undamped.controller.motor_damping = Some(0.0);
    undamped.controller.rate_time = Some(0.0);
    assert!(!nominal(&undamped, 1000.0).uncovered.is_empty());
}

/// Fingers of another build. Their masses, motor inertias, tendon stiffnesses and lengths are those of the default
/// finger times the factors below.
fn other_fingers(scheme: Scheme) -> Vec<(&'static str, ConfiguredFinger)> {
    let scaled = |masses: f64, inertia: f64, tendons: f64, lengths: f64| {
        let mut finger = finger(scheme);
        finger.links.masses = finger.links.masses.map(|mass| mass * masses);
        finger.motor.inertia = finger.motor.inertia.map(|motor| motor * inertia);
        finger.tendon.stiffness = finger.tendon.stiffness.map(|stiffness| stiffness * tendons);
        finger.geometry.links = finger.geometry.links.map(|length| length * lengths);
        finger
    };
    vec![
        ("half the masses", scaled(0.5, 1.0, 1.0, 1.0)),
        ("twice the masses", scaled(2.0, 1.0, 1.0, 1.0)),
        ("half the motor inertia", scaled(1.0, 0.5, 1.0, 1.0)),
        ("twice the motor inertia", scaled(1.0, 2.0, 1.0, 1.0)),
        ("softer tendons", scaled(1.0, 1.0, 0.5, 1.0)),
        ("stiffer tendons", scaled(1.0, 1.0, 1.5, 1.0)),
        ("shorter", scaled(0.7, 1.0, 1.0, 0.7)),
        ("longer", scaled(1.3, 1.0, 1.0, 1.3)),
    ]
}

/// The stiffness of each finger is limited by its tendons and not by the loop, because the gains of state feedback
/// follow from the configuration. The gains of Figure 10 do not: with them, at least half of these fingers are unstable
/// in some pose.
#[test]
fn state_feedback_is_made_for_the_finger_that_is_configured() {
    for (name, finger) in other_fingers(Scheme::StateFeedback) {
        let found = nominal(&finger, 1000.0);
        assert!(matches!(found.limit, Limit::Scaled(_)) && found.uncovered.is_empty(), "{name}: {found:?}");
    }
    let figure = other_fingers(Scheme::Figure10).into_iter().map(|(_, finger)| nominal(&finger, 1000.0));
    assert!(figure.filter(|found| !found.uncovered.is_empty()).count() >= 4);
}

#[test]
fn state_feedback_is_stable_at_its_bound_against_walls() {
    let against_walls = Search { samples: 30, walls: true, ..SEARCH };
    let found = against_walls.bound(&finger(Scheme::StateFeedback), 1000.0, &Variant::NOMINAL).unwrap();
    assert!(found.stiffness >= 6.0 && found.uncovered.is_empty(), "{found:?}");
}

/// Figure 10 is stable on the nominal plant. With one more cycle of delay, some samples are unstable even with the
/// softest spring of the search.
#[test]
fn a_plant_of_the_set_is_unstable_although_the_nominal_plant_is_stable() {
    let few = Search { samples: 16, ..SEARCH };
    let delayed = Variant::SET.into_iter().find(|variant| variant.name == "extra cycle of delay").unwrap();
    let uncovered = |variant| few.bound(&finger(Scheme::Figure10), 1000.0, variant).unwrap().uncovered.len();
    assert_eq!(uncovered(&Variant::NOMINAL), 0);
    assert!(uncovered(&delayed) > 0);
}

/// With these plants and state feedback, a damping of 1 is stable. The least or the most damping that a planner may
/// request is not stable in some poses, even with the softest spring. A search that tries only a damping of 1 finds no
/// such pose.
#[test]
fn the_least_and_the_most_damping_count_too() {
    let few = Search { samples: 24, ..SEARCH };
    let finger = finger(Scheme::StateFeedback);
    for (name, rate, least) in [("amplifier lag 2 ms", 500.0, true), ("rotor inertia x0.5", 1000.0, false)] {
        let plant = Variant::SET.into_iter().find(|variant| variant.name == name).unwrap();
        let uncovered = few.bound(&finger, rate, &plant).unwrap().uncovered;
        let range = AdmissibleDamping::new(&finger, rate).range(1.0);
        let tried = if least { range.0 } else { range.1 };
        assert!(uncovered.iter().any(|rest| rest.damping == tried), "{name}: {tried} is not in {uncovered:#?}");
    }
}
