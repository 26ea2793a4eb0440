//! The errno of a refused call.

use super::HandError;
use crate::calibration::Obstacle;
use crate::files::errno;

impl HandError {
    /// Returns the errno that describes the error best.
    #[must_use]
    pub fn errno(&self) -> i32 {
        match self {
            Self::NoSuchFinger(_)
            | Self::NotOpened(_)
            | Self::NotInHand { .. }
            | Self::NoSuchStage(_)
            | Self::NoSuchElement { .. } => libc::EINVAL,
            Self::SetPoint(error) => error.errno(),
            Self::Path(error) => error.errno(),
            Self::Configuration(error) => error.errno(),
            Self::Recovery(error) => error.errno(),
            Self::Reflex(error) => error.errno(),
            Self::TooMuchForce { .. } => libc::ERANGE,
            Self::Faulted { .. } | Self::FaultedAtOpening { .. } => libc::EIO,
            Self::System { source, .. } | Self::SimulatedPort(source) => source.raw_os_error().unwrap_or(libc::EIO),
            Self::NotRealTime { missing } => missing.errno(),
            Self::Link { source, .. } => source.errno(),
            Self::Calibration { obstacle: Obstacle::TimeLimit { .. }, .. }
            | Self::NoAnswer(_)
            | Self::NotThereInTime(_) => libc::ETIMEDOUT,
            Self::Calibration { .. } | Self::Interrupted(_) => libc::ECANCELED,
            Self::WrongWiring { .. } => libc::EIO,
            Self::SameNumber { .. } => libc::ENOTUNIQ,
            Self::NoSuchBoard { .. } => libc::ENODEV,
            Self::Busy(_) | Self::Limp(_) => libc::EBUSY,
            Self::BlackBox { source, .. } => errno(source),
            Self::NotStored { source, .. } => source.errno(),
            Self::NoRecord { .. } => libc::ENOENT,
            Self::NotSimulated(_) | Self::NoObject => libc::ENOTSUP,
        }
    }
}
