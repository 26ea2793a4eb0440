//! A hand that opens only some fingers: the ports of the others are not touched.

use std::path::PathBuf;
use std::time::{Duration, Instant};
use sun2xp::finger::Stage;
use sun2xp::hand::{Fingers, Hand, HandError, Recovering};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
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
    // The finger with the requested number, not the finger at that index.
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
        assert_eq!(refused.errno(), libc::ENODEV);
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
    // A busy machine may lose its replies soon, but the board has obeyed some commands.
    let obeyed = |finger| port.with_finger(finger, |finger| finger.commanded_at()).expect("the board has it");
    let patience = Instant::now() + Duration::from_secs(10);
    while obeyed(2).is_none() {
        assert!(Instant::now() < patience, "no command came: {:?}", hand.report(2));
        std::thread::yield_now();
    }
    assert!(obeyed(1).is_none() && obeyed(3).is_none());
    // Nothing was found for finger 2, and nothing can be found for a finger that is not open.
    assert!(!hand.store_calibration(2).expect("nothing to store"));
    assert!(matches!(hand.store_calibration(1), Err(HandError::NotOpened(FingerNumber::ONE))));
}
