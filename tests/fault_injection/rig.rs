//! A finger with its servo, its link and its board in memory, on simulated time: what happens is the same in every run.

use nalgebra::{Vector3, Vector4};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::cell::RefCell;
use std::rc::Rc;
use sun2xp::board::protocol::Identity;
use sun2xp::board::{Link, PortError, Terms, Transport};
use sun2xp::control::Law;
use sun2xp::finger::{
    BlackBox, Borrower, Fault, FingerServo, Lent, Mailbox, Mended, ServedPort, Servo, Stage, lending, stop_calls,
};
use sun2xp::model::configuration::{Configuration, ConfiguredFinger};
use sun2xp::realtime::ring;
use sun2xp::realtime::{Clock, Schedule};
use sun2xp::simulated::{SimulatedBoard, SimulatedCable, SimulatedFinger};

pub const MICROSECOND: u64 = 1000;
pub const MILLISECOND: u64 = 1000 * MICROSECOND;

/// How often the end state is looked at, ns.
const LOOK: u64 = MILLISECOND / 10;

/// What is at both ends of the cable: the board, and the clock that its host goes by.
struct Place {
    cable: SimulatedCable,
    /// When the motors were first seen without torque since this was asked for, ns.
    ended: Option<u64>,
    /// By so much, ns, the servo wakes up late every eighth time.
    late: u64,
    wake_ups: u32,
}

/// The same for whoever needs it.
#[derive(Clone)]
pub struct World(Rc<RefCell<Place>>);

impl Place {
    fn look(&mut self) {
        let now = self.cable.now();
        let finger = self.cable.board().finger(1).expect("the board has finger 1");
        if !finger.enabled() && finger.motor_torques().amax() == 0.0 {
            self.ended.get_or_insert(now);
        }
    }
}

impl Transport for World {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        let mut place = self.0.borrow_mut();
        let written = place.cable.write(bytes);
        place.look();
        written
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        let mut place = self.0.borrow_mut();
        loop {
            let next = (place.cable.now() + LOOK).min(deadline);
            let taken = place.cable.read_until(buffer, next)?;
            place.look();
            if taken > 0 || place.cable.now() >= deadline {
                return Ok(taken);
            }
        }
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        self.0.borrow_mut().cable.discard_input()
    }

    fn now(&self) -> u64 {
        self.0.borrow().cable.now()
    }
}

impl Clock for World {
    fn now(&self) -> u64 {
        self.0.borrow().cable.now()
    }

    fn sleep_until(&self, deadline: u64) {
        let mut place = self.0.borrow_mut();
        place.wake_ups += 1;
        let deadline = if place.wake_ups.is_multiple_of(8) { deadline + place.late } else { deadline };
        while place.cable.now() < deadline {
            let next = (place.cable.now() + LOOK).min(deadline);
            place.cable.advance_to(next);
            place.look();
        }
    }
}

/// What a finger truly is at the end of a cycle.
#[derive(Clone, Copy, Default)]
pub struct Truth {
    /// Since the injection, s.
    pub time: f64,
    pub joints: Vector3<f64>,
    pub tensions: Vector4<f64>,
    /// Mean tensions of the first cycles as a spring.
    pub tensions_at_first: Vector4<f64>,
    /// What the motors are told to pull, N.
    pub pulls: Vector4<f64>,
    /// Part of the heat that each motor bears for ever, by I^2 t, and for how long it has been beyond 0.95, s.
    pub heat: Vector4<f64>,
    pub hot_for: Vector4<f64>,
    /// Shares of the cycles of the last second without a reply, and that skipped periods.
    pub lost: f64,
    pub skipping: f64,
}

/// Finger 1 on a bench.
pub struct Bench {
    world: World,
    servo: Servo<World, World>,
    pub mailbox: Mailbox,
    borrower: Borrower<World>,
    terms: Terms,
    identity: Identity,
    random: Pcg64,
    pub configuration: Configuration,
    next_target: u64,
    pub truth: Truth,
    /// Of the cycles so far as a spring.
    cycles: u32,
    injected: u64,
    /// In all.
    lost: u64,
    skipped: u64,
}

