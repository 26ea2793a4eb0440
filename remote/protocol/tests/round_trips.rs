//! Tests that a message which is encoded and then decoded is unchanged.

use proptest::prelude::*;
use sun2xp_remote_protocol::{
    Action, Answer, ClientName, Code, Counts, Event, FaultText, Finger, FingerStatus, Part, PathPose, Place, Record,
    Request, Stage, State, Status, Target,
};

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![any::<f64>().prop_filter("finite", |number| number.is_finite()), -10.0..10.0]
}

fn numbers<const N: usize>() -> impl Strategy<Value = [f64; N]> {
    prop::collection::vec(number(), N).prop_map(|numbers| std::array::from_fn(|index| numbers[index]))
}

fn finger() -> impl Strategy<Value = Finger> {
    prop::sample::select(Finger::ALL.to_vec())
}

fn stage() -> impl Strategy<Value = Stage> {
    prop_oneof![
        Just(Stage::Opening),
        Just(Stage::Limp),
        Just(Stage::Calibrating),
        Just(Stage::Running),
        Just(Stage::Closing),
        Just(Stage::Closed),
        (1..=u16::MAX).prop_map(Stage::Faulted),
    ]
}

fn path() -> impl Strategy<Value = Place> {
    prop::collection::vec((1e-3..5.0, numbers()), 1..=32).prop_map(|steps| {
        let mut now = 0.0;
        let pose = |(step, joints)| {
            now += step;
            PathPose { time: now, joints }
        };
        Place::Path(steps.into_iter().map(pose).collect())
    })
}

fn part(finger: Finger) -> impl Strategy<Value = Part> {
    let place =
        prop_oneof![Just(Place::Kept), numbers().prop_map(Place::Joints), numbers().prop_map(Place::Tip), path()];
    let stiffness = prop::option::of([numbers::<3>(), numbers::<3>(), numbers::<3>()]);
    (1..=u32::MAX, place, stiffness, prop::option::of(number()))
        .prop_map(move |(command, place, stiffness, damping)| Part { finger, command, place, stiffness, damping })
}

fn target() -> impl Strategy<Value = Target> {
    let parts = Finger::ALL.map(|finger| prop::option::of(part(finger)));
    (1..=60_000u32, any::<[u64; 4]>(), parts).prop_map(|(validity_ms, [epoch, sequence, sent, seen], parts)| Target {
        validity_ms,
        epoch,
        sequence,
        sent,
        seen,
        parts: parts.into_iter().flatten().collect(),
    })
}

fn record() -> impl Strategy<Value = Record> {
    let places = (numbers(), prop::option::of(numbers()), numbers(), numbers(), numbers());
    (finger(), stage(), any::<(u32, u64, [bool; 4])>(), places).prop_map(|(finger, stage, rest, places)| {
        let (command, begin, [touching, caught, arrived, settled]) = rest;
        let (joints, set_point, tip, force, tensions) = places;
        Record {
            finger,
            stage,
            command,
            cycle: 0,
            begin,
            touching,
            caught,
            arrived,
            settled,
            joints,
            set_point,
            tip,
            force,
            tensions,
        }
    })
}

fn state() -> impl Strategy<Value = State> {
    (any::<(u32, u64, u64, u64)>(), prop::collection::vec(record(), 0..=300)).prop_map(|(fields, mut records)| {
        let (missing, number, time, owner) = fields;
        records.iter_mut().zip(number / 2..).for_each(|(record, cycle)| record.cycle = cycle);
        State { missing, number, time, owner, records }
    })
}

fn finger_status() -> impl Strategy<Value = FingerStatus> {
    let numbers = (numbers::<3>(), numbers::<3>(), 0.0..1e6, 0.0..=1.0);
    (stage(), any::<(u32, u64, u64, u64, u64)>(), numbers, ".{0,80}").prop_map(|(stage, counts, numbers, text)| {
        let (warnings, cycles, skipped_periods, lost_replies, corrupt_replies) = counts;
        let (one, other, stiffness_bound, calibration) = numbers;
        FingerStatus {
            stage,
            warnings,
            cycles,
            skipped_periods,
            lost_replies,
            corrupt_replies,
            low: std::array::from_fn(|joint| one[joint].min(other[joint])),
            high: std::array::from_fn(|joint| one[joint].max(other[joint])),
            stiffness_bound,
            calibration,
            fault_text: FaultText::beginning_of(if matches!(stage, Stage::Faulted(_)) { &text } else { "" }),
        }
    })
}

