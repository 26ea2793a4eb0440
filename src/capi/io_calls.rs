//! The exported functions for hardware that the program provides. Their doc comments are the C manual, as in
//! `calls.rs`.

use crate::capi::handle::sun2xp_hand;
use crate::capi::io_structs::sun2xp_io;
use crate::capi::io_table;
use crate::capi::memory::non_null;
use crate::capi::opened_hand::Source;
use crate::capi::opening_calls::open;
use crate::capi::refusal::Wanted;
use std::ffi::{c_char, c_int};

/// sun2xp_open_io - open a hand with hardware that the program provides
///
///   path    as in sun2xp_open
///   count   number of fingers whose hardware the program provides, 0 to 3
///   io      io[count]: the hardware of each of these fingers; copied
///   hand    result: the handle of the hand
///
/// Opens a hand as sun2xp_open does. A finger with an element in io has no serial port: the library calls
/// start, then exchange in every cycle, then stop, all with user as first argument. Each must return 0, or an
/// errno if it fails. Timing, faults and recovery are as with a board (docs/other-hardware.md). The library
/// calls these functions as follows:
///
///   start     in a thread of the library that is not real-time, at opening and at every recovery. start
///             may take seconds. If it fails, the opening or the recovery is refused.
///   exchange  in the servo thread of the finger. A failure counts as a lost reply. If exchange returns 0
///             after the deadline, the sample is used nevertheless. If the next period has begun by then,
///             the cycle counts as an overrun.
///   stop      in the servo thread. At a recovery, or when opening is refused, it may be called in a thread
///             that is not real-time. If stop fails, the library calls it again. If it keeps failing, the
///             library calls it at least three times in all. Every start that has succeeded is followed by
///             a stop.
///
/// Calls for one finger never overlap. Calls for different fingers may overlap. If the fingers share a
/// servo thread (finger.thread), their exchanges do not overlap, but a start, or the stop of a recovery,
/// may overlap with the exchange of another finger. In one cycle, these fingers get the same
/// command->deadline. The next cycle has a later one, so a new deadline marks the first exchange of a
/// cycle. A finger that is faulted or stopped gets no exchange.
///
/// exchange and stop must not allocate memory, wait for locks, write files or call the library. The behaviour
/// is undefined if one of the functions does not return, because of longjmp, pthread_exit or an exception.
///
/// The program must provide a watchdog outside this process, such as that of its drives: if no exchange
/// comes for the time terms->watchdog, the hardware must enter the end state by itself, even if this
/// process hangs or has died.
///
/// A tension may be from -8191 to 57342 times io->tension_unit. A tension that is NaN or outside this range
/// faults the finger, as SUN2XP_IO_SENSOR does. An encoder that moves by more than 32767
/// counts between two exchanges faults the finger in the same way.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   ENOMEM   there is not enough memory
///   EFAULT   hand is null, or io is null and count is not 0
///   EINVAL   size is too small; count is not 0 to 3; no such finger, or two elements for one finger;
///            shortest_watchdog is negative or NaN
///   EFAULT   a function of io is null
///   EMFILE   16 hands are open
///   ENOENT, EACCES ...  the configuration file cannot be read; errno of the system
///   EINVAL   the configuration is unusable; finger.gauge.newton_per_count or finger.gauge.zero does not fit
///            this hardware (docs/other-hardware.md); tension_unit is negative, infinite or NaN
///   others   as sun2xp_open, and the errno that start has returned
///
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_open_io(
    path: *const c_char,
    count: c_int,
    io: *const sun2xp_io,
    hand: *mut *mut sun2xp_hand,
) -> c_int {
    // SAFETY: here and below, by the contract in the manual, each pointer is null or points to the data of its
    // description.
    unsafe {
        open("sun2xp_open_io", hand, || {
            let io = io_table::load(count, io)?;
            Ok(Source::at(path).with_io(io))
        })
    }
}

/// sun2xp_open_io_text - sun2xp_open_io for a configuration in memory
///
///   configuration   the text, as in sun2xp_open_text
///   count, io       as in sun2xp_open_io
///   hand            result: the handle of the hand
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   hand or configuration is null, or io is null and count is not 0
///   others   as sun2xp_open_io
///
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_open_io_text(
    configuration: *const c_char,
    count: c_int,
    io: *const sun2xp_io,
    hand: *mut *mut sun2xp_hand,
) -> c_int {
    // SAFETY: as above.
    unsafe {
        open("sun2xp_open_io_text", hand, || {
            non_null(configuration, "configuration", Wanted::Text)?;
            let io = io_table::load(count, io)?;
            Ok(Source::in_memory(configuration).with_io(io))
        })
    }
}
