//! A finger with its servo, its link and its board in memory, on simulated time. The link can be repaired after a
//! fault.

use crate::finger_on_a_cable::{Hooks, ServedFinger, World};
use nalgebra::{Vector3, Vector4};
use std::cell::RefCell;
use std::rc::Rc;
use sun2xp::board::protocol::{Frame, Message, WireFrame};
use sun2xp::board::{PortError, Terms, Transport};
use sun2xp::finger::events::EventReader;
use sun2xp::finger::{
    BlackBox, Elements, Fault, FaultKind, FingerReport, GroupGate, LinkRepairEnd, Mailbox, Reflexes, RepairedLink,
    Replaced, RestoredBoard, Servo, Stage, StopCounts, stop_calls,
};
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::{Clock, Schedule};
use sun2xp::simulated::{SimulatedCable, SimulatedFinger};

pub const MILLISECOND: u64 = 1_000_000;

/// Joint angles of a pose, rad.
pub const TARGET: Vector3<f64> = Vector3::new(0.2, 0.6, 1.1);

type Read = Result<Vec<u8>, PortError>;

/// Replaces the board's answers before the host reads them.
#[derive(Default)]
pub struct Line {
    /// The result that the next read returns instead of the board's answer.
    instead: Option<Read>,
    /// The frame that every read returns instead of the board's answers.
    flood: Option<Flood>,
    /// The mailbox in which the last set point will be corrected, and the number of readings of the clock until then.
    correction: RefCell<Option<(u32, Rc<Mailbox>)>>,
}

/// A frame that is repeated without end.
struct Flood {
    wire: Vec<u8>,
    reads: u32,
}

/// Duration of a read during the flood, ns.
const FLOODED_READ: u64 = 10_000;

/// Limit on the reads during a flood. No test needs that many. Without this limit a failing test would never end.
const MOST_FLOODED_READS: u32 = 1_000_000;

impl Hooks for Line {
    fn read_until(&mut self, cable: &mut SimulatedCable, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        if let Some(Flood { wire, reads }) = &mut self.flood {
            *reads += 1;
            assert!(*reads < MOST_FLOODED_READS, "no end of reading");
            cable.advance_to(cable.now() + FLOODED_READ);
            buffer.chunks_exact_mut(wire.len()).for_each(|place| place.copy_from_slice(wire));
            return Ok(buffer.len() / wire.len() * wire.len());
        }
        match self.instead.take() {
            Some(Err(failure)) => Err(failure),
            Some(Ok(bytes)) => {
                buffer[..bytes.len()].copy_from_slice(&bytes);
                Ok(bytes.len())
            }
            None => cable.read_until(buffer, deadline),
        }
    }

    fn now(&self, cable: &SimulatedCable) -> u64 {
        let mut correction = self.correction.borrow_mut();
        if let Some((left, mailbox)) = &mut *correction {
            if *left == 0 {
                let sent = mailbox.sent();
                mailbox.correct(Replaced::Place, &sent, sent).expect("not faulted");
                *correction = None;
            } else {
                *left -= 1;
            }
        }
        cable.now()
    }
}

/// Finger 1 with its servo, link and board.
pub struct Bench {
    pub world: World<Line>,
    pub servo: Servo<World<Line>, World<Line>>,
    pub mailbox: Rc<Mailbox>,
    pub touch: Elements,
    pub reflexes: Reflexes,
    pub black_box: BlackBox,
    pub events: EventReader,
    pub gate: GroupGate,
    pub repair_end: LinkRepairEnd<World<Line>>,
    /// The configuration of the board.
    configuration: Configuration,
}

impl Bench {
    /// Opens the finger of the default configuration and waits until it is a spring.
    pub fn new() -> Self {
        Self::with(|_| {})
    }

    /// Opens the finger of a changed default configuration and waits until it is a spring.
    pub fn with(change: impl FnOnce(&mut Configuration)) -> Self {
        let mut bench = Self::believing(change, |_| {});
        bench.opens();
        bench
    }

    /// Constructs a finger that opens in the next periods. `is` changes the configuration of the board and of the
    /// servo. `believed` then changes only the configuration of the servo, so that the two configurations differ.
    pub fn believing(is: impl FnOnce(&mut Configuration), believed: impl FnOnce(&mut Configuration)) -> Self {
        let mut configuration = Configuration::default();
        // The port must not be "simulated": the time limits of a built-in board are longer.
        configuration.fingers[0].port = "in memory".into();
        is(&mut configuration);
        let mut belief = configuration.clone();
        believed(&mut belief);
        let world = World::new(&configuration, Line::default());
        let gate = GroupGate::new();
        let schedule = Schedule::new(Clock::now(&world) + MILLISECOND, MILLISECOND);
        let ServedFinger { servo, mailbox, repair_end, touch, reflexes, events, black_box, .. } =
            ServedFinger::in_thread(&world, &configuration, &belief, schedule, |finger| finger.in_groups(gate.clone()));
        let (events, mailbox) = (events.reader(), Rc::new(mailbox));
        Self { world, servo, mailbox, black_box, touch, reflexes, events, gate, repair_end, configuration }
    }

    pub fn report(&self) -> FingerReport {
        self.mailbox.report()
    }

    pub fn stage(&self) -> Stage {
        self.report().stage
    }

    /// The fault that has stopped the finger.
    pub fn fault(&self) -> Option<Fault> {
        match self.stage() {
            Stage::Faulted(fault) => Some(fault),
            _ => None,
        }
    }

