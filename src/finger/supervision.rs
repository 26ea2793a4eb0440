//! What a finger's servo watches beside its controller: the monitors of the core, and how well the line and the machine
//! do.

use crate::board::protocol::Status;
use crate::control::monitors::{LineQuality, Watch};
use crate::control::{Controller, Feedback, State};
use crate::finger::{Fault, FaultKind};

/// Seconds over which losses and overruns are told as warnings.
const WARNING_WINDOW: f64 = 1.0;

/// Shares of the last second from which on a line is noisy, and a servo overruns.
const NOISY: f64 = 0.02;
const OVERRUN: f64 = 0.02;

/// Most of the window's replies were damaged: no luck, but a line that cannot be used. One in two still controls a
/// finger.
const UNUSABLE: f64 = 0.6;

/// Where replies stay away altogether, so many damaged ones among them tell why.
const DAMAGED: f64 = 0.25;

/// Memory of the monitors of one finger.
pub(super) struct Supervision {
    watch: Watch,
    /// Periods from the sample before to the newest one.
    age: f64,
    /// The gauges' largest count.
    full_scale: u16,
    noise: LineQuality,
    damage: LineQuality,
    damaged: f64,
    overruns: LineQuality,
    damaged_frames: u64,
    clipped: bool,
    /// Of this period.
    warning: Option<Fault>,
}

impl Supervision {
    /// `patience`: cycles after which a finger without replies faults.
    pub fn new(rate: f64, patience: u32, gauge_bits: u8) -> Self {
        let warnings = LineQuality::new(rate * WARNING_WINDOW);
        Self {
            watch: Watch::default(),
            age: 1.0,
            full_scale: (u32::from(u16::MAX) >> (16 - gauge_bits.clamp(1, 16))) as u16,
            noise: warnings,
            damage: LineQuality::new(f64::from(patience)),
            damaged: 0.0,
            overruns: warnings,
            damaged_frames: 0,
            clipped: false,
            warning: None,
        }
    }

    /// What a reply's status says beside faults, and how many periods after the reply before it was sampled.
    pub fn note_reply(&mut self, status: Status, age: f64) {
        self.age = age;
        self.clipped = status.has(Status::TORQUE_CLIPPED);
    }

    /// One period: whether the reply came, how many periods were skipped, how many frames have come in damaged in all.
    /// A line that cannot be used is a fault.
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

    /// Why no valid reply has come for so many ms.
    pub fn silence(&self, milliseconds: f64) -> Fault {
        match self.damaged > DAMAGED {
            true => Fault::of(FaultKind::DamagedReplies, 100.0 * self.damaged),
            false => Fault::of(FaultKind::LostReplies, milliseconds),
        }
    }

    /// One cycle of a finger that is a spring, after `controller` has computed; none where the reply was lost.
    pub fn spring(&mut self, controller: &Controller, state: &State, feedback: Option<&Feedback>) -> Option<Fault> {
        let alarms = controller.watch(&mut self.watch, state, feedback?, self.age, self.full_scale);
        // Line and machine explain what the finger does.
        self.warning = self.warning.or(alarms.warning.map(Fault::from));
        alarms.fault.map(Fault::from)
    }

    /// The controller has been changed for another one.
    pub fn adjusted(&mut self) {
        self.watch.adjusted();
    }

    /// The finger begins to be a spring, or is watched again.
    pub fn begin(&mut self) {
        self.watch = Watch::default();
    }

    /// What this period gives warning of.
    pub fn warning(&self) -> Option<Fault> {
        self.warning
    }
}
