//! Why a call is refused.

use crate::capi::handle::MOST_HANDS;
use crate::capi::remote_hand::RemoteRefusal;
use crate::finger::Action;
use crate::hand;
use crate::model::FingerNumber;
use std::ffi::c_int;
use std::fmt::{self, Display, Formatter};
use std::mem::{Discriminant, discriminant};
use thiserror::Error;

/// Why the C interface or the hand refuses a call.
#[derive(Debug, Error)]
pub(super) enum Refusal {
    #[error(
        "this process was forked from a process that has opened a hand, or has tried to open one, and only that \
         process has the threads of the library: make the call in that process, or call exec first"
    )]
    Forked,
    #[error("{name} is a null pointer: pass {wanted}")]
    Null { name: &'static str, wanted: Wanted },
    #[error("{name}->size is {size}: set it to sizeof *{name} before the call (it must be at least {least})")]
    WrongSize { name: &'static str, size: usize, least: usize },
    /// `capi/reporting.rs` adds the remedy, which depends on the interface.
    #[error("no hand is open")]
    NoHand,
    #[error("the hand is already open, and stays open: call CloseHand before OpenHand")]
    AlreadyOpen,
    #[error("{} hands are open: close one of them before another is opened", MOST_HANDS)]
    TooManyHands,
    #[error("count is not 0, 1, 2 or 3: pass one struct sun2xp_io for each finger whose hardware the program provides")]
    IoCount,
    #[error("two elements of io are for finger {0}: pass one for each finger")]
    IoTwice(FingerNumber),
    #[error(
        "the shortest_watchdog of the io of finger {finger} is {seconds:?} s: set it to the shortest watchdog time of \
         the hardware, or to 0 for hardware that supports every time"
    )]
    IoWatchdog { finger: FingerNumber, seconds: f64 },
    #[error("no hand has this name: the names are nominal, worn, sheathed and cheap")]
    NoSuchName,
    #[error(
        "the process is exiting, and the library has closed the hand: make this call before exit is called or main \
         returns, or in an exit handler that is registered after the first hand was opened"
    )]
    Exiting,
    #[error("another thread is opening or closing the hand: wait until its call has returned")]
    Busy,
    #[error(
        "another thread is opening or closing the hand, and an event callback must not wait for that thread: return \
         from the callback, and repeat the call elsewhere if it is still necessary"
    )]
    BusyInCallback,
    #[error(
        "the log callback makes this call, which would wait until the callback has returned: make the call elsewhere"
    )]
    InLogCallback,
    #[error(
        "there is not enough free memory for this call, and nothing was changed: free memory, or raise the memory \
         limit of this process (ulimit -v), and call again"
    )]
    NoMemory,
    #[error("the library failed ({0}): please report this defect of the library")]
    Panicked(String),
    #[error(
        "the hand is on another machine, and this call does not reach it: make the call in a program on the machine \
         that has the hand, or use the calls that docs/installation.md lists"
    )]
    NotRemote,
    #[error(
        "this is libsun2xp_remote, which opens only hands on other machines, and the configuration has no table \
         [remote]: add the table (its keys, such as `endpoint`, are in docs/remote.md), or use libsun2xp"
    )]
    OnlyRemote,
    #[error("{text}")]
    Remote { number: c_int, errno: c_int, text: String, actions: Vec<Action> },
    #[error(transparent)]
    Hand(#[from] hand::HandError),
}

impl From<RemoteRefusal> for Refusal {
    fn from(refusal: RemoteRefusal) -> Self {
        match refusal {
            RemoteRefusal::Hand(error) => Self::Hand(error),
            RemoteRefusal::Other { number, errno, text, actions } => Self::Remote { number, errno, text, actions },
        }
    }
}

/// What a pointer argument must point to.
#[derive(Clone, Copy, Debug)]
pub(super) enum Wanted {
    /// An array with this number of elements.
    Array(usize),
    /// The struct with this name in the header.
    Struct(&'static str),
    Matrix,
    Text,
    FileName,
    Function,
    Handle,
}

impl Display for Wanted {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Array(numbers) => write!(formatter, "an array of {numbers} numbers"),
            Self::Struct(name) => write!(formatter, "the address of a struct {name}"),
            Self::Matrix => formatter.write_str("the array of the matrix"),
            Self::Text => formatter.write_str("a text"),
            Self::FileName => formatter.write_str("the name of a file"),
            Self::Function => formatter.write_str("the address of a function"),
            Self::Handle => formatter.write_str("the address of a sun2xp_hand *"),
        }
    }
}

/// The kind of a refusal. Only the first refusal of each kind is printed. The second element is the kind of the error
/// in [`Refusal::Hand`], and the third is the number and errno of [`Refusal::Remote`].
pub(super) type Kind = (Discriminant<Refusal>, Option<hand::ErrorKind>, Option<(c_int, c_int)>);

impl Refusal {
    pub fn errno(&self) -> c_int {
        match self {
            Self::Forked => libc::EPERM,
            Self::Null { .. } => libc::EFAULT,
            Self::WrongSize { .. } => libc::EINVAL,
            Self::NoHand => libc::ENODEV,
            Self::AlreadyOpen | Self::Busy | Self::BusyInCallback | Self::InLogCallback => libc::EBUSY,
            Self::TooManyHands => libc::EMFILE,
            Self::NoSuchName | Self::IoCount | Self::IoTwice(_) | Self::IoWatchdog { .. } => libc::EINVAL,
            Self::Exiting => libc::ESHUTDOWN,
            Self::NoMemory => libc::ENOMEM,
            Self::Panicked(_) => libc::EIO,
            Self::NotRemote => libc::ENOTSUP,
            Self::OnlyRemote => libc::EINVAL,
            Self::Remote { errno, .. } => *errno,
            Self::Hand(error) => error.errno(),
        }
    }

    /// The operations of the library that remedy the refusal, in the order of their use.
    pub fn actions(&self) -> &[Action] {
        match self {
            Self::NoHand => &[Action::Open],
            Self::TooManyHands => &[Action::Close],
            Self::Hand(error) => error.actions(),
            Self::Remote { actions, .. } => actions,
            _ => &[],
        }
    }

    pub fn kind(&self) -> Kind {
        let hand = match self {
            Self::Hand(error) => Some(error.kind()),
            _ => None,
        };
        let remote = match self {
            Self::Remote { number, errno, .. } => Some((*number, *errno)),
            _ => None,
        };
        (discriminant(self), hand, remote)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::FingerNumber;
    use crate::model::configuration::NamedHand;

    #[test]
    fn a_wrong_name_is_answered_with_the_names() {
        let text = Refusal::NoSuchName.to_string();
        assert!(NamedHand::ALL.iter().all(|hand| text.contains(hand.name())), "{text}");
    }

    #[test]
    fn refusals_of_the_hand_have_different_kinds() {
        let no_finger = Refusal::Hand(hand::HandError::NoSuchFinger(7));
        let not_simulated = Refusal::Hand(hand::HandError::NotSimulated(FingerNumber::ONE));
        assert_ne!(no_finger.kind(), not_simulated.kind());
        let negative = hand::SetPointError::Negative { finger: FingerNumber::ONE, smallest: -1.0 };
        let no_contact = hand::SetPointError::NoSuchContact(2);
        assert_ne!(Refusal::Hand(negative.into()).kind(), Refusal::Hand(no_contact.into()).kind());
        assert_eq!(no_finger.kind(), Refusal::Hand(hand::HandError::NoSuchFinger(8)).kind());
    }
}
