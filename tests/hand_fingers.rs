//! Tests that a hand that opens only some fingers does not touch the ports of the others. Also tests the bound of Kx
//! below the initial stiffness, and the search for boards by their unique numbers.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use sun2xp::board::Port;
use sun2xp::finger::Stage;
use sun2xp::hand::{FingerCommand, Fingers, FoundFinger, Hand, HandError, Recovering, Until, search_boards};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{BoardNumber, Configuration};
use sun2xp::realtime::Priority;
use sun2xp::simulated::{Pace, SimulatedBoard, SimulatedPort};

/// A port that does not exist.
const NOWHERE: &str = "/dev/sun2xp-no-such-port";

fn slow() -> Configuration {
    let mut configuration = Configuration::default();
    configuration.hand.rate = 500.0;
    configuration
}

fn fingers(numbers: &[i32]) -> Fingers {
    Fingers::of(numbers).expect("fingers")
}

#[test]
fn a_finger_is_opened_without_the_ports_of_the_others() {
    let mut configuration = slow();
    configuration.fingers[1].port = NOWHERE.into();
    let whole = Hand::open_limp(configuration.clone(), None, Fingers::ALL).err().expect("refused");
    assert!(matches!(whole, HandError::Link { finger: FingerNumber::TWO, .. }), "{whole}");

    let hand = Hand::open_limp(configuration, None, fingers(&[1, 3])).expect("open");
    for finger in [1, 3] {
        assert_eq!(hand.report(finger).expect("a report").stage, Stage::Limp);
        assert!(
            hand.status(finger).expect("a status").rate > 0.0 && hand.push_simulated(finger, [0.1, 0.0, 0.0]).is_ok()
        );
    }
    // The call affects the finger with the requested number, not the finger at that index.
    hand.find_signs(3, |_| {}).expect("signs");
    assert!(hand.report(3).expect("a report").calibration.is_some());
    assert!(hand.report(1).expect("a report").calibration.is_none());
    for refused in [
        hand.send_position(2, [0.0, 0.5, 1.0]).err(),
        hand.find_signs(2, |_| {}).err(),
        hand.calibrated(2).err(),
        hand.push_simulated(2, [0.0; 3]).err(),
        hand.adjust(2, "tendon.minimum = 6").err(),
        Recovering::begin(&hand, 2).err(),
    ] {
        let refused = refused.expect("refused");
        assert!(matches!(refused, HandError::NotOpened(FingerNumber::TWO)), "{refused}");
        assert_eq!(refused.errno(), libc::EINVAL);
    }
    assert!(matches!(hand.position(4), Err(HandError::NoSuchFinger(4))));
    assert!(matches!(Recovering::begin(&hand, 0), Err(HandError::NoSuchFinger(0))));
}

#[test]
fn one_of_three_fingers_on_a_port() {
    let mut configuration = slow();
    let board = SimulatedBoard::new(&configuration, &FingerNumber::ALL).expect("a board");
    let port = SimulatedPort::start(board, Pace::patient(500.0), Priority::default()).expect("a port");
    for finger in &mut configuration.fingers {
        (finger.port, finger.baud, finger.thread) = (port.path().display().to_string(), 2_000_000, 1);
    }
    let hand = Hand::open_limp(configuration, Some(PathBuf::from("hand.toml")), fingers(&[2])).expect("open");
    assert!(matches!(hand.report(1), Err(HandError::NotOpened(FingerNumber::ONE))));
    // On a busy machine the finger may soon lose replies, but its board obeys some commands before that.
    let obeyed = |finger| port.with_finger(finger, |finger| finger.commanded_at()).expect("the board has it");
    let patience = Instant::now() + Duration::from_secs(10);
    while obeyed(2).is_none() {
        assert!(Instant::now() < patience, "no command came: {:?}", hand.report(2));
        std::thread::yield_now();
    }
    assert!(obeyed(1).is_none() && obeyed(3).is_none());
    // No calibration of finger 2 has a result to store. A finger that is not open has no results at all.
    assert!(!hand.store_calibration(2).expect("nothing to store"));
    assert!(matches!(hand.store_calibration(1), Err(HandError::NotOpened(FingerNumber::ONE))));
}

