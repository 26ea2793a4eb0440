//! The hands of the C calls: a table with a place for the hand of OpenHand, and places for the hands of sun2xp_open.

use crate::capi::hand_events::{self, HandEvents};
use crate::capi::handle::{DEFAULT, Handle, PLACES};
use crate::capi::opened_hand::{self, OpenedHand, Source, SourceWithIo};
use crate::capi::process;
use crate::capi::refusal::Refusal;
use crate::capi::remote_hand::{RemoteHand, RemoteOpener};
use crate::capi::reporting;
use crate::hand::{FingerCommand, Hand};
use crate::realtime::{Mutex, RwLock, try_for};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, MutexGuard};
use std::thread::sleep;
use std::time::Duration;

/// A place for a hand.
struct Place {
    /// Locked while a hand is being opened or closed at this place, which takes a long time. Calls for a finger never
    /// wait for this lock.
    lifecycle: Mutex<()>,
    /// Locked for writing only to insert or remove a hand. The hand is boxed, so that the table is small and all zeros,
    /// and takes no space in the library's file.
    hand: RwLock<Option<Box<Opened>>>,
    /// The value of the handle of the open hand; 0 if there is none.
    handle: AtomicUsize,
    events: HandEvents,
}

struct Opened {
    handle: Handle,
    hand: OpenedHand,
}

static TABLE: [Place; PLACES] = [const { Place::new() }; PLACES];

/// Number of hands opened so far. It makes the handles of two hands different.
static OPENED: AtomicUsize = AtomicUsize::new(0);

/// Set when the process exits, before the exit handler of the library closes the hands. From then on no call may open
/// a hand, because nothing would close it. No call may move an open hand either, because the exit handler closes it.
static EXITING: AtomicBool = AtomicBool::new(false);

/// Longest time that exit waits for a lock of a hand, which a call in progress may hold. The wait is limited because
/// that call may be in the exiting thread itself, interrupted by a signal handler that calls exit.
const LONGEST_WAIT_AT_EXIT: Duration = Duration::from_millis(100);

/// Interval at which a call that closes a hand tries again if another thread has locked the lifecycle of the hand.
const CLOSING_PERIOD: Duration = Duration::from_millis(1);

/// The handle of the hand of OpenHand; null if it is not open. Inlined for the same reason as [`Handle::of`].
#[inline(always)]
pub(super) fn default_handle() -> Handle {
    Handle::from_value(TABLE[DEFAULT].handle.load(Ordering::Acquire))
}

/// Opens the hand of OpenHand. `open_remote` opens the hand if it is on another machine. `in_callback` says whether a
/// planner's callback for events makes the call.
pub(super) fn open_default(open_remote: RemoteOpener, in_callback: bool) -> Result<(), Refusal> {
    refuse_while_exiting()?;
    // This check comes before the lock, so that this call does not lock the lifecycle of an open hand. While the
    // lifecycle is locked, a callback that closes the hand is refused.
    if default_handle() != Handle::NULL {
        return Err(Refusal::AlreadyOpen);
    }
    let Some(_opening) = TABLE[DEFAULT].lifecycle.try_lock() else {
        return Err(if in_callback { Refusal::BusyInCallback } else { Refusal::Busy });
    };
    if TABLE[DEFAULT].hand.read().is_some() {
        return Err(Refusal::AlreadyOpen);
    }
    open_at(DEFAULT, Source::Found.into(), open_remote).map(drop)
}

/// Opens another hand, as [`open_default`] does.
pub(super) fn open(source: SourceWithIo, open_remote: RemoteOpener) -> Result<Handle, Refusal> {
    refuse_while_exiting()?;
    let (place, _opening) = free_place(&TABLE).ok_or(Refusal::TooManyHands)?;
    open_at(place, source, open_remote)
}

/// A free place of a table, with its locked lifecycle. The search does not lock the lifecycle of an open hand, because
/// a callback that closes this hand would be refused meanwhile.
fn free_place(table: &[Place]) -> Option<(usize, MutexGuard<'_, ()>)> {
    (DEFAULT + 1..table.len()).filter(|&place| table[place].handle.load(Ordering::Acquire) == 0).find_map(|place| {
        let opening = table[place].lifecycle.try_lock()?;
        table[place].hand.read().is_none().then_some((place, opening))
    })
}

