//! A servo thread: periods by absolute deadlines, one transaction a finger and period.

use crate::board::{Allowance, Link, LinkCounters, LinkError, OutgoingCommand, Transport};
use crate::finger::{Fault, FaultKind, FingerServo, Lender, Lent, Mended};
use crate::model::configuration::FINGERS;
use crate::realtime::{Clock, CycleStage, Follower, LockedMemory, Pages, Schedule};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The part of a period, from the thread's awakening, in which replies are awaited; the rest is for computing.
pub const REPLY_WINDOW: f64 = 0.85;

/// A port with the fingers behind it.
pub struct ServedPort<T> {
    /// None while it is lent.
    link: Option<Link<T>>,
    /// The port has failed.
    failed: bool,
    lender: Option<Lender<T>>,
    fingers: Pages<[FingerServo]>,
    /// What was heard on links before this one.
    heard_before: LinkCounters,
}

impl<T: Transport> ServedPort<T> {
    /// `fingers` have shaken hands over `link`.
    pub fn new(link: Link<T>, fingers: Vec<FingerServo>) -> Self {
        Self {
            link: Some(link),
            failed: false,
            lender: None,
            fingers: fingers.into(),
            heard_before: LinkCounters::default(),
        }
    }

    /// The same port, whose link is lent when all of its fingers have faulted, to be mended.
    pub fn lent_through(mut self, lender: Lender<T>) -> Self {
        self.lender = Some(lender);
        self
    }
}

/// How long a board may take to confirm its end state, ns: two attempts. Without it the watchdog does the same.
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
    /// A servo whose first cycle begins at the start of `schedule`.
    pub fn new(clock: C, schedule: Schedule, ports: Vec<ServedPort<T>>) -> Self {
        let reply_window = (schedule.period() as f64 * REPLY_WINDOW) as u64;
        Self { clock, schedule, reply_window, ports: ports.into(), follower: None }
    }

    /// The same servo with its schedule so much later, ns.
    pub fn later(mut self, by: u64) -> Self {
        self.schedule.shift(by.cast_signed());
        self
    }

    /// The same servo, with periods by the clock of its first board.
    pub fn following_board(mut self) -> Self {
        self.follower = Some(Follower::new(self.schedule.period()));
        self
    }

    /// What the servo touches and is not in this value itself.
    pub fn memory(&self) -> LockedMemory {
        let mut memory = LockedMemory::default();
        memory.add(&self.ports);
        for port in self.ports.iter() {
            memory.add(&port.fingers);
            port.fingers.iter().for_each(|finger| memory.append(finger.memory()));
        }
        memory
    }

    /// Runs until every finger is closed, or faulted and asked to close. A panic is a defect, but it must not leave the
    /// last torque on the motors: it faults every finger, and every board is told to stop.
    pub fn run(&mut self) {
        let cycles = || {
            while !self.finished() {
                self.cycle();
            }
            self.confirm_stops();
        };
        if catch_unwind(AssertUnwindSafe(cycles)).is_err() {
            // If even this panics, the board's watchdog is left.
            let _ = catch_unwind(AssertUnwindSafe(|| self.fail()));
        }
    }

    /// Whether every finger is closed, or faulted and asked to close.
    pub fn finished(&self) -> bool {
        self.ports.iter().flat_map(|port| port.fingers.iter()).all(FingerServo::finished)
    }

    /// One period: wait, commands out, replies in, compute, report. Nothing here allocates, locks or blocks beyond the
    /// deadline.
    pub fn cycle(&mut self) {
        let beginning = self.schedule.next();
        self.clock.sleep_until(beginning);
        let began = self.clock.now();
        for port in self.ports.iter_mut() {
            port.exchange();
            port.fingers.iter_mut().for_each(FingerServo::listen);
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
        let mut computing = self.clock.now();
        let skipped = self.schedule.advance(computing);
        let overrun = (computing > self.schedule.next()).then_some(skipped);
        if let Some(follower) = &mut self.follower {
            let first = self.ports.iter().flat_map(|port| port.fingers.iter()).next();
            let reading = first.and_then(FingerServo::sampled_at);
            self.schedule.shift(follower.correction(reading, 1 + skipped));
        }
        for port in self.ports.iter_mut() {
            let heard = port.heard();
            for finger in port.fingers.iter_mut() {
                finger.end(began, self.schedule.next(), overrun, &heard);
                let computed = self.clock.now();
                finger.note(CycleStage::Compute, computing, computed);
                finger.note(CycleStage::Whole, beginning, computed);
                finger.tell();
                computing = computed;
            }
        }
    }

    /// The last thing to do when a cycle panicked: every finger faulted, every board told to stop.
    fn fail(&mut self) {
        // Whoever would mend a port learns that nobody is left to run it.
        self.ports.iter_mut().for_each(|port| port.lender = None);
        let now = self.clock.now();
        for port in self.ports.iter_mut() {
            let heard = port.heard();
            for finger in port.fingers.iter_mut() {
                finger.fault(Fault::new(FaultKind::ServoPanic));
                finger.end(now, self.schedule.next(), None, &heard);
                finger.tell();
            }
        }
        self.confirm_stops();
    }

    /// Tells every board to stop, until it confirms that or the line fails: closing a port throws away what has not
    /// left it yet. Nothing else is left to do in time, so this waits.
    fn confirm_stops(&mut self) {
        self.send_stops();
        for port in self.ports.iter_mut() {
            // A link that was lent has stopped its boards before.
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
                    // Where nobody is left to tell, the board's watchdog does the rest.
                    port.failed |= matches!(link.stop(finger.address(), 0), Err(LinkError::Port(_)));
                }
            }
        }
    }
}

