//! The exported functions for events. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::{MEMORY_OF_THREAD, delegated, guarded};
use crate::capi::default_events;
use crate::capi::default_hand;
use crate::capi::memory::{fill_next, size_up_to};
use crate::capi::refusal::Refusal;
use crate::capi::status_calls::count;
use crate::events::{self, EventQueue};
use std::ffi::{c_int, c_uint, c_ulong, c_void};
use std::sync::Arc;
use std::sync::atomic::{AtomicI32, Ordering};
use std::time::{Duration, Instant};

/// An event: something that happened to a finger in one cycle of its servo.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Event {
    /// In: sizeof (struct Event). Out: bytes written, at most that.
    pub Size: c_uint,
    /// Finger, 1 to 3.
    pub Finger: c_int,
    /// Kind of the event: EVENT_...
    pub Kind: c_int,
    /// Part of the finger that the event concerns: joint (0 to 2), or tendon, motor, gauge or encoder (1 to 4). 0 if
    /// the event concerns the whole finger.
    pub Part: c_int,
    /// Number of the cycle to which the event belongs, as in FingerStatus.Cycles and FingerRecord.Cycle.
    pub Cycle: c_ulong,
    /// Events that were lost since OpenHand, the oldest first, because they were not taken in time.
    pub Lost: c_ulong,
    /// Time at which this cycle began, s of CLOCK_MONOTONIC. All events of a cycle have the same time.
    pub Time: f64,
    /// Values, with the meanings and units of the kind (docs/events.md). Unused values are 0.
    pub Values: [f64; 4],
}

/// NextEvent - take the next event
///
///     int NextEvent(struct Event *Event);
///
///   Event    result; set Event->Size before the call
///
/// Takes the earliest event of all fingers since OpenHand that no call has taken yet. Events come in
/// the order of their times, except if a servo is late by more than two periods. Each finger keeps its
/// newest 4096 events. If they are not taken in time, the oldest are lost, and Event->Lost counts them.
/// A callback of OnEvent takes nothing away from this call.
///
/// Returns 1 if there was an event, 0 if there was none, or -1 with
///   EPERM    forked child
///   EFAULT   Event is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small
///
/// Threads: any; each event goes to one thread. Never waits for a servo.
///
/// Example:
///
///     struct Event Event;
///     Event.Size = sizeof Event;
///     while (NextEvent(&Event) == 1)
///         if (Event.Kind == EVENT_SETTLED)
///             printf("finger %d rests at %.2f s\n", Event.Finger, Event.Time);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn NextEvent(Event: *mut Event) -> c_int {
    // SAFETY: by the contract in the manual, `Event` is null or points to as many bytes as its first member gives.
    unsafe { take("NextEvent", Event) }
}

/// WaitEvent - wait for the next event
///
///     int WaitEvent(struct Event *Event, int Milliseconds);
///
///   Event         result; set Event->Size before the call
///   Milliseconds  longest wait; 0: no wait; negative: no limit
///
/// Takes an event as NextEvent does, and waits for one if there is none. CloseHand ends the wait.
///
/// Returns 1 if there was an event, 0 if there was none within the time, or -1 with
///   EPERM    forked child
///   EFAULT   Event is null
///   ENODEV   no hand is open, or it was closed meanwhile
///   EINVAL   Size is too small
///
/// Threads: any; each event goes to one thread. Several threads may wait.
///
/// Example, until finger 1 has settled:
///
///     double Pos[3] = {0.0, 0.5, 0.8};
///     struct Event Event;
///     Event.Size = sizeof Event;
///     SendPos(1, Pos);
///     while (WaitEvent(&Event, 5000) == 1)
///         if (Event.Finger == 1 && Event.Kind == EVENT_SETTLED)
///             break;
#[unsafe(no_mangle)]
pub unsafe extern "C" fn WaitEvent(Event: *mut Event, Milliseconds: c_int) -> c_int {
    let limit = u64::try_from(Milliseconds).ok().map(Duration::from_millis);
    let deadline = limit.map(|limit| Instant::now() + limit);
    loop {
        // SAFETY: by the contract in the manual, `Event` is null or points to as many bytes as its first member gives.
        match unsafe { take("WaitEvent", Event) } {
            0 => {}
            result => return result,
        }
        let left = deadline.map(|deadline| deadline.saturating_duration_since(Instant::now()));
        if left.is_some_and(|left| left.is_zero()) {
            return 0;
        }
        // The thread of this call only waits. The planner's thread takes the event, so that no event is lost if a
        // signal handler jumps out of the wait.
        let wait = move || default_events::wait(left).map(|_| ());
        if delegated("WaitEvent", MEMORY_OF_THREAD, || Ok(wait)) != 0 {
            return -1;
        }
    }
}

