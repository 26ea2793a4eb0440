//! The off-line schedule that section 6.2 of the report asks for: whether every cycle of a configured hand meets its
//! deadline. The inputs are worst-case times, the times on the lines, and the allocation of fingers to threads, cores
//! and ports.

use serde::{Deserialize, Serialize, Serializer};
use sun2xp::board::{USABLE_SHARE, exchange_microseconds, tactile_microseconds, tactile_requests};
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
    /// The deadline that may be missed, if any.
    pub limit: Option<RateLimit>,
}

/// A deadline that may be missed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum RateLimit {
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
            let limit = match response {
                _ if line > USABLE_SHARE => Some(RateLimit::Line),
                None => Some(RateLimit::Cycle),
                Some((replies, _)) if replies > window => Some(RateLimit::Replies),
                Some(_) => None,
            };
            let load = (task.before + task.after) as f64 * 1e-3 / period;
            Scheduled { thread, core: task.core, priority: task.priority, fingers, load, line, response, limit }
        })
        .collect()
}

fn task(hand: &Configuration, fingers: &[FingerNumber], period: f64, costs: &Costs, sensor: &Sensor) -> PeriodicThread {
    // Fingers on one thread have the same core and priority, because the configuration was checked.
    let first = &hand.fingers[fingers[0].index()];
    let ports = lines(hand, fingers).count() as f64;
    // Required times are rounded up, the available time is rounded down.
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
                + touches(hand, fingers, 1e6 / period) as f64 * costs.read,
        ),
    }
}

/// The number of tactile events that a thread fetches in every period at a rate, Hz.
pub fn touches(hand: &Configuration, fingers: &[FingerNumber], rate: f64) -> usize {
    lines(hand, fingers).map(|(finger, sharing)| touches_on_line(hand, fingers, finger, sharing, rate)).sum()
}

