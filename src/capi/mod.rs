//! The C face: the five calls of 1990 and what was added to them, on one default hand. It checks pointers, catches
//! panics and turns refusals into errno; every other check is the hand's. `include/Sun2Xp.h` is generated from the
//! files named `calls`.
//!
//! Where several things are wrong with one call, it reports the first of this order: forked child (EPERM), null pointer
//! (EFAULT), no hand (ENODEV), a struct with too small a Size (EINVAL), then what the hand finds: finger number,
//! numbers that are not finite, symmetry and eigenvalues, limits, a faulted finger. The lists in the manual have the
//! same order. A slow call looks for free memory (ENOMEM) after the first.

// The boundary to C cannot be written without raw pointers.
#![allow(unsafe_code)]

mod black_box_calls;
mod boundary;
mod calibration_calls;
mod calls;
mod default_hand;
mod fault_calls;
mod fault_texts;
mod fingertip_calls;
mod forked;
mod memory;
mod process;
mod recovery_calls;
mod refusal;
mod status_calls;
mod text;
mod timing_calls;