#[test]
fn a_hand_of_one_finger_is_a_hand() {
    let mut configuration = slow();
    configuration.hand.fingers = fingers(&[2]);
    // The configuration may contain tables of fingers that the hand does not have yet. Their threads and ports disturb
    // nothing.
    for absent in [0, 2] {
        (configuration.fingers[absent].port, configuration.fingers[absent].thread) = (NOWHERE.into(), 2);
        configuration.fingers[absent].priority = 1;
    }
    let hand = Hand::open(configuration.clone()).expect("open");
    assert_eq!(hand.fingers(), fingers(&[2]));
    hand.send_group(&[FingerCommand::new(2).joints([0.1, 0.5, 1.0])]).expect("sent");
    hand.wait(&[2], Until::Settled, Duration::from_secs(20)).expect("settled");
    for refused in [
        hand.send_position(1, [0.0, 0.5, 1.0]).err(),
        hand.send_group(&[FingerCommand::new(2), FingerCommand::new(3)]).err(),
        hand.wait(&[1, 2], Until::Settled, Duration::ZERO).err(),
        hand.status(3).err(),
        hand.stop(1).err(),
        Recovering::begin(&hand, 3).err(),
    ] {
        let refused = refused.expect("refused");
        assert!(matches!(refused, HandError::NotInHand { .. }), "{refused}");
        assert!(refused.to_string().contains("hand.fingers = [2]"), "{refused}");
        assert_eq!(refused.errno(), libc::EINVAL);
    }
    hand.close();
    let other = Hand::open_limp(configuration, None, fingers(&[1, 2])).err().expect("refused");
    assert!(matches!(other, HandError::NotInHand { finger: FingerNumber::ONE, .. }), "{other}");
}

/// `stiffness.initial` has eigenvalues of 3 N/cm, and this key cannot change while the hand is open.
#[test]
fn the_bound_can_fall_below_the_initial_stiffness() {
    let hand = Hand::open(slow()).expect("open");
    hand.send_stiffness(1, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]).expect("sent");
    hand.adjust(1, "stiffness.bound = 2").expect("adjusted");
    assert_eq!(hand.limits(1).expect("limits").stiffness, 2.0);
    assert!(hand.send_stiffness(1, [[2.5, 0.0, 0.0], [0.0, 2.5, 0.0], [0.0, 0.0, 2.5]]).is_err());
    // The configuration with which a hand is opened must have an initial stiffness within the bound.
    let mut configuration = slow();
    configuration.fingers[0].stiffness.bound = Some(2.0);
    let refused = Hand::open(configuration).err().expect("refused");
    assert!(refused.to_string().contains("stiffness.initial"), "{refused}");
}

/// Starts a simulated board, and makes `link` a symbolic link to its port.
fn board(link: &Path, members: &[FingerNumber], number: u32) -> SimulatedPort {
    let board = SimulatedBoard::new(&slow(), members).expect("a board").numbered(number);
    let port = SimulatedPort::start(board, Pace::patient(500.0), Priority::default()).expect("a port");
    std::os::unix::fs::symlink(port.path(), link).expect("a link");
    port
}

#[test]
fn a_board_is_found_by_its_unique_number() {
    let folder = tempfile::tempdir().expect("a folder");
    let [left, right, used] = ["left", "right", "used"].map(|name| folder.path().join(name));
    let _left = board(&left, &[FingerNumber::ONE, FingerNumber::TWO], 7);
    let _right = board(&right, &[FingerNumber::THREE], 8);
    let _used = board(&used, &[FingerNumber::THREE], 9);
    let _user = Port::open(&used, 1_000_000).expect("free");
    let patterns = [folder.path().join("*").display().to_string()];
    let found = search_boards(&patterns, &[1_000_000]);
    let numbers: Vec<Vec<(u8, BoardNumber)>> = found
        .iter()
        .map(|port| {
            let number = |found: &FoundFinger| (found.address, BoardNumber(found.identity.unique_number));
            port.answer.iter().flatten().map(number).collect()
        })
        .collect();
    let addresses: Vec<Vec<u8>> = numbers.iter().map(|port| port.iter().map(|found| found.0).collect()).collect();
    assert_eq!(addresses, [vec![1, 2], vec![3], vec![]], "{found:?}");

    let mut configuration = slow();
    configuration.hand.search_ports = patterns.into();
    let places = [numbers[0][0].1, numbers[0][1].1, numbers[1][0].1];
    for (finger, number) in configuration.fingers.iter_mut().zip(places) {
        (finger.board, finger.baud) = (Some(number), 2_000_000);
    }
    let threads = Hand::open_limp(configuration.clone(), None, Fingers::ALL).err().expect("two threads on a port");
    assert!(threads.to_string().contains("set thread = 1"), "{threads}");
    configuration.fingers[1].thread = 1;
    let hand = Hand::open_limp(configuration.clone(), None, Fingers::ALL).expect("open");
    for (finger, path) in (1..).zip([&left, &left, &right]) {
        assert_eq!(hand.calibrated(finger).expect("open").port, path.display().to_string());
    }
    hand.close();

    configuration.fingers[2].board = Some(BoardNumber([0xAB; 12]));
    let begun = Instant::now();
    let missing = Hand::open_limp(configuration, None, Fingers::ALL).err().expect("no such board");
    assert!(begun.elapsed() < Duration::from_secs(5), "{:?}", begun.elapsed());
    let text = missing.to_string();
    let right_has = format!("{} has {}", right.display(), places[2]);
    let used = format!("{}: in use by another program or hand: end or close it", used.display());
    assert!(text.contains("finger.3.board") && text.contains(&right_has) && text.contains(&used), "{text}");
}
