//! The exported functions for events. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::{MEMORY_OF_THREAD, delegated, guarded, uncancelled};
use crate::capi::event_struct::sun2xp_event;
use crate::capi::hand_events;
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::planners_pointer::PlannersPointer;
use crate::capi::refusal::Refusal;
use crate::capi::remote_hand::RemoteHand;
use crate::capi::sized_struct::fill_next;
use crate::capi::status_calls::count;
use crate::events::{self, EventQueue};
use crate::hand::HandError;
use std::ffi::{c_int, c_void};
use std::sync::Arc;
use std::sync::atomic::{AtomicI32, Ordering};
use std::time::{Duration, Instant};

/// sun2xp_next_event - take the next event
///
///   event   result; set event->size before the call
///
/// Takes the earliest event of all fingers since sun2xp_open that no call has taken yet. Events come in the
/// order of their times, except if a servo is late by more than two periods. Each finger keeps its newest
/// 4096 events. If they are not taken in time, the oldest are lost, and event->lost counts them. A callback
/// of sun2xp_on_event takes no events: this call returns them too.
///
/// Returns 1 if there was an event, 0 if there was none, or a negative number with
///   EPERM    forked child
///   EFAULT   event is null
///   ENODEV   no such hand
///   EINVAL   size is too small
///
/// Threads: any; each event goes to one thread. Never waits for a servo.
///
/// Example:
///
///     struct sun2xp_event event;
///     event.size = sizeof event;
///     while (sun2xp_next_event(hand, &event) == 1)
///         if (event.kind == SUN2XP_EVENT_SETTLED)
///             printf("finger %d rests at %.2f s\n", event.finger, event.time);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_next_event(hand: *mut sun2xp_hand, event: *mut sun2xp_event) -> c_int {
    let hand = Handle::of(hand);
    // SAFETY: by the contract in the manual, `event` is null or points to as many bytes as its first member gives.
    unsafe { take("sun2xp_next_event", hand, event) }
}

/// sun2xp_wait_event - wait for the next event
///
///   event     result; set event->size before the call
///   seconds   longest wait, s; 0 or NaN: no wait; negative: no limit
///
/// Takes an event as sun2xp_next_event does, and waits for one if there is none. sun2xp_close ends the
/// wait.
///
/// Returns 1 if there was an event, 0 if there was none within the time, or a negative number with
///   EPERM    forked child
///   EFAULT   event is null
///   ENODEV   no such hand, or it was closed meanwhile
///   EINVAL   size is too small
///
/// Threads: any; each event goes to one thread. Several threads may wait.
///
/// Example, until finger 1 has settled:
///
///     double position[3] = {0.0, 0.5, 0.8};
///     struct sun2xp_event event;
///     event.size = sizeof event;
///     sun2xp_send_position(hand, 1, position);
///     while (sun2xp_wait_event(hand, &event, 5.0) == 1)
///         if (event.finger == 1 && event.kind == SUN2XP_EVENT_SETTLED)
///             break;
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_wait_event(hand: *mut sun2xp_hand, event: *mut sun2xp_event, seconds: f64) -> c_int {
    let hand = Handle::of(hand);
    uncancelled(|| {
        // A negative time means no limit, and so does a time that is too long for the clock. NaN means no wait.
        let limit = if seconds.is_nan() { Some(Duration::ZERO) } else { Duration::try_from_secs_f64(seconds).ok() };
        let deadline = limit.and_then(|limit| Instant::now().checked_add(limit));
        loop {
            // SAFETY: by the contract in the manual, `event` is null or points to as many bytes as its first member
            // gives.
            match unsafe { take("sun2xp_wait_event", hand, event) } {
                0 => {}
                result => return result,
            }
            let left = deadline.map(|deadline| deadline.saturating_duration_since(Instant::now()));
            if left.is_some_and(|left| left.is_zero()) {
                return 0;
            }
            // `delegated` waits in another thread. The planner's own thread takes the event, so that no event is lost
            // if a signal handler jumps out of the wait.
            let wait = move || match hand_table::remote(hand)? {
                Some(remote) => Ok(remote.wait_for_event(left)?),
                None => hand_table::events(hand)?.wait(hand, left).map(|_| ()),
            };
            match delegated("sun2xp_wait_event", hand, MEMORY_OF_THREAD, || Ok(wait)) {
                0 => {}
                refused => return refused,
            }
        }
    })
}

