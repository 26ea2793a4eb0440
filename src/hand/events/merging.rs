//! Merges the events of the fingers in the order of their times.

use super::source::EventSource;
use crate::finger::events::{Event, EventReader};

/// Number of periods for which an event waits for earlier events of other fingers. Events can be out of order only if a
/// servo is late by more than this number of periods.
const PATIENCE: u64 = 2;

/// The next event of several fingers.
pub enum Next {
    Event(Event),
    /// There is an event, but a finger may still have an earlier one. The event is due at this time, ns, or when that
    /// finger has finished its cycle.
    Waiting(u64),
    Nothing,
}

/// Readers of the logs of all fingers.
pub struct MergedEvents {
    fingers: Vec<FingerEvents>,
    /// Longest time for which an event waits for earlier events of other fingers, ns.
    patience: u64,
}

/// A reader, and its next event.
struct FingerEvents {
    reader: EventReader,
    next: Option<Event>,
    /// Lower bound of the times of all events that were not published yet when this bound was read, ns.
    horizon: u64,
}

impl MergedEvents {
    pub fn new(source: &EventSource) -> Self {
        let fingers = source.logs.iter().map(|log| FingerEvents { reader: log.reader(), next: None, horizon: 0 });
        Self { fingers: fingers.collect(), patience: PATIENCE * source.period }
    }

    /// Takes the earliest event. `now` is the time of the servos' clock, ns.
    pub fn next(&mut self, now: u64) -> Next {
        for finger in &mut self.fingers {
            if finger.next.is_none() {
                // The horizon is read before the log. So an event that this `take` does not find is not earlier than
                // the horizon.
                finger.horizon = finger.reader.horizon();
                finger.next = finger.reader.take();
            }
        }
        let earliest = self.fingers.iter().enumerate().filter_map(|(place, finger)| Some((finger.next?.time, place)));
        let Some((time, place)) = earliest.min() else { return Next::Nothing };
        let may_be_earlier = |finger: &FingerEvents| finger.next.is_none() && finger.horizon < time;
        let due = time + self.patience;
        if now < due && self.fingers.iter().any(may_be_earlier) {
            return Next::Waiting(due);
        }
        self.fingers[place].next.take().map_or(Next::Nothing, Next::Event)
    }

    /// Returns the number of events that were lost because they were not taken in time.
    pub fn lost(&self) -> u64 {
        self.fingers.iter().map(|finger| finger.reader.lost()).sum()
    }

    /// Skips all events before `time`, ns.
    pub fn skip_until(&mut self, time: u64) {
        for finger in &mut self.fingers {
            while finger.next.is_none_or(|event| event.time < time) {
                finger.horizon = finger.reader.horizon();
                finger.next = finger.reader.take();
                if finger.next.is_none() {
                    break;
                }
            }
        }
    }

