//! Tests how the steps of commissioning react to mistakes of the person, to lost replies, and to parts out of range.

use super::bench::{Wiring, World};
use super::finger::{Bench, Helper};
use super::kinds::right;
use crate::commission::desk::Desk;
use crate::commission::measure;
use crate::commission::outcome::Outcome;
use crate::commission::person::{Act, GRAVITY};
use crate::commission::step::Step;
use crate::commission::vitals::Vitals;
use crate::commission::wrong::Wrong;
use std::cell::RefCell;
use std::rc::Rc;
use sun2xp::model::configuration::{ConfiguredFinger, ZeroingMethod};

type Shared = Rc<RefCell<World>>;

/// A finger without mistakes, and its configuration. `change` changes only the true parameters of the finger.
fn world(change: impl Fn(&mut ConfiguredFinger)) -> (Shared, ConfiguredFinger) {
    let mut case = right(0);
    change(&mut case.truth);
    (World::new(&case.truth, &case.belief, Wiring::default()), case.belief)
}

/// Does one step.
fn step(step: Step, world: &Shared, person: &mut Helper, belief: &ConfiguredFinger) -> (Outcome, ConfiguredFinger) {
    let mut machine = Bench(world.clone());
    let (weights, vitals) = (vec![0.5 * GRAVITY, GRAVITY], Vitals::default());
    let mut desk = Desk { machine: &mut machine, person, finger: belief.clone(), weights, vitals };
    let outcome = desk.complete(step, |_| Ok(())).expect("carried out");
    (outcome, desk.finger.clone())
}

/// The zero of the gauge is at -18 counts, and the converter delivers no count below 0.
#[test]
fn a_gauge_below_the_range_of_its_converter_is_named_and_its_reading_is_left_out() {
    let (world, belief) = world(|truth| truth.gauge.zero[1] = -18.0);
    let (outcome, _) = step(Step::Gauges, &world, &mut Helper::new(&world), &belief);
    let named = outcome.wrong.iter().find(|wrong| !wrong.compensated()).expect("wrong");
    let Wrong::GaugeAtEnd(2, count, zero) = *named else { panic!("{outcome:?}") };
    assert!(count < 0.5 && (zero + 18.0).abs() < 4.0, "{count}, {zero}");
    assert!(named.remedy().starts_with("Shift the offset of amplifier 2 up by"), "{}", named.remedy());
    assert!(!outcome.wrong.iter().any(|wrong| matches!(wrong, Wrong::GaugeNotLinear(..))), "{outcome:?}");
}

/// The emergency stop may have tripped a fuse.
#[test]
fn a_supply_that_stays_off_after_the_emergency_stop_is_named() {
    let (world, belief) = world(|_| ());
    let mut person = Helper::new(&world);
    assert!(step(Step::Board, &world, &mut person, &belief).0.passed());
    person.loses_supply = true;
    let (outcome, _) = step(Step::Board, &world, &mut person, &belief);
    assert_eq!(outcome.wrong, [Wrong::Supply]);
}

#[test]
fn a_reading_without_replies_is_repeated_and_the_weighed_tendons_are_kept() {
    let (world, belief) = world(|_| ());
    let mut person = Helper::new(&world);
    // Up to three failed readings in a row are repeated without a question.
    world.borrow_mut().lost.0 = 3;
    assert!(step(Step::Gauges, &world, &mut person, &belief).0.passed());
    assert!(person.questions.is_empty(), "{:?}", person.questions);
    // After four failed readings in a row, the person is asked. Then the step continues where it was.
    (world.borrow_mut().lost.0, person.patience) = (7, 1);
    person.acts.clear();
    assert!(step(Step::Gauges, &world, &mut person, &belief).0.passed());
    assert!(person.questions[0].starts_with("the board has sent no measurement"), "{:?}", person.questions);
    let hung = person.acts.iter().filter(|act| matches!(act, Act::Hang(..))).count();
    assert_eq!((person.questions.len(), hung), (1, 8));
}

#[test]
fn a_step_whose_routine_has_failed_is_offered_again() {
    let (world, belief) = world(|_| ());
    let mut person = Helper::new(&world);
    (world.borrow_mut().lost.1, person.patience) = (1, 1);
    assert!(step(Step::Motors, &world, &mut person, &belief).0.passed());
    assert_eq!(person.questions, ["Remove the cause. Then press Enter to repeat the step \"motors\"."]);
}

/// The step is noted as failed, so that it does not count as passed any more.
#[test]
fn a_step_that_stops_with_an_error_is_noted() {
    let (world, belief) = world(|_| ());
    let (mut machine, mut person) = (Bench(world.clone()), Helper::new(&world));
    world.borrow_mut().lost.1 = 1;
    let (weights, vitals) = (Vec::new(), Vitals::default());
    let mut desk = Desk { machine: &mut machine, person: &mut person, finger: belief, weights, vitals };
    let mut noted = Vec::new();
    let stopped = desk.complete(Step::Motors, |outcome| {
        noted.extend(outcome.wrong.clone());
        Ok(())
    });
    assert!(stopped.is_err());
    assert_eq!(noted, [Wrong::Stopped("the board has sent no measurement".into())]);
}