/// Occupies all places for the hands of sun2xp_open while the result exists.
#[cfg(test)]
pub(super) fn occupy() -> Vec<MutexGuard<'static, ()>> {
    TABLE[DEFAULT + 1..].iter().map(|place| place.lifecycle.lock()).collect()
}

/// Opens a hand at a free place. The caller has locked the lifecycle of this place.
fn open_at(place: usize, from: SourceWithIo, open_remote: RemoteOpener) -> Result<Handle, Refusal> {
    process::prepare(close_at_exit);
    let (hand, print_refusals) = opened_hand::open(from, open_remote)?;
    // If the process exits, this line returns an error, and the return drops the hand, which closes it. The exit
    // handler waits only briefly for this call, so it cannot be relied on to close this hand.
    refuse_while_exiting()?;
    let handle = Handle::new(OPENED.fetch_add(1, Ordering::Relaxed), place);
    reporting::set_printing(handle, print_refusals);
    let Place { events, hand: slot, handle: value, .. } = &TABLE[place];
    if let OpenedHand::Local(hand) = &hand {
        events.open(handle, hand);
    }
    *slot.write() = Some(Box::new(Opened { handle, hand }));
    value.store(handle.value(), Ordering::Release);
    Ok(handle)
}

/// Closes the hand of OpenHand, if it is open.
pub(super) fn close_default() -> Result<(), Refusal> {
    let _closing = TABLE[DEFAULT].lifecycle.lock();
    TABLE[DEFAULT].close(false);
    Ok(())
}

/// Closes the hand of OpenHand on behalf of a planner's callback for events.
pub(super) fn close_default_in_callback() -> Result<(), Refusal> {
    // A CloseHand of another thread waits for the callback, so waiting for that call would be a deadlock.
    let Some(_closing) = TABLE[DEFAULT].lifecycle.try_lock() else { return Err(Refusal::BusyInCallback) };
    TABLE[DEFAULT].close(true);
    Ok(())
}

/// Closes a hand. `in_callback` says whether a planner's callback for events makes the call.
pub(super) fn close(handle: Handle, in_callback: bool) -> Result<(), Refusal> {
    loop {
        // The place of a closed hand may have another hand, for which this call must not wait.
        let place = Place::of(handle)?;
        if let Some(_closing) = place.lifecycle.try_lock() {
            Place::of(handle)?.close(in_callback);
            return Ok(());
        }
        if in_callback {
            return Err(Refusal::BusyInCallback);
        }
        sleep(CLOSING_PERIOD);
    }
}

impl Place {
    const fn new() -> Self {
        Self {
            lifecycle: Mutex::new(()),
            hand: RwLock::new(None),
            handle: AtomicUsize::new(0),
            events: HandEvents::new(),
        }
    }

    /// The place that a handle names. The hand of the handle may be closed, and another hand may be open at this place.
    #[inline]
    fn named_by(handle: Handle) -> Result<&'static Self, Refusal> {
        handle.place().and_then(|place| TABLE.get(place)).ok_or(Refusal::NoHand)
    }

    /// The place of an open hand.
    fn of(handle: Handle) -> Result<&'static Self, Refusal> {
        let place = Self::named_by(handle)?;
        if place.handle.load(Ordering::Acquire) == handle.value() { Ok(place) } else { Err(Refusal::NoHand) }
    }

    fn close(&self, in_callback: bool) {
        let handle = Handle::from_value(self.handle.swap(0, Ordering::AcqRel));
        let opened = self.hand.write().take();
        reporting::note_closed(handle);
        // Dropping the hand takes a long time. `hand` is already unlocked, so other calls are refused instead of
        // waiting.
        drop(opened);
        // The events are closed last. Their callback may be running, and may take longer than closing the hand.
        self.events.close(in_callback);
    }
}

fn close_at_exit() {
    EXITING.store(true, Ordering::Release);
    // All hands move to their end states at the same time.
    each_at_exit(OpenedHand::request_end);
    each_at_exit(OpenedHand::end);
    hand_events::end(LONGEST_WAIT_AT_EXIT, TABLE.iter().map(|place| &place.events));
}

