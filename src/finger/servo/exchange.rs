//! A finger's part of the exchange with its board in every period: the command that it sends, and the reply that it
//! accepts.

use super::FingerServo;
use crate::board::protocol::{Command, Status, TactileEvent};
use crate::board::{OutgoingCommand, OutgoingRequest, Received};
use crate::finger::{Fault, FaultKind};
use crate::realtime::CycleStage;

/// Limit of the age of a measurement, ms. The board's clock wraps after 65.5 ms, so it does not give the age of a
/// measurement that is older than this limit.
const CLOCK_UNKNOWN_MS: f64 = 60.0;

impl FingerServo {
    /// Begins a cycle. Returns the command that the last cycle computed, if the finger is under control and a command
    /// is due.
    pub fn begin(&mut self) -> Option<OutgoingCommand> {
        self.touch.begin(self.answered && self.under_control());
        if !self.under_control() {
            return None;
        }
        if self.answered || !self.link.in_step() {
            self.sequence = self.sequence.wrapping_add(1);
            self.toggle = !self.toggle;
            self.answered = false;
        } else if !self.link.repeats() {
            return None;
        }
        let torques = self.command.motor_torques.map(|torque| self.board.torque_count(torque)).into();
        let command = Command { toggle: self.toggle, enable: true, torques };
        Some(OutgoingCommand { address: self.address, sequence: self.sequence, command })
    }

    /// Returns whether a TactileRequest may follow this period's Command.
    pub fn touch_due(&self) -> bool {
        self.touch.due()
    }

    /// Returns the TactileRequest of this period.
    pub fn touch_request(&mut self) -> OutgoingRequest {
        self.touch.request(self.address, self.sequence)
    }

    /// Whether this period's TactileRequest has no answer yet.
    pub fn awaits_touch(&self) -> bool {
        self.touch.waiting()
    }

    /// Takes the answer to a TactileRequest. Returns whether the answer was awaited. Events that arrive before the
    /// finger enters the stage `Running` for the first time are not reported, because they may have happened before the
    /// hand was opened. The answer is ignored if the finger has faulted in this period: a board that was reset counts
    /// its events from 1 again.
    pub fn take_touch(&mut self, sequence: u8, event: &TactileEvent) -> bool {
        let awaited = self.touch.awaits(sequence);
        if awaited && !self.under_control() {
            self.touch.ignore();
        } else if awaited
            && let Some(occurrence) = self.touch.take(event)
            && self.report.springs > 0
        {
            self.events.write(occurrence);
        }
        awaited
    }

    /// Whether to send a Stop frame to the board. A finger that is faulted or closed gets a limited number of Stop
    /// frames, and every call that returns true counts one of them.
    pub fn stopping(&mut self) -> bool {
        let stopping = !self.under_control() && self.stops_left > 0;
        self.stops_left -= u8::from(stopping);
        stopping
    }

    /// Whether this cycle's reply has not arrived yet.
    pub fn waiting(&self) -> bool {
        !self.answered && self.under_control()
    }

    /// Whether a reply answers this cycle's command. A reply to an earlier command is not accepted, because its
    /// measurement is old.
    pub fn awaits(&self, received: &Received) -> bool {
        received.sequence == self.sequence && self.waiting()
    }

    /// Counts a reply that does not answer this cycle's command. Either it has arrived twice, or it has arrived after
    /// the end of its cycle.
    pub fn count_unexpected(&mut self, received: &Received) {
        match received.sequence == self.last_answer {
            true => self.report.losses.duplicate_replies += 1,
            false => self.report.losses.late_replies += 1,
        }
    }

    /// Counts an overrun of a cycle whose computation ended after the next cycle was due.
    pub fn count_late_computation(&mut self) {
        self.report.losses.overruns += 1;
    }

    /// Reading of the board's clock when this cycle's command arrived, us modulo 65 536; none without a reply.
    pub fn sampled_at(&self) -> Option<u16> {
        self.sampled_at.filter(|_| self.replied)
    }

    /// Accepts the reply that answers this cycle's command.
    pub fn take(&mut self, received: &Received) {
        (self.answered, self.replied) = (true, true);
        self.last_answer = received.sequence;
        let reply = &received.reply;
        let (mut counted, mut clocked) = (self.sample_age as f64, None);
        // This cycle's command took effect at this measurement, and was computed from the previous measurement. The age
        // to note is therefore the time between the two measurements.
        if let Some(before) = self.sampled_at
            && counted * self.limits.period_ms < CLOCK_UNKNOWN_MS
        {
            let microseconds = reply.sampled_at.wrapping_sub(before);
            self.timing.note(CycleStage::Age, 0, u64::from(microseconds) * 1000);
            clocked = Some(f64::from(microseconds) * 1e-3 / self.limits.period_ms);
        }
        if self.link.in_step() {
            // The finger has moved for one period, however late the reply is.
            (counted, clocked) = (1.0, None);
        }
        (self.sampled_at, self.sample_age) = (Some(reply.sampled_at), 0);
        self.feedback.motor_counts = reply.counts_after(self.feedback.motor_counts);
        self.feedback.gauge_counts = reply.gauges;
        self.supervision.note_reply(reply.status, counted, clocked);
        // If the board had no valid zero at opening, ZERO_VALID cannot show that the board has lost its counts. A board
        // loses its counts together with the terms of its Configure frame, so CONFIGURED shows the loss.
        let lost = |bit: Status| self.status.has(bit) && !reply.status.has(bit);
        let zero_lost = !reply.status.has(Status::ZERO_VALID) && (lost(Status::ZERO_VALID) || lost(Status::CONFIGURED));
        self.status = reply.status;
        if reply.status.has(Status::FAULTS | Status::WATCHDOG_TRIPPED | Status::ENDED) {
            let fault = Fault::stopped(reply.status);
            // The servo has sent commands in time. If they had reached the board, its watchdog would not have tripped.
            match self.link.explains_watchdog().filter(|_| fault.kind == FaultKind::Watchdog) {
                Some(lost) => self.fault_silence(lost),
                None => self.fault(fault),
            }
        } else if zero_lost {
            self.fault(Fault::of(FaultKind::ZeroLost, f64::from(reply.status.0)));
        }
    }

    /// Stops the finger because this many replies in a row were lost.
    pub(super) fn fault_silence(&mut self, lost: u32) {
        self.fault(self.supervision.silence(f64::from(lost) * self.limits.period_ms));
    }
}
