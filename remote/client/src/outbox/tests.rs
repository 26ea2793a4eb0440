//! Tests of the outbox in simulated time.

mod losses;

use super::*;
use crate::command::FingerCommand;
use sun2xp_remote_protocol::{Code, Part, PathPose, Place};

const MS: u64 = 1_000_000;
const ONE: Finger = Finger::ALL[0];
const KX: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn answer(code: Code, number: u64) -> Answer {
    Answer { code, catch_ms: 100, epoch: 77, time: 1000 * MS, number, text: String::new() }
}

fn owner() -> Outbox {
    let mut outbox = Outbox::new(Loss::Never);
    outbox.acquired(&answer(Code::Done, 5));
    outbox
}

fn changes(change: Change) -> [Option<Change>; FINGERS] {
    [Some(change), None, None]
}

fn joints(angle: f64) -> [Option<Change>; FINGERS] {
    changes(Change::of(&FingerCommand::new(1).joints([angle; 3])))
}

fn stiffness() -> [Option<Change>; FINGERS] {
    changes(Change::of(&FingerCommand::new(1).stiffness(KX)))
}

fn path() -> [Option<Change>; FINGERS] {
    let poses = vec![PathPose { time: 1.0, joints: [0.5; 3] }];
    changes(Change { place: Place::Path(poses), ..Change::default() })
}

/// The only part of the next Target.
fn part(outbox: &mut Outbox, now: u64) -> Part {
    let mut target = outbox.next(now).expect("a Target is due");
    assert_eq!(target.parts.len(), 1);
    target.parts.remove(0)
}

#[test]
fn without_ownership_nothing_is_sent() {
    let mut outbox = Outbox::new(Loss::Never);
    outbox.put(joints(0.5), None);
    assert_eq!((outbox.due(), outbox.next(u64::MAX)), (None, None));
    let mut outbox = owner();
    outbox.put(joints(0.5), None);
    outbox.lose(Loss::Ended);
    assert_eq!((outbox.due(), outbox.next(u64::MAX), outbox.ownership()), (None, None, Err(Loss::Ended)));
}

/// During an emergency stop no Targets are sent. Set points that are put into the outbox during this time wait in it.
#[test]
fn targets_can_be_held_back() {
    let mut outbox = owner();
    assert!(outbox.next(0).is_some());
    outbox.hold(true);
    outbox.put(joints(0.5), None);
    assert_eq!((outbox.due(), outbox.next(50 * MS), outbox.ownership().is_ok()), (None, None, true));
    outbox.hold(false);
    assert_eq!(part(&mut outbox, 60 * MS).place, Place::Joints([0.5; 3]));
    outbox.hold(true);
    outbox.acquired(&answer(Code::Done, 6));
    assert!(outbox.next(70 * MS).is_some(), "a new epoch is not held");
}

#[test]
fn an_owner_that_commands_nothing_says_that_it_lives() {
    let mut outbox = owner();
    let target = outbox.next(0).expect("a Target at once");
    assert_eq!((target.epoch, target.sequence, target.validity_ms, target.seen), (77, 1, 100, 1000 * MS));
    assert!(target.parts.is_empty());
    assert_eq!(outbox.next(19 * MS), None);
    outbox.received(1010 * MS, 5, true);
    let target = outbox.next(20 * MS).expect("a Target after 20 ms");
    assert_eq!((target.sequence, target.sent, target.seen), (2, 20 * MS, 1010 * MS));
    assert_eq!(outbox.due(), Some(40 * MS));
}

#[test]
fn a_change_is_sent_at_once_and_repeated_with_its_number() {
    let mut outbox = owner();
    assert!(outbox.next(0).is_some());
    outbox.put(joints(0.5), None);
    let sent = part(&mut outbox, MS);
    assert_eq!((sent.finger, sent.command, &sent.place), (ONE, 1, &Place::Joints([0.5; 3])));
    assert_eq!(outbox.next(2 * MS), None);
    assert_eq!(part(&mut outbox, 21 * MS), sent);
    outbox.confirm(ONE, 1);
    assert_eq!(part(&mut outbox, 41 * MS), sent);
}