impl Bench {
    /// Opens the finger and waits until it is a spring.
    pub fn new(mut configuration: Configuration, seed: u64) -> Self {
        // With the patience of a real port.
        configuration.fingers[0].port = "in memory".into();
        // After a blow a tendon may hang by centimetres, and it is wound in slowly.
        configuration.hand.open_timeout_ms = 30_000;
        let board = SimulatedBoard::new(&configuration, &[0]).expect("a board");
        let world = World(Rc::new(RefCell::new(Place {
            cable: SimulatedCable::new(board),
            ended: None,
            late: 0,
            wake_ups: 0,
        })));
        let (hand, finger) = (&configuration.hand, &configuration.fingers[0]);
        let terms = Terms::new(hand, finger);
        let mut link = Link::new(world.clone());
        let deadline = Transport::now(&world) + 1000 * MILLISECOND;
        let (identity, configured) = link.shake_hands(1, &terms, deadline).expect("a board answers");
        let (timings, _) = ring(1);
        let stiffness = finger.initial_stiffness();
        // Nobody reads it.
        let (recorder, _) = BlackBox::new(&configuration, 0);
        let (finger, mailbox) =
            FingerServo::new(&configuration, 0, stiffness, &identity, &configured, timings, recorder)
                .expect("a finger");
        let period = (1e9 / hand.rate) as u64;
        let schedule = Schedule::new(Transport::now(&world) + period, period);
        let (lender, borrower) = lending();
        let port = ServedPort::new(link, vec![finger]).lent_through(lender);
        let servo = Servo::new(world.clone(), schedule, vec![port]);
        let mut bench = Self {
            world,
            servo,
            mailbox,
            borrower,
            terms,
            identity,
            random: Pcg64::seed_from_u64(seed),
            configuration,
            next_target: 0,
            truth: Truth::default(),
            cycles: 0,
            injected: 0,
            lost: 0,
            skipped: 0,
        };
        bench.come_under_tension();
        bench
    }

    fn come_under_tension(&mut self) {
        for _ in 0..60_000 {
            self.servo.cycle();
            match self.mailbox.report().stage {
                Stage::Running => break,
                Stage::Faulted(fault) => panic!("while it takes up slack: {fault}"),
                _ => {}
            }
        }
        assert_eq!(self.mailbox.report().stage, Stage::Running, "the finger comes under tension");
        self.cycles = 0;
    }

    pub fn finger(&self) -> &ConfiguredFinger {
        &self.configuration.fingers[0]
    }

    pub fn now(&self) -> u64 {
        Clock::now(&self.world)
    }

    pub fn with_cable<R>(&self, act: impl FnOnce(&mut SimulatedCable) -> R) -> R {
        act(&mut self.world.0.borrow_mut().cable)
    }

    pub fn with_finger<R>(&self, act: impl FnOnce(&mut SimulatedFinger) -> R) -> R {
        self.with_cable(|cable| act(cable.board().finger(1).expect("the board has finger 1")))
    }

    /// Uniform, `low` to `high`.
    pub fn random(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * f64::from(self.random.next_u32()) / 4_294_967_296.0
    }

    /// 1 to 4.
    pub fn part(&mut self) -> u8 {
        1 + (self.random.next_u32() % 4) as u8
    }

    /// From now on the servo wakes up so much late, ns, every eighth time.
    pub fn wake_late(&self, by: u64) {
        self.world.0.borrow_mut().late = by;
    }

    /// The servo does not run for so long, ns.
    pub fn pause(&self, time: u64) {
        self.world.sleep_until(self.now() + time);
    }

    /// Something is injected now.
    pub fn mark(&mut self) {
        self.injected = self.now();
        self.world.0.borrow_mut().ended = None;
    }

    /// When the motors were without torque, ms after the mark.
    pub fn ended(&self) -> Option<f64> {
        self.world.0.borrow().ended.map(|ended| (ended - self.injected) as f64 * 1e-6)
    }

