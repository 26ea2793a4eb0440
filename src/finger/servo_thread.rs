//! A servo thread: periods with absolute deadlines, and one transaction per finger and period.

use crate::board::{Allowance, Link, LinkCounters, LinkError, OutgoingCommand, Transport};
use crate::finger::{Fault, FaultKind, FingerServo, LinkServoEnd, ReleasedLink, RepairedLink};
use crate::model::configuration::FINGERS;
use crate::realtime::{Clock, CycleStage, Follower, LockedMemory, Pages, Schedule};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The part of a period, from the wake-up of the thread, in which replies are awaited. The rest is for computing.
pub const REPLY_WINDOW: f64 = 0.85;

/// A port and its fingers.
pub struct ServedPort<T> {
    /// None while the link is being repaired.
    link: Option<Link<T>>,
    /// Whether the port has failed.
    failed: bool,
    handover: Option<LinkServoEnd<T>>,
    fingers: Pages<[FingerServo]>,
    /// Counters of earlier links.
    earlier_counters: LinkCounters,
}

impl<T: Transport> ServedPort<T> {
    /// Constructs a port. The handshake with `fingers` over `link` must be complete.
    pub fn new(link: Link<T>, fingers: Vec<FingerServo>) -> Self {
        Self {
            link: Some(link),
            failed: false,
            handover: None,
            fingers: fingers.into(),
            earlier_counters: LinkCounters::default(),
        }
    }

    /// Makes the servo release the link through `handover` for repair when all fingers of the port have faulted.
    pub fn with_handover(mut self, handover: LinkServoEnd<T>) -> Self {
        self.handover = Some(handover);
        self
    }
}

/// Time in which a board must confirm its end state, ns. It permits two attempts. Without a Stop frame, the watchdog of
/// the board has the same effect.
const CONFIRMATION: u64 = 100_000_000;

/// One to three fingers on one to three ports, run by one thread.
pub struct Servo<T, C> {
    clock: C,
    schedule: Schedule,
    reply_window: u64,
    ports: Pages<[ServedPort<T>]>,
    follower: Option<Follower>,
}

impl<T: Transport, C: Clock> Servo<T, C> {
    /// Constructs a servo whose first cycle begins at the start of `schedule`.
    pub fn new(clock: C, schedule: Schedule, ports: Vec<ServedPort<T>>) -> Self {
        let reply_window = (schedule.period() as f64 * REPLY_WINDOW) as u64;
        Self { clock, schedule, reply_window, ports: ports.into(), follower: None }
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
            memory.add(&port.fingers);
            port.fingers.iter().for_each(|finger| memory.append(finger.memory()));
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
            port.receive(began + self.reply_window, sending, &self.clock);
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
    }

    /// Wakes a thread that waits for events, if there are new ones. This makes at most one system call, after the
    /// reports of all fingers are published, because all fingers of a hand have the same readers.
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
            // The boards of a released link were stopped before it was released.
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

impl<T: Transport> ServedPort<T> {
    /// Releases the link for repair when no finger uses it any more, or takes back a repaired one.
    fn exchange(&mut self) {
        let Some(handover) = &mut self.handover else { return };
        let all_at_rest = self.fingers.iter().all(FingerServo::at_rest);
        if let Some(link) = self.link.take_if(|_| all_at_rest) {
            self.earlier_counters = self.earlier_counters.saturating_add(&link.counters());
            // The push succeeds, because this is the only link.
            if let Err(rejected) = handover.released.push(ReleasedLink { link, failed: self.failed }) {
                self.link = Some(rejected.link);
            }
        } else if let Some(RepairedLink { link, configured, stop_calls }) = handover.repaired.pop() {
            self.failed = false;
            // From now on, the counters of this link are added to the totals. They are subtracted here, so that the
            // totals do not jump, whether this is the same link or a new one.
            self.earlier_counters = self.earlier_counters.saturating_sub(&link.counters());
            self.link = Some(link);
            for (finger, configured) in self.fingers.iter_mut().zip(configured) {
                configured.into_iter().for_each(|configured| finger.recover(&configured, stop_calls));
            }
        }
    }

    /// Returns the counters of the port since open.
    fn counters(&self) -> LinkCounters {
        self.link.as_ref().map_or(self.earlier_counters, |link| self.earlier_counters.saturating_add(&link.counters()))
    }

    /// Sends all commands of the port back to back, so that replies overlap with the commands after them.
    fn send(&mut self) {
        let mut commands = [OutgoingCommand::default(); FINGERS];
        let mut count = 0;
        for (command, place) in self.fingers.iter_mut().filter_map(FingerServo::begin).zip(&mut commands) {
            *place = command;
            count += 1;
        }
        let Some(link) = &mut self.link else { return };
        if let Err(error) = link.send(&commands[..count]) {
            self.fail(&error);
        }
    }

    fn receive(&mut self, deadline: u64, sent: u64, clock: &impl Clock) {
        // One allowance for all replies of the period: a board that sends without end must not keep the thread here.
        let mut allowance = Allowance::for_replies(deadline);
        while self.fingers.iter().any(FingerServo::waiting) {
            let Some(link) = &mut self.link else { return };
            match link.receive_within(&mut allowance) {
                Ok(Some(received)) => {
                    let mut addressed = self.fingers.iter_mut().find(|finger| finger.address() == received.address);
                    let Some(finger) = addressed.take_if(|finger| finger.awaits(&received)) else {
                        addressed.into_iter().for_each(|finger| finger.count_unexpected(&received));
                        continue;
                    };
                    finger.take(&received);
                    let (ready, read) = link.arrival();
                    finger.note(CycleStage::Wire, sent, ready);
                    finger.note(CycleStage::Read, ready, read);
                    finger.note(CycleStage::Decode, read, clock.now());
                }
                Ok(None) => break,
                // Only the refused finger faults, because the other fingers of the board may be unaffected.
                Err(LinkError::Refused { address, refused }) => {
                    let addressed = self.fingers.iter_mut().filter(|finger| finger.address() == address);
                    addressed.for_each(|finger| finger.fault((&refused).into()));
                }
                Err(error) => {
                    self.fail(&error);
                    break;
                }
            }
        }
    }

    fn note(&mut self, stage: CycleStage, from: u64, to: u64) {
        self.fingers.iter_mut().for_each(|finger| finger.note(stage, from, to));
    }

    fn fail(&mut self, error: &LinkError) {
        self.failed |= matches!(error, LinkError::Port(_));
        self.fingers.iter_mut().for_each(|finger| finger.fault(error.into()));
    }
}
