//! The contents of the messages. Samples have the values that the calls of planners return.

use crate::support::{configuration, name, open, read_for, read_until, reader};
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeSet;
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use sun2xp::control::{Controller, Feedback};
use sun2xp::finger::events::EventKind;
use sun2xp::finger::{ControllerSource, CycleRecord, Fault, FaultKind, Keyframe, Outlet, Stage};
use sun2xp::hand::Hand;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::ConfiguredObject;
use sun2xp::realtime::CycleTiming;
use sun2xp::telemetry::{Message, Publisher, Serving, View};

#[test]
fn the_description_names_hand_process_and_configuration() {
    let name = name("described");
    let mut configured = configuration(&name);
    configured.fingers[1].tendon.maximum = 60.0;
    let hand = Hand::open(configured.clone()).expect("open");
    let reader = reader(&name);
    let description = reader.description();
    assert_eq!((&description.name, description.process), (&name, std::process::id()));
    assert_eq!(description.configuration, configured);
    assert_eq!(description.library, env!("CARGO_PKG_VERSION"));
    assert_eq!(description.fingers, FingerNumber::ALL);
    let present = SystemTime::now().duration_since(UNIX_EPOCH).expect("after 1970").as_secs();
    assert!(present.abs_diff(description.started) < 60, "{}", description.started);
    drop(hand);
}

#[test]
fn samples_have_the_values_that_planners_get() {
    let name = name("samples");
    let mut configured = configuration(&name);
    // On a finger that is turned in the palm, a value in the wrong frame differs.
    configured.fingers[1].turn_degrees = Some(40.0);
    let hand = Hand::open(configured.clone()).expect("open");
    let mut reader = reader(&name);
    let mut view = View::new(&reader.description().configuration);
    hand.send_stiffness(2, [[2.0, 0.1, 0.0], [0.1, 3.0, 0.0], [0.0, 0.0, 2.5]]).expect("sent");
    hand.push_simulated(2, [0.3, 0.5, -0.2]).expect("pushed");
    // A sample is compared with what the calls return for the same cycle.
    let (report, tip, palm, torques) = loop {
        let before = hand.report(2).expect("report");
        let (tip, palm) = (hand.fingertip(2).expect("tip"), hand.palm_pose(2).expect("pose"));
        let torques = hand.joint_torques(2).expect("torques");
        let after = hand.report(2).expect("report");
        if before.losses.cycles == after.losses.cycles && before.set_point.stiffness[(0, 0)] == 2.0 {
            break (after, tip, palm, torques);
        }
    };
    let number = report.losses.cycles;
    let sample = read_until(&mut reader, |message| {
        let sample = view.take(message)?;
        (sample.finger == FingerNumber::TWO && sample.cycle == number).then_some(sample)
    });
    assert!(sample.computed && sample.fault().is_none() && sample.stage_name() == "running");
    assert_eq!(sample.began, report.last);
    assert_eq!(Vector3::from(sample.joints), report.cycle.joints);
    assert_eq!(sample.tensions, tip.tensions);
    assert_eq!(sample.tip_force, tip.force);
    assert_eq!((sample.contact_force, sample.touching, sample.slide), (tip.contact, tip.touching, tip.slide));
    // The call returns the columns of the matrix, and the sample has the rows. The matrix is symmetric except for
    // rounding.
    assert!((Matrix3::from(sample.stiffness) - Matrix3::from(tip.stiffness)).amax() < 1e-12);
    let rotation = Matrix3::from_fn(|row, column| palm.rotation[row][column]);
    let close = |one: Vector3<f64>, other: Vector3<f64>| (one - other).amax() < 1e-12;
    assert!(close(sample.tip.into(), palm.tip.into()));
    assert!(close(sample.tip_force_in_palm.into(), rotation * Vector3::from(tip.force)));
    let stiffness = Matrix3::from(sample.stiffness_in_palm);
    assert!((stiffness - rotation * Matrix3::from(tip.stiffness) * rotation.transpose()).amax() < 1e-12);
    assert_eq!(sample.kx.expect("a spring")[0], [2.0, 0.1, 0.0]);
    assert_eq!(sample.joint_set_point.map(Vector3::from), Some(report.set_point.joints));
    assert_eq!((sample.t_min, sample.t_max), {
        let tendon = &configured.fingers[1].tendon;
        (tendon.minimum, tendon.maximum)
    });
    assert_eq!(sample.measured_joint_torques, torques.measured);
    assert!(sample.wake_up.is_some_and(|time| time > 0.0) && sample.whole > sample.wake_up);
}

