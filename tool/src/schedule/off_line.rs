//! The off-line schedule that section 6.2 of the report asks for: whether every cycle of a configured hand meets its
//! deadline. The inputs are worst-case times, the times on the lines, and the allocation of fingers to threads, cores
//! and ports.

use serde::{Deserialize, Serialize, Serializer};
use sun2xp::board::{USABLE_SHARE, exchange_microseconds, tactile_microseconds};
use sun2xp::finger::REPLY_WINDOW;
use sun2xp::hand::{Wrong, deserialize};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, FINGERS};
use sun2xp::realtime::{PeriodicThread, response_times};
use toml_edit::Document;

/// Worst-case times of a machine, us.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Costs {
    /// From the scheduled beginning of a cycle to the thread's first instruction.
    pub wake_up: f64,
    /// Passing the commands of one port to the system.
    pub write: f64,
    /// Receiving one reply from the system and decoding it.
    pub read: f64,
    /// The control computation and the report of one finger.
    pub compute: f64,
}

impl Costs {
    /// Reads the four times from TOML text with the keys `wake_up`, `write`, `read` and `compute`.
    ///
    /// # Errors
    /// Returns the line number, if known, and what is wrong.
    pub fn parse(text: &str) -> Result<Self, String> {
        let refused = |wrong: Wrong| match wrong.line(text) {
            Some(line) => format!("{line}: {wrong}"),
            None => format!(" {wrong}"),
        };
        let document = Document::parse(text).map_err(|error| refused(Wrong::in_syntax(error)))?;
        let costs: Self = deserialize(document.as_table()).map_err(refused)?;
        let Self { wake_up, write, read, compute } = costs;
        for (key, cost) in [("wake_up", wake_up), ("write", write), ("read", read), ("compute", compute)] {
            if !(cost.is_finite() && cost >= 0.0) {
                let span = document.as_table().key(key).and_then(|key| key.span());
                return Err(refused(Wrong::at(span, format!("{cost} is not a time of 0 us or more")).in_key(key)));
            }
        }
        Ok(costs)
    }
}

/// What another sensor would add to every finger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Sensor {
    /// Additional bytes in each reply.
    pub bytes: usize,
    /// Additional computing time in each cycle, us.
    pub compute: f64,
}

/// One servo thread of the schedule.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scheduled {
    /// Number of the thread, 1 to 3.
    pub thread: u8,
    /// The core that the thread is bound to.
    pub core: Option<usize>,
    /// SCHED_FIFO priority.
    pub priority: u8,
    /// The fingers of the thread, in the order in which they are served.
    #[serde(serialize_with = "numbers")]
    pub fingers: Vec<FingerNumber>,
    /// Fraction of a period in which the thread computes.
    pub load: f64,
    /// Fraction of a period in which the thread's busiest line is busy.
    pub line: f64,
    /// The latest times at which the replies have arrived and the cycle is done, us after the scheduled beginning of
    /// the cycle. `None` if there is no bound within the period.
    pub response: Option<(f64, f64)>,
    /// The condition that may be violated, if any. It is the key `limit` of the output of `--json`.
    #[serde(rename = "limit")]
    pub violation: Option<Violation>,
}

/// A condition of the schedule that may be violated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Violation {
    /// The line is busy for a larger part of a period than permitted.
    Line,
    /// Replies may arrive after the part of a period in which they are awaited.
    Replies,
    /// The cycle may not be done when the next one begins.
    Cycle,
}

fn numbers<S: Serializer>(fingers: &[FingerNumber], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(fingers.iter().map(|finger| finger.get()))
}

/// The schedule of a hand at a rate, Hz, with one entry per servo thread. A port that is `simulated` counts as a serial
/// line of the configured baud rate.
pub fn off_line_schedule(hand: &Configuration, rate: f64, costs: &Costs, sensor: &Sensor) -> Vec<Scheduled> {
    let numbers =
        (1..=FINGERS as u8).filter(|&number| hand.hand.fingers.members().any(|finger| hand.thread(finger) == number));
    let threads: Vec<(u8, Vec<FingerNumber>)> = numbers
        .map(|number| (number, hand.hand.fingers.members().filter(|&finger| hand.thread(finger) == number).collect()))
        .collect();
    let period = 1e6 / rate;
    let tasks: Vec<PeriodicThread> =
        threads.iter().map(|(_, fingers)| task(hand, fingers, period, costs, sensor)).collect();
    let responses = response_times(&tasks);
    let timed = threads.into_iter().zip(tasks).zip(responses);
    timed
        .map(|(((thread, fingers), task), response)| {
            let line = longest_exchange(hand, &fingers, sensor, period) / period;
            let window = task.wake_up as f64 * 1e-3 + REPLY_WINDOW * period;
            let response = response.map(|response| (response.waited as f64 * 1e-3, response.done as f64 * 1e-3));
            let violation = match response {
                _ if line > USABLE_SHARE => Some(Violation::Line),
                None => Some(Violation::Cycle),
                Some((replies, _)) if replies > window => Some(Violation::Replies),
                Some(_) => None,
            };
            let load = (task.before as f64 + task.after as f64) * 1e-3 / period;
            Scheduled { thread, core: task.core, priority: task.priority, fingers, load, line, response, violation }
        })
        .collect()
}