/// sun2xp_on_event - call a function with each event
///
///   callback   function to call, or null for none
///   context    second argument of each call of the function
///
/// From now on a thread of the library, which is not real-time, calls callback with each event. There is
/// one callback for the hand; a later sun2xp_on_event replaces it. While callback runs, later events wait.
/// The callback may make every call, and must return: no longjmp, pthread_exit or exception.
///
/// When sun2xp_on_event or sun2xp_close has returned, the previous callback is not running and is not
/// called again. There is one exception: a call that is made in an event callback of any hand
/// does not wait for the previous callback. The previous callback may then still be running or be called
/// once more, so its context must stay valid for some time.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   ENODEV   no such hand
///   EAGAIN   the system refuses to start a thread
///
/// Threads: any. Waits until the previous callback has returned, unless the call was made in a callback, of
/// this hand or of another one.
///
/// Example:
///
///     static void on_contact(const struct sun2xp_event *event, void *context)
///     {
///         (void)context;
///         if (event->kind == SUN2XP_EVENT_CONTACT)
///             printf("finger %d touches something\n", event->finger);
///     }
///
///     sun2xp_on_event(hand, on_contact, NULL);
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_on_event(
    hand: *mut sun2xp_hand,
    callback: Option<extern "C" fn(*const sun2xp_event, *mut c_void)>,
    context: *mut c_void,
) -> c_int {
    let hand = Handle::of(hand);
    delegated("sun2xp_on_event", hand, MEMORY_OF_THREAD, || {
        let in_callback = hand_events::in_callback();
        let context = PlannersPointer(context);
        let callback = callback.map(|callback| {
            move |event: &events::Event, lost: u64| {
                let context = &context;
                callback(&to_c(event, lost), context.0);
            }
        });
        Ok(move || {
            let events = hand_table::events(hand)?;
            // The hand stays open until the callback is replaced. Otherwise another hand could
            // be opened at the same place of the table, and this call would replace the callback of that hand.
            let previous = hand_table::with(hand, |hand| {
                let listener = callback.map(|callback| events.listener(hand, callback)).transpose()?;
                Ok::<_, HandError>(events.replace(listener))
            })?;
            events.end_previous(previous, in_callback);
            Ok(())
        })
    })
}

/// sun2xp_event_descriptor - a descriptor for poll and select
///
/// The descriptor is readable while sun2xp_next_event would return an event, and from the beginning of
/// sun2xp_close on. A call of sun2xp_next_event that returns 0 makes the descriptor unreadable. So after each
/// poll, call sun2xp_next_event until it does not return 1. If it returns a negative number, the hand is being
/// closed: do not poll again. Do not read, write or close the descriptor. sun2xp_close closes the descriptor as
/// its last step.
///
/// Returns the descriptor, the same one until sun2xp_close, or a negative number with
///   EPERM    forked child
///   ENODEV   no such hand
///   EMFILE, ENFILE, EAGAIN ...  the system refuses the descriptor, or the thread that makes it readable
///
/// Threads: any.
///
/// Example:
///
///     struct pollfd ready;
///     struct sun2xp_event event;
///     int next = 0;
///     ready.fd = sun2xp_event_descriptor(hand);
///     ready.events = POLLIN;
///     event.size = sizeof event;
///     while (next >= 0 && poll(&ready, 1, 1000) == 1)
///         while ((next = sun2xp_next_event(hand, &event)) == 1)
///             printf("event %d\n", event.kind);
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_event_descriptor(hand: *mut sun2xp_hand) -> c_int {
    let hand = Handle::of(hand);
    uncancelled(|| {
        let descriptor = Arc::new(AtomicI32::new(-1));
        let made = descriptor.clone();
        let result = delegated("sun2xp_event_descriptor", hand, MEMORY_OF_THREAD, || {
            Ok(move || {
                // Refuses a hand of another machine.
                hand_table::with(hand, |_| Ok::<_, Refusal>(()))?;
                made.store(hand_table::events(hand)?.descriptor(hand)?, Ordering::Relaxed);
                Ok(())
            })
        });
        if result == 0 { descriptor.load(Ordering::Relaxed) } else { result }
    })
}

/// Takes the next event. Returns 1 if there was an event, 0 if there was none, or a negative number if the call is
/// refused.
///
/// # Safety
/// `event` is null, or points to as many bytes as its first member gives.
#[inline(always)]
unsafe fn take(name: &'static str, hand: Handle, event: *mut sun2xp_event) -> c_int {
    let mut taken = false;
    let result = guarded(name, hand, || {
        // SAFETY: the contract of this function.
        taken = unsafe { fill_next(event, "event", || Taken::from(hand), Taken::next) }?;
        Ok(())
    });
    if result == 0 { c_int::from(taken) } else { result }
}

/// Where events are taken from.
enum Taken {
    Local(Arc<EventQueue>),
    Remote(Arc<dyn RemoteHand>),
}

impl Taken {
    fn from(hand: Handle) -> Result<Self, Refusal> {
        match hand_table::remote(hand) {
            Ok(Some(remote)) => Ok(Self::Remote(remote)),
            // The queue has a lock of its own, and refuses a hand that is not open or is being closed.
            _ => hand_table::events(hand)?.queue(hand).map(Self::Local),
        }
    }

    fn next(self) -> Result<Option<sun2xp_event>, Refusal> {
        match self {
            Self::Local(queue) => Ok(queue.next().map(|event| to_c(&event, queue.lost()))),
            Self::Remote(remote) => Ok(remote.next_event()?),
        }
    }
}

/// Converts an event. A callback receives this `size`. [`fill_next`] does not copy it, because the `size` of a result
/// belongs to the caller.
fn to_c(event: &events::Event, lost: u64) -> sun2xp_event {
    sun2xp_event {
        size: size_of::<sun2xp_event>(),
        finger: event.finger.get(),
        kind: event.kind.number().into(),
        part: event.part.number().into(),
        cycle: count(event.cycle),
        lost: count(lost),
        time: event.time as f64 * 1e-9,
        values: event.values,
    }
}