/// The number of tactile events on the port of `finger`, which has `sharing` fingers.
fn touches_on_line(
    hand: &Configuration,
    fingers: &[FingerNumber],
    finger: FingerNumber,
    sharing: usize,
    rate: f64,
) -> usize {
    let configured = &hand.fingers[finger.index()];
    let on_port = |other: &&FingerNumber| **other == finger || hand.fingers[other.index()].shares_port(configured);
    let with_elements = fingers.iter().filter(on_port);
    let with_elements = with_elements.filter(|other| !hand.fingers[other.index()].touch.elements.is_empty()).count();
    tactile_requests(configured.baud, sharing, rate).min(with_elements)
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

/// Time of the longest exchange on the thread's ports with its tactile events, us. `period` is in us.
fn longest_exchange(hand: &Configuration, fingers: &[FingerNumber], sensor: &Sensor, period: f64) -> f64 {
    lines(hand, fingers)
        .map(|(finger, sharing)| {
            let baud = hand.fingers[finger.index()].baud;
            let touches = touches_on_line(hand, fingers, finger, sharing, 1e6 / period);
            exchange_microseconds(baud, sharing, sensor.bytes) + touches as f64 * tactile_microseconds(baud)
        })
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::super::fastest::Fastest;
    use super::*;
    use sun2xp::model::configuration::TouchElement;

    const COSTS: Costs = Costs { wake_up: 100.0, write: 10.0, read: 5.0, compute: 15.0 };

    /// Each finger is on its own core: 100 + 10 us until the commands are written, 550 us for the exchange, and 20 us
    /// after that. The exchange takes 170 us for the 17 bytes of the command, 100 us in the board and 280 us for the 28
    /// bytes of the reply.
    #[test]
    fn three_fingers_on_three_cores() {
        let mut hand = Configuration::default();
        for (core, finger) in hand.fingers.iter_mut().enumerate() {
            finger.core = Some(core);
        }
        let schedule = off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default());
        assert_eq!(schedule.len(), 3);
        for (index, thread) in schedule.iter().enumerate() {
            assert_eq!(
                (thread.thread as usize, thread.core, &thread.fingers[..]),
                (index + 1, Some(index), &[FingerNumber::ALL[index]][..])
            );
            assert_eq!((thread.response, thread.limit), (Some((660.0, 680.0)), None));
            assert!((thread.load - 0.03).abs() < 1e-9 && (thread.line - 0.55).abs() < 1e-9);
        }
        // The line is the limit: 550 us are 80 % of a period at 1454.5 Hz.
        assert_eq!(Fastest::of(&hand, &COSTS, &Sensor::default()).rate, Some(1454));
        assert_eq!(off_line_schedule(&hand, 1455.0, &COSTS, &Sensor::default())[0].limit, Some(RateLimit::Line));
        // Ten more bytes take 100 us more. At 2 megabaud the exchange takes 225 + 100 + 50 us, which is 80 % of a
        // period at 2133 Hz.
        let sensor = Sensor { bytes: 10, compute: 50.0 };
        assert_eq!(off_line_schedule(&hand, 1000.0, &COSTS, &sensor)[0].response, Some((760.0, 830.0)));
        hand.fingers.iter_mut().for_each(|finger| finger.baud = 2_000_000);
        // 100 + 10 + 375 + 70 = 555: the cycle is done in time up to 1801 Hz.
        assert_eq!(Fastest::of(&hand, &COSTS, &sensor).rate, Some(1801));
        assert_eq!(off_line_schedule(&hand, 1802.0, &COSTS, &sensor)[0].limit, Some(RateLimit::Cycle));
    }

    /// On one core each thread may have to wait for two cycles of each other thread: 680 + 4 * 30.
    #[test]
    fn three_fingers_on_one_core() {
        let mut hand = Configuration::default();
        hand.fingers.iter_mut().for_each(|finger| finger.core = Some(1));
        let schedule = off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default());
        assert!(schedule.iter().all(|thread| thread.response == Some((780.0, 800.0))), "{schedule:?}");
        // Threads that are not bound to cores may compete for one core.
        hand.fingers.iter_mut().for_each(|finger| finger.core = None);
        assert_eq!(off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default())[2].response, Some((780.0, 800.0)));
    }

    /// On one thread, the lines are busy in parallel, and the fingers are computed one after the other.
    #[test]
    fn three_fingers_on_one_thread() {
        let mut hand = Configuration::default();
        hand.fingers.iter_mut().for_each(|finger| finger.thread = 1);
        let [thread] = &off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default())[..] else { panic!("one thread") };
        assert_eq!(thread.response, Some((680.0, 740.0)));
        // On one port the replies follow each other: 100 + 10 + 170 + 100 + 3 * 280 + 60 is more than a period.
        hand.fingers.iter_mut().for_each(|finger| finger.port = "/dev/ttyUSB0".into());
        assert_eq!(off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default())[0].limit, Some(RateLimit::Line));
        hand.fingers.iter_mut().for_each(|finger| finger.baud = 2_000_000);
        let schedule = off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default());
        assert_eq!(schedule[0].response, Some((715.0, 775.0)));
        assert_eq!((&schedule[0].fingers[..], schedule[0].limit), (&FingerNumber::ALL[..], None));
    }

    /// The answer to a TactileRequest takes 200 us, and reading it 5 us more.
    #[test]
    fn touch_takes_the_time_that_the_line_has_left() {
        let mut hand = Configuration::default();
        hand.fingers.iter_mut().enumerate().for_each(|(core, finger)| finger.core = Some(core));
        let element = TouchElement { position: [0.0; 3], normal: [0.0, 0.0, 1.0], newton_per_count: 0.001, zero: 0 };
        hand.fingers[1].touch.elements = vec![element];
        let schedule = off_line_schedule(&hand, 1000.0, &COSTS, &Sensor::default());
        let touched: Vec<usize> = schedule.iter().map(|thread| touches(&hand, &thread.fingers, 1000.0)).collect();
        assert_eq!(touched, [0, 1, 0]);
        assert_eq!((schedule[0].response, schedule[1].response), (Some((660.0, 680.0)), Some((860.0, 885.0))));
        assert!((schedule[1].line - 0.75).abs() < 1e-9);
        // At 1100 Hz no time is left, so the servo sends no requests, and touch makes no cycle later.
        assert_eq!(touches(&hand, &[FingerNumber::TWO], 1100.0), 0);
        assert_eq!(Fastest::of(&hand, &COSTS, &Sensor::default()).rate, Some(1454));
    }

    /// A late wake-up is not the board's fault: the reply window begins at the wake-up.
    #[test]
    fn the_reply_window_begins_at_the_wake_up() {
        let hand = Configuration::default();
        let costs = Costs { wake_up: 300.0, write: 10.0, read: 1.0, compute: 1.0 };
        assert_eq!(off_line_schedule(&hand, 1000.0, &costs, &Sensor::default())[0].limit, None);
        // With each finger on its own core, 310 + 550 us exceed the reply window of 850 us.
        let mut apart = hand.clone();
        apart.fingers.iter_mut().enumerate().for_each(|(core, finger)| finger.core = Some(core));
        let costs = Costs { wake_up: 9.0, write: 310.0, ..costs };
        assert_eq!(off_line_schedule(&apart, 1000.0, &costs, &Sensor::default())[0].limit, Some(RateLimit::Replies));
    }
}
