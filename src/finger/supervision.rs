//! Monitoring of one finger: the monitors of the control code, the quality of the line, and overruns of the servo.

use crate::board::protocol::Status;
use crate::control::monitors::{LineQuality, Watch};
use crate::control::{Controller, Feedback, State};
use crate::finger::faults::RecentWarnings;
use crate::finger::{Fault, FaultKind};

/// Window over which losses and overruns cause warnings, s.
const WARNING_WINDOW: f64 = 1.0;

/// A line counts as noisy if the share of lost replies in the window is larger than this.
const NOISY: f64 = 0.02;

/// A servo counts as overrunning if, in the window, the share of cycles that skipped periods is larger than this.
const OVERRUN: f64 = 0.02;

/// The line counts as unusable if the share of damaged replies in a window is larger than this. The length of the
/// window is equal to the time without replies after which a finger faults. With one damaged reply in two, the finger
/// is still under control.
const UNUSABLE: f64 = 0.6;

/// Share of damaged replies above which a finger that gets no valid reply reports the damage as the cause of its fault.
const DAMAGED: f64 = 0.25;

/// The board's clock counts as stopped after this number of samples in a row with less than [`LEAST_AGE`] between them.
/// A late cycle that is followed immediately by the next one gives one such sample.
const STOPPED: u32 = 16;

/// Least advance of the board's clock between two samples, periods. After a smaller one, the clock counts as not having
/// advanced.
const LEAST_AGE: f64 = 0.1;

/// State of the monitors of one finger.
pub(super) struct Supervision {
    watch: Watch,
    /// Periods between the last two samples.
    age: f64,
    /// Number of samples in a row between which the board's clock has hardly advanced.
    without_time: u32,
    /// Largest count of the gauges.
    full_scale: u16,
    noise: LineQuality,
    damage: LineQuality,
    damaged: f64,
    overruns: LineQuality,
    damaged_frames: u64,
    clipped: bool,
    /// Warning of this period.
    warning: Option<Fault>,
    pub recent_warnings: RecentWarnings,
}

impl Supervision {
    /// `patience`: number of cycles without replies after which a finger faults.
    pub fn new(rate: f64, patience: u32, gauge_bits: u8) -> Self {
        let warnings = LineQuality::new(rate * WARNING_WINDOW);
        Self {
            watch: Watch::default(),
            age: 1.0,
            without_time: 0,
            full_scale: (u32::from(u16::MAX) >> (16 - gauge_bits.clamp(1, 16))) as u16,
            noise: warnings,
            damage: LineQuality::new(f64::from(patience)),
            damaged: 0.0,
            overruns: warnings,
            damaged_frames: 0,
            clipped: false,
            warning: None,
            recent_warnings: RecentWarnings::default(),
        }
    }

    /// Notes the warnings in the status of a reply, and the time from the sample of the previous reply to the sample of
    /// this reply, in periods. `counted` is this time by the servo's count of periods. `clocked` is this time by the
    /// board's clock, or `None` if the clock does not give the time.
    pub fn note_reply(&mut self, status: Status, counted: f64, clocked: Option<f64>) {
        let advanced = clocked.is_none_or(|age| age >= LEAST_AGE);
        self.without_time = if advanced { 0 } else { self.without_time.saturating_add(1) };
        // With a clock that stands still, no time would pass for the monitors, and they would detect nothing.
        self.age = clocked.filter(|_| self.without_time < STOPPED).unwrap_or(counted);
        self.clipped = status.has(Status::TORQUE_CLIPPED);
    }

    /// Notes one period: whether the reply arrived, how many periods were skipped, and the total number of damaged
    /// frames. Returns a fault if the line is unusable.
    pub fn note_period(&mut self, answered: bool, skipped: u64, damaged_frames: u64) -> Option<Fault> {
        let count = |wrong: bool| f64::from(u8::from(wrong));
        let damaged = !answered && damaged_frames != self.damaged_frames;
        self.damaged_frames = damaged_frames;
        self.damaged = self.damage.note(count(damaged));
        let noise = self.noise.note(count(!answered));
        let overruns = self.overruns.note(count(skipped > 0));
        let share = |kind, share: f64| Fault::of(kind, 100.0 * share);
        self.warning = if overruns > OVERRUN {
            Some(share(FaultKind::Overrun, overruns))
        } else if noise > NOISY {
            Some(share(FaultKind::LineNoise, noise))
        } else {
            self.clipped.then_some(Fault::new(FaultKind::CurrentLimit))
        };
        (self.damaged > UNUSABLE).then(|| share(FaultKind::DamagedReplies, self.damaged))
    }

