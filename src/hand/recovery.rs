//! Going on after a fault: ports are opened again, boards shake hands anew, and the finger comes under tension as after OpenHand.
//!
//! The servo lends its link for that when every finger on it is at rest, because opening a port and shaking hands take long. They
//! happen on the planner's thread, in a recover call, and before that on a thread of their own where `finger.reconnect` asks for it.

use crate::board::protocol::{Configured, Identity, Status};
use crate::board::{Link, LinkError, Port, Terms};
use crate::finger::{Borrower, Fault, FaultKind, Mended, Stage, stop_calls};
use crate::hand::{Hand, HandError};
use crate::model::configuration::FINGERS;
use crate::realtime::{Priority, now, spawn};
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use parking_lot::Mutex;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::thread::{JoinHandle, sleep};
use std::time::{Duration, Instant};

/// How often a port that is gone is looked for.
const LOOKING_FOR_PORTS: Duration = Duration::from_millis(100);

/// How long a board may take to answer, ns, each time it is tried: short, because it is tried again.
const ANSWER: u64 = 300_000_000;

/// A servo lends its link so long after the last of its fingers faulted, at most.
const LENDING: Duration = Duration::from_millis(500);

/// How often a recovery is looked at.
const LOOKING: Duration = Duration::from_millis(2);

/// A servo takes a link back within a cycle; one that has not after so long never will.
const TAKING_BACK: Duration = Duration::from_secs(5);

/// A port that may have to be mended.
pub(super) struct Workshop {
    path: PathBuf,
    baud: u32,
    /// Whether a port that has failed is opened again.
    reconnect: bool,
    /// In the order of the servo's.
    boards: Vec<KnownBoard>,
    borrower: Borrower<Port>,
    /// The servo has lent its link, and not got it back.
    lent: bool,
    /// That link, or a new one; none where the port is gone.
    link: Option<Link<Port>>,
    /// Its boards have answered, and are those of open.
    checked: bool,
}

/// What a board was at open.
pub(super) struct KnownBoard {
    /// 1 to 3.
    pub finger: i32,
    pub address: u8,
    pub terms: Terms,
    pub identity: Identity,
    pub zero_valid: bool,
}

impl Workshop {
    /// `path` and `baud`: how the port is opened. `reconnect`: whether it is, once it has failed. `boards` in the order of the
    /// servo's fingers.
    pub fn new(path: PathBuf, baud: u32, reconnect: bool, boards: Vec<KnownBoard>, borrower: Borrower<Port>) -> Self {
        Self { path, baud, reconnect, boards, borrower, lent: false, link: None, checked: false }
    }

    /// Takes the link, if the servo has lent it.
    fn fetch(&mut self) -> bool {
        if let Ok(lent) = self.borrower.lent.pop() {
            (self.lent, self.checked) = (true, false);
            self.link = (!lent.failed).then_some(lent.link);
        }
        self.lent
    }

    /// Opens the port where it is gone, and shakes hands with its boards: the same ones, with their zeros.
    fn mend(&mut self) -> Result<[Option<Configured>; FINGERS], HandError> {
        self.checked = false;
        let first = self.boards.first().map_or(0, |board| board.finger);
        let mut link = match self.link.take() {
            Some(link) => link,
            None if self.reconnect => Link::open(&self.path, self.baud)
                .map_err(|source| HandError::Link { finger: first as usize, source })?, // 1 to 3
            None => return Err(HandError::NotReconnected(first)),
        };
        let mut all = [None; FINGERS];
        for (board, place) in self.boards.iter().zip(&mut all) {
            let KnownBoard { finger, address, ref terms, .. } = *board;
            // One whose port had failed was not told to stop; cable and power may be back before its watchdog's time is over.
            let _ = link.stop(address, 0);
            match link.shake_hands(address, terms, now() + ANSWER) {
                Ok((identity, configured)) => {
                    board.check(&identity, configured.status)?;
                    *place = Some(configured);
                }
                Err(source) => {
                    // A port that has failed is closed here; the next attempt opens it.
                    if !matches!(source, LinkError::Port(_)) {
                        self.link = Some(link);
                    }
                    return Err(HandError::Link { finger: finger as usize, source }); // 1 to 3
                }
            }
        }
        (self.link, self.checked) = (Some(link), true);
        Ok(all)
    }

    fn give_back(&mut self, configured: [Option<Configured>; FINGERS], stop_calls: u32) {
        if let Some(link) = self.link.take() {
            self.lent = false;
            // There is room: the servo has taken the last one, or it would not have lent this one.
            let _ = self.borrower.mended.push(Mended { link, configured, stop_calls });
        }
    }
}

impl KnownBoard {
    fn check(&self, identity: &Identity, status: Status) -> Result<(), HandError> {
        let faulted = |fault| Err(HandError::Faulted { finger: self.finger, fault });
        if *identity != self.identity {
            return faulted(Fault::new(FaultKind::IdentityChanged));
        }
        if self.zero_valid && !status.has(Status::ZERO_VALID) {
            return faulted(Fault::of(FaultKind::ZeroLost, f64::from(status.0)));
        }
        Ok(())
    }
}

