//! A finger with its servo, its link and its board in memory, on simulated time: every run is identical.

use crate::finger_on_a_cable::{Hooks, ServedFinger, World};
use nalgebra::{Vector3, Vector4};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use sun2xp::board::{Link, PortError, Terms, Transport};
use sun2xp::finger::{Fault, FingerReport, ReleasedLink, RepairedLink, RestoredBoard, Stage, StopCounts, stop_calls};
use sun2xp::model::configuration::{Configuration, ConfiguredFinger};
use sun2xp::realtime::Clock;
use sun2xp::simulated::{SimulatedCable, SimulatedFinger};

pub const MICROSECOND: u64 = 1000;
pub const MILLISECOND: u64 = 1000 * MICROSECOND;

/// Period at which the end state is checked, ns.
const LOOK: u64 = MILLISECOND / 10;

/// Observes the motors all the time, and delays the servo's wake-ups.
#[derive(Default)]
struct Watch {
    /// When the motors were first without torque since the last mark, ns.
    ended: Option<u64>,
    /// Delay of every eighth wake-up of the servo, ns.
    late: u64,
    wake_ups: u32,
}

impl Watch {
    fn look(&mut self, cable: &mut SimulatedCable) {
        let now = cable.now();
        let finger = cable.board().finger(1).expect("the board has finger 1");
        if !finger.enabled() && finger.motor_torques().amax() == 0.0 {
            self.ended.get_or_insert(now);
        }
    }
}

impl Hooks for Watch {
    fn write(&mut self, cable: &mut SimulatedCable, bytes: &[u8]) -> Result<usize, PortError> {
        let written = cable.write(bytes);
        self.look(cable);
        written
    }

    fn read_until(&mut self, cable: &mut SimulatedCable, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        loop {
            let next = (cable.now() + LOOK).min(deadline);
            let taken = cable.read_until(buffer, next)?;
            self.look(cable);
            if taken > 0 || cable.now() >= deadline {
                return Ok(taken);
            }
        }
    }

    fn sleep_until(&mut self, cable: &mut SimulatedCable, deadline: u64) {
        self.wake_ups += 1;
        let deadline = if self.wake_ups.is_multiple_of(8) { deadline + self.late } else { deadline };
        while cable.now() < deadline {
            let next = (cable.now() + LOOK).min(deadline);
            cable.advance_to(next);
            self.look(cable);
        }
    }
}

/// The true state of a finger at the end of a cycle.
#[derive(Clone, Copy, Default)]
pub struct Truth {
    /// Time since the injection, s.
    pub time: f64,
    pub joints: Vector3<f64>,
    pub tensions: Vector4<f64>,
    /// Commanded pulls of the motors, N.
    pub pulls: Vector4<f64>,
    /// Heat of each motor by I^2 t, as a fraction of the heat that it withstands continuously.
    pub heat: Vector4<f64>,
    /// Time for which `heat` has been above 0.95, s.
    pub hot_for: Vector4<f64>,
    /// Fraction of the cycles that had no reply, as a moving average with a time constant of one second.
    pub lost: f64,
    /// Fraction of the cycles that skipped periods, as a moving average with the same time constant.
    pub skipping: f64,
}

/// Finger 1 on a bench.
pub struct Bench {
    world: World<Watch>,
    served: ServedFinger<World<Watch>>,
    terms: Terms,
    random: Pcg64,
    pub configuration: Configuration,
    /// When the finger gets its next target, ns.
    pub next_target: u64,
    pub truth: Truth,
    injected: u64,
    /// Lost replies in total.
    lost: u64,
    skipped: u64,
}

impl Bench {
    /// Opens the finger and waits until it is a spring.
    pub fn new(configuration: Configuration, seed: u64) -> Self {
        Self::simulating(&configuration.clone(), configuration, seed)
    }

    /// Like [`Self::new`], with a finger that differs from the configuration of its controller.
    pub fn simulating(truth: &Configuration, mut configuration: Configuration, seed: u64) -> Self {
        // The finger has the time limits of a real port, because its port is not named "simulated".
        configuration.fingers[0].port = "in memory".into();
        // A blow can leave a tendon slack by centimetres, and slack is taken up slowly.
        configuration.hand.open_timeout_ms = 60_000;
        let world = World::new(truth, Watch::default());
        let served = ServedFinger::new(&world, &configuration);
        let terms = Terms::new(&configuration.hand, &configuration.fingers[0]);
        let mut bench = Self {
            world,
            served,
            terms,
            random: Pcg64::seed_from_u64(seed),
            configuration,
            next_target: 0,
            truth: Truth::default(),
            injected: 0,
            lost: 0,
            skipped: 0,
        };
        bench.come_under_tension();
        bench
    }

    fn come_under_tension(&mut self) {
        for _ in 0..70_000 {
            self.served.servo.cycle();
            match self.report().stage {
                Stage::Running => break,
                Stage::Faulted(fault) => {
                    let cycle = self.report().cycle;
                    panic!("while it takes up slack: {fault}; tensions {} joints {}", cycle.tensions, cycle.joints)
                }
                _ => {}
            }
        }
        assert_eq!(self.report().stage, Stage::Running, "the finger comes under tension");
    }

