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
use std::sync::atomic::{AtomicU32, Ordering};
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

/// A port that may have to be mended. It outlives its hand where somebody is at work on it.
struct Place {
    /// 1 to 3.
    fingers: Vec<i32>,
    /// How often it was mended and given back.
    mended: AtomicU32,
    /// Locked while ports are opened and hands shaken, which takes long. None once the hand is closed.
    workshop: Mutex<Option<Workshop>>,
}

/// What a port is mended with.
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

    /// Whether the servo has failed: it takes nothing back.
    fn servo_ended(&self) -> bool {
        self.borrower.lent.is_abandoned()
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
    places: Vec<Arc<Place>>,
    reconnecting: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Recovery {
    pub fn new(workshops: Vec<Workshop>) -> Self {
        let place = |workshop: Workshop| {
            let fingers = workshop.boards.iter().map(|board| board.finger).collect();
            Arc::new(Place { fingers, mended: AtomicU32::new(0), workshop: Mutex::new(Some(workshop)) })
        };
        Self { places: workshops.into_iter().map(place).collect(), reconnecting: None }
    }

    /// Starts that thread, where a port asks for it.
    pub fn start(&mut self) -> io::Result<()> {
        let asks = |place: &Arc<Place>| place.workshop.lock().as_ref().is_some_and(|workshop| workshop.reconnect);
        if !self.places.iter().any(asks) {
            return Ok(());
        }
        let (stop, stopped) = bounded(0);
        let places = self.places.clone();
        let thread = spawn("sun2xp ports", Priority::default(), move |_| reconnect(&places, &stopped))?;
        self.reconnecting = Some((stop, thread));
        Ok(())
    }

    /// In a forked child, which has no such thread.
    pub fn forget(&mut self) {
        std::mem::forget(self.reconnecting.take());
    }

    /// Ends that thread, and closes the ports that the servos have lent: waits for whoever is at work on one.
    pub fn end(&mut self) {
        if let Some((stop, thread)) = self.reconnecting.take() {
            drop(stop);
            // A panic has ended it before.
            let _ = thread.join();
        }
        self.places.iter().for_each(|place| *place.workshop.lock() = None);
    }
}

fn reconnect(places: &[Arc<Place>], stopped: &Receiver<()>) {
    while stopped.recv_timeout(LOOKING_FOR_PORTS) == Err(RecvTimeoutError::Timeout) {
        for place in places {
            if let Some(workshop) = &mut *place.workshop.lock()
                && workshop.reconnect
                && !workshop.servo_ended()
                && workshop.fetch()
                && !workshop.checked
            {
                // Whoever recovers the finger is told what is wrong.
                let _ = workshop.mend();
            }
        }
    }
}

/// A recovery under way, in three steps, of which only the second takes long, and needs no hand.
pub struct Recovering {
    /// Nothing is to be done without one.
    task: Option<Task>,
    begun: Instant,
}

struct Task {
    finger: i32,
    place: Arc<Place>,
    /// As it was.
    mended: u32,
    /// Every finger of the port, with how often it had recovered before.
    fingers: Vec<(i32, u32)>,
    stop_calls: u32,
}

impl Recovering {
    /// Notes how finger 1, 2 or 3 stands, with every other finger of its port. Nothing is to be done for a finger that is not
    /// faulted.
    ///
    /// # Errors
    /// No such finger.
    pub fn begin(hand: &Hand, finger: i32) -> Result<Self, HandError> {
        let begun = Instant::now();
        // An emergency stop from here on counts.
        let stop_calls = stop_calls();
        let place = hand.recovery.places.iter().find(|place| place.fingers.contains(&finger));
        let place = place.ok_or(HandError::NoSuchFinger(finger))?.clone();
        // Before the finger is looked at: who mends the port from here on has done it for this call too.
        let mended = place.mended.load(Ordering::Acquire);
        if !matches!(hand.report(finger)?.stage, Stage::Faulted(_)) {
            return Ok(Self { task: None, begun });
        }
        let before = |&finger: &i32| Ok((finger, hand.report(finger)?.recoveries));
        let fingers = place.fingers.iter().map(before).collect::<Result<_, HandError>>()?;
        Ok(Self { task: Some(Task { finger, place, mended, fingers, stop_calls }), begun })
    }

    /// Mends what the finger is connected by and lets it take up slack, with every other finger of the port. Ports are opened and
    /// hands shaken here: it may take a second. Only those wait for it who mend the same port or close the hand.
    ///
    /// # Errors
    /// A finger that runs on the same port; a port or board that does not serve, or is another than at open; a servo that has
    /// failed; a hand that was closed.
    pub fn mend(&self) -> Result<(), HandError> {
        let Some(Task { finger, ref place, mended, stop_calls, .. }) = self.task else { return Ok(()) };
        loop {
            if let Some(workshop) = &mut *place.workshop.lock() {
                if place.mended.load(Ordering::Acquire) != mended {
                    // Somebody who recovers a finger of the same port was faster.
                    return Ok(());
                }
                if workshop.servo_ended() {
                    return Err(HandError::ServoEnded(finger));
                }
                if workshop.fetch() {
                    let configured = workshop.mend()?;
                    workshop.give_back(configured, stop_calls);
                    place.mended.fetch_add(1, Ordering::Release);
                    return Ok(());
                }
            } else {
                return Err(HandError::NoAnswer(finger));
            }
            if self.begun.elapsed() > LENDING {
                return Err(HandError::PortInUse(finger));
            }
            sleep(LOOKING);
        }
    }

    /// Whether every finger of the port holds the pose that it was found in.
    ///
    /// # Errors
    /// A finger that faults again.
    pub fn poll(&self, hand: &Hand) -> Result<bool, HandError> {
        let mut done = true;
        for &(finger, before) in self.task.iter().flat_map(|task| &task.fingers) {
            let report = hand.report(finger)?;
            match report.stage {
                Stage::Faulted(_) if report.recoveries == before => {
                    if self.begun.elapsed() > TAKING_BACK {
                        return Err(HandError::NoAnswer(finger));
                    }
                    done = false;
                }
                Stage::Faulted(fault) => return Err(HandError::Faulted { finger, fault }),
                stage => done &= stage != Stage::Opening,
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
    /// As [`Recovering::begin`], [`Recovering::mend`] and [`Recovering::poll`].
    pub fn recover(&self, finger: i32) -> Result<(), HandError> {
        let recovering = Recovering::begin(self, finger)?;
        recovering.mend()?;
        while !recovering.poll(self)? {
            sleep(LOOKING);
        }
        Ok(())
    }
}
