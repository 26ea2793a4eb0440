//! An open hand with hardware that the program provides, in real time.

use super::plant_io::{PlantIo, Switches, starts_and_stops};
use super::settling::{Settling, distance};
use std::time::{Duration, Instant};
use sun2xp::finger::{FaultKind, Stage};
use sun2xp::hand::HandError;
use sun2xp::io::FingerIo;
use sun2xp::model::configuration::Configuration;
use sun2xp::model::{FingerNumber, Fingers};
use sun2xp::nalgebra::Vector3;
use sun2xp::realtime::CycleStage;
use sun2xp::{Hand, io};

const TARGET: [f64; 3] = [0.2, 0.6, 1.1];

/// Longest wait for anything.
const PATIENCE: Duration = Duration::from_secs(10);

/// Opens a hand with hardware for these fingers.
fn open(configuration: &Configuration, fingers: &[i32], in_step: bool) -> Result<(Hand, Vec<Switches>), HandError> {
    let (mut all, mut switches) = ([None, None, None], Vec::new());
    for number in fingers.iter().filter_map(|&finger| FingerNumber::new(finger)) {
        let hardware = PlantIo::new(configuration, number, in_step);
        switches.push(hardware.switches.clone());
        all[number.index()] = Some(Box::new(hardware) as Box<dyn FingerIo>);
    }
    Hand::open_with_io(configuration.clone(), all).map(|hand| (hand, switches))
}

/// A configuration with a watchdog time that is longer than the pauses of the test machine.
fn patient() -> Configuration {
    let mut configuration = Configuration::default();
    configuration.hand.watchdog_ms = 200;
    configuration
}

