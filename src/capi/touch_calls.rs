//! The exported functions for the tactile elements. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::guarded;
use crate::capi::default_hand;
use crate::capi::memory::fill;
use crate::capi::status_calls::count;
use crate::finger::TouchReading;
use crate::hand::Hand;
use std::ffi::{c_double, c_int, c_uint, c_ulong};
use std::mem::size_of;

/// Result of GetTouch.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FingerTouch {
    /// In: sizeof (struct FingerTouch). Out: bytes written, at most that.
    pub Size: c_uint,
    /// 1 if the board has reported this element since OpenHand and could read it, otherwise 0. If it is 0,
    /// Pressed, Count and Force are 0 too.
    pub Valid: c_int,
    /// 1 if something presses the element, otherwise 0.
    pub Pressed: c_int,
    /// The raw count of the element.
    pub Count: c_uint,
    /// Force on the element, N: its count minus its zero, times newton_per_count of the configuration.
    pub Force: c_double,
    /// Tactile events of the finger that were lost since OpenHand, because they did not fit into the queue of the
    /// board or because their element is not configured.
    pub LostEvents: c_ulong,
}

/// GetTouch - the newest reading of a tactile element
///
///     int GetTouch(int i, int Element, struct FingerTouch *Touch);
///
///   i        finger, 1 to 3
///   Element  element, from 0, in the order of [finger.touch] in the configuration
///   Touch    result; set Touch->Size before the call
///
/// A board reports an element when its reading changes. The servo fetches one such event of a finger in each period in
/// which the line has time for it. A faulted finger keeps its last readings.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Touch is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger; no such Element
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example:
///
///     struct FingerTouch Touch;
///     Touch.Size = sizeof Touch;
///     if (GetTouch(1, 0, &Touch) == 0 && Touch.Valid)
///         printf("%.3f N\n", Touch.Force);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetTouch(i: c_int, Element: c_int, Touch: *mut FingerTouch) -> c_int {
    guarded("GetTouch", || {
        let read = |hand: &Hand| {
            let element = usize::try_from(Element).unwrap_or(usize::MAX);
            let reading: TouchReading = hand.touch(i, element)?;
            Ok(FingerTouch {
                Size: size_of::<FingerTouch>() as c_uint,
                Valid: reading.valid.into(),
                Pressed: reading.pressed.into(),
                Count: reading.count.into(),
                Force: reading.force,
                LostEvents: count(hand.lost_touch_events(i)?),
            })
        };
        // SAFETY: by the contract in the manual, `Touch` is null or points to as many bytes as its first member gives.
        unsafe { fill(Touch, "Touch", size_of::<FingerTouch>(), read) }
    })
}

/// TareTouch - make the present readings of a finger's tactile elements their zeros
///
///     int TareTouch(int i);
///
///   i        finger, 1 to 3
///
/// Call TareTouch while nothing touches the finger. An element without a valid reading keeps its zero. The zeros are in
/// force until CloseHand. The configuration keeps its own zeros.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   ENODEV   no hand is open
///   EINVAL   no such finger
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example:
///
///     TareTouch(1);
#[unsafe(no_mangle)]
pub extern "C" fn TareTouch(i: c_int) -> c_int {
    guarded("TareTouch", || default_hand::with(|hand| hand.tare_touch(i).map(|_| ())))
}