    /// Skips all events up to now.
    pub fn clear(&mut self) {
        for finger in &mut self.fingers {
            finger.reader.skip();
            finger.next = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::finger::events::{EventKind, EventWriter, Occurrence, event_log};
    use crate::model::{FingerNumber, Part};
    use crate::realtime::{EventCount, Pages};
    use proptest::prelude::*;

    const PERIOD: u64 = 1_000_000;

    /// A cycle of a servo, with times in ns.
    #[derive(Clone, Debug)]
    struct Cycle {
        finger: usize,
        number: u64,
        scheduled: u64,
        began: u64,
        ended: u64,
        events: usize,
    }

    fn source() -> (Vec<EventWriter>, EventSource) {
        let (writers, logs) = FingerNumber::ALL.map(event_log).into_iter().unzip();
        (writers, EventSource::new(logs, Pages::new(EventCount::default()).into(), PERIOD))
    }

    /// Runs a cycle of a servo, up to the publication of its events.
    fn run(writer: &mut EventWriter, cycle: &Cycle, written: &mut u64) {
        writer.begin_cycle(cycle.number, cycle.began);
        for _ in 0..cycle.events {
            *written += 1;
            writer.write(Occurrence {
                kind: EventKind::Contact,
                part: Part::Finger,
                values: [cycle.scheduled as f64, 0.0, 0.0, 0.0],
            });
        }
        writer.publish(cycle.scheduled + PERIOD);
    }

    /// Returns the cycles of three fingers with staggered periods, in the order of their ends. `draw` gives random
    /// numbers. A cycle begins up to half a period late. It ends up to 0.9 periods after its scheduled beginning, or up
    /// to 2 periods if it overruns.
    fn cycles(count: u64, mut draw: impl FnMut(u64) -> u64) -> Vec<Cycle> {
        let mut cycles = Vec::new();
        for finger in 0..3 {
            let mut scheduled = 10 * PERIOD + finger as u64 * PERIOD / 3;
            for number in 1..=count {
                let began = scheduled + draw(PERIOD / 2);
                let longest = if draw(20) == 0 { 3 * PERIOD / 2 } else { PERIOD * 4 / 10 };
                let ended = began + draw(longest);
                cycles.push(Cycle { finger, number, scheduled, began, ended, events: draw(4) as usize });
                // Like a servo, this loop skips the whole periods that have passed when a cycle ends late. Unlike a
                // servo, it then also schedules the next cycle no earlier than the end of the late one.
                scheduled += PERIOD;
                scheduled += ended.saturating_sub(scheduled) / PERIOD * PERIOD;
                if ended > scheduled {
                    scheduled = ended;
                }
            }
        }
        cycles.sort_by_key(|cycle| (cycle.ended, cycle.finger));
        cycles
    }

    proptest! {
        #[test]
        fn events_come_in_order_and_their_stamps_are_exact_to_a_period(seed in 1u64.., polls in 1u64..5) {
            let mut random = seed;
            let mut draw = |below: u64| {
                random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (random >> 33) % below
            };
            let (mut writers, source) = source();
            let mut merged = MergedEvents::new(&source);
            let (mut written, mut taken): (u64, Vec<Event>) = (0, Vec::new());
            let cycles = cycles(300, &mut draw);
            for cycle in &cycles {
                run(&mut writers[cycle.finger], cycle, &mut written);
                while draw(polls) == 0 && let Next::Event(event) = merged.next(cycle.ended) {
                    taken.push(event);
                }
            }
            // At this time no event needs to wait for an earlier one.
            let end = cycles.last().map_or(0, |last| last.ended) + merged.patience;
            while let Next::Event(event) = merged.next(end) {
                taken.push(event);
            }
            prop_assert_eq!((taken.len() as u64, merged.lost()), (written, 0));
            prop_assert!(taken.is_sorted_by_key(|event| event.time));
            for finger in FingerNumber::ALL {
                let of_finger = taken.iter().filter(|event| event.finger == finger);
                prop_assert!(of_finger.clone().is_sorted_by_key(|event| event.cycle));
                for event in of_finger {
                    let scheduled = event.values[0] as u64;
                    prop_assert!((scheduled..scheduled + PERIOD).contains(&event.time));
                }
            }
        }
    }

    #[test]
    fn only_events_before_a_time_are_skipped() {
        let (mut writers, source) = source();
        let mut merged = MergedEvents::new(&source);
        let mut written = 0;
        for number in 1..=10 {
            for (finger, writer) in writers.iter_mut().enumerate() {
                let (began, events) = (number * PERIOD, usize::from(finger != 2));
                run(writer, &Cycle { finger, number, scheduled: began, began, ended: began, events }, &mut written);
            }
        }
        merged.skip_until(7 * PERIOD);
        let left = std::iter::from_fn(|| match merged.next(20 * PERIOD) {
            Next::Event(event) => Some(event.cycle),
            _ => None,
        });
        assert_eq!(left.collect::<Vec<_>>(), [7, 7, 8, 8, 9, 9, 10, 10]);
    }

    #[test]
    fn a_planner_that_reads_20_times_a_second_loses_none_of_100_000_events_a_second() {
        let (mut writers, source) = source();
        let mut merged = MergedEvents::new(&source);
        let (mut written, mut taken) = (0, 0);
        for number in 1..=2000 {
            let scheduled = number * PERIOD;
            for (finger, writer) in writers.iter_mut().enumerate() {
                let events = 33 + usize::from(finger == 0);
                let cycle = Cycle { finger, number, scheduled, began: scheduled, ended: scheduled, events };
                run(writer, &cycle, &mut written);
            }
            if number % 50 == 0 {
                while let Next::Event(_) = merged.next(scheduled + 2 * PERIOD) {
                    taken += 1;
                }
            }
        }
        assert_eq!((written, taken, merged.lost()), (200_000, 200_000, 0));
    }

    #[test]
    fn lost_events_are_counted_at_100_000_events_a_second() {
        let (mut writers, source) = source();
        let mut merged = MergedEvents::new(&source);
        let mut written = 0;
        for number in 1..=1000 {
            for (finger, writer) in writers.iter_mut().enumerate() {
                let scheduled = number * PERIOD;
                let cycle = Cycle { finger, number, scheduled, began: scheduled, ended: scheduled, events: 33 };
                run(writer, &cycle, &mut written);
            }
        }
        let (mut taken, mut first) = (0, None);
        while let Next::Event(event) = merged.next(2000 * PERIOD) {
            first = first.or(Some(event.cycle));
            taken += 1;
        }
        assert_eq!(taken + merged.lost(), written);
        // The newest events remain: the last 124 cycles.
        assert!(merged.lost() > 80_000 && first >= Some(870), "{first:?}");
    }
}