/// Runs `call` on every open hand. The hands are not dropped: a signal handler may have called exit in the middle of
/// malloc, and then free would wait forever for the lock of malloc.
fn each_at_exit(call: impl Fn(&OpenedHand)) {
    for place in &TABLE {
        if let Some(_closing) = try_for(LONGEST_WAIT_AT_EXIT, || place.lifecycle.try_lock())
            && let Some(opened) = try_for(LONGEST_WAIT_AT_EXIT, || place.hand.try_read())
            && let Some(opened) = &*opened
        {
            call(&opened.hand);
        }
    }
}

/// Runs `call` on an open hand, which stays open meanwhile.
#[inline]
fn with_opened<T>(handle: Handle, call: impl FnOnce(&OpenedHand) -> Result<T, Refusal>) -> Result<T, Refusal> {
    match &*Place::named_by(handle)?.hand.read() {
        Some(opened) if opened.handle == handle => call(&opened.hand),
        _ => Err(Refusal::NoHand),
    }
}

/// Runs `call` on an open hand of this machine.
#[inline]
pub(super) fn with<T, E: Into<Refusal>>(
    handle: Handle,
    call: impl FnOnce(&Hand) -> Result<T, E>,
) -> Result<T, Refusal> {
    with_opened(handle, |opened| match opened {
        OpenedHand::Local(hand) => call(hand).map_err(E::into),
        OpenedHand::Remote(_) => Err(Refusal::NotRemote),
    })
}

/// Runs `local` on an open hand of this machine, or `remote` on one of another machine.
#[inline]
pub(super) fn with_either<T, E: Into<Refusal>, F: Into<Refusal>>(
    handle: Handle,
    local: impl FnOnce(&Hand) -> Result<T, E>,
    remote: impl FnOnce(&dyn RemoteHand) -> Result<T, F>,
) -> Result<T, Refusal> {
    with_opened(handle, |opened| match opened {
        OpenedHand::Local(hand) => local(hand).map_err(E::into),
        OpenedHand::Remote(hand) => remote(&**hand).map_err(F::into),
    })
}

/// Runs `call`, which moves an open hand of this machine or changes how it moves. It is refused while the process
/// exits, because the hand is then closed, and the call would have no effect.
pub(super) fn command<T, E: Into<Refusal>>(
    handle: Handle,
    call: impl FnOnce(&Hand) -> Result<T, E>,
) -> Result<T, Refusal> {
    refuse_while_exiting()?;
    with(handle, call)
}

/// Commands a finger of an open hand. If the hand is on this machine, runs `local`. If the hand is on another machine,
/// calls `command`, and sends the result to the hand. While the process exits, the call is refused, as in the function
/// [`command`].
#[inline]
pub(super) fn send<E: Into<Refusal>>(
    handle: Handle,
    local: impl FnOnce(&Hand) -> Result<(), E>,
    command: impl FnOnce() -> FingerCommand,
) -> Result<(), Refusal> {
    refuse_while_exiting()?;
    with_either(handle, local, |remote| remote.send(&[command()]))
}

/// The hand of this handle if it is on another machine. It is used without locking the table, because its calls may
/// take long.
pub(super) fn remote(handle: Handle) -> Result<Option<Arc<dyn RemoteHand>>, Refusal> {
    with_opened(handle, |opened| match opened {
        OpenedHand::Local(_) => Ok(None),
        OpenedHand::Remote(hand) => Ok(Some(hand.clone())),
    })
}

/// As [`remote`], for a call that moves the hand: it is refused while the process exits.
pub(super) fn remote_to_command(handle: Handle) -> Result<Option<Arc<dyn RemoteHand>>, Refusal> {
    refuse_while_exiting()?;
    remote(handle)
}

/// The events at the place that a handle names. They can be used without locking the hand. The hand of the handle may
/// be closed.
pub(super) fn events(handle: Handle) -> Result<&'static HandEvents, Refusal> {
    Place::named_by(handle).map(|place| &place.events)
}

fn refuse_while_exiting() -> Result<(), Refusal> {
    if EXITING.load(Ordering::Acquire) { Err(Refusal::Exiting) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_search_for_a_free_place_leaves_open_hands_alone() {
        let table = [Place::new(), Place::new(), Place::new()];
        table[1].handle.store(1, Ordering::Release);
        assert_eq!(free_place(&table).map(|(place, _)| place), Some(2));
        table[2].handle.store(2, Ordering::Release);
        assert!(free_place(&table).is_none());
    }
}
