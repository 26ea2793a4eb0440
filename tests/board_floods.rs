//! A board that sends valid frames without end. Every deadline of the link must still hold.

use sun2xp::board::protocol::*;
use sun2xp::board::{Link, LinkError, PortError, Terms, Transport};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger, ConfiguredHand};
use sun2xp::simulated::SimulatedBoard;

const MS: u64 = 1_000_000;

/// Duration of one read, ns.
const READ: u64 = 10_000;

/// More reads than any call may need. Without this bound a failing test would never end.
const MOST_READS: u32 = 100_000;

/// Largest overrun of a call, ns: one read may begin before the deadline and end after it, and one more read may
/// follow.
const LATE: u64 = 2 * READ;

/// A simulated board that at some point begins to send the same frame again and again, and nothing else.
struct Flood {
    board: SimulatedBoard,
    frame: Frame,
    /// Sequence number of that frame.
    sequence: u8,
    /// Type of the request that triggers the flood.
    begins_with: Option<Kind>,
    /// Whether that frame gets the sequence number of each request of the type `begins_with`, as an answer does.
    answers_all: bool,
    begun: bool,
    answers: Vec<u8>,
    now: u64,
    /// Duration of a read, ns.
    read_time: u64,
    reads: u32,
}

impl Flood {
    fn of(frame: Frame) -> Self {
        Self {
            board: SimulatedBoard::new(&Configuration::default(), &[FingerNumber::ONE]).expect("a board"),
            frame,
            sequence: 200,
            begins_with: None,
            answers_all: false,
            begun: true,
            answers: Vec::new(),
            now: 0,
            read_time: READ,
            reads: 0,
        }
    }

    /// The flood begins when the host sends a frame of this type, which is not answered.
    fn beginning_with(self, kind: Kind) -> Self {
        Self { begins_with: Some(kind), begun: false, ..self }
    }
}

impl Transport for Flood {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        let mut decoder = Decoder::default();
        let mut rest = bytes;
        while let Some(packet) = decoder.next(&mut rest) {
            if self.begins_with.is_some_and(|kind| packet.kind() == kind as u8) {
                self.begun = true;
                self.sequence = if self.answers_all { packet.sequence() } else { self.sequence };
            }
        }
        if !self.begun {
            let answers = &mut self.answers;
            self.board.receive(self.now, bytes, &mut |answer| answers.extend(answer));
        }
        Ok(bytes.len())
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        self.reads += 1;
        assert!(self.reads < MOST_READS, "no end after {} reads", self.reads);
        if !self.begun && self.answers.is_empty() {
            self.now = self.now.max(deadline);
            return Ok(0);
        }
        self.now += self.read_time;
        if self.begun {
            let message = Message { address: 1, sequence: self.sequence, frame: self.frame };
            let wire = WireFrame::new(&message);
            self.answers.extend(wire.as_bytes().repeat(buffer.len() / wire.as_bytes().len()));
        }
        let taken = self.answers.len().min(buffer.len());
        for (place, byte) in buffer.iter_mut().zip(self.answers.drain(..taken)) {
            *place = byte;
        }
        Ok(taken)
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        self.answers.clear();
        Ok(())
    }

    fn now(&self) -> u64 {
        self.now
    }
}

/// Frames that nothing waits for, one of each type that a board sends.
fn unasked() -> [Frame; 6] {
    let identity = Identity {
        version: VERSION,
        addresses: 2,
        board_kind: 0,
        unique_number: [7; 12],
        firmware: FirmwareVersion([0; 3]),
        counts_per_revolution: 0,
        gauge_bits: 12,
        torque_unit: 2000,
        torque_limit: 30_000,
        shortest_watchdog_ms: 2,
        capabilities: Capabilities(0),
    };
    [
        Frame::Reply(Reply::default()),
        Frame::Identity(identity),
        Frame::Configured(Configured::default()),
        Frame::Stopped(Stopped::default()),
        Frame::Refused(Refused { request: Kind::Configure as u8, reason: Reason::Running, detail: 0 }),
        Frame::TactileEvent(TactileEvent::default()),
    ]
}

fn terms() -> Terms {
    Terms::new(&ConfiguredHand::default(), &ConfiguredFinger::default())
}

#[test]
fn a_receive_ends_at_its_deadline() {
    for frame in unasked().into_iter().filter(|frame| frame.kind() != Kind::Reply) {
        let mut link = Link::new(Flood::of(frame));
        for _ in 0..10 {
            let deadline = link.transport().now + MS;
            assert_eq!(link.receive(deadline).expect("the port is there"), None, "{frame:?}");
            assert!(link.transport().now <= deadline + LATE, "{frame:?}");
            // A deadline in the past still allows one read.
            let before = link.transport().reads;
            assert_eq!(link.receive(0).expect("the port is there"), None, "{frame:?}");
            assert!(link.transport().reads <= before + 1, "{frame:?}");
        }
    }
}

/// The clock of a paused virtual machine may stand still for some time.
#[test]
fn a_receive_ends_though_its_clock_stands_still() {
    let mut flood = Flood::of(Frame::Stopped(Stopped::default()));
    flood.read_time = 0;
    let mut link = Link::new(flood);
    assert_eq!(link.receive(MS).expect("the port is there"), None);
    assert!(link.transport().reads <= 20, "{} reads", link.transport().reads);
}

#[test]
fn a_handshake_ends_at_its_deadline_and_names_the_unanswered_frame() {
    let deadline = 300 * MS;
    for frame in unasked() {
        for asked in [Kind::Hello, Kind::Configure] {
            let mut link = Link::new(Flood::of(frame).beginning_with(asked));
            let error = link.shake_hands(1, &terms(), deadline).expect_err("the flood is no answer");
            let unanswered = matches!(error, LinkError::Unanswered { address: 1, request } if request == asked);
            assert!(unanswered, "{frame:?} instead of the answer to {asked:?}: {error}");
            assert!(link.transport().now <= deadline + LATE, "{frame:?}, {asked:?}");
        }
    }
}

/// A board whose motors are enabled refuses a Configure. The host retries until the watchdog has disabled them.
#[test]
fn a_handshake_with_a_board_that_refuses_without_end_ends_at_its_deadline() {
    let deadline = 300 * MS;
    let refused = Refused { request: Kind::Configure as u8, reason: Reason::Running, detail: 0 };
    let flood = Flood::of(Frame::Refused(refused)).beginning_with(Kind::Configure);
    let mut link = Link::new(Flood { answers_all: true, ..flood });
    let error = link.shake_hands(1, &terms(), deadline).expect_err("refused");
    assert!(matches!(error, LinkError::Refused { address: 1, refused: reported } if reported == refused), "{error}");
    assert!(link.transport().now <= deadline + LATE);
}

#[test]
fn a_stop_is_sent_and_ends_at_its_deadline() {
    for frame in unasked() {
        let mut link = Link::new(Flood::of(frame));
        // A deadline in the past, which a servo passes in order not to wait for the confirmation.
        assert!(!link.stop(1, 0).expect("the port is there"), "{frame:?}");
        assert!(link.transport().reads <= 1, "{frame:?}");
        let deadline = link.transport().now + 100 * MS;
        assert!(!link.stop(1, deadline).expect("the port is there"), "{frame:?}");
        assert!(link.transport().now <= deadline + LATE, "{frame:?}");
    }
}
