//! A port and its fingers. The port sends the Commands of its fingers, and receives the Replies.

use crate::board::protocol::Message;
use crate::board::{Allowance, Arrival, Link, LinkCounters, LinkError, OutgoingCommand, OutgoingRequest, Transport};
use crate::finger::relay::RelayedRequest;
use crate::finger::{FingerServo, LinkServoEnd, ReleasedLink, RepairedLink, RestoredFinger};
use crate::model::configuration::FINGERS;
use crate::realtime::{Clock, CycleStage, LockedMemory, Pages};

/// A port and its fingers.
pub struct ServedPort<T> {
    /// None while the link is being repaired.
    pub(super) link: Option<Link<T>>,
    /// Whether the port has failed.
    pub(super) failed: bool,
    /// None if the port cannot be repaired while the hand is open.
    pub(super) handover: Option<LinkServoEnd<T>>,
    pub(super) fingers: Pages<[FingerServo]>,
    /// Number of TactileRequests for which the line has time in every period.
    requests: usize,
    /// The finger that may send the first request of the next period.
    next_request: usize,
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
            requests: 0,
            next_request: 0,
            earlier_counters: LinkCounters::default(),
        }
    }

    /// Sends up to this number of TactileRequests in every period.
    pub fn with_requests(mut self, requests: usize) -> Self {
        self.requests = requests.min(FINGERS);
        self
    }

    /// When all fingers of the port have faulted, the servo passes the link on through `handover`, so that the link can
    /// be repaired. The servo also relays the handshakes of single fingers.
    pub fn with_handover(mut self, handover: LinkServoEnd<T>) -> Self {
        self.handover = Some(handover);
        self
    }

    /// Returns the memory of the port that is not in this value itself.
    pub(super) fn memory(&self) -> LockedMemory {
        let mut memory = LockedMemory::default();
        memory.add(&self.fingers);
        self.fingers.iter().for_each(|finger| memory.append(finger.memory()));
        self.handover.iter().for_each(|handover| handover.add_to(&mut memory));
        memory
    }

    /// Releases the link for repair when no finger uses it any more, or takes back a repaired one. Takes back a finger
    /// whose handshake was relayed.
    pub(super) fn exchange(&mut self) {
        let Some(handover) = &mut self.handover else { return };
        // While the link is released, a finger whose handshake was relayed is not taken back here. The repair of the
        // link includes that finger.
        if self.link.is_some()
            && let Some(RestoredFinger { address, board }) = handover.restored.pop()
        {
            let finger = self.fingers.iter_mut().find(|finger| finger.address() == address && finger.at_rest());
            finger.into_iter().for_each(|finger| finger.recover(&board));
        }
        let all_at_rest = self.fingers.iter().all(FingerServo::at_rest);
        if let Some(link) = self.link.take_if(|_| all_at_rest) {
            self.earlier_counters = self.earlier_counters.wrapping_add(&link.counters());
            // The push succeeds, because this is the only link.
            if let Err(rejected) = handover.released.push(ReleasedLink { link, failed: self.failed }) {
                self.link = Some(rejected.link);
            }
        } else if let Some(RepairedLink { link, boards }) = handover.repaired.pop() {
            self.failed = false;
            // From now on, `counters` adds the counters of this link to `earlier_counters`. What this link has counted
            // until now is subtracted here, so that the sum does not jump, whether this is the same link or a new one.
            // The difference may be below 0: the repair itself has received frames.
            self.earlier_counters = self.earlier_counters.wrapping_sub(&link.counters());
            self.link = Some(link);
            // The handshakes of the repair are newer than a relayed one.
            while handover.restored.pop().is_some() {}
            for (finger, board) in self.fingers.iter_mut().zip(boards) {
                board.iter().for_each(|board| finger.recover(board));
            }
        }
    }

    /// Returns the counters of the port since open.
    pub(super) fn counters(&self) -> LinkCounters {
        self.link.as_ref().map_or(self.earlier_counters, |link| self.earlier_counters.wrapping_add(&link.counters()))
    }

    /// Returns the next relayed request, if its finger is still faulted (see [`FingerServo::at_rest`]). Otherwise the
    /// request came too late, and is discarded.
    fn relayed_request(&mut self) -> Option<RelayedRequest> {
        let request = self.handover.as_mut()?.relay.requests.pop()?;
        self.fingers.iter().any(|finger| finger.address() == request.address && finger.at_rest()).then_some(request)
    }

    /// Passes on the answer to a relayed request. Returns false if the answer is not from a faulted finger (see
    /// [`FingerServo::at_rest`]).
    fn relay(&mut self, answer: &Message) -> bool {
        let finger = self.fingers.iter().find(|finger| finger.address() == answer.address);
        let (true, Some(handover)) = (finger.is_some_and(FingerServo::at_rest), &mut self.handover) else {
            return false;
        };
        handover.relay.answers.push(*answer).is_ok()
    }

    /// Sends all commands of the port back to back, so that the first replies overlap with the later commands. A
    /// relayed request follows the commands.
    pub(super) fn send(&mut self) {
        let mut commands = [OutgoingCommand::default(); FINGERS];
        let mut count = 0;
        for (command, place) in self.fingers.iter_mut().filter_map(FingerServo::begin).zip(&mut commands) {
            *place = command;
            count += 1;
        }
        let relayed = self.relayed_request();
        let relaying = relayed.is_some() || self.link.as_ref().is_some_and(Link::awaits_relayed);
        // The line has no time for TactileRequests while it carries a handshake.
        let (requests, asked) = if relaying { Default::default() } else { self.requests() };
        let Some(link) = &mut self.link else { return };
        relayed.iter().for_each(|relayed| link.relay(relayed.bytes()));
        if let Err(error) = link.send_with(&commands[..count], &requests[..asked]) {
            self.fail(&error);
        }
    }

    /// Returns the TactileRequests of this period and their number. The fingers take turns if there is not enough time
    /// for all of them.
    fn requests(&mut self) -> ([OutgoingRequest; FINGERS], usize) {
        let (mut requests, mut asked) = ([OutgoingRequest::default(); FINGERS], 0);
        let first = self.next_request;
        for turn in 0..self.fingers.len() {
            let place = (first + turn) % self.fingers.len();
            let finger = &mut self.fingers[place];
            if asked < self.requests && finger.touch_due() {
                requests[asked] = finger.touch_request();
                asked += 1;
                self.next_request = (place + 1) % self.fingers.len();
            }
        }
        (requests, asked)
    }

    /// Receives Replies until `deadline`. After the last Reply, receives answers to TactileRequests until
    /// `touch_deadline`. `sent` is the end of the write. All times are in ns.
    pub(super) fn receive(&mut self, deadline: u64, touch_deadline: u64, sent: u64, clock: &impl Clock) {
        // One allowance for all replies of the period: a board that sends without end must not keep the thread here.
        let mut allowance = Allowance::for_replies(deadline);
        while self.fingers.iter().any(FingerServo::waiting) {
            if !self.receive_one(&mut allowance, sent, clock) {
                return;
            }
        }
        if self.fingers.iter().any(FingerServo::awaits_touch) {
            let mut allowance = Allowance::for_replies(touch_deadline);
            while self.fingers.iter().any(FingerServo::awaits_touch) && self.receive_one(&mut allowance, sent, clock) {}
        }
        // The answer to a relayed request may come in a later period, so the servo does not wait for it.
        let mut arrived = Allowance::for_replies(0);
        while self.link.as_ref().is_some_and(Link::awaits_relayed) && self.receive_one(&mut arrived, sent, clock) {}
    }

    /// Receives one answer. Returns false if no answer arrived in time, or the port failed.
    fn receive_one(&mut self, allowance: &mut Allowance, sent: u64, clock: &impl Clock) -> bool {
        let Some(link) = &mut self.link else { return false };
        match link.next_arrival(allowance) {
            Ok(Some(Arrival::Reply(received))) => {
                let mut addressed = self.fingers.iter_mut().find(|finger| finger.address() == received.address);
                let Some(finger) = addressed.take_if(|finger| finger.awaits(&received)) else {
                    addressed.into_iter().for_each(|finger| finger.count_unexpected(&received));
                    return true;
                };
                finger.take(&received);
                let (ready, read) = link.arrival();
                finger.note(CycleStage::Wire, sent, ready);
                finger.note(CycleStage::Read, ready, read);
                finger.note(CycleStage::Decode, read, clock.now());
            }
            Ok(Some(Arrival::Tactile { address, sequence, event })) => {
                let mut addressed = self.fingers.iter_mut().filter(|finger| finger.address() == address);
                if !addressed.any(|finger| finger.take_touch(sequence, &event)) {
                    link.count_foreign();
                }
            }
            Ok(Some(Arrival::Relayed(answer))) => {
                if !self.relay(&answer)
                    && let Some(link) = &mut self.link
                {
                    link.count_foreign();
                }
            }
            Ok(None) => return false,
            // Only the refused finger faults, because the other fingers of the board may be unaffected.
            Err(LinkError::Refused { address, refused }) => {
                let addressed = self.fingers.iter_mut().filter(|finger| finger.address() == address);
                addressed.for_each(|finger| finger.fault((&refused).into()));
            }
            Err(error) => {
                self.fail(&error);
                return false;
            }
        }
        true
    }

    pub(super) fn note(&mut self, stage: CycleStage, from: u64, to: u64) {
        self.fingers.iter_mut().for_each(|finger| finger.note(stage, from, to));
    }

    fn fail(&mut self, error: &LinkError) {
        self.failed |= matches!(error, LinkError::Port(_));
        self.fingers.iter_mut().for_each(|finger| finger.fault(error.into()));
    }
}