#[test]
fn a_new_reader_can_replay_from_its_first_keyframe() {
    let name = name("replayed");
    let hand = open(&name);
    hand.send_position(1, [0.1, 0.5, 0.9]).expect("sent");
    let mut reader = reader(&name);
    let mut messages = Vec::new();
    read_for(&mut reader, Duration::from_millis(900), &mut messages);
    drop(hand);
    let (mut controller, mut state, mut replayed) = (None, None, 0);
    for message in &messages {
        match message {
            Message::Controller { finger: FingerNumber::ONE, source, hand } => {
                let ControllerSource { finger, gravity, .. } = &**source;
                controller = Some(Controller::in_gravity(finger, gravity, hand.rate).expect("a controller"));
            }
            Message::Keyframe { finger: FingerNumber::ONE, state: kept, .. } if state.is_none() => {
                state = Some(**kept);
            }
            Message::Cycle { finger: FingerNumber::ONE, record } => {
                let (Some(state), Some(control)) = (&mut state, record.control) else { continue };
                let controller = controller.as_ref().expect("the controller comes before the cycles");
                let (command, report) = control.input.run(controller, None, state, record.feedback.as_ref());
                assert_eq!(command, control.command, "cycle {}", record.cycle);
                assert_eq!(report, control.report, "cycle {}", record.cycle);
                replayed += 1;
            }
            _ => {}
        }
    }
    assert!(replayed > 500, "{replayed} cycles");
}

#[test]
fn an_adjusted_controller_comes_before_its_cycles() {
    let name = name("adjusted");
    let hand = open(&name);
    let mut reader = reader(&name);
    let mut known = BTreeSet::new();
    read_until(&mut reader, |message| match message {
        Message::Controller { finger: FingerNumber::THREE, source, .. } => {
            known.insert(source.number);
            None
        }
        Message::Cycle { finger: FingerNumber::THREE, .. } => Some(()),
        _ => None,
    });
    hand.adjust(3, "tendon.minimum = 5.5").expect("adjusted");
    let mut view = View::new(&reader.description().configuration);
    let sample = read_until(&mut reader, |message| {
        let sample = view.take(message).filter(|sample| sample.finger == FingerNumber::THREE);
        match message {
            Message::Controller { finger: FingerNumber::THREE, source, .. } => {
                known.insert(source.number);
            }
            Message::Cycle { finger: FingerNumber::THREE, record } => {
                assert!(record.control.iter().all(|control| known.contains(&control.controller)), "{known:?}");
            }
            _ => {}
        }
        sample.filter(|_| {
            matches!(message, Message::Cycle { record, .. }
            if record.control.is_some_and(|control| control.controller == 1))
        })
    });
    assert_eq!(sample.t_min, 5.5);
}

