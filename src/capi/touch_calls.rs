//! The exported functions for the tactile elements. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::guarded;
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::sized_struct::fill_from;
use crate::capi::status_calls::count;
use crate::finger::TouchReading;
use crate::hand::Hand;
use std::ffi::{c_double, c_int, c_uint, c_ulong};

/// Result of sun2xp_touch.
///
/// If the member valid is 0, the members pressed, count and force are 0 too. The member force is the member count minus
/// the zero of the element, times newton_per_count of the configuration. Tactile events are lost if they do not fit
/// into the queue of the board, or if their element is not configured.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_touch {
    /// sizeof (struct sun2xp_touch), set before the call.
    pub size: usize,
    /// 1: the newest report of this element has a reading. 0: it has none, or the board has not reported the element
    /// since sun2xp_open or since its last reset.
    pub valid: c_int,
    /// 1 if something presses the element, otherwise 0.
    pub pressed: c_int,
    /// The raw count of the element.
    pub count: c_uint,
    /// Force on the element, N.
    pub force: c_double,
    /// Tactile events of the finger that were lost since sun2xp_open.
    pub lost_events: c_ulong,
}

/// sun2xp_touch - the newest reading of a tactile element
///
///   finger    1 to 3
///   element   element, from 0, in the order of [finger.touch] in the configuration
///   touch     result; set touch->size before the call
///
/// A board reports a changed reading of an element as an event. The servo fetches one event of a finger in
/// each period in which the line has time for it. A faulted finger keeps its last readings. They become
/// invalid when the finger recovers, if the board may have been reset: after SUN2XP_FAULT_BOARD_RESET,
/// SUN2XP_FAULT_LOST_REPLIES, SUN2XP_FAULT_DAMAGED_REPLIES, SUN2XP_FAULT_PORT_VANISHED and
/// SUN2XP_FAULT_PORT_FAILED, and after any other fault if the board was reset before the recovery.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   touch is null
///   ENODEV   no such hand
///   EINVAL   size is too small; no such finger; no such element
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example:
///
///     struct sun2xp_touch touch;
///     touch.size = sizeof touch;
///     if (sun2xp_touch(hand, 1, 0, &touch) == 0 && touch.valid)
///         printf("%.3f N\n", touch.force);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_touch(
    hand: *mut sun2xp_hand,
    finger: c_int,
    element: c_int,
    touch: *mut sun2xp_touch,
) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_touch", hand, || {
        let read = |hand: &Hand| {
            let element = usize::try_from(element).unwrap_or(usize::MAX);
            let reading: TouchReading = hand.touch(finger, element)?;
            Ok(sun2xp_touch {
                size: 0,
                valid: reading.valid.into(),
                pressed: reading.pressed.into(),
                count: reading.count.into(),
                force: reading.force,
                lost_events: count(hand.lost_touch_events(finger)?),
            })
        };
        // SAFETY: by the contract in the manual, `touch` is null or points to as many bytes as its first member gives.
        unsafe { fill_from(hand, touch, "touch", read) }
    })
}

/// sun2xp_tare_touch - make the present readings of a finger's tactile elements their zeros
///
///   finger   1 to 3
///
/// Call sun2xp_tare_touch while nothing touches the finger. An element without a valid reading keeps its
/// zero. The zeros are in force until sun2xp_close. The configuration keeps its own zeros.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   ENODEV   no such hand
///   EINVAL   no such finger
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example:
///
///     sun2xp_tare_touch(hand, 1);
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_tare_touch(hand: *mut sun2xp_hand, finger: c_int) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_tare_touch", hand, || hand_table::with(hand, |hand| hand.tare_touch(finger)))
}
