//! Computes, before a port is opened, whether a serial line can carry the cyclic traffic.

use super::protocol::{Kind, TURNAROUND_MICROSECONDS};
use crate::model::Counted;
use crate::model::configuration::{BAUDS, RATES};
use thiserror::Error;

/// Start bit, eight data bits, stop bit.
const BITS_PER_BYTE: f64 = 10.0;

/// The part of a period that the traffic may occupy. The rest is for wake-up, computation, and the buffers of a UART or
/// a USB bridge.
pub const USABLE_SHARE: f64 = 0.8;

/// A rate that the line cannot carry.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "{who} at {rate} Hz {verb} not fit on a port at {baud} baud: each period needs {command_us:.0} us for a command of \
     {command} bytes, {turnaround} us for the turnaround of the board, and {replies_us:.0} us for {replies} of {reply} \
     bytes (10 bits a byte). This is {needed_us:.0} us in all, but only {share:.0} % of a period, {usable_us:.0} us, \
     are usable. {remedy}",
    who = Counted(*.fingers as u64, "finger", "fingers"), verb = if *.fingers == 1 { "does" } else { "do" },
    replies = Counted(*.fingers as u64, "reply", "replies"),
    command = Kind::Command.wire_length(), reply = Kind::Reply.wire_length(), turnaround = TURNAROUND_MICROSECONDS,
    share = 100.0 * USABLE_SHARE, remedy = remedy(*.least_baud, *.fastest_rate, *.fingers)
)]
pub struct TooFast {
    /// Baud rate of the port, bit/s.
    pub baud: u32,
    /// Number of fingers on the port.
    pub fingers: usize,
    /// Servo rate, Hz.
    pub rate: f64,
    /// Duration of the first command, us.
    pub command_us: f64,
    /// Duration of all replies, us.
    pub replies_us: f64,
    /// Duration of the whole exchange, us.
    pub needed_us: f64,
    /// Usable part of a period, us.
    pub usable_us: f64,
    /// The lowest common UART rate that suffices, or the exact minimum if no common rate does, bit/s.
    pub least_baud: u32,
    /// The highest servo rate that this port can carry, Hz.
    pub fastest_rate: f64,
}

fn remedy(least_baud: u32, fastest_rate: f64, fingers: usize) -> String {
    let mut ways = Vec::new();
    if least_baud <= *BAUDS.end() {
        ways.push(format!("set baud = {least_baud} or more for every finger of the port and in its board"));
    }
    if fastest_rate >= *RATES.start() {
        ways.push(format!("set hand.rate = {fastest_rate:.0} or less"));
    }
    if fingers > 1 {
        ways.push("put fewer fingers on the port".into());
    }
    let ways = match ways.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{}, or {last}", others.join(", ")),
        _ => ways.concat(),
    };
    ways.replacen(|_: char| true, &ways[..1].to_uppercase(), 1)
}

/// Returns how long one exchange with `fingers` fingers takes on the line, us. `more` is the number of additional bytes
/// in each reply, for example those of a sensor that is still to be added.
///
/// The line is full duplex, so the first reply may begin while the second command is still being sent. Replies are
/// longer than commands. An exchange therefore takes one command, the board's turnaround and all replies.
pub fn exchange_microseconds(baud: u32, fingers: usize, more: usize) -> f64 {
    let bytes = Kind::Command.wire_length() as f64 + fingers as f64 * (Kind::Reply.wire_length() as f64 + more as f64);
    bytes * BITS_PER_BYTE / f64::from(baud) * 1e6 + f64::from(TURNAROUND_MICROSECONDS)
}

/// Returns the time by which a TactileRequest prolongs an exchange, us: the time of its answer, which follows the
/// Replies. The request itself adds no time. It follows the Commands, and is sent before the Replies end, because a
/// Command and a TactileRequest together are shorter than a Reply.
pub fn tactile_microseconds(baud: u32) -> f64 {
    Kind::TactileEvent.wire_length() as f64 * BITS_PER_BYTE / f64::from(baud) * 1e6
}

/// Returns the number of TactileRequests, at most one for each finger, that fit into each period beside the Commands
/// and Replies of a port.
pub fn tactile_requests(baud: u32, fingers: usize, rate: f64) -> usize {
    let left = USABLE_SHARE * 1e6 / rate - exchange_microseconds(baud, fingers, 0);
    ((left / tactile_microseconds(baud)).floor().max(0.0) as usize).min(fingers)
}