#[test]
fn events_status_and_object_arrive() {
    let name = name("events");
    let mut configured = configuration(&name);
    configured.hand.simulated_object = Some(ConfiguredObject::default());
    let hand = Hand::open(configured).expect("open");
    let mut first = reader(&name);
    let object = read_until(&mut first, |message| match message {
        Message::Object(object) => Some(*object),
        _ => None,
    });
    assert!(object.time > 0.0 && object.position == hand.object().expect("an object").position);
    hand.stop(1).expect("stopped");
    let mut event = None;
    let mut cycles = Vec::new();
    let is_stopped = |stage| matches!(stage, Stage::Faulted(Fault { kind: FaultKind::FingerStopCall, .. }));
    let status = read_until(&mut first, |message| match message {
        Message::Event(new) if new.kind == EventKind::Fault => {
            event = Some(*new);
            None
        }
        Message::Cycle { finger: FingerNumber::ONE, record } => {
            cycles.push(*record);
            None
        }
        Message::Status(status) if status.finger == FingerNumber::ONE && is_stopped(status.stage) => {
            Some(status.clone())
        }
        _ => None,
    });
    let event = event.expect("the event comes before the status");
    let last = cycles.last().expect("cycles");
    assert_eq!((event.finger, event.cycle), (FingerNumber::ONE, last.cycle));
    assert!(is_stopped(last.stage), "{last:?}");
    assert!(status.losses.cycles >= last.cycle && status.wake_up.count > 0);
    // A reader that attaches later sees the fault and the last cycle.
    let mut second = reader(&name);
    let status = read_until(&mut second, |message| match message {
        Message::Status(status) if status.finger == FingerNumber::ONE => Some(status.clone()),
        _ => None,
    });
    assert!(is_stopped(status.stage));
    assert_eq!(status.last.map(|record| record.cycle), Some(last.cycle));
    let view = &mut View::new(&second.description().configuration);
    let sample = view.sample(FingerNumber::ONE, &status.last.expect("the last cycle"));
    assert_eq!(sample.fault().map(|fault| fault.kind), Some(FaultKind::FingerStopCall));
    // The cycles in which a finger is faulted do not count as lost.
    assert_eq!((first.lost(), second.lost()), ([0; 3], [0; 3]));
}

/// A reader that asks to attach waits for the next publication. If a fault occurs in this time, the reader receives the
/// event of the fault.
#[test]
fn a_fault_while_a_reader_attaches_is_an_event() {
    let name = name("attaching");
    let hand = open(&name);
    for finger in 1..=3 {
        hand.stop(finger).expect("stopped");
        let mut reader = reader(&name);
        let kind = read_until(&mut reader, |message| match message {
            Message::Event(event) if event.finger.get() == finger && event.kind == EventKind::Fault => Some(event.kind),
            _ => None,
        });
        assert_eq!(kind, EventKind::Fault);
    }
}

/// A servo writes a keyframe before the record of its cycle, and the two may be collected at different times.
#[test]
fn a_keyframe_is_published_even_if_it_is_collected_before_its_cycle() {
    let name = name("keyframes");
    let configuration = configuration(&name);
    let finger = &configuration.fingers[0];
    let controller = Controller::in_gravity(finger, &Vector3::zeros(), 1000.0).expect("a controller");
    let feedback = Feedback { motor_counts: [0; 4], gauge_counts: [0; 4] };
    let mut publisher = Publisher::open(configuration.clone(), vec![FingerNumber::ONE]).expect("published");
    let mut reader = std::thread::scope(|scope| {
        let attaching = scope.spawn(|| reader(&name));
        while !matches!(publisher.serve(|| Ok(())), Serving::Readers { .. }) {
            std::thread::yield_now();
        }
        attaching.join().expect("attached")
    });
    let record = |cycle: u64| CycleRecord {
        cycle,
        began: cycle,
        stage: Stage::Running,
        timing: CycleTiming::default(),
        feedback: None,
        status: 0,
        control: None,
    };
    let mut outlet = Outlet { records: vec![record(1), record(2)], ..Outlet::default() };
    outlet.keyframes.push(Keyframe { cycle: 3, state: controller.start(&feedback) });
    publisher.publish_cycles(FingerNumber::ONE, &mut outlet);
    outlet.records.extend([record(3), record(4)]);
    publisher.publish_cycles(FingerNumber::ONE, &mut outlet);
    publisher.end_batch();
    let mut messages = Vec::new();
    reader.read(Duration::from_secs(10), &mut messages).expect("messages");
    let order: Vec<String> = messages
        .iter()
        .map(|message| match message {
            Message::Cycle { record, .. } => format!("cycle {}", record.cycle),
            Message::Keyframe { cycle, .. } => format!("keyframe {cycle}"),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(order, ["cycle 1", "cycle 2", "keyframe 3", "cycle 3", "cycle 4"]);
}