/// The person has ended the step after four failed readings.
#[test]
fn a_step_that_is_given_up_is_noted() {
    let (world, belief) = world(|_| ());
    let (mut machine, mut person) = (Bench(world.clone()), Helper::new(&world));
    world.borrow_mut().lost.0 = 4;
    let (weights, vitals) = (vec![GRAVITY], Vitals::default());
    let mut desk = Desk { machine: &mut machine, person: &mut person, finger: belief, weights, vitals };
    let mut noted = Vec::new();
    let stopped = desk.complete(Step::Gauges, |outcome| {
        noted.extend(outcome.wrong.clone());
        Ok(())
    });
    assert!(stopped.is_err());
    assert_eq!(noted, [Wrong::Stopped("the board has sent no measurement".into())]);
    assert_eq!(person.questions.len(), 1, "{:?}", person.questions);
}

/// The person's hand may be in the way of the finger.
#[test]
fn nothing_moves_if_the_person_cannot_prepare_the_step() {
    for (doing, cannot) in [
        (Step::Motors, (|act| act == Act::HoldStill) as fn(Act) -> bool),
        (Step::Zeros, |act| matches!(act, Act::HoldPose(_) | Act::LetGo)),
        (Step::Tendons, |act| act == Act::LetGo),
    ] {
        let (world, belief) = world(|_| ());
        let mut person = Helper::new(&world);
        person.cannot = Some(cannot);
        let (outcome, finger) = step(doing, &world, &mut person, &belief);
        assert_eq!((outcome.wrong, finger), (vec![Wrong::NotPrepared], belief), "{doing}");
        assert_eq!(world.borrow().largest_torque, 0.0, "{doing}");
    }
}

#[test]
fn a_gauge_without_a_weight_is_not_reported_as_dead() {
    let (world, belief) = world(|_| ());
    let mut person = Helper::new(&world);
    person.cannot = Some(|act| matches!(act, Act::Hang(3, _)));
    let (outcome, _) = step(Step::Gauges, &world, &mut person, &belief);
    let open: Vec<_> = outcome.wrong.into_iter().filter(|wrong| !wrong.compensated()).collect();
    assert_eq!(open, [Wrong::NotWeighed(3)]);
}

/// The tolerance of the straight line through the readings of a gauge must follow from the weights that hang.
#[test]
fn a_bent_gauge_is_named_although_the_heaviest_weight_does_not_hang() {
    let (world, belief) = world(|_| ());
    let (mut machine, mut person) = (Bench(world.clone()), Helper::new(&world));
    person.cannot = Some(|act| matches!(act, Act::Hang(_, newton) if newton > 2.0 * GRAVITY));
    // The heavier of the two weights that hang is wrong by 2 N.
    person.hung = |newton| if newton > 0.75 * GRAVITY { newton + 2.0 } else { newton };
    let (weights, vitals) = (vec![0.5 * GRAVITY, GRAVITY, 5.0 * GRAVITY], Vitals::default());
    let mut desk = Desk { machine: &mut machine, person: &mut person, finger: belief, weights, vitals };
    let outcome = desk.complete(Step::Gauges, |_| Ok(())).expect("carried out");
    assert!(outcome.wrong.iter().any(|wrong| matches!(wrong, Wrong::GaugeNotLinear(1, _))), "{outcome:?}");
}

/// A motor without torque does not show whether the motors are swapped too.
#[test]
fn swapped_encoders_with_a_motor_that_does_not_turn_are_not_called_swapped_motors() {
    let mut case = right(0);
    (case.wiring.encoder_at, case.wiring.dead_motor) = ([1, 0, 2, 3], Some(0));
    let world = World::new(&case.truth, &case.belief, case.wiring.clone());
    let mut person = Helper::new(&world);
    let (outcome, _) = step(Step::Encoders, &world, &mut person, &case.belief);
    assert!(person.acts.contains(&Act::HoldStill));
    let [Wrong::EncodersUnclear([2, 1, 3, 4]), Wrong::Refused(text)] = &outcome.wrong[..] else {
        panic!("{outcome:?}")
    };
    assert!(text.contains("motor 1"), "{text}");
}

/// `sun2xp health` continues with the step that has failed.
#[test]
fn health_repeats_only_what_has_failed() {
    let truth = right(0).truth;
    let mut belief = truth.clone();
    belief.zeroing.method = Some(ZeroingMethod::Stops);
    let world = World::new(&truth, &belief, Wiring::default());
    let (mut machine, mut person) = (Bench(world.clone()), Helper::new(&world));
    (world.borrow_mut().lost.1, person.patience) = (1, 1);
    let (weights, vitals) = (Vec::new(), Vitals::default());
    let mut desk = Desk { machine: &mut machine, person: &mut person, finger: belief, weights, vitals };
    measure(&mut desk, &[Step::Zeros]).expect("measured");
    assert!(desk.vitals.tensions.is_some());
    assert_eq!(person.questions.len(), 1);
}