    /// The fault for a finger without a valid reply for this many milliseconds.
    pub fn silence(&self, milliseconds: f64) -> Fault {
        match self.damaged > DAMAGED {
            true => Fault::of(FaultKind::DamagedReplies, 100.0 * self.damaged),
            false => Fault::of(FaultKind::LostReplies, milliseconds),
        }
    }

    /// Runs the monitors for one cycle of a finger that follows set points, after `controller` has computed the cycle.
    /// `feedback` is `None` if the reply was lost.
    pub fn spring(&mut self, controller: &Controller, state: &State, feedback: Option<&Feedback>) -> Option<Fault> {
        let alarms = controller.watch(&mut self.watch, state, feedback?, self.age, self.full_scale);
        // The warning of `note_period` takes precedence, because the state of the line or of the machine can explain
        // the symptoms of the finger.
        self.warning = self.warning.or(alarms.warning.map(Fault::from));
        alarms.fault.map(Fault::from)
    }

    /// Notes that another controller is in use.
    pub fn adjusted(&mut self) {
        self.watch.adjusted();
    }

    /// Resets the monitors when the finger enters the stage `Running`.
    pub fn begin(&mut self) {
        self.watch = Watch::default();
    }

    /// Restarts the monitors when replies return after a long loss.
    pub fn resume(&mut self) {
        self.watch.resume();
    }

    /// Forgets the lost replies, the damaged replies and the overruns from before a recovery.
    pub fn recover(&mut self) {
        for quality in [&mut self.noise, &mut self.damage, &mut self.overruns] {
            quality.forget();
        }
        self.damaged = 0.0;
    }

    /// The warning of this period.
    pub fn warning(&self) -> Option<Fault> {
        self.warning
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Notes periods with a damaged reply until the finger faults. Returns the fault and the number of periods.
    fn damaged_until_the_fault(supervision: &mut Supervision) -> (Fault, u64) {
        (1..1000)
            .find_map(|period| {
                let frames = supervision.damaged_frames + 1;
                supervision.note_period(false, 0, frames).map(|fault| (fault, period))
            })
            .expect("the finger faults")
    }

    #[test]
    fn time_passes_for_the_monitors_of_a_board_whose_clock_stands_still() {
        let mut supervision = Supervision::new(1000.0, 18, 12);
        let mut age = |counted, clocked| {
            supervision.note_reply(Status::default(), counted, clocked);
            supervision.age
        };
        // In this order: a reply was lost, a cycle was late, the next cycle followed at once, and the clock did not
        // give the age.
        let ages = [(2.0, Some(2.01)), (1.0, Some(1.6)), (1.0, Some(0.0)), (70.0, None)];
        assert_eq!(ages.map(|(counted, clocked)| age(counted, clocked)), [2.01, 1.6, 0.0, 70.0]);
        let stopped: Vec<f64> = (0..100).map(|_| age(1.0, Some(0.0))).collect();
        assert!(stopped[20..].iter().all(|&age| age == 1.0), "{stopped:?}");
        assert_eq!(age(2.0, Some(0.0)), 2.0);
        assert_eq!(age(1.0, Some(1.01)), 1.01);
    }

    #[test]
    fn a_recovered_finger_bears_as_many_damaged_replies_as_a_new_one() {
        let mut supervision = Supervision::new(200.0, 18, 12);
        let (fault, periods) = damaged_until_the_fault(&mut supervision);
        assert!(fault.kind == FaultKind::DamagedReplies && periods > 10, "{fault} after {periods}");
        supervision.recover();
        assert_eq!(supervision.silence(18.0).kind, FaultKind::LostReplies);
        assert_eq!(damaged_until_the_fault(&mut supervision), (fault, periods));
        supervision.recover();
        let frames = supervision.damaged_frames;
        assert_eq!(supervision.note_period(true, 0, frames), None);
        assert_eq!(supervision.warning(), None, "the line was noisy only before the recovery");
    }
}
