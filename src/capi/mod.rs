//! The C face: the five calls of 1990 and what was added to them, on one default hand. It checks pointers, catches panics
//! and turns refusals into errno; every other check is the hand's. `include/Sun2Xp.h` is generated from `calls.rs`,
//! `fingertip_calls.rs` and `fault_calls.rs`.
//!
//! Where several things are wrong with one call, the first of this order is told: forked child (EPERM), null pointer
//! (EFAULT), no hand (ENODEV), then what the hand finds: finger number, numbers that are not finite, symmetry and
//! eigenvalues, limits, a faulted finger.

// The boundary to C cannot be written without raw pointers.
#![allow(unsafe_code)]

mod calls;
mod default_hand;
mod fault_calls;
mod fingertip_calls;
mod process;
mod refusal;
