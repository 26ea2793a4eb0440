//! The report of a refused call: errno, a number and a text for the calling thread, and a message for the first refusal
//! of its kind.

use crate::capi::error_numbers::number;
use crate::capi::handle::{DEFAULT, Handle, PLACES};
use crate::capi::process;
use crate::capi::refusal::{Kind, Refusal};
use crate::capi::remedy_calls::{Appendix, Interface, RemedyCalls};
use crate::capi::thread_errors;
use crate::realtime::{Mutex, Severity, report};
use std::ffi::c_int;
use std::fmt::{self, Display, Formatter};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of kinds of refusals for which memory is reserved.
const KINDS: usize = 128;

/// One value for each place of the table of hands. It is 0 if the refusals of the last hand at this place are printed.
/// Otherwise it is the value of this hand's handle while the hand is open, and [`CLOSED`] afterwards.
static SILENT: [AtomicUsize; PLACES] = [const { AtomicUsize::new(0) }; PLACES];

/// A value that no handle has.
const CLOSED: usize = 1;

static PRINTED: Mutex<Vec<Kind>> = Mutex::new(Vec::new());

/// Displays a refusal with its remedy.
struct Shown<'a>(&'a Refusal, Interface);

impl Display for Shown<'_> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match (self.0, self.1) {
            (Refusal::NoHand, Interface::Of1990) => {
                formatter.write_str("no hand is open: call OpenHand first, and check its result")
            }
            (Refusal::NoHand, Interface::Handles) => formatter.write_str(
                "the handle does not belong to an open hand: pass a handle of sun2xp_open or sun2xp_default_hand whose \
                 hand has not been closed, and check the results of these calls",
            ),
            (refusal, interface) => {
                write!(formatter, "{refusal}{}", Appendix(RemedyCalls(refusal.actions(), interface)))
            }
        }
    }
}

/// Reports a refusal to the calling thread: sets errno, and stores number and text for the hand of the call. Passes the
/// text on as a message if the refusal is the first of its kind. Returns the result of the call.
pub(super) fn refuse(name: &'static str, handle: Handle, refusal: &Refusal) -> c_int {
    let interface = Interface::of(name);
    let (number, errno) = (number(refusal), refusal.errno());
    let remedy = RemedyCalls(refusal.actions(), interface);
    let stored = thread_errors::store(handle, number, errno, name, &Shown(refusal, interface), &remedy);
    if stored && is_printed(name, handle, interface) && is_first_of_its_kind(refusal.kind()) {
        thread_errors::with_newest_text(|text| report(Severity::Refusal, text));
    }
    process::set_errno(errno);
    if interface == Interface::Handles { -number } else { -1 }
}

fn is_first_of_its_kind(kind: Kind) -> bool {
    // This function must not wait for the lock: in a forked child, nothing releases a lock that another thread of the
    // parent held.
    let Some(mut printed) = PRINTED.try_lock() else { return false };
    let first = !printed.contains(&kind);
    // If there is no memory to store the kind, the next refusal of this kind is printed too.
    if first && printed.try_reserve(1).is_ok() {
        printed.push(kind);
    }
    first
}

/// Returns whether the refusals of calls for this hand are printed. The handle may belong to no open hand.
fn is_printed(name: &str, handle: Handle, interface: Interface) -> bool {
    match interface {
        // The hand whose opening is refused has no setting yet.
        Interface::Of1990 if name == "OpenHand" => true,
        // The other calls of 1990 have only one hand. Its setting stays in force after it is closed, until OpenHand
        // opens it again.
        Interface::Of1990 => SILENT[DEFAULT].load(Ordering::Relaxed) == 0,
        Interface::Handles => {
            let silent = handle.place().and_then(|place| SILENT.get(place));
            silent.is_none_or(|silent| silent.load(Ordering::Relaxed) != handle.value())
        }
    }
}

/// Sets whether the refusals of calls for this hand are printed. This function is called after the hand was opened, and
/// before the program has its handle.
pub(super) fn set_printing(handle: Handle, on: bool) {
    if let Some(silent) = handle.place().and_then(|place| SILENT.get(place)) {
        silent.store(if on { 0 } else { handle.value() }, Ordering::Relaxed);
    }
    // The memory is reserved here, so that the first KINDS kinds of refusals allocate nothing.
    PRINTED.lock().reserve(KINDS);
}

/// Notes that a hand was closed. From now on the refusals of calls with its handle are printed, as for every handle
/// that does not belong to an open hand.
pub(super) fn note_closed(handle: Handle) {
    if let Some(silent) = handle.place().and_then(|place| SILENT.get(place)) {
        // The exchange fails if the refusals of the hand were printed while it was open.
        let _ = silent.compare_exchange(handle.value(), CLOSED, Ordering::Relaxed, Ordering::Relaxed);
    }
}