/// OnEvent - call a function with each event
///
///     int OnEvent(void (*Callback)(const struct Event *Event, void *Context), void *Context);
///
///   Callback   function to call, or null for none
///   Context    second argument of each call of the function
///
/// From now on a thread of the library, which is not real-time, calls Callback with each event. There
/// is one callback for the hand; a later OnEvent replaces it. While Callback runs, later events wait.
/// Callback may make every call, and must return: no longjmp, pthread_exit or exception.
///
/// When OnEvent or CloseHand has returned, the previous callback is not running and is not called
/// again. If they are called by the callback itself, they do not wait for it, and it is not called
/// again after it has returned.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   ENODEV   no hand is open
///   EAGAIN   the system refuses to start a thread
///
/// Threads: any, and Callback. Waits until the previous callback has returned.
///
/// Example:
///
///     static void OnContact(const struct Event *Event, void *Context)
///     {
///         (void)Context;
///         if (Event->Kind == EVENT_CONTACT)
///             printf("finger %d touches something\n", Event->Finger);
///     }
///
///     OnEvent(OnContact, NULL);
#[unsafe(no_mangle)]
pub extern "C" fn OnEvent(Callback: Option<extern "C" fn(*const Event, *mut c_void)>, Context: *mut c_void) -> c_int {
    delegated("OnEvent", MEMORY_OF_THREAD, || {
        let in_callback = default_events::in_callback();
        let context = PlannersPointer(Context);
        let callback = Callback.map(|callback| {
            move |event: &events::Event, lost: u64| {
                let context = &context;
                callback(&to_c(event, lost), context.0);
            }
        });
        Ok(move || {
            let start = |callback| default_hand::with(|hand| default_events::listener(hand, callback));
            // An open hand is needed to remove a callback too.
            let listener = match callback {
                Some(callback) => Some(start(callback)?),
                None => default_hand::with(|_| Ok::<_, Refusal>(None))?,
            };
            default_events::replace(listener, in_callback);
            Ok(())
        })
    })
}

/// EventDescriptor - a descriptor for poll and select
///
///     int EventDescriptor(void);
///
/// The descriptor is readable while NextEvent would return an event, and when the hand is closed.
/// NextEvent makes it unreadable when it returns 0, so call NextEvent until it returns 0 after each
/// poll. Do not read, write or close the descriptor. CloseHand closes it.
///
/// Returns the descriptor, the same one until CloseHand, or -1 with
///   EPERM    forked child
///   ENODEV   no hand is open
///   EMFILE, ENFILE, EAGAIN ...  the system refuses the descriptor or the thread
///
/// Threads: any.
///
/// Example:
///
///     struct pollfd Ready;
///     struct Event Event;
///     Ready.fd = EventDescriptor();
///     Ready.events = POLLIN;
///     Event.Size = sizeof Event;
///     while (poll(&Ready, 1, 1000) == 1)
///         while (NextEvent(&Event) == 1)
///             printf("event %d\n", Event.Kind);
#[unsafe(no_mangle)]
pub extern "C" fn EventDescriptor() -> c_int {
    let descriptor = Arc::new(AtomicI32::new(-1));
    let made = descriptor.clone();
    let result = delegated("EventDescriptor", MEMORY_OF_THREAD, || {
        Ok(move || {
            made.store(default_events::descriptor()?, Ordering::Relaxed);
            Ok(())
        })
    });
    if result == 0 { descriptor.load(Ordering::Relaxed) } else { result }
}

/// A pointer of the planner that the library only passes back.
struct PlannersPointer(*mut c_void);

// SAFETY: the library does not access what the pointer points to.
unsafe impl Send for PlannersPointer {}

/// Takes the next event. Returns 1, 0 if there is none, or -1 if the call is refused.
///
/// # Safety
/// `event` is null, or points to as many bytes as its first member gives.
unsafe fn take(name: &'static str, event: *mut Event) -> c_int {
    let mut taken = false;
    let result = guarded(name, || {
        let least = size_up_to!(Event, Values: [f64; 4]);
        // SAFETY: the contract of this function.
        taken = unsafe {
            let next = |queue: Arc<EventQueue>| queue.next().map(|event| to_c(&event, queue.lost()));
            fill_next(event, "Event", least, default_events::queue, next)
        }?;
        Ok(())
    });
    if result == 0 { c_int::from(taken) } else { result }
}

/// Converts everything except `Size`. [`fill_next`] sets `Size`, because it depends on the room of the caller.
fn to_c(event: &events::Event, lost: u64) -> Event {
    Event {
        Size: size_of::<Event>() as c_uint,
        Finger: event.finger.get(),
        Kind: event.kind.number().into(),
        Part: event.part.number().into(),
        Cycle: count(event.cycle),
        Lost: count(lost),
        Time: event.time as f64 * 1e-9,
        Values: event.values,
    }
}
