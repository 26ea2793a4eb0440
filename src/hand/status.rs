//! The status of a finger and of its servo thread.

use crate::calibration::Verdict;
use crate::finger::{Losses, Stage};
use crate::hand::{Hand, HandError};
use crate::model::FingerNumber;
use crate::realtime::{self, Distribution, now};

/// The status of a finger and of its servo thread.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FingerStatus {
    /// Stage of the finger between open and close.
    pub stage: Stage,
    /// Whether every servo thread runs under SCHED_FIFO.
    pub realtime: bool,
    /// Whether every servo thread has its memory locked.
    pub memory_locked: bool,
    /// Whether every servo thread runs on its configured core, if one is configured.
    pub on_core: bool,
    /// Configured rate, Hz.
    pub rate: f64,
    /// Measured rate since open, Hz. It decreases while a cycle is missing.
    pub measured_rate: f64,
    /// Time from the scheduled beginning of a cycle to its first instruction, microseconds: the jitter of the servo.
    pub wake_up: Distribution,
    /// Cycles and errors since open. The skipped periods include those that are missing now.
    pub losses: Losses,
    /// Part of the desired joint torque that the tension limits permitted in the last cycle, 0 to 1.
    pub torque_scale: f64,
    /// Part of Kx that was applied in the last cycle, 0 to 1. It is less than 1 if the tendons cannot produce Kx in
    /// this pose.
    pub stiffness_scale: f64,
    /// Completed part of the calibration in progress, 0 to 1; 0 if there is none.
    pub calibration: f64,
}

impl Hand {
    /// The status of finger 1, 2 or 3 and of its servo thread.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn status(&self, finger: i32) -> Result<FingerStatus, HandError> {
        let finger = FingerNumber::try_from(finger)?;
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
            realtime: self.real_time.scheduling,
            memory_locked: self.real_time.memory,
            on_core: self.real_time.core,
            rate,
            measured_rate: if seconds > 0.0 { intervals / seconds } else { 0.0 },
            wake_up: self.dispatcher.timing(finger, realtime::CycleStage::WakeUp)?,
            losses,
            torque_scale: report.cycle.torque_scale,
            stiffness_scale: report.cycle.stiffness_scale,
            calibration: match report.calibration {
                // If a fault ends a calibration, its verdict stays `InProgress`. So the stage is checked too.
                Some(Verdict::InProgress(progress)) if report.stage == Stage::Calibrating => progress.part,
                _ => 0.0,
            },
        })
    }
}
