//! A servo that panics does not leave the last torque on the motors, and its thread does not end the process.

use std::cell::{Cell, RefCell};
use std::rc::Rc;
use sun2xp::board::protocol::Status;
use sun2xp::board::{Link, PortError, Terms, Transport};
use sun2xp::finger::{BlackBox, Borrower, Fault, FaultKind, FingerServo, Mailbox, ServedPort, Servo, Stage, lending};
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::{Clock, CycleTiming, Schedule};
use sun2xp::realtime::{Consumer, ring};
use sun2xp::simulated::{SimulatedBoard, SimulatedCable};

const PERIOD: u64 = 1_000_000;

/// The time of the schedule's beginning, ns: after the handshake.
const FIRST: u64 = 1_000_000_000;

/// The time from which reading has a defect, ns.
const DEFECTIVE: u64 = FIRST + 300 * PERIOD;

/// A cable whose driver has a defect.
#[derive(Clone)]
struct Defective {
    cable: Rc<RefCell<SimulatedCable>>,
    /// How often it still panics.
    panics: Rc<Cell<u32>>,
}

impl Clock for Defective {
    fn now(&self) -> u64 {
        self.cable.borrow().now()
    }

    fn sleep_until(&self, deadline: u64) {
        self.cable.borrow_mut().advance_to(deadline);
    }
}

impl Transport for Defective {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        self.cable.borrow_mut().write(bytes)
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        if Transport::now(self) >= DEFECTIVE && self.panics.get() > 0 {
            self.panics.set(self.panics.get() - 1);
            panic!("the defect of this test");
        }
        self.cable.borrow_mut().read_until(buffer, deadline)
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        self.cable.borrow_mut().discard_input()
    }

    fn now(&self) -> u64 {
        self.cable.borrow().now()
    }
}

type Uncollected = (Consumer<CycleTiming>, BlackBox, Borrower<Defective>);

fn servo(panics: u32) -> (Defective, Servo<Defective, Defective>, Mailbox, Uncollected) {
    let configuration = Configuration::default();
    let (hand, finger) = (&configuration.hand, &configuration.fingers[0]);
    let board = SimulatedBoard::new(&configuration, &[0]).expect("a board");
    let cable = Rc::new(RefCell::new(SimulatedCable::new(board)));
    let here = Defective { cable, panics: Rc::new(Cell::new(panics)) };
    let mut link = Link::new(here.clone());
    let (identity, configured) = link.shake_hands(1, &Terms::new(hand, finger), FIRST).expect("a handshake");
    let (recorder, black_box) = BlackBox::new(&configuration, 0);
    let (producer, timings) = ring(16);
    let stiffness = finger.initial_stiffness();
    let (finger, mailbox) =
        FingerServo::new(&configuration, 0, stiffness, &identity, &configured, producer, recorder).expect("a finger");
    let (lender, borrower) = lending();
    let ports = vec![ServedPort::new(link, vec![finger]).lent_through(lender)];
    let servo = Servo::new(here.clone(), Schedule::new(FIRST, PERIOD), ports);
    (here, servo, mailbox, (timings, black_box, borrower))
}

#[test]
fn a_panic_in_a_cycle_stops_the_board_and_faults_the_finger() {
    // Once; and again whatever is read, also while the board is told to stop.
    for panics in [1, u32::MAX] {
        let (here, mut servo, mailbox, (_timings, _black_box, mut borrower)) = servo(panics);
        while Clock::now(&here) + 2 * PERIOD < DEFECTIVE {
            servo.cycle();
        }
        let pulling = here.cable.borrow_mut().board().fingers()[0].motor_torques();
        assert!(pulling.amax() > 0.1, "nothing to let go: {pulling}");

        // Returns: a panic that left it would fail this test.
        servo.run();
        assert!(here.panics.get() < panics, "no panic");
        let stage = mailbox.report().stage;
        assert!(matches!(stage, Stage::Faulted(Fault { kind: FaultKind::ServoPanic, .. })), "{stage:?}");
        assert!(mailbox.send(|_| {}).is_err(), "calls are refused");
        assert!(borrower.lent.is_abandoned() && borrower.lent.pop().is_none(), "whoever mends ports knows of it");
        let mut cable = here.cable.borrow_mut();
        let finger = &mut cable.board().fingers()[0];
        let status = finger.status();
        assert!(status.has(Status::ENDED) && !status.has(Status::WATCHDOG_TRIPPED), "{status:?}");
        assert_eq!(finger.motor_torques().amax(), 0.0);
    }
}
