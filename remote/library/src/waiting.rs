//! sun2xp_wait for a hand on another machine: by the records that it sends, and by the bounds of `[finger.events]`.

use std::time::{Duration, Instant};
use sun2xp::events::ConfiguredEvents;
use sun2xp_remote_client::Record;

/// Time within which a command that was sent before the wait has reached the servo: two repetitions of a Target, and a
/// round trip. A line that is slower catches the finger.
const ON_ITS_WAY: Duration = Duration::from_millis(60);

/// A wait for one finger.
pub(crate) struct FingerWait {
    begun: Instant,
    arrived: f64,
    settled: f64,
    /// Cycles without motion, ns.
    calm: u64,
    /// The angles that were sent last; none if another pose was sent.
    sent: Option<[f64; 3]>,
    /// The record at the beginning of the present calm.
    anchor: Option<Record>,
}

impl FingerWait {
    /// Begins now. `sent` is the pose that was sent last, as joint angles, if it was.
    pub fn begin(events: &ConfiguredEvents, sent: Option<[f64; 3]>, now: Instant) -> Self {
        Self {
            begun: now,
            arrived: events.arrived_degrees.to_radians(),
            settled: events.settled_degrees.to_radians(),
            calm: (events.settled_ms * 1e6) as u64,
            sent,
            anchor: None,
        }
    }

    /// Whether every joint is at the set point that was sent last.
    pub fn has_arrived(&self, newest: &Record, now: Instant) -> bool {
        if now.duration_since(self.begun) < ON_ITS_WAY {
            return false;
        }
        let goal = self.sent.or(newest.set_point);
        goal.is_some_and(|goal| distance(&goal, &newest.joints) <= self.arrived)
    }

    /// Whether no joint and no set point has moved for the configured time.
    pub fn has_settled(&mut self, newest: &Record, now: Instant) -> bool {
        if now.duration_since(self.begun) < ON_ITS_WAY {
            return false;
        }
        let moved = |anchor: &Record| {
            distance(&anchor.joints, &newest.joints) > self.settled || anchor.set_point != newest.set_point
        };
        match &self.anchor {
            Some(anchor) if !moved(anchor) => newest.begin.saturating_sub(anchor.begin) >= self.calm,
            _ => {
                self.anchor = Some(*newest);
                false
            }
        }
    }
}

fn distance(one: &[f64; 3], other: &[f64; 3]) -> f64 {
    one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}
