//! The fetching of tactile events, one in a period.

use super::Elements;
use crate::board::OutgoingRequest;
use crate::board::protocol::{Capabilities, TactileChange, TactileEvent, TactileRequest};
use crate::finger::FaultKind;
use crate::finger::events::{EventKind, Occurrence};
use crate::model::Part;
use crate::realtime::LockedMemory;

/// Number of requests in a row without an answer, after which the board is asked less often.
const PATIENCE: u32 = 10;

/// Number of periods between two requests to a board that does not answer them.
const PAUSE: u32 = 100;

/// The servo's side of the fetching of one finger's tactile events. It never waits or allocates.
pub(in crate::finger) struct TouchFetching {
    elements: Elements,
    /// Whether the board has tactile events, and elements are configured.
    enabled: bool,
    /// Whether the line has time for a request in this period.
    permitted: bool,
    /// The sequence number of this period's request, until its answer arrives.
    asked: Option<u8>,
    /// Number of the last event that was received; 0 if none.
    received: u8,
    /// The board's count of lost events in its last answer; none before the first answer.
    lost: Option<u8>,
    /// Number of restarts of the board that recoveries have found since open.
    restarts: u32,
    /// Number of requests in a row without an answer.
    unanswered: u32,
    /// Number of periods until the next request.
    pause: u32,
}

impl TouchFetching {
    /// Constructs the fetching for a finger whose board has these capabilities. Adds the pages of the elements to
    /// `memory`.
    pub fn new(elements: Elements, board: Capabilities, memory: &mut LockedMemory) -> Self {
        elements.add_to(memory);
        let enabled = board.has(Capabilities::TACTILE) && elements.count() > 0;
        let (asked, lost) = (None, None);
        Self { elements, enabled, permitted: false, asked, received: 0, lost, restarts: 0, unanswered: 0, pause: 0 }
    }

    /// Resumes after a fault. The board may have been reset, so it may have begun to count its events again. A request
    /// with the number of an earlier event could then make the board delete events that were not received, so the next
    /// request has the number 0. If the board was not reset, one event may come twice. A board that was reset has also
    /// forgotten its readings, and never reports the end of a contact from before the reset. `restarts` is the number
    /// of restarts that recoveries have found since open. It may have grown after a fault of any kind, because the
    /// board may have restarted while its finger was faulted.
    pub fn recover(&mut self, fault: FaultKind, restarts: u32) {
        (self.asked, self.received, self.unanswered, self.pause) = (None, 0, 0, 0);
        let restarted = std::mem::replace(&mut self.restarts, restarts) != restarts;
        self.lost = match fault {
            FaultKind::BoardReset => Some(0),
            // The board may have lost its power. It then counts lost events from 0 again.
            FaultKind::LostReplies | FaultKind::DamagedReplies | FaultKind::PortVanished | FaultKind::PortFailed => {
                None
            }
            _ if restarted => Some(0),
            _ => return,
        };
        self.elements.forget_readings();
    }

    /// Returns the elements, which planners read.
    pub fn elements(&self) -> &Elements {
        &self.elements
    }

    /// Begins a period. `answered` says whether the last Command was answered. If it was not, the line has no time for
    /// a request. A request without an answer is not repeated in its own period. The next request fetches the same
    /// event.
    pub fn begin(&mut self, answered: bool) {
        self.permitted = answered;
        if self.asked.take().is_some() {
            self.unanswered += 1;
            if self.unanswered >= PATIENCE {
                self.pause = PAUSE;
            }
        }
        self.pause = self.pause.saturating_sub(1);
    }

    /// Returns whether a request is due in this period.
    pub fn due(&self) -> bool {
        self.enabled && self.permitted && self.pause == 0
    }

    /// Returns the request of this period for the finger with this address. `sequence` is the sequence number of its
    /// Command.
    pub fn request(&mut self, address: u8, sequence: u8) -> OutgoingRequest {
        self.asked = Some(sequence);
        OutgoingRequest { address, sequence, request: TactileRequest { received: self.received } }
    }

    /// Returns whether this period's request has no answer yet.
    pub fn waiting(&self) -> bool {
        self.asked.is_some()
    }

    /// Returns whether an answer with this sequence number answers this period's request. A late answer to an earlier
    /// request is dropped: this period's request fetches the same event.
    pub fn awaits(&self, sequence: u8) -> bool {
        self.asked == Some(sequence)
    }

    /// Ignores the answer to this period's request. A later request fetches the same event again.
    pub fn ignore(&mut self) {
        self.asked = None;
    }

    /// Takes the answer to this period's request. Returns what has happened, if an element has changed.
    pub fn take(&mut self, event: &TactileEvent) -> Option<Occurrence> {
        (self.asked, self.unanswered) = (None, 0);
        let lost = event.lost.wrapping_sub(self.lost.unwrap_or(event.lost));
        self.elements.count_lost(lost);
        self.lost = Some(event.lost);
        if event.waiting == 0 || event.number == self.received {
            return None;
        }
        self.received = event.number;
        let reading = self.elements.store(event)?;
        let kind = match event.change {
            TactileChange::Made => EventKind::TouchMade,
            TactileChange::Lost => EventKind::TouchLost,
            TactileChange::Slip => EventKind::TouchSlip,
            TactileChange::Pressure => EventKind::TouchPressure,
            TactileChange::Invalid => EventKind::TouchInvalid,
            TactileChange::Nothing | TactileChange::Other(_) => return None,
        };
        Some(Occurrence { kind, part: Part::Finger, values: [event.element.into(), reading.force, 0.0, 0.0] })
    }
}
