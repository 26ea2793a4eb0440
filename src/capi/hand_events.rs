//! The events of a hand that a C program has opened: their queue, and the planner's callback.

use crate::capi::handle::Handle;
use crate::capi::refusal::Refusal;
use crate::events::Event;
use crate::hand::{EventListener, EventQueue, Hand, HandError};
use crate::realtime::{Mutex, RwLock, try_for};
use std::cell::Cell;
use std::os::fd::RawFd;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::Duration;

/// The events of the hand at one place of the table of hands.
pub(super) struct HandEvents {
    /// The queue of the open hand. It is shared, so that a thread that waits for an event does not delay closing.
    queue: RwLock<Option<(Handle, Arc<EventQueue>)>>,
    /// The callback of the open hand.
    listener: Mutex<Option<Listener>>,
    /// Locked while the planner's callback runs. The exit handler waits for this lock.
    calling: Mutex<()>,
    /// The mark [`Listener::removed`] of the callback that runs.
    running: Mutex<Option<Arc<AtomicBool>>>,
}

/// A thread that calls a planner's function.
pub(super) struct Listener {
    thread: EventListener,
    /// Set when the function must not be called again.
    removed: Arc<AtomicBool>,
}

/// Set when the process exits. From then on no callback of the planner is called.
static ENDED: AtomicBool = AtomicBool::new(false);

/// Interval at which a thread checks whether a removed callback has returned.
const RETURN_PERIOD: Duration = Duration::from_millis(1);

thread_local! {
    /// Whether the calling thread is in a callback of the planner.
    static IN_CALLBACK: Cell<bool> = const { Cell::new(false) };
}

impl HandEvents {
    pub const fn new() -> Self {
        Self {
            queue: RwLock::new(None),
            listener: Mutex::new(None),
            calling: Mutex::new(()),
            running: Mutex::new(None),
        }
    }

    /// Creates the queue of a hand that is being opened.
    pub fn open(&self, handle: Handle, hand: &Hand) {
        *self.queue.write() = Some((handle, Arc::new(hand.events())));
    }

    /// Ends the callback and the queue of a hand that is closed. Waits until the callback has returned, unless
    /// `in_callback` is true.
    pub fn close(&self, in_callback: bool) {
        self.end_previous(self.replace(None), in_callback);
        drop(self.queue.write().take());
    }

    /// The queue of an open hand.
    pub fn queue(&self, handle: Handle) -> Result<Arc<EventQueue>, Refusal> {
        let queue = self.queue.read();
        // A hand that is being closed no longer counts as open.
        let queue = queue.as_ref().filter(|(owner, queue)| *owner == handle && !queue.is_closed());
        queue.map(|(_, queue)| queue.clone()).ok_or(Refusal::NoHand)
    }

    /// Waits until there is an event. Returns false after the limit, and an error if the hand is closed meanwhile.
    pub fn wait(&self, handle: Handle, limit: Option<Duration>) -> Result<bool, Refusal> {
        let queue = self.queue(handle)?;
        let ready = queue.wait_until_ready(limit);
        if !ready && queue.is_closed() { Err(Refusal::NoHand) } else { Ok(ready) }
    }

    /// A descriptor that is readable while there is an event.
    pub fn descriptor(&self, handle: Handle) -> Result<RawFd, Refusal> {
        let failed = |source| HandError::System { doing: "create a descriptor for events", source };
        Ok(self.queue(handle)?.descriptor().map_err(failed)?)
    }

    /// Starts the thread that calls `callback` with each event of a hand, and with the number of lost events.
    pub fn listener(
        &'static self,
        hand: &Hand,
        callback: impl FnMut(&Event, u64) + Send + 'static,
    ) -> Result<Listener, HandError> {
        let removed = Arc::new(AtomicBool::new(false));
        let thread = hand.on_event(self.guarded(removed.clone(), callback))?;
        Ok(Listener { thread, removed })
    }

    /// Replaces the callback. Returns the previous one, which the caller passes to [`Self::end_previous`].
    pub fn replace(&self, listener: Option<Listener>) -> Option<Listener> {
        std::mem::replace(&mut *self.listener.lock(), listener)
    }

