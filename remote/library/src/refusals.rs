//! Conversion of the client's errors to refusals of the C calls. If a hand of this machine can refuse a call for the
//! same reason, errno is the same, except for requests that the server refuses: see `request_refusal`. The text says
//! the same, but the words can differ, for example for a busy finger.

use sun2xp::FaultKind;
use sun2xp::capi::RemoteRefusal;
use sun2xp::finger::Action;
use sun2xp_remote_client::{HandName, RemoteError, RemoteErrorKind as Kind};

/// The error numbers of `sun2xp.h`.
mod number {
    pub const NO_HAND: i32 = 4;
    pub const BUSY: i32 = 5;
    pub const ARGUMENT: i32 = 7;
    pub const LIMIT: i32 = 8;
    pub const FAULTED: i32 = 9;
    pub const CONFIGURATION: i32 = 10;
    pub const PORT: i32 = 11;
    pub const SYSTEM: i32 = 12;
    pub const TIMED_OUT: i32 = 14;
    pub const CALIBRATION: i32 = 15;
    pub const NOT_SUPPORTED: i32 = 16;
}

/// The refusal for an error of the client.
pub(crate) fn refusal(error: RemoteError) -> RemoteRefusal {
    if let RemoteError::Faulted { finger, name, .. } = &error
        && let Some(kind) = FaultKind::from_number(error.fault().into())
    {
        return faulted(finger.number().into(), kind, name);
    }
    let (number, errno) = numbers(error.kind());
    let errno = match &error {
        RemoteError::System { source, .. } => source.raw_os_error().unwrap_or(errno),
        _ => errno,
    };
    let actions = match error.kind() {
        Kind::Faulted => vec![Action::Recover, Action::Close, Action::Open],
        Kind::NotOwner | Kind::Closed => vec![Action::Close, Action::Open],
        _ => Vec::new(),
    };
    RemoteRefusal::Other { number, errno, text: error.to_string(), actions }
}

/// The refusal by a finger with a fault. `name` is the name of the fault with its part and its value, or empty if the
/// client has not received them.
fn faulted(finger: i32, kind: FaultKind, name: &str) -> RemoteRefusal {
    let description = kind.description();
    let fault = if name.is_empty() { description.name } else { name };
    RemoteRefusal::Other {
        number: number::FAULTED,
        errno: libc::EIO,
        text: format!("finger {finger} is faulted (fault {}): {fault}: {}", kind.number(), description.explanation()),
        actions: description.actions.to_vec(),
    }
}

/// The refusal for an error of a request that calibrates.
pub(crate) fn calibration_refusal(error: RemoteError) -> RemoteRefusal {
    request_refusal(error, (number::CALIBRATION, libc::ECANCELED))
}

/// The refusal for an error of a request that recovers fingers. Opening a hand is such a request too.
pub(crate) fn recovery_refusal(error: RemoteError) -> RemoteRefusal {
    request_refusal(error, (number::PORT, libc::EIO))
}

/// If a request has failed, the server gives the reason only as a text. So the number and the errno are those of
/// `failed`, whatever the reason is.
fn request_refusal(error: RemoteError, failed: (i32, i32)) -> RemoteRefusal {
    if error.kind() != Kind::Refused {
        return refusal(error);
    }
    let (number, errno) = failed;
    RemoteRefusal::Other { number, errno, text: error.to_string(), actions: Vec::new() }
}

fn numbers(kind: Kind) -> (i32, i32) {
    match kind {
        Kind::NoSuchFinger | Kind::Argument => (number::ARGUMENT, libc::EINVAL),
        Kind::NotInHand => (number::NOT_SUPPORTED, libc::EINVAL),
        Kind::OutOfRange | Kind::Refused => (number::LIMIT, libc::ERANGE),
        Kind::NotASpring => (number::LIMIT, libc::EDOM),
        // A planner that fell silent has lost the hand, and the fingers have stopped. As after a fault, the planner
        // opens the hand again.
        Kind::Faulted | Kind::NotOwner => (number::FAULTED, libc::EIO),
        Kind::Busy | Kind::Owned => (number::BUSY, libc::EBUSY),
        Kind::NotConnected => (number::PORT, libc::ENOTCONN),
        Kind::Stale => (number::TIMED_OUT, libc::ETIMEDOUT),
        Kind::Closed => (number::PORT, libc::ENOTCONN),
        Kind::Protocol => (number::PORT, libc::EPROTO),
        Kind::Configuration => (number::CONFIGURATION, libc::EINVAL),
        _ => (number::SYSTEM, libc::EIO),
    }
}

