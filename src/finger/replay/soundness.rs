//! Checks of a recording before anything is computed from it: the configuration must be valid, and the rest must be
//! data that a servo can have recorded. A file can be altered, and with some numbers a controller would compute forever
//! or panic.

use super::NotReplayable;
use super::remedy::without_remedy;
use crate::finger::link_watch::LinkWatch;
use crate::finger::{ControlInput, ControllerSource, Recording};
use crate::model::configuration::{ConfiguredHand, Unusable};
use nalgebra::Vector3;
use serde::Serialize;
use serde_json::Value;
use std::ops::RangeInclusive;

/// Largest number of controller cycles that a replay computes, including those for skipped periods: a hundred times
/// the number of cycles in two seconds at the highest rate. The computation takes some seconds.
const MOST_COMPUTED: u64 = 1_000_000;

/// Largest permitted size of a number. It is larger than any quantity of a finger in any unit, and small enough that
/// its powers are finite.
const LARGEST: f64 = 1e30;

/// Range of each component of gravity in the finger's frame, m/s^2. A configuration may have up to 100 in each of three
/// components of the palm's frame. The rotation to the finger's frame can combine them into a larger component.
const GRAVITY: RangeInclusive<f64> = -200.0..=200.0;

impl Recording {
    /// Returns an error for a recording that no servo can have made.
    pub(super) fn check(&self) -> Result<(), NotReplayable> {
        let origin = &self.origin;
        let wrong = |key: &str, reason: String| Err(NotReplayable::Origin { key: format!("origin.{key}"), reason });
        if !(1..=3).contains(&origin.finger) {
            return wrong("finger", format!("is {}: fingers are 1, 2 and 3", origin.finger));
        }
        if let Err(Unusable { key, reason }) = origin.hand.check() {
            return wrong(&format!("hand.{key}"), without_remedy(&reason));
        }
        for source in &origin.controllers {
            let number = source.number;
            let unusable = |(key, reason)| NotReplayable::Unusable { number, key, reason };
            check_source(source).map_err(unusable)?;
        }
        let numbers = origin.controllers.iter().map(|source| source.number);
        if !numbers.is_sorted_by(|one, next| one < next) {
            return wrong("controllers", "are not in the order of their numbers".into());
        }
        if let Err((key, reason)) = within_bounds(&origin.state, "state") {
            return wrong(&key, reason);
        }
        self.check_cycles()
    }

    fn check_cycles(&self) -> Result<(), NotReplayable> {
        let limits = InputLimits::new(&self.origin.hand);
        let mut computed: u64 = 0;
        for (index, record) in self.cycles.iter().enumerate() {
            let Some(control) = &record.control else { continue };
            let wrong = |(key, reason)| {
                let key = format!("control.input.{key}");
                NotReplayable::Cycle { cycle: record.cycle, line: index + 2, key, reason }
            };
            limits.check(&control.input).map_err(wrong)?;
            computed = computed.saturating_add(control.input.skipped + 1);
            if computed > MOST_COMPUTED {
                let reason = format!(
                    "up to this cycle, the cycles and the skipped periods together are more than {MOST_COMPUTED}, the \
                     most that a replay can compute"
                );
                return Err(wrong(("skipped".into(), reason)));
            }
        }
        Ok(())
    }
}

/// Checks that a finger can have this controller. Otherwise returns the key and the reason.
pub(super) fn check_source(source: &ControllerSource) -> Result<(), (&'static str, String)> {
    source.finger.check().map_err(|Unusable { key, reason }| (key, without_remedy(&reason)))?;
    check_gravity(&source.gravity)
}

fn check_gravity(gravity: &Vector3<f64>) -> Result<(), (&'static str, String)> {
    match gravity.iter().find(|part| !GRAVITY.contains(part)) {
        None => Ok(()),
        Some(part) => {
            let reason = format!("is {part:?} m/s^2, outside {} to {}", GRAVITY.start(), GRAVITY.end());
            Err(("gravity", reason))
        }
    }
}

/// The limits of the inputs that a servo can have recorded for its controller.
pub(super) struct InputLimits<'a> {
    hand: &'a ConfiguredHand,
    most_skipped: u64,
}

impl<'a> InputLimits<'a> {
    pub fn new(hand: &'a ConfiguredHand) -> Self {
        // A built-in simulated finger waits for its servo and never skips a period, so it is within every limit. The
        // limit for real fingers can therefore be used for all.
        Self { hand, most_skipped: u64::from(LinkWatch::new(hand, false).fault_at()) }
    }

    /// Checks an input. If no servo can have recorded one of its values, returns the key of that value, and the reason.
    pub fn check(&self, input: &ControlInput) -> Result<(), (String, String)> {
        let most_skipped = self.most_skipped;
        let ControlInput { skipped, fading, .. } = *input;
        if skipped > most_skipped {
            let reason = format!("is {skipped}: with the hand.watchdog_ms of this file it is at most {most_skipped}");
            return Err(("skipped".into(), reason));
        }
        if fading.is_some_and(|fading| !fading.possible(self.hand)) {
            let most = self.hand.hold_torque_limit;
            let reason = format!("has `left` outside 0 to 1, or `rest` outside 0 to {most} N cm");
            return Err(("fading".into(), reason));
        }
        if let Some(gravity) = &input.gravity {
            check_gravity(gravity).map_err(|(key, reason)| (key.into(), reason))?;
        }
        within_bounds(input, "").map_err(|(key, reason)| (key.trim_start_matches('.').into(), reason))
    }
}

/// Checks that every number is within bounds. Otherwise returns the key and the reason.
pub(super) fn within_bounds(value: &impl Serialize, key: &str) -> Result<(), (String, String)> {
    match serde_json::to_value(value) {
        Ok(value) => check_numbers(&value, key),
        Err(error) => Err((key.into(), error.to_string())),
    }
}

fn check_numbers(value: &Value, key: &str) -> Result<(), (String, String)> {
    match value {
        Value::Number(number) => match number.as_f64() {
            Some(number) if number.abs() <= LARGEST => Ok(()),
            _ => Err((key.into(), format!("is {number}: the limit of every number is {LARGEST:e}"))),
        },
        Value::Array(values) => {
            let indexed = |(index, value)| check_numbers(value, &format!("{key}[{index}]"));
            values.iter().enumerate().try_for_each(indexed)
        }
        Value::Object(values) => {
            values.iter().try_for_each(|(name, value)| check_numbers(value, &format!("{key}.{name}")))
        }
        Value::Null | Value::Bool(_) | Value::String(_) => Ok(()),
    }
}
