//! The self-test at open, on simulated boards behind ports.

use sun2xp::finger::Stage;
use sun2xp::hand::{Hand, HandError};
use sun2xp::model::configuration::Configuration;
use sun2xp::model::{FingerNumber, Fingers};
use sun2xp::realtime::Priority;
use sun2xp::simulated::{Defect, Pace, SimulatedBoard, SimulatedPort, WiredPart};

/// Opens a hand that has only finger 2, with the self-test at open. The simulated finger has these defects.
fn opened(defects: &[Defect]) -> (SimulatedPort, Result<Hand, HandError>) {
    let mut configuration = Configuration::default();
    (configuration.hand.rate, configuration.hand.watchdog_ms) = (500.0, 1000);
    (configuration.hand.fingers, configuration.hand.self_test) = (Fingers::one(FingerNumber::TWO), true);
    let board = SimulatedBoard::new(&configuration, &[FingerNumber::TWO]).expect("a board");
    let port = SimulatedPort::start(board, Pace::patient(500.0), Priority::default()).expect("a port");
    for defect in defects {
        assert_eq!(port.with_finger(2, |finger| finger.inject(defect)), Some(true), "{defect:?}");
    }
    configuration.fingers[1].port = port.path().display().to_string();
    let hand = Hand::open(configuration);
    (port, hand)
}

#[test]
fn a_finger_that_is_wired_correctly_becomes_a_spring() {
    let (_port, hand) = opened(&[]);
    let hand = hand.expect("open");
    assert_eq!(hand.report(2).expect("a report").stage, Stage::Running);
}

#[test]
fn a_finger_that_is_wired_wrongly_does_not_become_a_spring() {
    for (defect, named) in [
        (Defect::Swapped(WiredPart::Motor, 1, 3), "motors 1 and 3 are swapped"),
        (Defect::Reversed(WiredPart::Encoder, 4), "encoder 4 counts backwards"),
        (Defect::GaugeGain { gauge: 2, ratio: 0.8 }, "gauge 2 reads"),
    ] {
        let (port, hand) = opened(&[defect]);
        let refusal = hand.err().expect("wrong wiring");
        assert!(matches!(refusal, HandError::WrongWiring { finger: FingerNumber::TWO, .. }), "{refusal}");
        assert!(refusal.to_string().contains(named), "{refusal}");
        let torques = port.with_finger(2, |finger| finger.motor_torques()).expect("finger 2");
        assert_eq!(torques.amax(), 0.0);
    }
}