    /// The newest present warning of the finger.
    pub fn warning(&self) -> Option<Fault> {
        self.report().warnings.newest()
    }

    pub fn with_cable<R>(&self, act: impl FnOnce(&mut SimulatedCable) -> R) -> R {
        act(&mut self.world.place().cable)
    }

    pub fn with_finger<R>(&self, act: impl FnOnce(&mut SimulatedFinger) -> R) -> R {
        self.with_cable(|cable| act(cable.board().finger(1).expect("the board has finger 1")))
    }

    /// Torques that the motors give, N cm.
    pub fn executed(&self) -> Vector4<f64> {
        self.with_finger(|finger| finger.motor_torques())
    }

    /// Makes the next read of the port fail with this error.
    pub fn fail_port(&self, failure: PortError) {
        self.world.place().hooks.instead = Some(Err(failure));
    }

    /// Makes the next read of the port return this frame. The board's own answer comes after it.
    pub fn answer_with(&self, frame: Frame) {
        let wire = WireFrame::new(&Message { address: 1, sequence: 200, frame });
        self.world.place().hooks.instead = Some(Ok(wire.as_bytes().to_vec()));
    }

    /// Starts a flood: every read returns copies of this frame, and the board's answers do not reach the host.
    pub fn flood_with(&self, frame: Frame) {
        let wire = WireFrame::new(&Message { address: 1, sequence: 200, frame }).as_bytes().to_vec();
        self.world.place().hooks.flood = Some(Flood { wire, reads: 0 });
    }

    pub fn end_flood(&self) {
        self.world.place().hooks.flood = None;
    }

    /// Corrects the last set point when the servo has read the clock `readings` times and reads it again. The
    /// correction changes no value.
    pub fn correct_after(&self, readings: u32) {
        self.world.place().hooks.correction = RefCell::new(Some((readings, self.mailbox.clone())));
    }

    /// Returns whether the correction of [`Bench::correct_after`] has been made.
    pub fn corrected(&self) -> bool {
        self.world.place().hooks.correction.borrow().is_none()
    }

    /// Sends this frame to the finger's board, as another program on the same port would. The first reader of the port
    /// gets the answer.
    pub fn another_program_sends(&mut self, frame: Frame) {
        let message = Message { address: 1, sequence: 200, frame };
        self.world.write(WireFrame::new(&message).as_bytes()).expect("written");
    }

    /// Runs the given number of periods.
    pub fn cycles(&mut self, count: usize) {
        for _ in 0..count {
            self.servo.cycle();
        }
    }

    /// Runs periods until the condition holds. Panics if it does not hold within 10 000 periods.
    pub fn until(&mut self, what: &str, wanted: impl Fn(&Self) -> bool) {
        for _ in 0..10_000 {
            if wanted(self) {
                return;
            }
            self.servo.cycle();
        }
        panic!("not {what}: {:?}, warned of {:?}", self.stage(), self.warning());
    }

    /// Runs periods until the finger is a spring.
    pub fn opens(&mut self) {
        self.until("a spring", |bench| bench.stage() != Stage::Opening);
        assert_eq!(self.stage(), Stage::Running);
    }

    /// Sends the finger to a pose, and checks that it arrives.
    pub fn goes(&mut self, joints: Vector3<f64>) {
        self.mailbox.send(|set_point| set_point.joints = joints).expect("not faulted");
        self.cycles(1500);
        let off = (self.report().cycle.joints - joints).amax();
        assert!(off < 0.03, "off by {off} rad");
    }

    /// Runs periods until this fault stops the finger.
    pub fn faults(&mut self, kind: FaultKind) -> Fault {
        self.until("faulted", |bench| bench.fault().is_some());
        let fault = self.fault().expect("faulted");
        assert_eq!(fault.kind, kind, "{fault}");
        fault
    }

    /// Runs periods until the finger has this warning. It must keep running.
    pub fn warns(&mut self, kind: FaultKind) -> Fault {
        self.until(&format!("warned of {kind:?}"), |bench| {
            assert_eq!(bench.fault(), None);
            bench.warning().is_some_and(|warning| warning.kind == kind)
        });
        self.warning().expect("warned")
    }

    /// Takes the link from the servo, shakes hands with the board and gives the link back to the servo. The finger then
    /// takes up slack.
    pub fn repair(&mut self) {
        self.repair_after(0);
    }

    /// Repairs the link, as `repair` does. `restarts` is the number of restarts of the board since open.
    pub fn repair_after(&mut self, restarts: u32) {
        self.until("at rest", |bench| !bench.repair_end.released.is_empty());
        let mut link = self.repair_end.released.pop().expect("released").link;
        let terms = Terms::new(&self.configuration.hand, &self.configuration.fingers[0]);
        let deadline = Transport::now(&self.world) + 1000 * MILLISECOND;
        let (_, configured) = link.shake_hands(1, &terms, deadline).expect("the board answers");
        let stops = StopCounts { calls: stop_calls(), of_finger: self.mailbox.stops(), ..StopCounts::default() };
        let restored = RestoredBoard { configured, stops, restarts };
        let repaired = RepairedLink { link, boards: [Some(restored), None, None] };
        assert!(self.repair_end.repaired.push(repaired).is_ok());
        self.cycles(1);
        assert_eq!(self.stage(), Stage::Opening);
    }
}
