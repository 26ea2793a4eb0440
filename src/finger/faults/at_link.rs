//! Faults of a port and of the board that is connected to it.

use super::{Fault, FaultKind};
use crate::board::protocol::{Reason, Refused, Status};
use crate::board::{LinkError, PortError};

impl From<&LinkError> for Fault {
    fn from(error: &LinkError) -> Self {
        match error {
            LinkError::Port(error) => error.into(),
            LinkError::Silent { milliseconds } => Fault::of(FaultKind::BoardSilent, *milliseconds as f64),
            LinkError::Unintelligible { .. } => Fault::new(FaultKind::Unintelligible),
            LinkError::Unanswered { .. } => Fault::new(FaultKind::Unanswered),
            LinkError::WrongAddress { .. } => Fault::new(FaultKind::WrongFinger),
            LinkError::WrongVersion { .. } => Fault::new(FaultKind::WrongVersion),
            LinkError::Terms(_) | LinkError::OtherTerms { .. } => Fault::new(FaultKind::UnsuitableBoard),
            LinkError::Refused { refused, .. } => refused.into(),
        }
    }
}

impl From<&PortError> for Fault {
    fn from(error: &PortError) -> Self {
        let kind = match error {
            PortError::Missing(_) => FaultKind::PortMissing,
            PortError::Forbidden(_) => FaultKind::PortPermission,
            PortError::Busy(_) => FaultKind::PortBusy,
            PortError::Vanished => FaultKind::PortVanished,
            PortError::Closed => FaultKind::PortClosed,
            PortError::NotReady(_) => FaultKind::PortUnusable,
            PortError::NotASerialPort(_) | PortError::Baud { .. } => FaultKind::PortUnusable,
            PortError::Opening { .. } | PortError::SetUp { .. } => FaultKind::PortUnusable,
            PortError::Failed(_) => FaultKind::PortFailed,
            PortError::Hardware { .. } => FaultKind::HardwareFailed,
        };
        let with_errno = matches!(kind, FaultKind::PortFailed | FaultKind::HardwareFailed);
        let value = if with_errno { f64::from(error.errno()) } else { 0.0 };
        Fault::of(kind, value)
    }
}

impl From<&Refused> for Fault {
    fn from(refused: &Refused) -> Self {
        match refused.reason {
            Reason::NotConfigured => Fault::new(FaultKind::BoardReset),
            Reason::Version => Fault::new(FaultKind::WrongVersion),
            Reason::Fault => Fault::stopped(Status(refused.detail)),
            reason => Fault::of(FaultKind::CommandRefused, f64::from(reason.number())),
        }
    }
}

impl Fault {
    /// Returns the fault for the status of a board that has stopped its motors.
    #[must_use]
    pub fn stopped(status: Status) -> Self {
        let kind = [
            (Status::EMERGENCY_STOP, FaultKind::EmergencyStopInput),
            (Status::SUPPLY_FAULT, FaultKind::SupplyFault),
            (Status::DRIVER_FAULT, FaultKind::DriverFault),
            (Status::SENSOR_FAULT, FaultKind::SensorFault),
            (Status::WATCHDOG_TRIPPED, FaultKind::Watchdog),
        ]
        .into_iter()
        .find_map(|(bit, kind)| status.has(bit).then_some(kind));
        Fault::of(kind.unwrap_or(FaultKind::BoardStopped), f64::from(status.0))
    }
}
