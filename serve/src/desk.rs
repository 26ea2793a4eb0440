//! The desk of the hand. Everything that clients want passes through it, one message at a time. It knows the owner,
//! decides which Targets are taken, and keeps track of how long the owner may still be silent. It sends to the
//! mailboxes of the fingers and never waits.

use crate::acceptance::{Acceptance, Fresh, Rejection};
use crate::fingers::Fingers;
use crate::goal::Goal;
use crate::ownership::{Owner, Ownership};
use crate::settings::Limits;
use crate::silence::{MILLISECOND, Silence};
use std::collections::BTreeSet;
use std::sync::Arc;
use sun2xp::control::events::Arrival;
use sun2xp::{Fault, FaultKind, Hand, HandError};
use sun2xp_remote_protocol::{Answer, ClientName, Code, Counts, DecodeError, FINGERS, Target};

/// If an ownership ends because its owner is silent, the desk stops every finger after this time, ns, in case one still
/// moves. The servos also measure the silence, and normally stop their fingers earlier.
const GRACE: u64 = 20 * MILLISECOND;

/// The desk of a hand.
pub struct Desk {
    hand: Arc<Hand>,
    limits: Limits,
    ownership: Ownership,
    acceptance: Acceptance,
    /// How long the owner may be silent; none without an owner, and while an acquire recovers fingers.
    silence: Option<Silence>,
    fingers: Fingers,
    counts: Counts,
    clients: BTreeSet<ClientName>,
    /// Whether a finger was caught (see [`crate::silence`]) at the last call of [`Desk::look`].
    caught: bool,
    /// The time at which every finger is stopped because one may still move, ns.
    stop_at: Option<u64>,
    stops: Stops,
}

/// How often each finger was stopped.
pub type Stops = [u32; FINGERS];

impl Desk {
    /// Constructs the desk of this hand. `start` is the time at which the server started, ns.
    #[must_use]
    pub fn new(hand: Arc<Hand>, limits: Limits, start: u64) -> Self {
        Self {
            fingers: Fingers::new(hand.clone(), limits.lead_force),
            hand,
            limits,
            ownership: Ownership::new(start),
            acceptance: Acceptance::default(),
            silence: None,
            counts: Counts::default(),
            clients: BTreeSet::new(),
            caught: false,
            stop_at: None,
            stops: Stops::default(),
        }
    }

    /// Returns the owner; none if nobody owns the hand.
    #[must_use]
    pub fn owner(&self) -> Option<&Owner> {
        self.ownership.owner()
    }

    /// Returns the number of the epoch in force; 0 without an owner.
    #[must_use]
    pub fn epoch_number(&self) -> u64 {
        self.ownership.number()
    }

    /// Returns what the desk has counted.
    #[must_use]
    pub fn counts(&self) -> &Counts {
        &self.counts
    }

    /// Returns the number of clients that have sent a permitted Request.
    #[must_use]
    pub fn clients(&self) -> u32 {
        self.clients.len() as u32
    }

    /// Returns what the owner wants of the fingers.
    #[must_use]
    pub fn goals(&self) -> [Goal; FINGERS] {
        *self.fingers.goals()
    }

    /// Returns the progress of each finger toward where the owner wants it.
    #[must_use]
    pub fn progress(&self) -> [Arrival; FINGERS] {
        self.fingers.progress()
    }

    /// Notes that this client has sent a permitted Request.
    pub fn note_client(&mut self, client: &ClientName) {
        if !self.clients.contains(client) {
            self.clients.insert(client.clone());
        }
    }

    /// Counts a message that could not be decoded.
    pub fn count_malformed(&mut self) {
        Rejection::Malformed.count(&mut self.counts);
    }

    /// Takes a Target, or counts the reason why it is not taken. Returns an Answer for its sender if the hand refuses
    /// the Target. `client` is the client that is named in the Zenoh key of the Target, and `now` is the time at which
    /// the Target was received, ns.
    pub fn take_target(&mut self, client: &ClientName, payload: &[u8], now: u64) -> Option<Answer> {
        let tested = Target::decode(payload).map_err(|_: DecodeError| Rejection::Malformed).and_then(|target| {
            let owned = self.ownership.admits(client, target.epoch);
            self.acceptance.test(&target, owned, now, self.limits.catch_ms).map(|fresh| (target, fresh))
        });
        let (target, fresh) = match tested {
            Ok(tested) => tested,
            Err(rejection) => {
                rejection.count(&mut self.counts);
                return None;
            }
        };
        // A Target shows that the owner is alive, even if the hand refuses it.
        let silence = self.receive(fresh)?;
        match self.fingers.apply(&target.parts, &silence, now) {
            Ok(()) => {
                self.counts.taken += 1;
                None
            }
            Err(error) => {
                Rejection::Refused.count(&mut self.counts);
                self.fingers.keep_valid(&silence);
                let text = error.to_string();
                Some(Answer { number: target.sequence, ..self.answer(code_of(&error), text, target.epoch, now) })
            }
        }
    }

    /// Notes that the owner is alive. Returns none while an acquire recovers fingers.
    fn receive(&mut self, fresh: Fresh) -> Option<Silence> {
        let silence = self.silence.as_mut()?;
        silence.renew(fresh.seen, fresh.validity);
        Some(*silence)
    }

    /// Returns whether an acquire by this client is admitted.
    #[must_use]
    pub fn may_acquire(&self, client: &ClientName, take_over: bool) -> bool {
        self.ownership.other_owner(client, take_over).is_none()
    }

