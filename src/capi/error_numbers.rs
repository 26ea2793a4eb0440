//! The numbers of refusals (SUN2XP_ERROR_...). They never change.

use crate::capi::refusal::Refusal;
use crate::hand::HandError;
use std::ffi::c_int;

/// The library has a defect. Please report it.
pub const SUN2XP_ERROR_DEFECT: c_int = 1;

/// The process is a forked child, which has no servo threads.
pub const SUN2XP_ERROR_FORKED: c_int = 2;

/// The process is exiting, and its hands are closed.
pub const SUN2XP_ERROR_EXITING: c_int = 3;

/// The handle does not belong to an open hand.
pub const SUN2XP_ERROR_NO_HAND: c_int = 4;

/// Hand or finger is busy. It is being opened, closed, calibrated or recovered; or the finger left its pose while
/// sun2xp_send_path computed a path that begins at this pose; or 16 groups of sun2xp_send_group have not taken effect
/// yet. Call again later. If a finger is limp (SUN2XP_STATE_LIMP), zero it first. Three other calls get this number
/// too: OpenHand while its hand is open, sun2xp_set_log in the log callback, and a call for a hand on another machine
/// if another client commands this hand.
pub const SUN2XP_ERROR_BUSY: c_int = 5;

/// Too many hands or reflexes.
pub const SUN2XP_ERROR_TOO_MANY: c_int = 6;

/// An argument makes no sense: null, NaN, no such finger, a struct that is too small.
pub const SUN2XP_ERROR_ARGUMENT: c_int = 7;

/// An argument is outside the limits of the finger (out of reach, too fast, too stiff), or it is a matrix that cannot
/// be the stiffness of a spring.
pub const SUN2XP_ERROR_LIMIT: c_int = 8;

/// The finger has stopped because of a fault.
pub const SUN2XP_ERROR_FAULTED: c_int = 9;

/// The configuration cannot be read, used, changed or stored.
pub const SUN2XP_ERROR_CONFIGURATION: c_int = 10;

/// A port, a board or the connection to another machine does not work. A refusal of sun2xp_recover has this number too
/// if the servo gets no processor time and therefore does not release its port.
pub const SUN2XP_ERROR_PORT: c_int = 11;

/// The system refuses a thread, a file or another resource.
pub const SUN2XP_ERROR_SYSTEM: c_int = 12;

/// There is not enough memory.
pub const SUN2XP_ERROR_NO_MEMORY: c_int = 13;

/// The time limit has expired.
pub const SUN2XP_ERROR_TIMED_OUT: c_int = 14;

/// A calibration failed.
pub const SUN2XP_ERROR_CALIBRATION: c_int = 15;

/// The hand lacks what the call needs, such as a simulated finger or object.
pub const SUN2XP_ERROR_NOT_SUPPORTED: c_int = 16;

/// There is no such record or reflex.
pub const SUN2XP_ERROR_NOT_FOUND: c_int = 17;

/// hand.real_time is "enforce", and real time is not available.
pub const SUN2XP_ERROR_REAL_TIME: c_int = 18;

/// The number of a refusal.
pub(super) fn number(refusal: &Refusal) -> c_int {
    match refusal {
        Refusal::Panicked(_) => SUN2XP_ERROR_DEFECT,
        Refusal::Forked => SUN2XP_ERROR_FORKED,
        Refusal::Exiting => SUN2XP_ERROR_EXITING,
        Refusal::NoHand => SUN2XP_ERROR_NO_HAND,
        Refusal::AlreadyOpen | Refusal::Busy | Refusal::BusyInCallback | Refusal::InLogCallback => SUN2XP_ERROR_BUSY,
        Refusal::TooManyHands => SUN2XP_ERROR_TOO_MANY,
        Refusal::Null { .. }
        | Refusal::WrongSize { .. }
        | Refusal::NoSuchName
        | Refusal::IoCount
        | Refusal::IoTwice(_)
        | Refusal::IoWatchdog { .. } => SUN2XP_ERROR_ARGUMENT,
        Refusal::NoMemory => SUN2XP_ERROR_NO_MEMORY,
        Refusal::NotRemote => SUN2XP_ERROR_NOT_SUPPORTED,
        Refusal::OnlyRemote => SUN2XP_ERROR_CONFIGURATION,
        Refusal::Remote { number, .. } => *number,
        Refusal::Hand(error) => of_hand(error),
    }
}