fn fault(hand: &Hand, finger: i32) -> FaultKind {
    let begun = Instant::now();
    loop {
        match hand.report(finger).expect("a report").stage {
            Stage::Faulted(fault) => return fault.kind,
            stage => assert!(begun.elapsed() < PATIENCE, "finger {finger} is {stage:?}"),
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Moves every finger to the target, and then pushes finger 1. Returns where the fingers rest before the push, and
/// where finger 1 rests during it.
fn moves(hand: &Hand, push: impl FnOnce()) -> (Vec<[f64; 3]>, [f64; 3]) {
    let settling = Settling { tolerance: 0.01, rest: Duration::from_millis(300), patience: PATIENCE };
    (1..=3).for_each(|finger| hand.send_position(finger, TARGET).expect("sent"));
    let rest = settling.wait(hand, &[(1, TARGET), (2, TARGET), (3, TARGET)]).unwrap_or_else(|error| panic!("{error}"));
    push();
    let begun = Instant::now();
    let (mut last, mut since) = (rest[0], begun);
    while since.elapsed() < Duration::from_millis(500) || distance(last, rest[0]) < 0.01 {
        let position = hand.position(1).expect("a position");
        if distance(position, last) > 0.004 {
            (last, since) = (position, Instant::now());
        }
        assert!(begun.elapsed() < PATIENCE, "finger 1 does not rest: {position:?}");
        std::thread::sleep(Duration::from_millis(2));
    }
    (rest, hand.position(1).expect("a position"))
}

#[test]
fn hardware_of_the_program_opens_and_is_the_spring_of_the_simulated_board() {
    let force = [0.0, 1.0, 0.5];
    let configuration = patient();
    let (hand, switches) = open(&configuration, &[1, 2, 3], true).expect("open");
    let with_io = moves(&hand, || switches[0].lock().force = Vector3::from(force));
    hand.close();
    for switches in &switches {
        let switches = switches.lock();
        assert_eq!((switches.starts, switches.stops), (1, 1));
        assert!(switches.exchanges > 500);
    }

    let simulated = Hand::open(configuration).expect("open");
    let built_in = moves(&simulated, || simulated.push_simulated(1, force).expect("pushed"));
    for (one, other) in with_io.0.iter().zip(built_in.0) {
        assert!(distance(*one, other) < 0.01, "{one:?} and {other:?}");
    }
    assert!(distance(with_io.1, built_in.1) < 0.01, "pushed: {:?} and {:?}", with_io.1, built_in.1);
    assert!(distance(with_io.1, TARGET) > 0.02, "the push is visible: {:?}", with_io.1);
}

#[test]
fn lost_exchanges_fault_the_finger_and_it_recovers() {
    let (hand, switches) = open(&patient(), &[2], false).expect("open");
    let switches = &switches[0];
    switches.lock().exchange_fails = Some(libc::EIO);
    let (fault, losses) = (fault(&hand, 2), hand.losses(2).expect("losses"));
    // If the servo skips periods, the watchdog may trip before the finger faults. The fault is still that of lost
    // replies, unless the servo has skipped half of the 200 periods of the watchdog time.
    if losses.skipped_periods < 100 {
        assert_eq!(fault, FaultKind::LostReplies);
    } else {
        println!("the servo has skipped {} periods", losses.skipped_periods);
        assert!(matches!(fault, FaultKind::LostReplies | FaultKind::Watchdog), "{fault:?}");
    }
    assert!(losses.lost_replies > 2);
    assert_eq!(hand.report(1).expect("a report").stage, Stage::Running, "the other fingers continue");
    let begun = Instant::now();
    while switches.lock().stops == 0 && begun.elapsed() < PATIENCE {
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(starts_and_stops(switches), (1, 1));

    switches.lock().start_fails = Some(libc::ENXIO);
    let refused = hand.recover(2).expect_err("the hardware does not start");
    assert!(refused.errno() == libc::ENXIO && refused.to_string().contains("failed to start"), "{refused}");
    assert!(refused.to_string().contains("Check its power and its cables"), "{refused}");
    switches.lock().start_fails = None;
    switches.lock().exchange_fails = None;
    hand.recover(2).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(switches.lock().starts, 2);
    hand.send_position(2, TARGET).expect("sent");
    let settling = Settling { tolerance: 0.02, rest: Duration::from_millis(100), patience: PATIENCE };
    settling.wait(&hand, &[(2, TARGET)]).unwrap_or_else(|error| panic!("{error}"));
    hand.close();
    assert_eq!(switches.lock().stops, 2);
}

/// The start of the hardware takes longer than the 5 s within which the servo must take back a repaired finger. The
/// start must not count toward these 5 s.
#[test]
fn a_finger_recovers_although_its_hardware_starts_slowly() {
    let (hand, switches) = open(&patient(), &[1], true).expect("open");
    hand.stop(1).expect("finger 1");
    assert_eq!(fault(&hand, 1), FaultKind::FingerStopCall);
    switches[0].lock().start_takes = Some(Duration::from_millis(5100));
    hand.recover(1).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(hand.report(1).expect("a report").stage, Stage::Running);
    assert_eq!(switches[0].lock().starts, 2);
}

/// Hardware that starts without a reference for its encoder counts, and whose stop fails.
#[test]
fn a_recovery_reports_the_error_of_a_stop_although_the_zeros_were_lost() {
    let configuration = patient();
    let hardware = PlantIo::new(&configuration, FingerNumber::ONE, true);
    let switches = hardware.switches.clone();
    switches.lock().faults = io::IoFaults::ZERO_LOST;
    let hand = Hand::open_with_io(configuration, [Some(Box::new(hardware) as Box<dyn FingerIo>), None, None]);
    let hand = hand.expect("open");
    switches.lock().stops_fail = u32::MAX;
    hand.stop(1).expect("finger 1");
    assert_eq!(fault(&hand, 1), FaultKind::FingerStopCall);
    let refused = hand.recover(1).expect_err("the hardware does not stop");
    assert!(refused.errno() == libc::EIO && refused.to_string().contains("failed to stop"), "{refused}");
    switches.lock().stops_fail = 0;
    hand.recover(1).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(starts_and_stops(&switches), (2, 1));
}

/// Hardware that was opened without a reference for its encoder counts, and then loses its counts.
#[test]
fn counts_that_are_lost_after_an_opening_without_a_zero_fault_the_finger_and_refuse_its_recovery() {
    let configuration = patient();
    let hardware = PlantIo::new(&configuration, FingerNumber::ONE, true);
    let switches = hardware.switches.clone();
    let report = |faults: io::IoFaults| switches.lock().faults = faults;
    report(io::IoFaults::ZERO_LOST);
    let hand = Hand::open_with_io(configuration, [Some(Box::new(hardware) as Box<dyn FingerIo>), None, None]);
    let hand = hand.expect("open");
    let refused = |why: &str| match hand.recover(1) {
        Err(HandError::Faulted { fault, .. }) => assert_eq!(fault.kind, FaultKind::ZeroLost, "{why}"),
        other => panic!("{why}: {other:?}"),
    };

    report(io::IoFaults::default());
    let (exchanges, begun) = (switches.lock().exchanges, Instant::now());
    while switches.lock().exchanges == exchanges {
        assert!(begun.elapsed() < PATIENCE, "no exchange");
        std::thread::sleep(Duration::from_millis(1));
    }
    report(io::IoFaults::ZERO_LOST);
    assert_eq!(fault(&hand, 1), FaultKind::ZeroLost);
    refused("lost in a sample");
    refused("the previous start has not brought the counts back");

    report(io::IoFaults::default());
    hand.recover(1).unwrap_or_else(|error| panic!("{error}"));
    hand.stop(1).expect("finger 1");
    assert_eq!(fault(&hand, 1), FaultKind::FingerStopCall);
    report(io::IoFaults::ZERO_LOST);
    refused("lost before the start");
}

#[test]
fn faults_of_the_hardware_fault_the_finger() {
    let (hand, switches) = open(&patient(), &[1, 2, 3], false).expect("open");
    switches[0].lock().faults = io::IoFaults::EMERGENCY_STOP;
    switches[1].lock().tension = Some((0, f64::NAN));
    switches[2].lock().faults = io::IoFaults::ZERO_LOST;
    assert_eq!(fault(&hand, 1), FaultKind::EmergencyStopInput);
    assert_eq!(fault(&hand, 2), FaultKind::SensorFault);
    assert_eq!(fault(&hand, 3), FaultKind::ZeroLost);
}

#[test]
fn a_slow_exchange_is_an_overrun_and_is_seen_in_the_stage_wire() {
    let (hand, switches) = open(&patient(), &[3], false).expect("open");
    hand.reset_timing(3).expect("reset");
    switches[0].lock().delay = Some(Duration::from_millis(5));
    let begun = Instant::now();
    let wire = loop {
        let wire = hand.timing(3, CycleStage::Wire).expect("timing");
        if wire.maximum >= 5000.0 || begun.elapsed() > PATIENCE {
            break wire;
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    assert!(wire.maximum >= 5000.0, "{wire:?}");
    let losses = hand.losses(3).expect("losses");
    assert!(losses.overruns >= 1 && losses.skipped_periods >= 3, "{losses:?}");
    assert_eq!(hand.report(3).expect("a report").stage, Stage::Running);
}

#[test]
fn if_one_finger_cannot_start_the_others_are_stopped_again() {
    let configuration = patient();
    let (mut all, mut switches) = ([None, None, None], Vec::new());
    for number in FingerNumber::ALL {
        let hardware = PlantIo::new(&configuration, number, false);
        switches.push(hardware.switches.clone());
        all[number.index()] = Some(Box::new(hardware) as Box<dyn FingerIo>);
    }
    switches[2].lock().start_fails = Some(libc::EHOSTDOWN);
    // A stop that fails is repeated.
    switches[0].lock().stops_fail = 2;
    let refused = Hand::open_with_io(configuration, all).err().expect("finger 3 does not start");
    assert_eq!(refused.errno(), libc::EHOSTDOWN, "{refused}");
    for (switches, started) in switches.iter().zip([1, 1, 0]) {
        assert_eq!(starts_and_stops(switches), (started, started));
    }
}

#[test]
fn hardware_of_a_finger_that_the_hand_does_not_have_is_refused_with_this_reason() {
    let mut configuration = patient();
    configuration.hand.fingers = Fingers::one(FingerNumber::ONE);
    let refused = open(&configuration, &[1, 2], false).err().expect("no finger 2");
    assert!(matches!(refused, HandError::NotInHand { finger: FingerNumber::TWO, .. }), "{refused}");
}

#[test]
fn gauges_of_another_board_are_refused() {
    let mut configuration = patient();
    configuration.fingers[0].gauge.newton_per_count = [0.03; 4];
    let refused = open(&configuration, &[1], false).err().expect("another scale");
    assert!(refused.to_string().contains("newton_per_count") && refused.errno() == libc::EINVAL, "{refused}");
}
