//! The C calls of libsun2xp for a hand on another machine.
//!
//! The exported functions are those of the package `sun2xp`. They have the same names, structs and texts, and protect
//! the planner's process in the same way. In this package they open only hands over the network.

#![deny(unsafe_code)]
#![warn(missing_docs)]

mod measured_rate;
mod network_hand;
mod opening;
mod refusals;
mod results;
mod stop_calls;

/// Runs when the library is loaded.
#[allow(unsafe_code, reason = "the loader calls the functions of this section")]
mod start {
    extern "C" fn start() {
        sun2xp::capi::open_only_remote_hands(crate::opening::open);
    }

    // SAFETY: the loader calls each address of the section as a function. This one does not panic, and needs nothing
    // that other libraries initialise.
    #[used]
    #[unsafe(link_section = ".init_array")]
    static START: extern "C" fn() = start;
}