/// The number of a refusal by the hand.
pub fn of_hand(error: &HandError) -> c_int {
    match error {
        HandError::NoSuchFinger(_) | HandError::NoSuchStage(_) | HandError::NoSuchElement { .. } => {
            SUN2XP_ERROR_ARGUMENT
        }
        HandError::NotOpened(_) | HandError::NotInHand { .. } => SUN2XP_ERROR_NOT_SUPPORTED,
        HandError::SetPoint(_) | HandError::Path(_) | HandError::Reflex(_) => by_errno(error.errno()),
        HandError::Configuration(_) if error.errno() == libc::ERANGE => SUN2XP_ERROR_LIMIT,
        HandError::Configuration(_) | HandError::NotStored { .. } => SUN2XP_ERROR_CONFIGURATION,
        HandError::Recovery(_) if error.errno() == libc::EIO => SUN2XP_ERROR_FAULTED,
        HandError::Recovery(_)
        | HandError::Link { .. }
        | HandError::SameNumber { .. }
        | HandError::NoSuchBoard { .. } => SUN2XP_ERROR_PORT,
        HandError::Faulted { .. } | HandError::FaultedAtOpening { .. } => SUN2XP_ERROR_FAULTED,
        HandError::SimulatedPort(_) | HandError::System { .. } | HandError::BlackBox { .. } => SUN2XP_ERROR_SYSTEM,
        HandError::NotRealTime { .. } => SUN2XP_ERROR_REAL_TIME,
        HandError::WrongWiring { .. } => SUN2XP_ERROR_FAULTED,
        HandError::Calibration { .. } | HandError::Interrupted(_) => SUN2XP_ERROR_CALIBRATION,
        HandError::Busy(_) | HandError::Limp(_) => SUN2XP_ERROR_BUSY,
        HandError::NotThereInTime(_) | HandError::NoAnswer(_) => SUN2XP_ERROR_TIMED_OUT,
        HandError::NoRecord { .. } => SUN2XP_ERROR_NOT_FOUND,
        HandError::TooMuchForce { .. } => SUN2XP_ERROR_LIMIT,
        HandError::NotSimulated(_) | HandError::NoObject => SUN2XP_ERROR_NOT_SUPPORTED,
    }
}

/// The number of an error whose type has variants with different numbers. The errno of the error determines the
/// number.
fn by_errno(errno: c_int) -> c_int {
    match errno {
        libc::ERANGE | libc::EDOM => SUN2XP_ERROR_LIMIT,
        libc::EBUSY | libc::EAGAIN => SUN2XP_ERROR_BUSY,
        libc::ENOSPC => SUN2XP_ERROR_TOO_MANY,
        libc::ENOENT => SUN2XP_ERROR_NOT_FOUND,
        _ => SUN2XP_ERROR_ARGUMENT,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::{RecoveryError, SetPointError};
    use crate::model::FingerNumber;

    #[test]
    fn set_points_are_told_apart_by_their_errnos() {
        let of = |error: SetPointError| number(&Refusal::Hand(error.into()));
        assert_eq!(of(SetPointError::NoSuchContact(2)), SUN2XP_ERROR_ARGUMENT);
        let negative = SetPointError::Negative { finger: FingerNumber::ONE, smallest: -1.0 };
        assert_eq!(of(negative), SUN2XP_ERROR_LIMIT);
        assert_eq!(number(&Refusal::NoHand), SUN2XP_ERROR_NO_HAND);
    }

    /// The manual says at SUN2XP_ERROR_PORT that a refusal because of a stalled servo has this number.
    #[test]
    fn a_recovery_has_the_number_of_ports_unless_the_servo_has_failed() {
        let of = |error: RecoveryError| number(&Refusal::Hand(error.into()));
        assert_eq!(of(RecoveryError::ServoStalled(FingerNumber::ONE)), SUN2XP_ERROR_PORT);
        assert_eq!(of(RecoveryError::NotReconnected(FingerNumber::ONE)), SUN2XP_ERROR_PORT);
        assert_eq!(of(RecoveryError::ServoEnded(FingerNumber::ONE)), SUN2XP_ERROR_FAULTED);
    }
}
