//! The C interface: the five calls of 1990, on one default hand, and the calls with handles. It checks pointers,
//! catches panics and converts refusals to numbers and errno; the hand makes all other checks. `include/Sun2Xp.h` and
//! `include/sun2xp.h` are generated from the files that `tests/header/main.rs` lists.
//!
//! If several reasons to refuse a call apply, the call reports the first one in this order: forked child (EPERM), null
//! pointer (EFAULT), exiting process (ESHUTDOWN), no hand (ENODEV), a struct whose size is too small (EINVAL), then the
//! reasons that the hand finds: finger number, numbers that are not finite, symmetry and eigenvalues, limits, faulted
//! finger. The lists in the manual have the same order, without ESHUTDOWN. A slow call checks for free memory (ENOMEM)
//! after the check for a forked child. The manual names the exceptions.

// A C interface needs raw pointers.
#![allow(unsafe_code)]

mod adjustment_calls;
mod black_box_calls;
mod boundary;
mod calibration_calls;
mod calls;
mod error_calls;
mod error_numbers;
mod event_calls;
mod event_struct;
mod fault_calls;
mod fault_struct;
mod fault_texts;
mod fingers;
mod fingertip_calls;
mod fingertip_result;
mod fingertip_struct;
mod forked;
mod group_calls;
mod hand_events;
mod hand_table;
mod handle;
mod io_calls;
mod io_structs;
mod io_table;
mod kinematics_calls;
mod limits_calls;
mod limits_struct;
mod loaded_hand;
mod log_calls;
mod long_operations;
mod memory;
mod object_calls;
mod opened_hand;
mod opening_calls;
mod path_calls;
mod planners_pointer;
mod position_calls;
mod process;
mod recovery_calls;
mod reflex_calls;
mod refusal;
mod remedy_calls;
mod remote_hand;
mod remote_library;
mod reporting;
mod sized_struct;
mod spring_calls;
mod status_calls;
mod status_struct;
mod text;
mod thread_errors;
mod timing_calls;
mod touch_calls;
mod version_calls;

#[cfg(feature = "internals")]
pub use error_numbers::of_hand as error_number;
#[cfg(feature = "internals")]
pub use event_struct::sun2xp_event;
#[cfg(feature = "internals")]
pub use fault_struct::sun2xp_fault;
#[cfg(feature = "internals")]
pub use fingertip_struct::sun2xp_tip;
#[cfg(feature = "internals")]
pub use limits_struct::sun2xp_limits;
#[cfg(feature = "internals")]
pub use remote_hand::{RemoteHand, RemoteOpener, RemoteRefusal, RemoteSource, open_only_remote_hands};
#[cfg(feature = "internals")]
pub use status_struct::sun2xp_status;