/// Returns the share of a period that one exchange takes, 0 to [`USABLE_SHARE`].
pub fn capacity(baud: u32, fingers: usize, rate: f64) -> Result<f64, TooFast> {
    const USUAL_BAUDS: [u32; 10] =
        [115_200, 230_400, 460_800, 500_000, 921_600, 1_000_000, 1_500_000, 2_000_000, 3_000_000, 4_000_000];
    let command_bits = Kind::Command.wire_length() as f64 * BITS_PER_BYTE;
    let reply_bits = (fingers * Kind::Reply.wire_length()) as f64 * BITS_PER_BYTE;
    let turnaround_us = f64::from(TURNAROUND_MICROSECONDS);
    let microseconds = |bits: f64| bits / f64::from(baud) * 1e6;

    let needed_us = exchange_microseconds(baud, fingers, 0);
    let period_us = 1e6 / rate;
    let usable_us = USABLE_SHARE * period_us;
    if needed_us <= usable_us {
        return Ok(needed_us / period_us);
    }
    // If the usable part of a period is not longer than the turnaround, `line_us` is zero and the division gives
    // infinity. The conversion to an integer then gives the largest value.
    let line_us = (usable_us - turnaround_us).max(0.0);
    let exact_baud = ((command_bits + reply_bits) / line_us * 1e6).ceil() as u32;
    Err(TooFast {
        baud,
        fingers,
        rate,
        command_us: microseconds(command_bits),
        replies_us: microseconds(reply_bits),
        needed_us,
        usable_us,
        least_baud: USUAL_BAUDS.into_iter().find(|&usual| usual >= exact_baud).unwrap_or(exact_baud),
        fastest_rate: (USABLE_SHARE * 1e6 / needed_us).floor(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_finger_at_1_khz_fits_on_1_megabaud() {
        // 170 us command, 100 us turnaround, 280 us reply.
        assert!((capacity(1_000_000, 1, 1000.0).unwrap() - 0.55).abs() < 1e-12);
    }

    #[test]
    fn three_fingers_at_1_khz_need_1_5_megabaud() {
        let refusal = capacity(1_000_000, 3, 1000.0).unwrap_err();
        assert_eq!(refusal.least_baud, 1_500_000);
        // 170 us command, 100 us turnaround, 840 us replies.
        assert!((refusal.needed_us - 1110.0).abs() < 1e-9);
        let text = refusal.to_string();
        for part in ["1110 us in all", "80 % of a period, 800 us, are usable", "baud = 1500000", "hand.rate = 720"] {
            assert!(text.contains(part), "{part:?} is not in: {text}");
        }
        assert!(text.starts_with("3 fingers at 1000 Hz do not fit") && text.contains(" 3 replies of "), "{text}");
        let one = capacity(115_200, 1, 1000.0).unwrap_err().to_string();
        assert!(one.starts_with("1 finger at 1000 Hz does not fit") && one.contains(" 1 reply of "), "{one}");
        // The text does not suggest a lower rate, because the rate that this line can carry is below the permitted
        // rates. It does not suggest fewer fingers, because no other finger shares the port.
        assert!(!one.contains("hand.rate") && !one.contains("fewer fingers"), "{one}");
        assert!(capacity(1_500_000, 3, 1000.0).is_ok());
        assert!(capacity(1_000_000, 3, refusal.fastest_rate).is_ok());
    }

    #[test]
    fn the_named_remedies_work() {
        for baud in [115_200, 230_400, 1_000_000, 3_000_000] {
            for fingers in 1..=3 {
                for rate in [500.0, 1000.0, 2000.0] {
                    if let Err(refusal) = capacity(baud, fingers, rate) {
                        assert!(capacity(refusal.least_baud, fingers, rate).is_ok(), "{refusal}");
                        assert!(capacity(baud, fingers, refusal.fastest_rate).is_ok(), "{refusal}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_baud_rate_that_no_configuration_may_have_is_not_a_remedy() {
        let text = capacity(12_000_000, 3, 5000.0).unwrap_err().to_string();
        assert!(!text.contains("baud =") && text.contains("Set hand.rate = "), "{text}");
    }

    #[test]
    fn tactile_requests_use_the_time_that_the_replies_leave() {
        // The 20 bytes of an answer take 200 us at 1 megabaud, and 800 - 550 us are left.
        assert_eq!(tactile_requests(1_000_000, 1, 1000.0), 1);
        assert_eq!(tactile_requests(1_000_000, 1, 1100.0), 0);
        // At 2 megabaud three fingers need 605 us, and 195 us are left for one answer of 100 us.
        assert_eq!(tactile_requests(2_000_000, 3, 1000.0), 1);
        assert_eq!(tactile_requests(3_000_000, 3, 1000.0), 3);
        // A hand that does not fit has no time for touch.
        assert_eq!(tactile_requests(115_200, 3, 1000.0), 0);
    }

    #[test]
    fn endless_replies_take_endless_time() {
        assert!(exchange_microseconds(1_000_000, 3, usize::MAX) > 1e12);
    }

    #[test]
    fn a_period_shorter_than_the_turnaround_is_refused() {
        assert!(capacity(4_000_000, 1, 20_000.0).is_err());
    }
}
