//! A finger with its servo, its link and its board in memory, on simulated time: what happens is the same in every run.

use nalgebra::Vector3;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rtrb::RingBuffer;
use std::cell::RefCell;
use std::rc::Rc;
use sun2xp::board::{Link, PortError, SimulatedBoard, SimulatedCable, SimulatedFinger, Terms, Transport};
use sun2xp::control::Law;
use sun2xp::finger::{BlackBox, ControllerSource, Fault, FingerServo, Mailbox, ServedPort, Servo, Stage};
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::{Clock, Schedule};

const MILLISECOND: u64 = 1_000_000;

/// The cable, and the clock at both its ends.
#[derive(Clone)]
pub struct World(Rc<RefCell<SimulatedCable>>);

impl Transport for World {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        self.0.borrow_mut().write(bytes)
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        self.0.borrow_mut().read_until(buffer, deadline)
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        self.0.borrow_mut().discard_input()
    }

    fn now(&self) -> u64 {
        self.0.borrow().now()
    }
}

impl Clock for World {
    fn now(&self) -> u64 {
        self.0.borrow().now()
    }

    fn sleep_until(&self, deadline: u64) {
        self.0.borrow_mut().advance_to(deadline);
    }
}

/// Finger 1 on a bench.
pub struct Bench {
    world: World,
    servo: Servo<World, World>,
    pub mailbox: Mailbox,
    random: Pcg64,
    configuration: Configuration,
    next_target: u64,
}

impl Bench {
    /// Opens the finger and waits until it is a spring.
    pub fn new(configuration: Configuration, seed: u64) -> Self {
        let board = SimulatedBoard::new(&configuration, &[0]).expect("a board");
        let world = World(Rc::new(RefCell::new(SimulatedCable::new(board))));
        Self::open(world, configuration, Pcg64::seed_from_u64(seed))
    }

    fn open(world: World, mut configuration: Configuration, random: Pcg64) -> Self {
        // With the patience of a real port.
        configuration.fingers[0].port = "in memory".into();
        // After a blow a tendon may hang by centimetres, and it is wound in slowly.
        configuration.hand.open_timeout_ms = 30_000;
        let (hand, finger) = (&configuration.hand, &configuration.fingers[0]);
        let mut link = Link::new(world.clone());
        let deadline = Transport::now(&world) + 1000 * MILLISECOND;
        let (identity, configured) = link.shake_hands(1, &Terms::new(hand, finger), deadline).expect("a board answers");
        let (timings, _) = RingBuffer::new(1);
        let stiffness = finger.initial_stiffness();
        let source = ControllerSource { number: 0, gravity: configuration.gravity(0), finger: finger.clone() };
        // Nobody reads it.
        let (recorder, _) = BlackBox::new(1, hand, source);
        let (finger, mailbox) =
            FingerServo::new(&configuration, 0, stiffness, &identity, &configured, timings, recorder)
                .expect("a finger");
        let period = (1e9 / hand.rate) as u64;
        let schedule = Schedule::new(Transport::now(&world) + period, period);
        let servo = Servo::new(world.clone(), schedule, vec![ServedPort::new(link, vec![finger])]);
        let mut bench = Self { world, servo, mailbox, random, configuration, next_target: 0 };
        for _ in 0..30_000 {
            bench.servo.cycle();
            match bench.mailbox.report().stage {
                Stage::Running => break,
                Stage::Faulted(fault) => panic!("at open: {fault}"),
                _ => {}
            }
        }
        assert_eq!(bench.mailbox.report().stage, Stage::Running, "the finger opens");
        bench
    }

    pub fn now(&self) -> u64 {
        self.world.0.borrow().now()
    }

    pub fn with_cable<R>(&self, act: impl FnOnce(&mut SimulatedCable) -> R) -> R {
        act(&mut self.world.0.borrow_mut())
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

    /// Whether the board is in its end state.
    pub fn ended(&self) -> bool {
        self.with_finger(|finger| !finger.enabled() && finger.motor_torques().amax() == 0.0)
    }

    /// Closes, mends, zeroes by hand and opens again.
    pub fn recover(mut self) -> Self {
        self.mailbox.close();
        for _ in 0..1000 {
            if self.servo.finished() {
                break;
            }
            self.servo.cycle();
        }
        assert!(self.servo.finished(), "the servo ends");
        self.with_cable(|cable| {
            cable.set_plugged(true);
            cable.clear();
        });
        self.with_finger(|finger| {
            finger.mend();
            finger.plant().set_external_force(Vector3::zeros());
        });
        // What was on its way, and a watchdog.
        self.with_cable(|cable| {
            let later = cable.now() + 200 * MILLISECOND;
            cable.advance_to(later);
        });
        let Self { world, configuration, random, .. } = self;
        Self::open(world, configuration, random)
    }
}
