//! The report of a refused call: errno, a text for the calling thread, and a line on standard error for the first
//! refusal of its kind.

use crate::capi::process;
use crate::capi::remedy_calls::RemedyCalls;
use crate::capi::text::Text;
use crate::hand;
use crate::realtime::print_line;
use parking_lot::Mutex;
use std::cell::RefCell;
use std::ffi::{c_char, c_int};
use std::fmt::{self, Display, Formatter};
use std::mem::{Discriminant, discriminant};
use std::sync::atomic::{AtomicBool, Ordering};
use thiserror::Error;

/// Why the C interface or the hand refuses a call.
#[derive(Debug, Error)]
pub(super) enum Refusal {
    #[error(
        "this process was forked from the process that has called OpenHand, and only that process has the servo \
         threads: make the call in that process, or call exec first"
    )]
    Forked,
    #[error("{name} is a null pointer: pass {wanted}")]
    Null { name: &'static str, wanted: Wanted },
    #[error("{name}->Size is {size}: set it to sizeof *{name}, at least {least}, before the call")]
    SmallStruct { name: &'static str, size: usize, least: usize },
    #[error("no hand is open: call OpenHand first, and check its result")]
    NoHand,
    #[error("the hand is already open, and stays open: call CloseHand before OpenHand")]
    AlreadyOpen,
    #[error(
        "the process is exiting, and the library has closed the hand: make this call before exit is called or main \
         returns, or in an exit handler that is registered after OpenHand"
    )]
    Exiting,
    #[error("another thread is opening or closing the hand: wait until its call has returned")]
    Busy,
    #[error(
        "there is not enough free memory for this call, and nothing was changed: free memory, or raise the memory \
         limit of this process (ulimit -v), and call again"
    )]
    NoMemory,
    #[error("the library failed ({0}): please report this defect of the library")]
    Panicked(String),
    #[error("{}{}", .0, RemedyCalls(.0.actions()))]
    Hand(#[from] hand::HandError),
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
}

impl Display for Wanted {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Array(numbers) => write!(formatter, "an array of {numbers} numbers"),
            Self::Struct(name) => write!(formatter, "the address of a struct {name}"),
            Self::Matrix => formatter.write_str("the array of the matrix"),
            Self::Text => formatter.write_str("a text"),
            Self::FileName => formatter.write_str("the name of a file"),
        }
    }
}

type Kind = (Discriminant<Refusal>, Option<hand::ErrorKind>);

impl Refusal {
    fn errno(&self) -> c_int {
        match self {
            Self::Forked => libc::EPERM,
            Self::Null { .. } => libc::EFAULT,
            Self::SmallStruct { .. } => libc::EINVAL,
            Self::NoHand => libc::ENODEV,
            Self::AlreadyOpen | Self::Busy => libc::EBUSY,
            Self::Exiting => libc::ESHUTDOWN,
            Self::NoMemory => libc::ENOMEM,
            Self::Panicked(_) => libc::EIO,
            Self::Hand(error) => error.errno(),
        }
    }

    fn kind(&self) -> Kind {
        let hand = match self {
            Self::Hand(error) => Some(error.kind()),
            _ => None,
        };
        (discriminant(self), hand)
    }
}

thread_local! {
    static TEXT: RefCell<Text> = const { RefCell::new(Text::EMPTY) };
}

/// Upper bound of the number of kinds of refusals.
const KINDS: usize = 64;

static PRINT: AtomicBool = AtomicBool::new(true);
static PRINTED: Mutex<Vec<Kind>> = Mutex::new(Vec::new());

/// Sets errno and the text of the calling thread. Prints the text on standard error if it is the first of its kind.
pub(super) fn refuse(name: &str, refusal: &Refusal) {
    TEXT.with(|slot| {
        // The borrow fails if a signal handler has interrupted this function and makes a call that it may not make.
        // errno still reports the refusal.
        let Ok(mut text) = slot.try_borrow_mut() else { return };
        text.compose(format_args!("{name}: {refusal}"));
        if PRINT.load(Ordering::Relaxed) && is_first_of_its_kind(refusal.kind()) {
            print_line(text.as_str());
        }
    });
    process::set_errno(refusal.errno());
}

fn is_first_of_its_kind(kind: Kind) -> bool {
    // This must not wait: in a forked child, nothing releases a lock that another thread of the parent held.
    let Some(mut printed) = PRINTED.try_lock() else { return false };
    let first = !printed.contains(&kind);
    // If there is no memory to store the kind, the next refusal of this kind is printed too.
    if first && printed.try_reserve(1).is_ok() {
        printed.push(kind);
    }
    first
}

/// Sets whether refusals are printed, as configured for the hand that is being opened.
pub(super) fn set_printing(on: bool) {
    PRINT.store(on, Ordering::Relaxed);
    // The memory is reserved here, so that no refusal allocates.
    PRINTED.lock().reserve(KINDS);
}

/// Returns the text of the calling thread's last refused call; empty if none was refused.
pub(super) fn text() -> *const c_char {
    TEXT.with(|slot| slot.try_borrow().map_or(c"".as_ptr(), |text| text.as_c_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::FingerNumber;

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
