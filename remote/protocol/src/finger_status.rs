//! The status of one finger, a part of the Status that the server publishes once a second.

use crate::bytes::{Bytes, Written};
use crate::error::{FieldError, Reason, finite, within};
use crate::{FaultText, Stage};

/// The record of one finger in a Status.
#[derive(Clone, Debug, PartialEq)]
pub struct FingerStatus {
    /// Its stage, with the fault.
    pub stage: Stage,
    /// Warnings since open. A warning that persists counts once.
    pub warnings: u32,
    /// Cycles since open.
    pub cycles: u64,
    /// Skipped periods since open.
    pub skipped_periods: u64,
    /// Lost replies since open.
    pub lost_replies: u64,
    /// Corrupt replies since open.
    pub corrupt_replies: u64,
    /// Lower joint limits, rad.
    pub low: [f64; 3],
    /// Upper joint limits, rad.
    pub high: [f64; 3],
    /// Largest eigenvalue of Kx that the finger admits, N/cm.
    pub stiffness_bound: f64,
    /// Completed part of a calibration, 0 to 1.
    pub calibration: f64,
    /// The beginning of the text of the fault; empty if there is none.
    pub fault_text: FaultText,
}

impl FingerStatus {
    /// Bytes of a record.
    pub(crate) const LENGTH: usize = 176;

    pub(crate) fn decode(bytes: Bytes<'_>) -> Result<Self, FieldError> {
        let length = usize::from(bytes.u8(104));
        within("length of the text of the fault", length as u64, 0, FaultText::LONGEST as u64)?;
        let text = std::str::from_utf8(bytes.from(105, length).0)
            .map_err(|_| FieldError::new("text of the fault", Reason::NotText))?;
        if bytes.from(105 + length, FaultText::LONGEST - length).0.iter().any(|&byte| byte != 0) {
            return Err(FieldError::new("bytes after the text of the fault", Reason::NotPadding));
        }
        let status = Self {
            stage: Stage::decode(bytes.u8(0), bytes.u16(2))?,
            warnings: bytes.u32(4),
            cycles: bytes.u64(8),
            skipped_periods: bytes.u64(16),
            lost_replies: bytes.u64(24),
            corrupt_replies: bytes.u64(32),
            low: bytes.f64s(40),
            high: bytes.f64s(64),
            stiffness_bound: bytes.f64(88),
            calibration: bytes.f64(96),
            fault_text: FaultText::beginning_of(text),
        };
        status.check()?;
        Ok(status)
    }

    pub(crate) fn check(&self) -> Result<(), FieldError> {
        self.stage.check()?;
        finite("smallest joint angles", &self.low)?;
        finite("largest joint angles", &self.high)?;
        for (joint, (&smallest, &largest)) in self.low.iter().zip(&self.high).enumerate() {
            if smallest > largest {
                let reason = Reason::BelowSmallest { joint, largest, smallest };
                return Err(FieldError::new("largest joint angles", reason));
            }
        }
        finite("largest eigenvalue", &[self.stiffness_bound])?;
        if self.stiffness_bound < 0.0 {
            return Err(FieldError::new("largest eigenvalue", Reason::Negative(self.stiffness_bound)));
        }
        finite("completed part of a calibration", &[self.calibration])?;
        if !(0.0..=1.0).contains(&self.calibration) {
            let reason = Reason::NotAFraction(self.calibration);
            return Err(FieldError::new("completed part of a calibration", reason));
        }
        match self.stage {
            Stage::Faulted(_) => Ok(()),
            _ if self.fault_text.as_str().is_empty() => Ok(()),
            _ => Err(FieldError::new("text of the fault", Reason::Contradicts("the stage, which is not faulted"))),
        }
    }

    pub(crate) fn encode(&self, to: &mut Written) {
        let ((stage, fault), text) = (self.stage.numbers(), self.fault_text.as_str().as_bytes());
        to.u8(stage).zeros(1).u16(fault).u32(self.warnings);
        to.u64(self.cycles).u64(self.skipped_periods).u64(self.lost_replies).u64(self.corrupt_replies);
        to.f64s(&self.low).f64s(&self.high).f64s(&[self.stiffness_bound, self.calibration]);
        to.u8(text.len() as u8).bytes(text).zeros(FaultText::LONGEST - text.len());
    }
}
