//! The C interface: the five calls of 1990 and later calls, on one default hand. It checks pointers, catches panics and
//! converts refusals to errno; the hand makes all other checks. `tests/header.rs` lists the files from which
//! `include/Sun2Xp.h` is generated.
//!
//! If several reasons apply to a call, it reports the first one in this order: forked child (EPERM), null pointer
//! (EFAULT), no hand (ENODEV), a struct whose Size is too small (EINVAL), then the reasons that the hand finds: finger
//! number, numbers that are not finite, symmetry and eigenvalues, limits, faulted finger. The lists in the manual have
//! the same order. A slow call checks for free memory (ENOMEM) after the check for a forked child.

// A C interface needs raw pointers.
#![allow(unsafe_code)]

mod black_box_calls;
mod boundary;
mod calibration_calls;
mod calls;
mod default_events;
mod default_hand;
mod event_calls;
mod fault_calls;
mod fault_texts;
mod fingertip_calls;
mod fingertip_result;
mod forked;
mod group_calls;
mod kinematics_calls;
mod memory;
mod object_calls;
mod path_calls;
mod process;
mod recovery_calls;
mod reflex_calls;
mod refusal;
mod remedy_calls;
mod spring_calls;
mod status_calls;
mod text;
mod timing_calls;
mod touch_calls;