#[test]
fn if_a_planner_sends_without_a_pause_the_newest_set_point_is_sent() {
    let mut outbox = owner();
    let mut sent = Vec::new();
    // The planner sends a set point each microsecond for 10 ms.
    for now in (0..10 * MS).step_by(1000) {
        outbox.put(joints(now as f64), None);
        sent.extend(outbox.next(now).map(|target| (now, target)));
    }
    assert_eq!(sent.len(), 20, "one Target each 0.5 ms");
    for (now, target) in sent {
        assert_eq!(target.parts[0].place, Place::Joints([now as f64; 3]));
    }
}

#[test]
fn what_is_not_confirmed_is_sent_with_the_next_change() {
    let mut outbox = owner();
    outbox.put(joints(0.5), None);
    part(&mut outbox, 0);
    outbox.put(stiffness(), None);
    let both = part(&mut outbox, MS);
    assert_eq!((both.command, &both.place, both.stiffness), (2, &Place::Joints([0.5; 3]), Some(KX)));
    outbox.put(changes(Change::of(&FingerCommand::new(1).damping(0.5))), None);
    let all = part(&mut outbox, 2 * MS);
    assert_eq!((&all.place, all.stiffness, all.damping), (&Place::Joints([0.5; 3]), Some(KX), Some(0.5)));
    // A confirmation of the first part does not confirm later changes.
    outbox.confirm(ONE, 1);
    assert!(!outbox.is_applied(ONE));
    outbox.put(changes(Change::of(&FingerCommand::new(1).damping(0.75))), None);
    let later = part(&mut outbox, 3 * MS);
    assert_eq!((&later.place, later.stiffness, later.damping), (&Place::Kept, Some(KX), Some(0.75)));
}

#[test]
fn what_is_confirmed_is_not_sent_again_with_a_new_number() {
    let mut outbox = owner();
    outbox.put(joints(0.5), None);
    part(&mut outbox, 0);
    outbox.confirm(ONE, 1);
    outbox.put(stiffness(), None);
    let alone = part(&mut outbox, MS);
    assert_eq!((alone.command, alone.place, alone.stiffness), (2, Place::Kept, Some(KX)));
}

#[test]
fn a_path_begins_once() {
    let mut outbox = owner();
    outbox.put(path(), None);
    assert!(matches!(part(&mut outbox, 0).place, Place::Path(_)));
    outbox.put(stiffness(), None);
    assert_eq!(outbox.next(MS), None, "Kx waits for the path");
    let repeated = part(&mut outbox, 20 * MS);
    assert_eq!((repeated.command, repeated.stiffness), (1, None));
    outbox.confirm(ONE, 1);
    let alone = part(&mut outbox, 21 * MS);
    assert_eq!((alone.command, alone.place, alone.stiffness), (2, Place::Kept, Some(KX)));
}

#[test]
fn a_place_replaces_a_path_at_once() {
    let mut outbox = owner();
    outbox.put(path(), None);
    part(&mut outbox, 0);
    outbox.put(stiffness(), None);
    outbox.put(joints(0.25), None);
    let replaced = part(&mut outbox, MS);
    assert_eq!((replaced.place, replaced.stiffness), (Place::Joints([0.25; 3]), Some(KX)));
}

#[test]
fn a_group_waits_as_a_whole() {
    let mut outbox = owner();
    outbox.put(path(), None);
    part(&mut outbox, 0);
    let [one, _, _] = stiffness();
    let [other, _, _] = joints(0.5);
    outbox.put([one, other, None], None);
    assert_eq!(outbox.next(MS), None);
    outbox.confirm(ONE, 1);
    let target = outbox.next(2 * MS).expect("a Target with both parts");
    assert_eq!(target.parts.len(), 2);
}

#[test]
fn refused_values_are_not_sent_again() {
    let mut outbox = owner();
    outbox.put(joints(0.5), None);
    part(&mut outbox, 0);
    let text = "too stiff: send a softer Kx".to_string();
    outbox.refused(&Answer { text: text.clone(), time: 1005 * MS, ..answer(Code::Argument, 1) });
    let target = outbox.next(20 * MS).expect("a Target without parts");
    assert_eq!((target.parts.len(), target.seen), (0, 1005 * MS));
    assert_eq!((outbox.take_refusal(), outbox.take_refusal()), (Some(text), None));
    outbox.put(stiffness(), None);
    assert_eq!(part(&mut outbox, 21 * MS).place, Place::Kept);
}

