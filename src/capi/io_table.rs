//! Hardware that the program provides as a table of C functions.

use crate::board::{DEFAULT_TENSION_UNIT, FingerIo, HandIo, IoCommand, IoFaults, IoProperties, IoSample, IoTerms};
use crate::capi::io_structs::{
    SUN2XP_IO_DRIVER, SUN2XP_IO_EMERGENCY_STOP, SUN2XP_IO_ENDED, SUN2XP_IO_SENSOR, SUN2XP_IO_SUPPLY,
    SUN2XP_IO_WATCHDOG, SUN2XP_IO_ZERO_LOST, sun2xp_io, sun2xp_io_command, sun2xp_io_sample, sun2xp_io_terms,
};
use crate::capi::planners_pointer::PlannersPointer;
use crate::capi::refusal::{Refusal, Wanted};
use crate::capi::sized_struct::SizedStruct;
use crate::capi::status_calls::count;
use crate::model::FingerNumber;
use crate::model::configuration::{EndState, FINGERS};
use std::ffi::{c_int, c_uint, c_void};
use std::io;

type Start = extern "C" fn(*mut c_void, *const sun2xp_io_terms, *mut sun2xp_io_sample) -> c_int;
type Exchange = extern "C" fn(*mut c_void, *const sun2xp_io_command, *mut sun2xp_io_sample) -> c_int;
type Stop = extern "C" fn(*mut c_void) -> c_int;

/// The functions of one finger.
struct IoTable {
    properties: IoProperties,
    user: PlannersPointer,
    start: Start,
    exchange: Exchange,
    stop: Stop,
}

impl FingerIo for IoTable {
    fn properties(&self) -> IoProperties {
        self.properties
    }

    fn start(&mut self, terms: &IoTerms) -> io::Result<IoSample> {
        let seconds = |milliseconds: u16| f64::from(milliseconds) * 1e-3;
        let terms = sun2xp_io_terms {
            size: size_of::<sun2xp_io_terms>(),
            finger: terms.finger.get(),
            hold: c_int::from(terms.end_state == EndState::Hold),
            rate: terms.rate,
            watchdog: seconds(terms.watchdog_ms),
            hold_time: seconds(terms.hold_time_ms),
            hold_torque: terms.hold_torque_limit,
            torque_limits: terms.torque_limits.into(),
            torque_constants: terms.torque_constants.into(),
        };
        let mut sample = blank();
        outcome((self.start)(self.user.0, &terms, &mut sample))?;
        Ok(from_c(&sample))
    }

    fn exchange(&mut self, command: &IoCommand) -> io::Result<IoSample> {
        let command = sun2xp_io_command {
            size: size_of::<sun2xp_io_command>(),
            number: count(command.number),
            enable: c_int::from(command.enable),
            torques: command.torques.into(),
            deadline: command.deadline as f64 * 1e-9,
        };
        let mut sample = blank();
        outcome((self.exchange)(self.user.0, &command, &mut sample))?;
        Ok(from_c(&sample))
    }

    fn stop(&mut self) -> io::Result<()> {
        outcome((self.stop)(self.user.0))
    }
}

fn blank() -> sun2xp_io_sample {
    sun2xp_io_sample { size: size_of::<sun2xp_io_sample>(), time: 0.0, tensions: [0.0; 4], encoders: [0; 4], faults: 0 }
}

fn from_c(sample: &sun2xp_io_sample) -> IoSample {
    let sun2xp_io_sample { time, tensions, encoders, faults, .. } = *sample;
    let known = time.is_finite() && time > 0.0;
    IoSample { time: known.then_some((time * 1e9) as u64), encoders, tensions, faults: named(faults) }
}

/// Converts the faults. Bits of a later version are ignored.
fn named(faults: c_uint) -> IoFaults {
    let bits = [
        (SUN2XP_IO_WATCHDOG, IoFaults::WATCHDOG),
        (SUN2XP_IO_ENDED, IoFaults::ENDED),
        (SUN2XP_IO_EMERGENCY_STOP, IoFaults::EMERGENCY_STOP),
        (SUN2XP_IO_SUPPLY, IoFaults::SUPPLY),
        (SUN2XP_IO_DRIVER, IoFaults::DRIVER),
        (SUN2XP_IO_SENSOR, IoFaults::SENSOR),
        (SUN2XP_IO_ZERO_LOST, IoFaults::ZERO_LOST),
    ];
    bits.into_iter().filter(|(bit, _)| faults & bit != 0).fold(IoFaults::default(), |all, (_, fault)| all | fault)
}

