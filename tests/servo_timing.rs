//! Periods of a servo on simulated time: what is late is counted and skipped, the age of the feedback, and the board's clock.

use nalgebra::Matrix3;
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use sun2xp::board::{Link, PortError, Terms, Transport};
use sun2xp::finger::{BlackBox, FingerServo, Mailbox, ServedPort, Servo};
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::{Clock, CycleTiming, Distribution, Histograms, Schedule, Stage};
use sun2xp::realtime::{Consumer, ring};
use sun2xp::simulated::{SimulatedBoard, SimulatedCable};

const PERIOD: u64 = 1_000_000;

/// When the servo's schedule begins, ns: after the handshake.
const FIRST: u64 = 1_000_000_000;

/// A host and a board, whose clock may be faster than the host's.
struct World {
    now: Cell<u64>,
    drift: f64,
    cable: RefCell<SimulatedCable>,
    /// How late the host's thread is woken next time, ns.
    oversleep: Cell<u64>,
    /// Beginnings of cycles on the board's clock, ns.
    beginnings: RefCell<Vec<u64>>,
    /// Replies are kept back.
    withheld: Cell<bool>,
}

#[derive(Clone)]
struct Here(Rc<World>);

impl World {
    fn advance_to(&self, time: u64) {
        self.now.set(self.now.get().max(time));
        self.cable.borrow_mut().advance_to(self.board_time());
    }

    fn board_time(&self) -> u64 {
        (self.now.get() as f64 * (1.0 + self.drift)) as u64
    }
}

impl Clock for Here {
    fn now(&self) -> u64 {
        self.0.now.get()
    }

    fn sleep_until(&self, deadline: u64) {
        self.0.advance_to(deadline + self.0.oversleep.take());
        self.0.beginnings.borrow_mut().push(self.0.board_time());
    }
}

impl Transport for Here {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        self.0.cable.borrow_mut().write(bytes)
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        let board_time = self.0.board_time();
        let taken = match self.0.withheld.get() {
            true => 0,
            // No more than what is there: time passes here and not in the cable.
            false => self.0.cable.borrow_mut().read_until(buffer, board_time)?,
        };
        if taken == 0 {
            self.0.advance_to(deadline);
        }
        Ok(taken)
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        self.0.cable.borrow_mut().discard_input()
    }

    fn now(&self) -> u64 {
        self.0.now.get()
    }
}

struct Rig {
    world: Rc<World>,
    servo: Servo<Here, Here>,
    mailbox: Mailbox,
    timings: Consumer<CycleTiming>,
}

impl Rig {
    fn new(drift: f64, follow: bool) -> Self {
        let mut configuration = Configuration::default();
        // Not "simulated": a built-in finger stands still where replies stay away.
        configuration.fingers[0].port = "/dev/cable".into();
        let board = SimulatedBoard::new(&configuration, &[0]).expect("a board");
        let world = Rc::new(World {
            now: Cell::new(0),
            drift,
            cable: RefCell::new(SimulatedCable::new(board)),
            oversleep: Cell::new(0),
            beginnings: RefCell::default(),
            withheld: Cell::new(false),
        });
        let mut link = Link::new(Here(world.clone()));
        let terms = Terms::new(&configuration.hand, &configuration.fingers[0]);
        let (identity, configured) = link.shake_hands(1, &terms, FIRST).expect("the board answers");
        let (producer, timings) = ring(100_000);
        let stiffness = Matrix3::from_diagonal_element(3.0);
        // Nobody reads it.
        let (recorder, _) = BlackBox::new(&configuration, 0);
        let (finger, mailbox) =
            FingerServo::new(&configuration, 0, stiffness, &identity, &configured, producer, recorder)
                .expect("a finger");
        let ports = vec![ServedPort::new(link, vec![finger])];
        let mut servo = Servo::new(Here(world.clone()), Schedule::new(FIRST, PERIOD), ports);
        if follow {
            servo = servo.following_board();
        }
        Self { world, servo, mailbox, timings }
    }

    fn cycles(&mut self, count: usize) {
        (0..count).for_each(|_| self.servo.cycle());
    }

    /// Of the cycles since the last call.
    fn age(&mut self) -> Distribution {
        let mut histograms = Histograms::new();
        while let Some(timing) = self.timings.pop() {
            histograms.record(&timing);
        }
        histograms.distribution(Stage::Age)
    }

    /// The mean of the last `cycles` periods, ns of the board's clock.
    fn board_period(&self, cycles: usize) -> f64 {
        let beginnings = self.world.beginnings.borrow();
        let last = beginnings.len() - 1;
        (beginnings[last] - beginnings[last - cycles]) as f64 / cycles as f64
    }
}

#[test]
fn a_late_cycle_is_run_late_and_nothing_is_made_up() {
    let mut rig = Rig::new(0.0, false);
    rig.cycles(10);
    let losses = rig.mailbox.report().losses;
    assert_eq!((losses.cycles, losses.overruns, losses.skipped_periods, losses.lost_replies), (10, 0, 0, 0));

    // 3.4 periods late: that cycle runs, three periods are gone, and the one after them begins at once.
    rig.world.oversleep.set(3 * PERIOD + 400_000);
    rig.cycles(6);
    let losses = rig.mailbox.report().losses;
    assert_eq!((losses.cycles, losses.overruns, losses.skipped_periods), (16, 1, 2));
    let beginnings: Vec<u64> = rig.world.beginnings.borrow()[10..].iter().map(|at| (at - FIRST) / 1000).collect();
    assert_eq!(beginnings, [13_400, 13_400, 14_000, 15_000, 16_000, 17_000], "us");
}

#[test]
fn feedback_is_one_period_old_and_older_where_replies_stay_away() {
    let mut rig = Rig::new(0.0, false);
    rig.cycles(200);
    let age = rig.age();
    assert_eq!(age.count, 199, "the first command was computed from nothing");
    assert!((age.minimum - 1000.0).abs() < 10.0 && (age.maximum - 1000.0).abs() < 10.0, "{age:?}");

    rig.world.withheld.set(true);
    rig.cycles(3);
    rig.world.withheld.set(false);
    rig.cycles(1);
    let age = rig.age();
    assert!(age.count == 1 && (age.maximum - 4000.0).abs() < 40.0, "{age:?}");
    let losses = rig.mailbox.report().losses;
    assert_eq!((losses.lost_replies, losses.late_replies, losses.skipped_periods), (3, 3, 0));

    // Longer than the board's clock can tell: not counted, rather than counted wrong.
    rig.world.oversleep.set(70 * PERIOD);
    rig.cycles(2);
    assert!(rig.age().count <= 1);
}

#[test]
fn the_period_can_follow_the_board() {
    for drift in [-200e-6, 200e-6] {
        let mut by_host = Rig::new(drift, false);
        by_host.cycles(2000);
        let off = by_host.board_period(1000) - PERIOD as f64;
        assert!((off - 1e6 * drift).abs() < 3.0, "{off}");

        let mut by_board = Rig::new(drift, true);
        by_board.cycles(20_000);
        let off = by_board.board_period(5000) - PERIOD as f64;
        assert!(off.abs() < 3.0, "{} ppm of drift: periods off by {off} ns", drift * 1e6);
    }
}
