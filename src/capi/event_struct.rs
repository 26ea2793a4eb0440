//! The struct of an event. Its doc comments are the C manual, as in `calls.rs`.

// The names of the header.
#![allow(non_camel_case_types)]

use std::ffi::{c_int, c_ulong};

/// An event: something that happened to a finger in one cycle of its servo.
///
/// For each kind of event, docs/events.md says whether the member part is the number of a joint, of a tendon
/// or of another part. This member is 0 if the event concerns the whole finger. All events of a cycle have the
/// same time. The oldest events are lost first.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_event {
    /// sizeof (struct sun2xp_event), set before the call.
    pub size: usize,
    /// Finger, 1 to 3.
    pub finger: c_int,
    /// Kind of the event: SUN2XP_EVENT_...
    pub kind: c_int,
    /// Number of the joint, 0 to 2, or of the tendon, motor, gauge or encoder, 1 to 4; 0 for the whole finger.
    pub part: c_int,
    /// Cycle of the event, as in sun2xp_status and sun2xp_record.
    pub cycle: c_ulong,
    /// Number of events that were lost since sun2xp_open; in a callback, since sun2xp_on_event. An event is lost if it
    /// is not taken in time. An event of a hand on another machine can also be lost on the way.
    pub lost: c_ulong,
    /// Beginning of the event's cycle, s of CLOCK_MONOTONIC.
    pub time: f64,
    /// Values, whose meaning depends on the kind (docs/events.md). Unused ones are 0.
    pub values: [f64; 4],
}