/// A refusal arrives while later set points are on the way, so the newest Target is never the refused one.
#[test]
fn later_set_points_do_not_contain_a_refused_value_for_ever() {
    let mut outbox = owner();
    outbox.put(stiffness(), None);
    part(&mut outbox, 0);
    for number in 1..=20 {
        outbox.put(joints(f64::from(number)), None);
        let sent = part(&mut outbox, u64::from(number as u32) * MS);
        // The refusal of a Target arrives after the next two Targets were sent.
        assert_eq!(sent.stiffness.is_some(), number <= 2, "set point {number}");
        match number {
            1 => {}
            2 | 3 => outbox.refused(&answer(Code::Argument, number as u64 - 1)),
            _ => outbox.confirm(ONE, sent.command - 1),
        }
    }
    assert_eq!(part(&mut outbox, 40 * MS).place, Place::Joints([20.0; 3]));
}

/// On a line with a long delay, a Target is repeated before its refusal arrives.
#[test]
fn the_refusals_of_repeated_targets_are_reported_once() {
    let mut outbox = owner();
    outbox.put(joints(0.5), None);
    (0..3).for_each(|number| drop(part(&mut outbox, number * 20 * MS)));
    outbox.refused(&answer(Code::Argument, 1));
    assert!(outbox.take_refusal().is_some());
    outbox.put(joints(0.25), None);
    part(&mut outbox, 60 * MS);
    for copy in [2, 3] {
        outbox.refused(&answer(Code::Argument, copy));
        assert_eq!(outbox.take_refusal(), None, "Target {copy}");
    }
    assert_eq!(part(&mut outbox, 80 * MS).command, 2, "the new part is sent");
    outbox.refused(&answer(Code::Argument, 4));
    assert!(outbox.take_refusal().is_some(), "the new part was refused");
}

#[test]
fn a_refusal_does_not_concern_later_or_confirmed_values() {
    let mut outbox = owner();
    outbox.put(joints(0.5), None);
    part(&mut outbox, 0);
    outbox.confirm(ONE, 1);
    outbox.refused(&answer(Code::Argument, 1));
    assert_eq!(part(&mut outbox, 20 * MS).command, 1, "the value was confirmed");
    outbox.put(joints(0.25), None);
    part(&mut outbox, 40 * MS);
    outbox.refused(&answer(Code::Argument, 2));
    assert_eq!(part(&mut outbox, 60 * MS).command, 2, "the value came with Target 3");
    outbox.refused(&Answer { epoch: 76, ..answer(Code::Argument, 9) });
    assert_eq!(part(&mut outbox, 80 * MS).command, 2, "the refusal was of another epoch");
}

#[test]
fn the_owner_notices_that_it_has_lost_the_hand() {
    let mut outbox = owner();
    outbox.received(1000 * MS, 4, true);
    assert!(outbox.ownership().is_ok(), "that State was not later than the Answer");
    outbox.received(1001 * MS, 5, true);
    assert!(outbox.ownership().is_ok());
    outbox.received(1002 * MS, 6, true);
    assert_eq!(outbox.ownership(), Err(Loss::TakenOver));
    let mut outbox = owner();
    outbox.received(1002 * MS, 0, true);
    assert_eq!(outbox.ownership(), Err(Loss::Ended));
}

#[test]
fn a_new_epoch_begins_without_old_set_points() {
    let mut outbox = owner();
    outbox.put(joints(0.5), None);
    part(&mut outbox, 0);
    outbox.put(joints(0.75), None);
    outbox.acquired(&Answer { epoch: 78, ..answer(Code::Done, 6) });
    let target = outbox.next(MS).expect("a Target without parts");
    assert_eq!((target.epoch, target.sequence, target.parts.len()), (78, 1, 0));
    outbox.put(joints(0.25), None);
    assert_eq!(part(&mut outbox, 2 * MS).command, 2, "command numbers continue");
}

#[test]
fn a_given_time_stamp_is_used_and_stamps_do_not_go_back() {
    let mut outbox = owner();
    outbox.put(joints(0.5), Some(3 * MS));
    assert_eq!(outbox.next(4 * MS).expect("a Target").sent, 3 * MS);
    outbox.put(joints(0.25), Some(2 * MS));
    assert_eq!(outbox.next(5 * MS).expect("a Target").sent, 3 * MS);
    assert_eq!(outbox.next(25 * MS).expect("a Target").sent, 25 * MS);
}

#[test]
fn after_the_highest_command_number_comes_1() {
    let mut outbox = owner();
    outbox.command = u32::MAX;
    outbox.put(joints(0.5), None);
    assert_eq!(part(&mut outbox, 0).command, 1);
}