    pub fn report(&self) -> FingerReport {
        self.served.mailbox.report()
    }

    pub fn finger(&self) -> &ConfiguredFinger {
        &self.configuration.fingers[0]
    }

    pub fn now(&self) -> u64 {
        Clock::now(&self.world)
    }

    pub fn with_cable<R>(&self, act: impl FnOnce(&mut SimulatedCable) -> R) -> R {
        act(&mut self.world.place().cable)
    }

    pub fn with_finger<R>(&self, act: impl FnOnce(&mut SimulatedFinger) -> R) -> R {
        self.with_cable(|cable| act(cable.board().finger(1).expect("the board has finger 1")))
    }

    /// A random number, uniform from `low` to `high`.
    pub fn random(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * f64::from(self.random.next_u32()) / 4_294_967_296.0
    }

    /// A random number from 1 to 4.
    pub fn part(&mut self) -> u8 {
        1 + (self.random.next_u32() % 4) as u8
    }

    /// Delays every eighth wake-up of the servo by this time from now on, ns.
    pub fn wake_late(&self, by: u64) {
        self.world.place().hooks.late = by;
    }

    /// Keeps the servo from running for this time, ns.
    pub fn pause(&self, time: u64) {
        self.world.sleep_until(self.now() + time);
    }

    /// Marks the moment of the injection.
    pub fn mark(&mut self) {
        self.injected = self.now();
        self.world.place().hooks.ended = None;
    }

    /// When the motors were first without torque, ms after the mark.
    pub fn ended(&self) -> Option<f64> {
        self.world.place().hooks.ended.map(|ended| (ended - self.injected) as f64 * 1e-6)
    }

    /// Runs one period. The finger gets a new random target every 200 to 800 ms.
    pub fn cycle(&mut self) {
        if self.now() >= self.next_target {
            let within = |bench: &mut Self, low: f64, high: f64| bench.random(low, high).to_radians();
            let joints = Vector3::new(within(self, -30.0, 30.0), within(self, -10.0, 70.0), within(self, 30.0, 100.0));
            let sent = self.served.mailbox.send(|set_point| set_point.joints = joints);
            assert!(sent.is_ok() || self.fault().is_some());
            let pause = self.random(200.0, 800.0) as u64;
            self.next_target = self.now() + pause * MILLISECOND;
        }
        self.served.servo.cycle();
        self.look();
    }

    fn look(&mut self) {
        let now = self.now();
        let report = self.report();
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
        // A moving average with a time constant of one second.
        let note = |share: &mut f64, wrong: bool| *share += (f64::from(u8::from(wrong)) - *share) / hand.rate;
        note(&mut truth.lost, report.losses.lost_replies > self.lost);
        note(&mut truth.skipping, report.losses.skipped_periods > self.skipped);
        (self.lost, self.skipped) = (report.losses.lost_replies, report.losses.skipped_periods);
    }

    pub fn run(&mut self, milliseconds: u64) {
        let end = self.now() + milliseconds * MILLISECOND;
        while self.now() < end {
            self.cycle();
        }
    }

    /// The fault that has stopped the finger.
    pub fn fault(&self) -> Option<Fault> {
        match self.report().stage {
            Stage::Faulted(fault) => Some(fault),
            _ => None,
        }
    }

    /// The present warning of the finger.
    pub fn warning(&self) -> Option<Fault> {
        self.report().warnings.newest()
    }

    /// Removes every disturbance: of the line, of the finger and of its surroundings.
    pub fn repair(&mut self) {
        self.wake_late(0);
        self.with_cable(|cable| {
            cable.set_plugged(true);
            cable.clear();
        });
        self.with_finger(|finger| {
            finger.repair();
            finger.plant().set_external_force(Vector3::zeros());
        });
    }

    /// Does what sun2xp_recover does with a faulted finger: takes the link from the servo, replaces it if it has
    /// failed, shakes hands, hands the link to the servo, and waits until the finger is a spring.
    pub fn recover(&mut self) {
        let before = self.report().recoveries;
        // Lets delayed frames arrive.
        self.pause(200 * MILLISECOND);
        let released = (0..10).find_map(|_| {
            self.served.servo.cycle();
            self.served.repair_end.released.pop()
        });
        let ReleasedLink { link, failed } = released.expect("the servo releases its link");
        let mut link = if failed { Link::new(self.world.clone()) } else { link };
        let deadline = self.now() + 300 * MILLISECOND;
        let (identity, configured) = link.shake_hands(1, &self.terms, deadline).expect("the board answers again");
        assert_eq!(identity, self.served.identity);
        let stops = StopCounts { calls: stop_calls(), ..StopCounts::default() };
        let restored = RestoredBoard { configured, stops, restarts: 0 };
        let repaired = RepairedLink { link, boards: [Some(restored), None, None] };
        assert!(self.served.repair_end.repaired.push(repaired).is_ok());
        self.come_under_tension();
        assert_eq!(self.report().recoveries, before + 1);
    }
}
