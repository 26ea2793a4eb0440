//! How a finger and the thread that serves it are doing.

use crate::calibration::Verdict;
use crate::finger::{Losses, Stage};
use crate::hand::{Hand, HandError};
use crate::realtime::{self, Distribution, now};

/// What is known of a finger and of the thread that serves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerStatus {
    /// Where the finger is between open and close.
    pub stage: Stage,
    /// Whether every servo thread runs under SCHED_FIFO.
    pub realtime: bool,
    /// Whether every servo thread has its memory locked.
    pub memory_locked: bool,
    /// Whether every servo thread runs on the core that is configured, if one is.
    pub on_core: bool,
    /// Configured cycles in a second, Hz.
    pub rate: f64,
    /// Measured cycles in a second since open, Hz; less while a cycle is missing.
    pub measured_rate: f64,
    /// From the scheduled beginning of a cycle to its first instruction, microseconds: the servo's jitter.
    pub wake_up: Distribution,
    /// Its cycles since open, and what went wrong in them. The skipped periods include those that are missing up to
    /// now.
    pub losses: Losses,
    /// The part of the wanted joint torque that the tension limits let through in the last cycle, 0 to 1.
    pub torque_scale: f64,
    /// The part of Kx that the finger was given in the last cycle, 0 to 1: less than 1 where its tendons carry no more
    /// in this pose.
    pub stiffness_scale: f64,
    /// The part of the calibration under way that is done, 0 to 1; 0 where there is none.
    pub calibration: f64,
}

impl Hand {
    /// How finger 1, 2 or 3 and its thread are doing.
    ///
    /// # Errors
    /// No such finger.
    pub fn status(&self, finger: i32) -> Result<FingerStatus, HandError> {
        let report = self.dispatcher.last_report(finger)?;
        let (rate, period) = {
            let hand = &self.configuration.read().hand;
            (hand.rate, hand.period())
        };
        let missing = report.missing_periods(now(), period);
        let losses = Losses { skipped_periods: report.losses.skipped_periods + missing, ..report.losses };
        let seconds = (report.last.saturating_sub(report.first) + missing * period) as f64 * 1e-9;
        let intervals = report.losses.cycles.saturating_sub(1) as f64;
        Ok(FingerStatus {
            stage: report.stage,
            realtime: self.given.scheduling,
            memory_locked: self.given.memory,
            on_core: self.given.core,
            rate,
            measured_rate: if seconds > 0.0 { intervals / seconds } else { 0.0 },
            wake_up: self.timing(finger, realtime::CycleStage::WakeUp)?,
            losses,
            torque_scale: report.cycle.torque_scale,
            stiffness_scale: report.cycle.stiffness_scale,
            calibration: match report.calibration {
                Some(Verdict::Going(progress)) => progress.part,
                _ => 0.0,
            },
        })
    }
}
