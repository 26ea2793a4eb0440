//! Fingers on simulated boards behind pseudo-terminals. The caller runs their servos with a clock of its choice.

use crate::Failure;
use sun2xp::board::{Link, Port, Terms};
use sun2xp::finger::{BlackBox, FingerServo, Mailbox, ServedPort};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, FINGERS};
use sun2xp::realtime::{Consumer, ring};
use sun2xp::realtime::{CycleTiming, Priority, Schedule, now};
use sun2xp::simulated::{Pace, SimulatedBoard, SimulatedPort};

/// One finger: the parts for its planner, its servo thread and its board.
pub struct Finger {
    pub mailbox: Mailbox,
    pub port: ServedPort<Port>,
    pub schedule: Schedule,
    /// Beginning of the first period, ns.
    pub start: u64,
    /// The board. It runs until this value is dropped.
    pub board: SimulatedPort,
    /// The receivers of the servo's timings and records. They must outlive the servo, even if nothing reads them.
    pub uncollected: (Consumer<CycleTiming>, BlackBox),
}

/// Connects to all fingers of a hand, each on its own port. `period` is in ns. The phases of the fingers are staggered.
pub fn reach(configuration: &Configuration, period: u64, board_priority: u8) -> Result<Vec<Finger>, Failure> {
    reach_with(configuration, period, board_priority, |_, servo| servo)
}

/// Does the same as [`reach`], but `change` changes the servo of each finger.
pub fn reach_with(
    configuration: &Configuration,
    period: u64,
    board_priority: u8,
    mut change: impl FnMut(FingerNumber, FingerServo) -> FingerServo,
) -> Result<Vec<Finger>, Failure> {
    let first = now() + 100_000_000;
    let reach_one = |number: FingerNumber| {
        let finger = &configuration.fingers[number.index()];
        let board = SimulatedBoard::new(configuration, &[number])?;
        let pace = Pace::patient(configuration.hand.rate);
        let board = SimulatedPort::start(board, pace, Priority { fifo: board_priority, core: None })?;
        let mut link = Link::open(&board.path(), finger.baud)?;
        let terms = Terms::new(&configuration.hand, finger);
        let deadline = now() + 10_000_000_000;
        let (identity, configured) = link.shake_hands(configuration.address(number), &terms, deadline)?;
        let (producer, timings) = ring(16);
        let stiffness = finger.initial_stiffness();
        let (recorder, black_box) = BlackBox::new(configuration, number);
        let (servo, mailbox) =
            FingerServo::new(configuration, number, stiffness, &identity, &configured, (producer, recorder))
                .map_err(|unusable| unusable.reason)?;
        let start = first + period * number.index() as u64 / FINGERS as u64;
        Ok(Finger {
            mailbox,
            port: ServedPort::new(link, vec![change(number, servo)]),
            schedule: Schedule::new(start, period),
            start,
            board,
            uncollected: (timings, black_box),
        })
    };
    FingerNumber::ALL.into_iter().map(reach_one).collect()
}