/// With --json, this text is all that the user sees.
#[test]
fn health_stops_with_the_cause_and_its_remedy() {
    let (world, belief) = world(|_| ());
    let (mut machine, mut person) = (Bench(world.clone()), Helper::new(&world));
    person.loses_supply = true;
    let (weights, vitals) = (Vec::new(), Vitals::default());
    let mut desk = Desk { machine: &mut machine, person: &mut person, finger: belief, weights, vitals };
    let text = measure(&mut desk, &[Step::Board]).expect_err("no supply").to_string();
    assert!(text.contains("the step \"board\" stopped: the motors have no supply. Switch the supply on"), "{text}");
}

/// The person turns motor 2 twice, or hangs a weight on tendon 2 twice.
#[test]
fn a_part_that_answers_twice_is_no_exchange() {
    let (world, belief) = world(|_| ());
    let mut person = Helper::new(&world);
    person.instead = Some((1, 2));
    let (outcome, finger) = step(Step::Encoders, &world, &mut person, &belief);
    assert_eq!(outcome.wrong, [Wrong::EncodersUnclear([2, 2, 3, 4])]);
    let (weighed, _) = step(Step::Gauges, &world, &mut person, &belief);
    assert_eq!(weighed.wrong, [Wrong::GaugesUnclear([2, 2, 3, 4])]);
    assert_eq!(finger, belief);
}

#[test]
fn four_motors_turned_the_wrong_way_are_asked_about() {
    let (world, belief) = world(|truth| truth.encoder.sign = [-1; 4]);
    let mut person = Helper::new(&world);
    person.right_way = false;
    let (outcome, finger) = step(Step::Encoders, &world, &mut person, &belief);
    assert_eq!((outcome.wrong, finger), (vec![Wrong::TurnedWrongWay], belief.clone()));
    person.right_way = true;
    let (outcome, finger) = step(Step::Encoders, &world, &mut person, &belief);
    assert!(outcome.passed() && finger.encoder.sign == [-1; 4], "{outcome:?}");
}

#[test]
fn a_lowered_stiffness_and_its_limit_are_reported() {
    let (world, belief) = world(|_| ());
    world.borrow_mut().bound = 0.4;
    let (outcome, finger) = step(Step::Bound, &world, &mut Helper::new(&world), &belief);
    assert!(matches!(outcome.wrong[..], [Wrong::InitialLowered(initial, 0.4)] if initial > 0.4), "{outcome:?}");
    assert!(outcome.found.contains(&"limited by: a soft tendon, against walls".into()), "{outcome:?}");
    assert!(
        outcome.comment("stiffness.bound", Step::Bound, "now").ends_with("limited by: a soft tendon, against walls")
    );
    assert!(finger.initial_stiffness().symmetric_eigenvalues().max() <= 0.4 + 1e-9);
}

/// Nobody holds the finger. The remedy is the same as for a held finger that trembles: it names the likely cause of the
/// trembling and the way out.
#[test]
fn a_refused_pose_says_how_to_zero_at_the_stops() {
    let (world, mut belief) = world(|_| ());
    belief.zeroing.method = Some(ZeroingMethod::Pose);
    let mut person = Helper::new(&world);
    person.holds = false;
    let (outcome, _) = step(Step::Zeros, &world, &mut person, &belief);
    let [wrong @ Wrong::PoseRefused(_)] = &outcome.wrong[..] else { panic!("{outcome:?}") };
    for part in ["because the signals of its gauges arrive too late", "leave with q", "start the tool again"] {
        assert!(wrong.remedy().contains(part), "{}", wrong.remedy());
    }
}

#[test]
fn the_person_lets_go_once_before_a_finger_is_identified_and_zeroed_at_its_stops() {
    let truth = right(0).truth;
    let mut belief = truth.clone();
    belief.zeroing.method = Some(ZeroingMethod::Stops);
    let world = World::new(&truth, &belief, Wiring::default());
    let mut person = Helper::new(&world);
    let (outcome, _) = step(Step::Tendons, &world, &mut person, &belief);
    assert!(outcome.passed(), "{outcome:?}");
    assert_eq!(person.acts, [Act::LetGo]);
}

/// The computer is examined before the motors move. Its faults are reported as suspect, and not as harmless notes.
#[test]
fn the_computer_is_examined_before_the_motors_move() {
    assert!(Step::Computer < Step::Encoders && Step::Computer.number() == 2);
    let slow = Wrong::Computer("72 of 1500 replies lost".into());
    assert!(slow.compensated() && slow.suspect());
}
