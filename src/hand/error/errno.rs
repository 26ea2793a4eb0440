//! The errno of a refused call.

use super::HandError;
use crate::calibration::Obstacle;
use crate::files::errno;
use crate::model::ContactError;

impl HandError {
    /// The nearest errno.
    pub fn errno(&self) -> i32 {
        match self {
            Self::NoSuchFinger(_) | Self::NotFinite { .. } => libc::EINVAL,
            Self::Configuration { .. } | Self::Unusable { .. } => libc::EINVAL,
            Self::NoSuchStage(_) | Self::NoSuchContact(_) | Self::Adjustment { .. } => libc::EINVAL,
            Self::TooMuchForce { .. } | Self::BeyondJointLimit { .. } | Self::TooStiff { .. } => libc::ERANGE,
            Self::OutOfReach { .. } | Self::Damping { .. } => libc::ERANGE,
            Self::Contact { source: ContactError::NotFinite(_), .. } => libc::EINVAL,
            Self::Contact { .. } => libc::EDOM,
            Self::Permanent { .. } => libc::EBUSY,
            Self::NotSymmetric { .. } | Self::Negative { .. } => libc::EDOM,
            Self::Faulted { .. } | Self::FaultedAtOpening { .. } | Self::ServoEnded(_) => libc::EIO,
            // Without an errno of the system's the file was read, but is no text.
            Self::ConfigurationFile { source, .. } => source.raw_os_error().unwrap_or(libc::EINVAL),
            Self::UntrustedEnvironment { .. } => libc::EACCES,
            Self::System { source, .. } => source.raw_os_error().unwrap_or(libc::EIO),
            Self::NotRealTime { missing } => missing.errno(),
            Self::Link { source, .. } => source.errno(),
            Self::Calibration { obstacle: Obstacle::TimeLimit { .. }, .. } => libc::ETIMEDOUT,
            Self::NoAnswer(_) | Self::ServoStalled(_) => libc::ETIMEDOUT,
            Self::Calibration { .. } => libc::ECANCELED,
            Self::SameNumber { .. } => libc::ENOTUNIQ,
            Self::NotReconnected(_) | Self::NotOpened(_) => libc::ENODEV,
            Self::Busy(_) | Self::PortInUse { .. } => libc::EBUSY,
            Self::Store { source, .. } | Self::BlackBox { source, .. } => errno(source),
            Self::Unfit { .. } => libc::EINVAL,
            Self::NotStored { source, .. } => source.errno(),
            Self::NoRecord { .. } => libc::ENOENT,
            Self::NotSimulated(_) => libc::ENOTSUP,
        }
    }
}
