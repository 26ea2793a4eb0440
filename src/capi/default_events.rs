//! The events of the one hand of the C calls: its queue, and the planner's callback.

use crate::capi::refusal::Refusal;
use crate::events::Event;
use crate::hand::{EventListener, EventQueue, Hand, HandError};
use parking_lot::{Mutex, RwLock};
use std::cell::Cell;
use std::os::fd::RawFd;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The queue of the open hand. It is shared, so that a thread that waits for an event does not delay CloseHand.
static QUEUE: RwLock<Option<Arc<EventQueue>>> = RwLock::new(None);

/// The callback of the open hand.
static LISTENER: Mutex<Option<EventListener>> = Mutex::new(None);

/// Locked while the planner's callback runs. The exit handler waits for it.
static CALLING: Mutex<()> = Mutex::new(());

/// Set when the process exits. From then on the planner's callback is not called.
static ENDED: AtomicBool = AtomicBool::new(false);

thread_local! {
    /// Whether the calling thread is in the planner's callback.
    static IN_CALLBACK: Cell<bool> = const { Cell::new(false) };
}

/// Creates the queue of a hand that is being opened.
pub(super) fn open(hand: &Hand) {
    *QUEUE.write() = Some(Arc::new(hand.events()));
}

/// Ends the callback and the queue of a hand that is closed. Waits until the callback has returned, unless
/// `in_callback` is true.
pub(super) fn close(in_callback: bool) {
    replace(None, in_callback);
    drop(QUEUE.write().take());
}

/// The queue of the open hand.
pub(super) fn queue() -> Result<Arc<EventQueue>, Refusal> {
    // A hand that is being closed no longer counts as open.
    QUEUE.read().clone().filter(|queue| !queue.is_closed()).ok_or(Refusal::NoHand)
}

/// Waits until there is an event. Returns false after the limit.
pub(super) fn wait(limit: Option<Duration>) -> Result<bool, Refusal> {
    let queue = queue()?;
    let ready = queue.wait_until_ready(limit);
    if !ready && queue.is_closed() { Err(Refusal::NoHand) } else { Ok(ready) }
}

/// A descriptor that is readable while there is an event.
pub(super) fn descriptor() -> Result<RawFd, Refusal> {
    let failed = |source| HandError::System { doing: "create a descriptor for events", source };
    Ok(queue()?.descriptor().map_err(failed)?)
}

/// Starts the thread that calls `callback` with each event of a hand, and with the number of lost events.
pub(super) fn listener(
    hand: &Hand,
    callback: impl FnMut(&Event, u64) + Send + 'static,
) -> Result<EventListener, HandError> {
    hand.on_event(guarded(callback))
}

/// Replaces the callback. Waits until the previous one has returned, unless `in_callback` is true. The caller must hold
/// no lock, because the previous callback may make calls that need it.
pub(super) fn replace(listener: Option<EventListener>, in_callback: bool) {
    let previous = std::mem::replace(&mut *LISTENER.lock(), listener);
    match previous {
        Some(previous) if in_callback => previous.detach(),
        previous => drop(previous),
    }
}

/// Returns whether the calling thread is in the planner's callback.
pub(super) fn in_callback() -> bool {
    IN_CALLBACK.try_with(Cell::get).unwrap_or(false)
}

/// Returns a function that makes a call of the planner's callback known to [`in_callback`] and [`end`].
fn guarded(mut callback: impl FnMut(&Event, u64)) -> impl FnMut(&Event, u64) {
    move |event, lost| {
        let _calling = CALLING.lock();
        if !ENDED.load(Ordering::Acquire) {
            IN_CALLBACK.set(true);
            callback(event, lost);
            IN_CALLBACK.set(false);
        }
    }
}

/// Prevents further calls of the callback when the process exits, because the planner's data are about to be destroyed.
/// Waits for a callback that is running, for at most `limit`.
pub(super) fn end(limit: Duration) {
    ENDED.store(true, Ordering::Release);
    if !in_callback() {
        drop(CALLING.try_lock_for(limit));
    }
}