impl<T: Transport> ServedPort<T> {
    /// Lends the link when no finger uses it any more, and takes back a mended one.
    fn exchange(&mut self) {
        let Some(lender) = &mut self.lender else { return };
        let all_at_rest = self.fingers.iter().all(FingerServo::at_rest);
        if let Some(link) = self.link.take_if(|_| all_at_rest) {
            self.heard_before = self.heard_before.plus(&link.counters());
            // There is room: it is the only link.
            if let Err(lent) = lender.lend.push(Lent { link, failed: self.failed }) {
                self.link = Some(lent.link);
            }
        } else if let Some(Mended { link, configured, stop_calls }) = lender.mended.pop() {
            self.failed = false;
            // Of the same link, or of a new one: it goes on from what was counted.
            self.heard_before = self.heard_before.less(&link.counters());
            self.link = Some(link);
            for (finger, configured) in self.fingers.iter_mut().zip(configured) {
                configured.into_iter().for_each(|configured| finger.recover(&configured, stop_calls));
            }
        }
    }

    /// What was heard since open.
    fn heard(&self) -> LinkCounters {
        self.link.as_ref().map_or(self.heard_before, |link| self.heard_before.plus(&link.counters()))
    }

    /// All commands of the port back to back, so that replies overlap the commands that follow.
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
        // One for all replies of the period: a board that sends without end must not hold the thread.
        let mut allowance = Allowance::for_replies(deadline);
        while self.fingers.iter().any(FingerServo::waiting) {
            let Some(link) = &mut self.link else { return };
            match link.receive_within(&mut allowance) {
                Ok(Some(received)) => {
                    let mut addressed = self.fingers.iter_mut().find(|finger| finger.address() == received.address);
                    let Some(finger) = addressed.take_if(|finger| finger.awaits(&received)) else {
                        addressed.into_iter().for_each(|finger| finger.pass_over(&received));
                        continue;
                    };
                    finger.take(&received);
                    let (ready, read) = link.arrival();
                    finger.note(CycleStage::Wire, sent, ready);
                    finger.note(CycleStage::Read, ready, read);
                    finger.note(CycleStage::Decode, read, clock.now());
                }
                Ok(None) => break,
                // The other fingers of the board may be as they were.
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