/// Every port of a hand, and the thread that looks for those that are gone.
pub(super) struct Recovery {
    workshops: Arc<Vec<Mutex<Workshop>>>,
    reconnecting: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Recovery {
    pub fn new(workshops: Vec<Workshop>) -> Self {
        Self { workshops: Arc::new(workshops.into_iter().map(Mutex::new).collect()), reconnecting: None }
    }

    /// Starts that thread, where a port asks for it.
    pub fn start(&mut self) -> io::Result<()> {
        if !self.workshops.iter().any(|workshop| workshop.lock().reconnect) {
            return Ok(());
        }
        let (stop, stopped) = bounded(0);
        let workshops = self.workshops.clone();
        let thread = spawn("sun2xp ports", Priority::default(), move |_| reconnect(&workshops, &stopped))?;
        self.reconnecting = Some((stop, thread));
        Ok(())
    }

    /// In a forked child, which has no such thread.
    pub fn forget(&mut self) {
        std::mem::forget(self.reconnecting.take());
    }
}

impl Drop for Recovery {
    fn drop(&mut self) {
        if let Some((stop, thread)) = self.reconnecting.take() {
            drop(stop);
            // A panic has ended it before.
            let _ = thread.join();
        }
    }
}

fn reconnect(workshops: &[Mutex<Workshop>], stopped: &Receiver<()>) {
    while stopped.recv_timeout(LOOKING_FOR_PORTS) == Err(RecvTimeoutError::Timeout) {
        for workshop in workshops {
            let mut workshop = workshop.lock();
            if workshop.reconnect && workshop.fetch() && !workshop.checked {
                // Whoever recovers the finger is told what is wrong.
                let _ = workshop.mend();
            }
        }
    }
}

/// A recovery under way.
pub struct Recovering {
    /// Every finger of the port, with how often it had recovered before.
    fingers: Vec<(i32, u32)>,
    begun: Instant,
}

impl Recovering {
    /// Mends what finger 1, 2 or 3 is connected by and lets it take up slack, with every other finger of the port. Nothing is to be
    /// done for a finger that is not faulted.
    ///
    /// # Errors
    /// No such finger; a finger that runs on the same port; a port or board that does not serve, or is another than at open.
    pub fn begin(hand: &Hand, finger: i32) -> Result<Self, HandError> {
        let begun = Instant::now();
        // An emergency stop from here on counts.
        let stop_calls = stop_calls();
        if !matches!(hand.report(finger)?.stage, Stage::Faulted(_)) {
            return Ok(Self { fingers: Vec::new(), begun });
        }
        let on_port = |workshop: &&Mutex<Workshop>| workshop.lock().boards.iter().any(|board| board.finger == finger);
        let workshop = hand.recovery.workshops.iter().find(on_port).ok_or(HandError::NoSuchFinger(finger))?;
        let mut workshop = workshop.lock();
        while !workshop.fetch() {
            if begun.elapsed() > LENDING {
                return Err(HandError::PortInUse(finger));
            }
            sleep(LOOKING);
        }
        let configured = workshop.mend()?;
        let fingers: Result<Vec<_>, HandError> =
            workshop.boards.iter().map(|board| Ok((board.finger, hand.report(board.finger)?.recoveries))).collect();
        let fingers = fingers?;
        workshop.give_back(configured, stop_calls);
        Ok(Self { fingers, begun })
    }

    /// Whether every finger of the port holds the pose that it was found in.
    ///
    /// # Errors
    /// A finger that faults again.
    pub fn poll(&self, hand: &Hand) -> Result<bool, HandError> {
        let mut done = true;
        for &(finger, before) in &self.fingers {
            let report = hand.report(finger)?;
            if report.recoveries == before {
                if self.begun.elapsed() > TAKING_BACK {
                    return Err(HandError::NoAnswer(finger));
                }
                done = false;
                continue;
            }
            match report.stage {
                Stage::Faulted(fault) => return Err(HandError::Faulted { finger, fault }),
                Stage::Opening => done = false,
                _ => hand.dispatcher.member(finger)?.mailbox.adopt(),
            }
        }
        Ok(done)
    }
}

impl Hand {
    /// Makes a faulted finger 1, 2 or 3 a spring again, that holds the pose it is in at its initial stiffness; and with it the
    /// other faulted fingers on its port. What made it fault must be mended. Does nothing for a finger that is not faulted.
    ///
    /// # Errors
    /// As [`Recovering::begin`] and [`Recovering::poll`].
    pub fn recover(&self, finger: i32) -> Result<(), HandError> {
        let recovering = Recovering::begin(self, finger)?;
        while !recovering.poll(self)? {
            sleep(LOOKING);
        }
        Ok(())
    }
}