    /// Makes a client the owner at `now`, ns, with this epoch, and returns the number of the epoch. Paths of the
    /// previous owner end. The time limit for the new owner's silence begins with [`Desk::begin`].
    ///
    /// # Errors
    /// Returns the name of the other owner. Then nothing has changed.
    pub fn acquire(&mut self, client: &ClientName, take_over: bool, epoch: u64, now: u64) -> Result<u64, ClientName> {
        let number = self.ownership.acquire(client, take_over, epoch)?.number;
        (self.acceptance, self.silence, self.stop_at) = (Acceptance::default(), None, None);
        self.fingers.forget_commands();
        self.fingers.end_paths(&self.silence_from(now));
        Ok(number)
    }

    /// Begins the time limit for this client's silence at `now`, ns, if the client still owns the hand with this epoch.
    /// Returns whether it still does.
    pub fn begin(&mut self, client: &ClientName, epoch: u64, now: u64) -> bool {
        if !self.ownership.admits(client, epoch) {
            return false;
        }
        let silence = self.silence_from(now);
        self.silence = Some(silence);
        self.fingers.begin_epoch(&silence);
        true
    }

    /// Returns whether this client owns the hand and `epoch` is the epoch in force.
    #[must_use]
    pub fn admits(&self, client: &ClientName, epoch: u64) -> bool {
        self.ownership.admits(client, epoch)
    }

    /// Ends the ownership, and stops every finger.
    pub fn release(&mut self) {
        self.ownership.end();
        (self.silence, self.stop_at) = (None, None);
        // This returns no error, because it stops only fingers of the hand.
        let _ = self.stop(None);
    }

    /// Ends the ownership at `now`, ns. The fingers go to their end state as if the owner had fallen silent.
    pub fn abandon(&mut self, now: u64) {
        self.ownership.end();
        // The set point of a finger that is still being recovered has no validity that could end. The desk therefore
        // stops every finger when the time `end` has passed.
        let end = u64::from(self.limits.end_ms) * MILLISECOND + GRACE;
        (self.silence, self.stop_at) = (None, Some(now + end));
    }

    /// Stops `finger`, or every finger if `finger` is none, whoever owns the hand.
    ///
    /// # Errors
    /// Returns an error if the hand does not have the finger. Then nothing has stopped.
    pub fn stop(&mut self, finger: Option<i32>) -> Result<(), HandError> {
        let all: Vec<i32> = finger.map_or_else(|| self.fingers.numbers().collect(), |finger| vec![finger]);
        for number in all {
            self.hand.stop(number)?;
            self.stops[number as usize - 1] += 1;
        }
        Ok(())
    }

    /// Returns how often each finger was stopped so far. The stops at the end of an ownership count too.
    #[must_use]
    pub fn stops(&self) -> Stops {
        self.stops
    }

    /// Stops again the fingers that were stopped after `before` was read. A recovery that begins after such a stop
    /// would undo it.
    ///
    /// # Errors
    /// Returns an error if it has stopped a finger.
    pub fn stop_again(&mut self, before: &Stops) -> Result<(), HandError> {
        let mut stopped = Ok(());
        for finger in self.hand.fingers().members() {
            if self.stops[finger.index()] != before[finger.index()] {
                self.hand.stop(finger.get())?;
                stopped = Err(HandError::Faulted { finger, fault: Fault::new(FaultKind::FingerStopCall) });
            }
        }
        stopped
    }

    /// Advances set points, and ends the ownership of an owner that has been silent for too long. It is called about
    /// every 5 ms.
    pub fn look(&mut self, now: u64) {
        let caught = self.fingers.numbers().any(|number| self.hand.report(number).is_ok_and(|report| report.expired));
        if caught && !self.caught {
            self.counts.caught += 1;
        }
        self.caught = caught;
        match self.silence {
            Some(silence) if silence.is_over(now) => {
                self.counts.ended += 1;
                self.ownership.end();
                (self.silence, self.stop_at) = (None, Some(now + GRACE));
            }
            Some(silence) => self.fingers.advance(&silence, now),
            // An acquire is recovering fingers. The set points of the fingers that run stay valid meanwhile.
            None if self.ownership.owner().is_some() => self.fingers.keep_waiting(&self.silence_from(now)),
            None => {}
        }
        if self.stop_at.is_some_and(|at| now >= at) {
            self.stop_at = None;
            // A finger that was being calibrated may not have stopped by itself. A recovery that the owner has
            // requested may still be running, so faulted fingers are stopped too.
            let _ = self.stop(None);
        }
    }

    /// The silence of an owner whose time limit begins at `now`, ns.
    fn silence_from(&self, now: u64) -> Silence {
        Silence::after_acquire(now, self.limits.catch_ms, self.limits.end_ms)
    }

    /// Returns an Answer with the time `now`, ns.
    #[must_use]
    pub fn answer(&self, code: Code, text: String, epoch: u64, now: u64) -> Answer {
        Answer { code, catch_ms: self.limits.catch_ms, epoch, time: now, number: 0, text }
    }
}

/// The code of an Answer for an error of the hand.
#[must_use]
pub fn code_of(error: &HandError) -> Code {
    match error {
        HandError::NoSuchFinger(_) | HandError::NotInHand { .. } | HandError::NotOpened(_) => Code::NoSuchFinger,
        HandError::Faulted { .. } => Code::Stopped,
        HandError::Busy(_) | HandError::Limp(_) => Code::InProgress,
        _ => Code::Argument,
    }
}
