//! A servo thread: periods with absolute deadlines, and one transaction per finger and period.

use crate::board::{LinkError, Transport, USABLE_SHARE};
use crate::finger::{Fault, FaultKind, FingerServo, ServedPort};
use crate::realtime::{Clock, CycleStage, Follower, LockedMemory, Pages, Schedule};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The part of a period, from the wake-up of the thread, in which replies are awaited. The rest is for computing.
pub const REPLY_WINDOW: f64 = 0.85;

/// Time in which a board must confirm its end state, ns. It permits two attempts. If no Stop frame reaches the board,
/// the watchdog of the board makes its fingers enter the end state.
const CONFIRMATION: u64 = 100_000_000;

/// One to three fingers on one to three ports, run by one thread.
pub struct Servo<T, C> {
    clock: C,
    schedule: Schedule,
    reply_window: u64,
    touch_window: u64,
    ports: Pages<[ServedPort<T>]>,
    follower: Option<Follower>,
}

impl<T: Transport, C: Clock> Servo<T, C> {
    /// Constructs a servo whose first cycle begins at the start of `schedule`.
    pub fn new(clock: C, schedule: Schedule, ports: Vec<ServedPort<T>>) -> Self {
        let reply_window = (schedule.period() as f64 * REPLY_WINDOW) as u64;
        let touch_window = (schedule.period() as f64 * USABLE_SHARE) as u64;
        Self { clock, schedule, reply_window, touch_window, ports: ports.into(), follower: None }
    }

    /// Delays the schedule by `by` ns.
    pub fn later(mut self, by: u64) -> Self {
        self.schedule.delay(by);
        self
    }

    /// Makes the periods follow the clock of the first board.
    pub fn following_board(mut self) -> Self {
        self.follower = Some(Follower::new(self.schedule.period()));
        self
    }

    /// Returns the memory that the servo accesses and that is not in this value itself.
    pub fn memory(&self) -> LockedMemory {
        let mut memory = LockedMemory::default();
        memory.add(&self.ports);
        for port in self.ports.iter() {
            memory.append(&port.memory());
        }
        memory
    }

    /// Runs until every finger is closed, or is faulted and has been asked to close. A panic is a defect, but it must
    /// not leave the last torque on the motors: it faults every finger, and every board gets a Stop frame.
    pub fn run(&mut self) {
        let cycles = || {
            while !self.finished() {
                self.cycle();
            }
            self.confirm_stops();
        };
        if catch_unwind(AssertUnwindSafe(cycles)).is_err() {
            // If this panics too, the watchdog of the board stops the motors.
            let _ = catch_unwind(AssertUnwindSafe(|| self.fail()));
        }
    }

    /// Returns whether every finger is closed, or is faulted and has been asked to close.
    pub fn finished(&self) -> bool {
        self.ports.iter().flat_map(|port| port.fingers.iter()).all(FingerServo::finished)
    }

    /// Runs one period: wait, send commands, receive replies, compute, report. Nothing here allocates, locks, or blocks
    /// beyond the deadline.
    pub fn cycle(&mut self) {
        let beginning = self.schedule.next();
        self.clock.sleep_until(beginning);
        let began = self.clock.now();
        for port in self.ports.iter_mut() {
            port.exchange();
            port.fingers.iter_mut().for_each(|finger| finger.begin_period(began));
        }
        self.send_stops();
        let mut sending = began;
        for port in self.ports.iter_mut() {
            port.send();
            let sent = self.clock.now();
            port.note(CycleStage::WakeUp, beginning, began);
            port.note(CycleStage::Write, sending, sent);
            sending = sent;
        }
        for port in self.ports.iter_mut() {
            port.receive(began + self.reply_window, began + self.touch_window, sending, &self.clock);
        }
        let period = self.schedule.number(beginning);
        let mut computing = self.clock.now();
        let skipped = self.schedule.advance(computing);
        let overrun = (computing > self.schedule.next()).then_some(skipped);
        if let Some(follower) = &mut self.follower {
            let first = self.ports.iter().flat_map(|port| port.fingers.iter()).next();
            let reading = first.and_then(FingerServo::sampled_at);
            self.schedule.shift(follower.correction(reading, 1 + skipped));
        }
        for port in self.ports.iter_mut() {
            let counters = port.counters();
            for finger in port.fingers.iter_mut() {
                finger.take_groups(period, || self.schedule.number(self.clock.now()));
                finger.end(began, self.schedule.next(), overrun, &counters);
                let computed = self.clock.now();
                finger.note(CycleStage::Compute, computing, computed);
                finger.note(CycleStage::Whole, beginning, computed);
                finger.publish();
                computing = computed;
            }
        }
        self.announce_events();
        // The reports of this cycle were made before its end was known. The next reports count this overrun.
        if overrun.is_none() && computing > self.schedule.next() {
            for port in self.ports.iter_mut() {
                port.fingers.iter_mut().for_each(FingerServo::count_late_computation);
            }
        }
    }

    /// Wakes a thread that waits for events, if there are new events. All fingers of a hand have the same readers, so
    /// this makes at most one system call. It must be called after the reports of all fingers are published.
    fn announce_events(&self) {
        let mut fingers = self.ports.iter().flat_map(|port| port.fingers.iter());
        if let Some(finger) = fingers.find(|finger| finger.has_new_events()) {
            finger.announce_events();
        }
    }

    /// Faults every finger and stops every board. This is the last action after a panic.
    fn fail(&mut self) {
        // Dropping the handover informs the repairing thread that no servo runs the port any more.
        self.ports.iter_mut().for_each(|port| port.handover = None);
        let now = self.clock.now();
        for port in self.ports.iter_mut() {
            let counters = port.counters();
            for finger in port.fingers.iter_mut() {
                finger.begin_period(now);
                finger.fault(Fault::new(FaultKind::ServoPanic));
                finger.end(now, self.schedule.next(), None, &counters);
                finger.publish();
            }
        }
        self.announce_events();
        self.confirm_stops();
    }

    /// Sends Stop frames to every board until the board confirms, the line fails or [`CONFIRMATION`] has passed.
    /// Closing the port earlier would discard bytes that have not been sent yet. The servo has no deadlines any more,
    /// so this may wait.
    fn confirm_stops(&mut self) {
        self.send_stops();
        for port in self.ports.iter_mut() {
            // Without a link, the port is being repaired. Its boards were stopped before the link was released.
            let Some(link) = &mut port.link else { continue };
            for finger in port.fingers.iter() {
                let deadline = self.clock.now() + CONFIRMATION;
                while self.clock.now() < deadline && matches!(link.stop(finger.address(), deadline), Ok(false)) {}
            }
        }
    }

    fn send_stops(&mut self) {
        for port in self.ports.iter_mut() {
            for finger in port.fingers.iter_mut() {
                if let (true, Some(link)) = (finger.stopping(), &mut port.link) {
                    // If the port has failed, the watchdog of the board stops the motors.
                    port.failed |= matches!(link.stop(finger.address(), 0), Err(LinkError::Port(_)));
                }
            }
        }
    }
}
