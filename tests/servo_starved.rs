//! A servo and its simulated board on a machine that delays the servo, the board and the carrier. The carrier is the
//! part of the system that moves bytes between the servo and the board. The machine's clock is simulated too.

#[allow(dead_code)]
#[path = "common/finger_on_a_cable.rs"]
mod finger_on_a_cable;

use finger_on_a_cable::ServedFinger;
use nalgebra::Vector3;
use rand_distr::{Distribution, Exp};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use sun2xp::board::{PortError, Transport};
use sun2xp::finger::{Fault, FaultKind, FingerReport, Stage};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::Clock;
use sun2xp::simulated::{Pace, PacedTime, SimulatedBoard};

/// Time grid of all events, ns.
const STEP: u64 = 50_000;

/// Period of the board's thread, ns.
const TICK: u64 = 1_000_000;

const MILLISECOND: u64 = 1_000_000;

/// Waiting times on the machine: means of exponential distributions, ms.
#[derive(Clone, Copy, Debug, Default)]
struct Load {
    /// The carrier of the bytes.
    carrier: f64,
    board: f64,
    servo: f64,
}

/// A host, a cable and a board.
struct World {
    now: u64,
    load: Load,
    random: Pcg64,
    board: SimulatedBoard,
    time: PacedTime,
    to_board: Vec<u8>,
    carried: Vec<u8>,
    from_board: Vec<u8>,
    to_host: VecDeque<u8>,
    /// Next run of the carrier, ns.
    carrier_runs: u64,
    /// Next run of the board's thread, ns.
    board_runs: u64,
}

impl World {
    fn wait(&mut self, mean: f64) -> u64 {
        if mean == 0.0 {
            return 0;
        }
        let milliseconds = Exp::new(1.0 / mean).expect("a mean").sample(&mut self.random);
        (milliseconds * MILLISECOND as f64) as u64
    }

    /// The true joint angles, rad.
    fn pose(&mut self) -> Vector3<f64> {
        self.board.fingers()[0].plant().joints()
    }

    fn advance_to(&mut self, time: u64) {
        while self.now < time {
            self.now = time.min(self.now + STEP);
            if self.now >= self.carrier_runs && !(self.to_board.is_empty() && self.from_board.is_empty()) {
                self.carried.append(&mut self.to_board);
                self.to_host.extend(self.from_board.drain(..));
                self.carrier_runs = self.now + self.wait(self.load.carrier);
            }
            if self.now >= self.board_runs || (!self.carried.is_empty() && self.load.board == 0.0) {
                let bytes = std::mem::take(&mut self.carried);
                let board_time = self.time.wake(self.now, !bytes.is_empty());
                let from_board = &mut self.from_board;
                self.board.receive(board_time, &bytes, &mut |answer| from_board.extend(answer));
                self.board_runs = self.now + self.wait(self.load.board).max(TICK);
            }
        }
    }
}

#[derive(Clone)]
struct Here(Rc<RefCell<World>>);

impl Clock for Here {
    fn now(&self) -> u64 {
        self.0.borrow().now
    }

    fn sleep_until(&self, deadline: u64) {
        let mut world = self.0.borrow_mut();
        let late = world.load.servo;
        let late = world.wait(late);
        world.advance_to(deadline + late);
    }
}

impl Transport for Here {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        self.0.borrow_mut().to_board.extend(bytes);
        Ok(bytes.len())
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        let mut world = self.0.borrow_mut();
        while world.to_host.is_empty() && world.now < deadline {
            let next = deadline.min(world.now + STEP);
            world.advance_to(next);
        }
        let taken = buffer.len().min(world.to_host.len());
        for (place, byte) in buffer.iter_mut().zip(world.to_host.drain(..taken)) {
            *place = byte;
        }
        Ok(taken)
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        self.0.borrow_mut().to_host.clear();
        Ok(())
    }

    fn now(&self) -> u64 {
        self.0.borrow().now
    }
}

struct Rig {
    world: Rc<RefCell<World>>,
    finger: ServedFinger<Here>,
}

impl Rig {
    /// The finger may take `open_timeout_ms`, measured by the machine's clock, to come under tension.
    fn new(seed: u64, open_timeout_ms: u32) -> Self {
        let mut configuration = Configuration::default();
        configuration.hand.open_timeout_ms = open_timeout_ms;
        let world = Rc::new(RefCell::new(World {
            now: 0,
            load: Load::default(),
            random: Pcg64::seed_from_u64(seed),
            board: SimulatedBoard::new(&configuration, &[FingerNumber::ONE]).expect("a board"),
            time: PacedTime::new(Pace::patient(configuration.hand.rate), 0),
            to_board: Vec::new(),
            carried: Vec::new(),
            from_board: Vec::new(),
            to_host: VecDeque::new(),
            carrier_runs: 0,
            board_runs: 0,
        }));
        let finger = ServedFinger::new(&Here(world.clone()), &configuration);
        Self { world, finger }
    }

    /// Runs cycles for the given time by the machine's clock.
    fn run(&mut self, seconds: f64) {
        let end = self.world.borrow().now + (seconds * 1e9) as u64;
        while self.world.borrow().now < end {
            self.finger.servo.cycle();
        }
    }

    /// Runs cycles until the report is as wanted, for at most the given time by the machine's clock.
    fn run_until(&mut self, seconds: f64, wanted: impl Fn(&FingerReport) -> bool) {
        let end = self.world.borrow().now + (seconds * 1e9) as u64;
        while !wanted(&self.finger.mailbox.report()) && self.world.borrow().now < end {
            self.finger.servo.cycle();
        }
    }
}