fn status() -> impl Strategy<Value = Status> {
    let owner = prop::option::of("[A-Za-z0-9._-]{1,64}");
    let fingers = prop::array::uniform3(prop::option::of(finger_status()));
    let times = (1..=u32::MAX, 1..=u32::MAX, any::<u32>(), any::<u64>());
    (times, 1e-3..1e5, 1e-3..1e5, 0.0..1e5, any::<[u64; 8]>(), fingers, owner).prop_map(
        |((catch_ms, end_ms, clients, time), rate, lead_force, soft_stiffness, counts, fingers, owner)| {
            let [taken, malformed, old_epoch, replayed, late, refused, caught, ended] = counts;
            let counts = Counts { taken, malformed, old_epoch, replayed, late, refused, caught, ended };
            let owner: Option<ClientName> = owner.map(|owner| owner.parse().expect("a name"));
            Status { catch_ms, end_ms, clients, time, rate, lead_force, soft_stiffness, counts, fingers, owner }
        },
    )
}

fn request() -> impl Strategy<Value = Request> {
    let action = prop::sample::select(Action::ALL.to_vec());
    (action, finger(), any::<(bool, bool, bool, u64)>()).prop_map(
        |(action, finger, (one, take_over, recover, epoch))| {
            let acquires = action == Action::Acquire;
            let finger = match action {
                Action::Calibrate | Action::Identify => Some(finger),
                Action::Acquire | Action::Release => None,
                Action::Recover | Action::Stop => one.then_some(finger),
            };
            Request { action, finger, take_over: take_over && acquires, recover: recover && acquires, epoch }
        },
    )
}

fn answer() -> impl Strategy<Value = Answer> {
    (prop::sample::select(Code::ALL.to_vec()), 1..=u32::MAX, any::<[u64; 3]>(), ".{0,300}").prop_map(
        |(code, catch_ms, [epoch, time, number], text)| {
            let text = if code == Code::Done { String::new() } else { text };
            Answer { code, catch_ms, epoch, time, number, text }
        },
    )
}

proptest! {
    #[test]
    fn round_trip_of_a_target(target in target()) {
        prop_assert_eq!(Target::decode(&target.encode().expect("good")), Ok(target));
    }

    #[test]
    fn round_trip_of_a_state(state in state()) {
        prop_assert_eq!(State::decode(&state.encode().expect("good")), Ok(state));
    }

    #[test]
    fn round_trip_of_an_event(finger in finger(), fields in any::<(u8, u64, u64)>(),
                              counts in (1..=u16::MAX, 1..=u64::MAX), values in numbers()) {
        let ((part, cycle, begin), (kind, number)) = (fields, counts);
        let event = Event { finger, part, kind, number, cycle, begin, values };
        prop_assert_eq!(Event::decode(&event.encode().expect("good")), Ok(event));
    }

    #[test]
    fn round_trip_of_a_status(status in status()) {
        prop_assert_eq!(Status::decode(&status.encode().expect("good")), Ok(status));
    }

    #[test]
    fn round_trip_of_a_request(request in request()) {
        prop_assert_eq!(Request::decode(&request.encode().expect("good")), Ok(request));
    }

    #[test]
    fn round_trip_of_an_answer(answer in answer()) {
        prop_assert_eq!(Answer::decode(&answer.encode().expect("good")), Ok(answer));
    }
}

#[test]
fn what_cannot_be_decoded_is_not_encoded() {
    let part = |finger| {
        let place = Place::Joints([0.0, f64::NAN, 0.0]);
        Part { finger, command: 1, place, stiffness: None, damping: None }
    };
    let target = |parts| Target { validity_ms: 100, epoch: 1, sequence: 1, sent: 0, seen: 0, parts };
    let refused = |target: Target| target.encode().expect_err("refused").to_string();
    assert_eq!(refused(target(vec![part(Finger::ALL[1])])), "part 0, joint angles must be finite, and not NaN");
    let good = |finger| Part { place: Place::Kept, ..part(finger) };
    let falling = target(vec![good(Finger::ALL[1]), good(Finger::ALL[0])]);
    assert_eq!(refused(falling), "part 1, finger must be higher than that of the previous part");
    let none = Part { command: 0, ..good(Finger::ALL[0]) };
    assert_eq!(refused(target(vec![none])), "part 0, command number is 0: it must be 1 to 4294967295");
}