    /// Ends the callback that was replaced. Then waits until no removed callback runs, unless `in_callback` is true. A
    /// callback that has removed itself may still be running although `previous` is `None`. The caller must hold no
    /// lock, because the callback may make calls that need it.
    pub fn end_previous(&self, previous: Option<Listener>, in_callback: bool) {
        if let Some(previous) = previous {
            previous.end(in_callback);
        }
        let runs = || self.running.lock().as_ref().is_some_and(|removed| removed.load(Ordering::Acquire));
        while !in_callback && runs() {
            sleep(RETURN_PERIOD);
        }
    }

    /// Wraps the planner's callback in a function that notes for [`in_callback`] and [`end`] whether the callback runs.
    fn guarded(&self, removed: Arc<AtomicBool>, mut callback: impl FnMut(&Event, u64)) -> impl FnMut(&Event, u64) {
        move |event, lost| {
            let _calling = self.calling.lock();
            // `running` is set before `removed` is checked, so that `end_previous` waits for each callback that passes
            // this check.
            *self.running.lock() = Some(removed.clone());
            // ENDED and `removed` can have changed while this thread waited for the lock.
            if !ENDED.load(Ordering::Acquire) && !removed.load(Ordering::Acquire) {
                IN_CALLBACK.set(true);
                callback(event, lost);
                IN_CALLBACK.set(false);
            }
            *self.running.lock() = None;
        }
    }
}

impl Listener {
    /// Ends the calls of the function. Waits until the function has returned, unless `in_callback` is true. The caller
    /// must hold no lock, because the function may make calls that need it.
    fn end(self, in_callback: bool) {
        self.removed.store(true, Ordering::Release);
        if in_callback {
            self.thread.detach();
        }
    }
}

/// Returns whether the calling thread is in a planner's callback of any hand. Such a thread waits for no callback: two
/// callbacks that close each other's hand would wait for each other.
pub(super) fn in_callback() -> bool {
    IN_CALLBACK.try_with(Cell::get).unwrap_or(false)
}

/// Prevents further calls of the callbacks when the process exits, because the planner's data are about to be
/// destroyed. Waits for each callback that is running, for at most `limit`.
pub(super) fn end<'a>(limit: Duration, hands: impl Iterator<Item = &'a HandEvents>) {
    ENDED.store(true, Ordering::Release);
    if !in_callback() {
        hands.for_each(|events| drop(try_for(limit, || events.calling.try_lock())));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::events::EventKind;
    use crate::model::{FingerNumber, Part};
    use std::sync::mpsc::channel;
    use std::thread;

    /// A callback that runs can remove another listener while the thread of that listener waits for the lock `calling`.
    /// The removed listener must not call its function when it gets the lock.
    #[test]
    fn a_removed_callback_is_not_called() {
        let (finger, kind, part) = (FingerNumber::ONE, EventKind::Settled, Part::Finger);
        let event = Event { finger, cycle: 7, time: 7_000_000, kind, part, values: [0.0; 4] };
        let (events, removed, mut calls) = (HandEvents::new(), Arc::new(AtomicBool::new(false)), 0);
        let mut guarded = events.guarded(removed.clone(), |_, _| calls += 1);
        guarded(&event, 0);
        removed.store(true, Ordering::Release);
        guarded(&event, 0);
        drop(guarded);
        assert_eq!(calls, 1);
    }

    #[test]
    fn a_callback_that_has_removed_itself_is_waited_for() {
        let (finger, kind, part) = (FingerNumber::ONE, EventKind::Settled, Part::Finger);
        let event = Event { finger, cycle: 7, time: 7_000_000, kind, part, values: [0.0; 4] };
        let (events, removed) = (&HandEvents::new(), Arc::new(AtomicBool::new(false)));
        let ((began, has_begun), (allow, may_return)) = (channel(), channel());
        let (close, closed) = channel();
        thread::scope(move |scope| {
            let mut guarded = events.guarded(removed.clone(), move |_, _| {
                removed.store(true, Ordering::Release);
                began.send(()).expect("the test waits");
                may_return.recv().expect("the test allows it");
            });
            scope.spawn(move || guarded(&event, 0));
            has_begun.recv().expect("the callback runs");
            scope.spawn(move || {
                events.close(false);
                close.send(()).expect("the test waits");
            });
            assert!(closed.recv_timeout(Duration::from_millis(100)).is_err(), "the callback still runs");
            allow.send(()).expect("the callback waits");
            closed.recv().expect("the hand is closed");
        });
    }
}