#[test]
fn a_simulated_finger_survives_a_machine_that_runs_nothing_in_time() {
    let none = Load::default();
    for load in [
        Load { carrier: 0.5, ..none },
        Load { carrier: 5.0, ..none },
        Load { board: 3.0, ..none },
        Load { board: 10.0, ..none },
        Load { servo: 3.0, ..none },
        Load { servo: 10.0, ..none },
        Load { carrier: 2.0, board: 2.0, servo: 2.0 },
    ] {
        for seed in 0..3 {
            let mut rig = Rig::new(seed, 60_000);
            let start = rig.world.borrow_mut().pose();
            rig.world.borrow_mut().load = load;
            // The board's time passes more slowly than the machine's clock, so opening takes longer than without load.
            rig.run_until(60.0, |report| report.stage != Stage::Opening);
            let report = rig.finger.mailbox.report();
            assert_eq!(report.stage, Stage::Running, "{load:?}, {seed}: {report:?}");
            let turned = (rig.world.borrow_mut().pose() - start).amax();
            assert!(turned < 0.02, "{load:?}, {seed}: turned by {turned} rad while slack was taken up");

            let target = Vector3::new(0.2, 0.6, 1.1);
            rig.finger.mailbox.send(|set_point| set_point.joints = target).expect("under control");
            let arrived = |report: &FingerReport| {
                (report.cycle.joints - target).amax() < 0.01 && report.cycle.joint_rates.amax() < 0.5
            };
            rig.run_until(60.0, arrived);
            let off = (rig.world.borrow_mut().pose() - target).amax();
            assert!(off < 0.02, "{load:?}, {seed}: {off} rad away, {:?}", rig.finger.mailbox.report());
        }
    }
}

/// While the servo does not run, sun2xp_status counts the missing periods. When the servo runs again, it counts the
/// same number, or up to two more.
#[test]
fn skipped_periods_are_counted_before_the_servo_runs_again() {
    let mut rig = Rig::new(0, 60_000);
    rig.run_until(60.0, |report| report.stage != Stage::Opening);
    let before = rig.finger.mailbox.report();
    let missing = |rig: &Rig| rig.finger.mailbox.report().missing_periods(rig.world.borrow().now, MILLISECOND);
    assert_eq!(missing(&rig), 0);
    let mut most = 0;
    for pause in [1, 3, 900, 1800] {
        let now = rig.world.borrow().now;
        rig.world.borrow_mut().advance_to(now + pause * MILLISECOND);
        let periods = missing(&rig);
        assert!(periods + 2 >= pause && periods >= most, "{periods} of {pause}");
        most = periods;
    }
    rig.finger.servo.cycle();
    let counted = rig.finger.mailbox.report().losses.skipped_periods - before.losses.skipped_periods;
    assert!((most..=most + 2).contains(&counted), "{most} were missing, and {counted} are counted");
    assert_eq!(missing(&rig), 0);
}

#[test]
fn a_discarded_command_or_reply_is_repeated() {
    let mut rig = Rig::new(0, 60_000);
    rig.run_until(60.0, |report| report.stage != Stage::Opening);
    for _ in 0..3 {
        rig.run(0.01);
        {
            let mut world = rig.world.borrow_mut();
            world.load.carrier = 1e9;
            world.carrier_runs = u64::MAX;
        }
        rig.run(0.005);
        {
            let mut world = rig.world.borrow_mut();
            world.to_board.clear();
            world.from_board.clear();
            world.load.carrier = 0.0;
            world.carrier_runs = 0;
        }
        let lost = rig.finger.mailbox.report().losses.lost_replies;
        rig.run(0.3);
        let report = rig.finger.mailbox.report();
        assert_eq!(report.stage, Stage::Running);
        // The command is repeated after 0.1 s.
        assert!((75..125).contains(&(report.losses.lost_replies - lost)), "{report:?}");
    }
}

#[test]
fn a_simulated_board_that_never_answers_again_faults_its_finger() {
    let mut rig = Rig::new(0, 60_000);
    rig.run_until(60.0, |report| report.stage != Stage::Opening);
    rig.world.borrow_mut().carrier_runs = u64::MAX;
    rig.run(4.9);
    assert_eq!(rig.finger.mailbox.report().stage, Stage::Running);
    rig.run(0.2);
    let stage = rig.finger.mailbox.report().stage;
    assert!(matches!(stage, Stage::Faulted(Fault { kind: FaultKind::LostReplies, .. })), "{stage:?}");
}

#[test]
fn a_finger_that_an_overloaded_machine_keeps_from_opening_faults_at_the_time_out() {
    let mut rig = Rig::new(0, 1500);
    // Either the carrier stops after its next run, or every wake-up is late.
    for load in [Load { carrier: 1e9, ..Load::default() }, Load { servo: 30.0, ..Load::default() }] {
        rig.world.borrow_mut().load = load;
        let begun = rig.world.borrow().now;
        rig.run_until(60.0, |report| report.stage != Stage::Opening);
        let stage = rig.finger.mailbox.report().stage;
        assert!(matches!(stage, Stage::Faulted(Fault { kind: FaultKind::OpeningTimedOut, .. })), "{stage:?}");
        let lasted = (rig.world.borrow().now - begun) as f64 / MILLISECOND as f64;
        assert!((1400.0..1900.0).contains(&lasted), "{lasted} ms");
        rig = Rig::new(0, 1500);
    }
}