fn task(hand: &Configuration, fingers: &[FingerNumber], period: f64, costs: &Costs, sensor: &Sensor) -> PeriodicThread {
    // Fingers on one thread have the same core and priority, because the configuration was checked.
    let first = &hand.fingers[fingers[0].index()];
    let ports = lines(hand, fingers).count() as f64;
    // Required times are rounded up, and the available time is rounded down.
    let needed = |microseconds: f64| (microseconds * 1e3).ceil() as u64;
    PeriodicThread {
        core: first.core,
        priority: first.priority,
        period: (period * 1e3) as u64,
        wake_up: needed(costs.wake_up),
        before: needed(ports * costs.write),
        waiting: needed(longest_exchange(hand, fingers, sensor, period)),
        after: needed(
            fingers.len() as f64 * (costs.read + costs.compute + sensor.compute)
                + touches(hand, fingers, sensor, 1e6 / period) as f64 * costs.read,
        ),
    }
}

/// The largest number of tactile events that a thread fetches in a period at a rate, Hz.
pub fn touches(hand: &Configuration, fingers: &[FingerNumber], sensor: &Sensor, rate: f64) -> usize {
    lines(hand, fingers).map(|line| touches_on_line(hand, fingers, line, sensor, rate)).sum()
}

/// The largest number of tactile events in a period on the port of `finger`. `sharing` is the number of the thread's
/// fingers on this port. The servo requests only the tactile events for which the exchange leaves time.
fn touches_on_line(
    hand: &Configuration,
    fingers: &[FingerNumber],
    (finger, sharing): (FingerNumber, usize),
    sensor: &Sensor,
    rate: f64,
) -> usize {
    let configured = &hand.fingers[finger.index()];
    let on_port = |other: &&FingerNumber| **other == finger || hand.fingers[other.index()].shares_port(configured);
    let with_elements = fingers.iter().filter(on_port);
    let with_elements = with_elements.filter(|other| !hand.fingers[other.index()].touch.elements.is_empty()).count();
    let left = USABLE_SHARE * 1e6 / rate - exchange_microseconds(configured.baud, sharing, sensor.bytes);
    // The time may be negative. The conversion to an integer returns 0 then.
    ((left / tactile_microseconds(configured.baud)).floor() as usize).min(with_elements)
}

/// The ports of a thread. Each item is one finger on a port and the number of the thread's fingers on that port. Every
/// simulated finger has a port of its own.
fn lines<'a>(hand: &'a Configuration, fingers: &'a [FingerNumber]) -> impl Iterator<Item = (FingerNumber, usize)> + 'a {
    let shares = |a: FingerNumber, b: FingerNumber| {
        let (one, other) = (&hand.fingers[a.index()], &hand.fingers[b.index()]);
        a == b || one.shares_port(other)
    };
    fingers
        .iter()
        .filter(move |&&finger| !fingers.iter().any(|&earlier| earlier < finger && shares(earlier, finger)))
        .map(move |&finger| (finger, fingers.iter().filter(|&&other| shares(finger, other)).count()))
}

/// Longest time of an exchange and its tactile events on one of the thread's ports, us. `period` is in us.
fn longest_exchange(hand: &Configuration, fingers: &[FingerNumber], sensor: &Sensor, period: f64) -> f64 {
    lines(hand, fingers)
        .map(|(finger, sharing)| {
            let baud = hand.fingers[finger.index()].baud;
            let touches = touches_on_line(hand, fingers, (finger, sharing), sensor, 1e6 / period);
            exchange_microseconds(baud, sharing, sensor.bytes) + touches as f64 * tactile_microseconds(baud)
        })
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