    /// One period of a finger that is led from pose to pose, with pauses.
    pub fn cycle(&mut self) {
        if self.now() >= self.next_target {
            let within = |bench: &mut Self, low: f64, high: f64| bench.random(low, high).to_radians();
            let joints = Vector3::new(within(self, -30.0, 30.0), within(self, -10.0, 70.0), within(self, 30.0, 100.0));
            let sent = self.mailbox.send(|set_point| (set_point.joints, set_point.law) = (joints, Law::Report));
            assert!(sent.is_ok() || self.fault().is_some());
            let pause = self.random(200.0, 800.0) as u64;
            self.next_target = self.now() + pause * MILLISECOND;
        }
        self.servo.cycle();
        self.look();
    }

    fn look(&mut self) {
        let now = self.now();
        let report = self.mailbox.report();
        let (joints, tensions, torques) = self.with_finger(|finger| {
            let torques = finger.motor_torques();
            (finger.plant().joints(), finger.plant().tensions(), torques)
        });
        let (hand, finger) = (&self.configuration.hand, &self.configuration.fingers[0]);
        let motor = &finger.motor;
        let truth = &mut self.truth;
        (truth.time, truth.joints, truth.tensions) = ((now - self.injected) as f64 * 1e-9, joints, tensions);
        truth.pulls = torques.component_div(&Vector4::from(finger.geometry.motor_radius));
        let square = torques.component_div(&Vector4::from(motor.continuous_torque)).map(|part| part * part);
        truth.heat += (square - truth.heat) * -(-1.0 / (hand.rate * motor.thermal_time)).exp_m1();
        let (heat, period) = (truth.heat, 1.0 / hand.rate);
        truth.hot_for = truth.hot_for.zip_map(&heat, |time, heat| if heat > 0.95 { time + period } else { 0.0 });
        // One that forgets, 1/e in a second.
        let note = |share: &mut f64, wrong: bool| *share += (f64::from(u8::from(wrong)) - *share) / hand.rate;
        note(&mut truth.lost, report.losses.lost_replies > self.lost);
        note(&mut truth.skipping, report.losses.skipped_periods > self.skipped);
        (self.lost, self.skipped) = (report.losses.lost_replies, report.losses.skipped_periods);
        // As many as the library's own zero has.
        self.cycles += 1;
        if self.cycles <= 32 {
            truth.tensions_at_first += (tensions - truth.tensions_at_first) / f64::from(self.cycles);
        }
    }

    pub fn run(&mut self, milliseconds: u64) {
        let end = self.now() + milliseconds * MILLISECOND;
        while self.now() < end {
            self.cycle();
        }
    }

    /// What has stopped the finger.
    pub fn fault(&self) -> Option<Fault> {
        match self.mailbox.report().stage {
            Stage::Faulted(fault) => Some(fault),
            _ => None,
        }
    }

    /// What the finger is warned of.
    pub fn warning(&self) -> Option<Fault> {
        self.mailbox.report().warnings.newest()
    }

    /// Nothing is wrong any more: with the line, the finger, or what is around it.
    pub fn mend(&mut self) {
        self.wake_late(0);
        self.with_cable(|cable| {
            cable.set_plugged(true);
            cable.clear();
        });
        self.with_finger(|finger| {
            finger.mend();
            finger.plant().set_external_force(Vector3::zeros());
        });
    }

    /// Does what RecoverHand does with a finger that has faulted: takes the link that the servo lends, or a new one, shakes hands,
    /// gives it back, and waits until the finger is a spring.
    pub fn recover(&mut self) {
        let before = self.mailbox.report().recoveries;
        // What was on its way comes.
        self.pause(200 * MILLISECOND);
        let lent = (0..10).find_map(|_| {
            self.servo.cycle();
            self.borrower.lent.pop()
        });
        let Lent { link, failed } = lent.expect("the servo lends its link");
        let mut link = if failed { Link::new(self.world.clone()) } else { link };
        let deadline = self.now() + 300 * MILLISECOND;
        let (identity, configured) = link.shake_hands(1, &self.terms, deadline).expect("the board answers again");
        assert_eq!(identity, self.identity);
        let mended = Mended { link, configured: [Some(configured), None, None], stop_calls: stop_calls() };
        assert!(self.borrower.mended.push(mended).is_ok());
        self.come_under_tension();
        assert_eq!(self.mailbox.report().recoveries, before + 1);
    }
}