/// A program may return an errno with either sign.
fn outcome(result: c_int) -> io::Result<()> {
    if result == 0 { Ok(()) } else { Err(io::Error::from_raw_os_error(result.saturating_abs())) }
}

/// Copies the tables of the caller.
///
/// # Safety
/// `io` is null, or points to `number` structs with the size of the first one.
pub(super) unsafe fn load(number: c_int, io: *const sun2xp_io) -> Result<HandIo, Refusal> {
    let mut loaded: HandIo = Default::default();
    if number == 0 {
        return Ok(loaded);
    }
    // SAFETY: by the contract of this function, `io` is null or points to a struct.
    let tables = unsafe { SizedStruct::new(io, "io") }?;
    tables.check()?;
    let number = usize::try_from(number).ok().filter(|&number| number <= FINGERS);
    let mut by_finger = [None; FINGERS];
    for place in 0..number.ok_or(Refusal::IoCount)? {
        // SAFETY: the size is right, as checked above, and by the contract of this function there are `number` structs.
        let table = unsafe { tables.load(place) };
        let finger = FingerNumber::try_from(table.finger)?;
        if by_finger[finger.index()].replace(table).is_some() {
            return Err(Refusal::IoTwice(finger));
        }
        // No range contains NaN, so NaN is refused too.
        if !(0.0..).contains(&table.shortest_watchdog) {
            return Err(Refusal::IoWatchdog { finger, seconds: table.shortest_watchdog });
        }
    }
    // The callbacks are checked last, because the manual of sun2xp_open_io lists a missing callback after the other
    // errors that are found here.
    for (loaded, table) in loaded.iter_mut().zip(&by_finger) {
        if let Some(table) = table {
            *loaded = Some(Box::new(from_table(table)?));
        }
    }
    Ok(loaded)
}

fn from_table(table: &sun2xp_io) -> Result<IoTable, Refusal> {
    let missing = |name| Refusal::Null { name, wanted: Wanted::Function };
    let sun2xp_io { holds, in_step, shortest_watchdog, tension_unit, user, start, exchange, stop, .. } = *table;
    let properties = IoProperties {
        tension_unit: if tension_unit == 0.0 { DEFAULT_TENSION_UNIT } else { tension_unit },
        shortest_watchdog_ms: whole_milliseconds(shortest_watchdog),
        holds: holds != 0,
        in_step: in_step != 0,
    };
    Ok(IoTable {
        properties,
        user: PlannersPointer(user),
        start: start.ok_or(missing("io->start"))?,
        exchange: exchange.ok_or(missing("io->exchange"))?,
        stop: stop.ok_or(missing("io->stop"))?,
    })
}

/// Rounds a time up to milliseconds. Rounding errors can make a time slightly longer than the program intends: 9 * 1e-3
/// is more than 9 ms. An excess of at most `INEXACT_MS` is therefore ignored. The conversion saturates, and a time that
/// is too long is refused when the terms are agreed.
fn whole_milliseconds(seconds: f64) -> u16 {
    const INEXACT_MS: f64 = 1e-4;
    (seconds * 1e3 - INEXACT_MS).ceil() as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_of_milliseconds_stays_this_number() {
        for milliseconds in 0..=1000_u16 {
            let exact = f64::from(milliseconds);
            for seconds in [exact * 1e-3, exact / 1e3, f64::from((exact / 1e3) as f32)] {
                assert_eq!(whole_milliseconds(seconds), milliseconds, "{seconds:?} s");
            }
        }
        assert_eq!(whole_milliseconds(0.0091), 10);
        assert_eq!((whole_milliseconds(1e-300), whole_milliseconds(1e9)), (0, u16::MAX));
    }
}