/// The refusal of a call for a hand that another thread has closed.
pub(crate) fn closed() -> RemoteRefusal {
    let text = "the hand was closed meanwhile: open it again".into();
    RemoteRefusal::Other { number: number::NO_HAND, errno: libc::ENODEV, text, actions: vec![Action::Open] }
}

/// The refusal to a client that may not command the hand.
pub(crate) fn forbidden(hand: &HandName) -> RemoteRefusal {
    let text = format!(
        "the server does not let this client command the hand \"{hand}\": give the client the permission \"command\" \
         in [serve.clients] of the server, and start the server again"
    );
    RemoteRefusal::Other { number: number::SYSTEM, errno: libc::EACCES, text, actions: Vec::new() }
}

/// The refusal of something that the system or this library cannot do.
pub(crate) fn system(errno: i32, text: &str) -> RemoteRefusal {
    RemoteRefusal::Other { number: number::SYSTEM, errno, text: text.into(), actions: Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sun2xp::model::Part;
    use sun2xp::{Fault, FingerNumber, HandError};
    use sun2xp_remote_client::{FaultText, Finger};

    fn numbers_of(refusal: RemoteRefusal) -> (i32, i32) {
        match refusal {
            RemoteRefusal::Other { number, errno, .. } => (number, errno),
            RemoteRefusal::Hand(error) => panic!("{error}"),
        }
    }

    /// A planner that gets ERANGE looks for a mistake in its own numbers.
    #[test]
    fn a_failed_request_is_not_reported_as_a_number_out_of_range() {
        let failed = || RemoteError::Refused("a tendon is slack: tension it".into());
        assert_eq!(numbers_of(calibration_refusal(failed())), (number::CALIBRATION, libc::ECANCELED));
        assert_eq!(numbers_of(recovery_refusal(failed())), (number::PORT, libc::EIO));
        assert_eq!(numbers_of(refusal(failed())), (number::LIMIT, libc::ERANGE));
        let owned = || RemoteError::Owned("bob owns the hand: wait until it is released".into());
        assert_eq!(numbers_of(calibration_refusal(owned())), (number::BUSY, libc::EBUSY));
        assert_eq!(numbers_of(recovery_refusal(owned())), (number::BUSY, libc::EBUSY));
    }

    #[test]
    fn the_errno_of_the_system_is_kept() {
        let source = std::io::Error::from_raw_os_error(libc::EAGAIN);
        let error = RemoteError::System { doing: "start a thread".into(), source };
        assert_eq!(numbers_of(refusal(error)), (number::SYSTEM, libc::EAGAIN));
    }

    /// If the client has not received the text of the fault, the refusal names no part and no value.
    #[test]
    fn a_fault_has_the_text_of_a_hand_of_this_machine() {
        let mut fault = Fault::of(FaultKind::BrokenTendon, 0.2);
        fault.part = Part::Tendon(3);
        let local = HandError::Faulted { finger: FingerNumber::ALL[0], fault }.to_string();
        let reported = |text: &str| {
            let (finger, fault) = (Finger::ALL[0], FaultKind::BrokenTendon.number().into());
            let name = FaultText::beginning_of(text).fault().into();
            match refusal(RemoteError::Faulted { finger, fault, name }) {
                RemoteRefusal::Other { number: number::FAULTED, errno: libc::EIO, text, actions } => (text, actions),
                _ => panic!("not the refusal of a fault"),
            }
        };
        let (text, actions) = reported(&fault.to_string());
        assert_eq!(text, local);
        assert_eq!(actions, FaultKind::BrokenTendon.description().actions);
        let (text, _) = reported("");
        assert!(text.starts_with("finger 1 is faulted (fault 2): broken tendon: "), "{text}");
    }
}
