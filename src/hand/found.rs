//! What one run has found of a finger: keys of the configuration with their values, and what they were found with.

use crate::calibration::Findings;
use crate::hand::HandError;
use crate::model::configuration::{Configuration, FINGERS};
use std::collections::BTreeMap;
use toml_edit::Item;

/// What signs, zeros, friction and stiffness hold for, besides the finger itself: where it is connected, and what turns
/// counts and torques into angles and forces.
const HELD_BY_CALIBRATION: &[&str] = &[
    "port",
    "address",
    "geometry.r",
    "geometry.motor_radius",
    "encoder.counts_per_revolution",
    "motor.torque_constant",
];

/// What a bound of Kx holds for.
const HELD_BY_BOUND: &[&str] = &[RATE, "geometry", "motor", "tendon", "joints", "links", "friction", "controller"];

/// The one key among these that is not a finger's.
const RATE: &str = "hand.rate";

/// What one run, or several calibrations in a row, found of one finger. Only this is written when it is stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// 1 to 3.
    finger: i32,
    values: Vec<FoundValue>,
    /// Keys and tables of keys on which the values depend.
    held_by: &'static [&'static str],
    /// These keys as they were.
    holds_for: BTreeMap<String, String>,
}

/// A key of a finger with what was found.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FoundValue {
    pub section: &'static str,
    pub key: &'static str,
    pub numbers: Numbers,
}

/// Numbers as they stand in a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Numbers {
    /// An array of whole numbers.
    Whole(Vec<i64>),
    /// An array of real numbers.
    Real(Vec<f64>),
    /// A real number.
    One(f64),
    /// The signs of the real numbers that are there: their sizes were not looked for.
    SignsOf([i8; 4]),
}

impl Found {
    /// What a calibration of a finger has found. `configuration`: the one that is in force with it.
    ///
    /// # Errors
    /// No such finger.
    pub fn by_calibration(findings: &Findings, finger: i32, configuration: &Configuration) -> Result<Self, HandError> {
        let of = &configuration.fingers[index(finger)?];
        let values = match findings {
            Findings::Signs(signs) => vec![
                value("motor", "sign", whole(signs.motor)),
                value("encoder", "sign", whole(signs.encoder)),
                value("gauge", "newton_per_count", Numbers::SignsOf(signs.gauge)),
            ],
            Findings::Zeros(zeros) => vec![
                value("encoder", "zero", whole(zeros.encoder)),
                value("gauge", "zero", Numbers::Real(zeros.gauge.into())),
            ],
            // The gains were found relative to those before, and the tolerance is not measured: both stand in the
            // configuration.
            Findings::Identified(found) => vec![
                value("gauge", "newton_per_count", Numbers::Real(of.gauge.newton_per_count.into())),
                value("tendon", "stiffness", Numbers::Real(found.tendon_stiffness.as_slice().into())),
                value("tendon", "stiffness_tolerance", Numbers::One(of.tendon.stiffness_tolerance)),
                value("friction", "motor_coulomb", Numbers::Real(found.motor_coulomb.as_slice().into())),
                value("friction", "conduit", Numbers::Real(found.conduit.as_slice().into())),
                value("friction", "joint_coulomb", Numbers::Real(found.joint_coulomb.as_slice().into())),
            ],
        };
        Self::new(finger, values, HELD_BY_CALIBRATION, configuration)
    }

    /// The bound of Kx of a finger, N/cm, that was found with `configuration`.
    ///
    /// # Errors
    /// No such finger.
    pub fn bound(bound: f64, finger: i32, configuration: &Configuration) -> Result<Self, HandError> {
        let values = vec![value("stiffness", "bound", Numbers::One(bound))];
        Self::new(finger, values, HELD_BY_BOUND, configuration)
    }

    fn new(
        finger: i32,
        values: Vec<FoundValue>,
        held_by: &'static [&'static str],
        configuration: &Configuration,
    ) -> Result<Self, HandError> {
        let holds_for = excerpt(configuration, index(finger)?, held_by);
        Ok(Self { finger, values, held_by, holds_for })
    }

    /// 1 to 3.
    pub fn finger(&self) -> i32 {
        self.finger
    }

    /// Adds what a later calibration of the same finger has found.
    pub(super) fn add(&mut self, later: Self) {
        for FoundValue { section, key, numbers } in later.values {
            let before = self.values.iter_mut().find(|value| (value.section, value.key) == (section, key));
            match (before.map(|value| &mut value.numbers), numbers) {
                (Some(Numbers::Real(sizes)), Numbers::SignsOf(signs)) => *sizes = with_signs(sizes, signs),
                (Some(before), numbers) => *before = numbers,
                (None, numbers) => self.values.push(FoundValue { section, key, numbers }),
            }
        }
        self.holds_for = later.holds_for;
    }

    pub(super) fn values(&self) -> &[FoundValue] {
        &self.values
    }

    /// The first key on which this depends and that `configuration` has otherwise, unless all are as they were.
    pub(super) fn misfit(&self, configuration: &Configuration) -> Option<Misfit> {
        let present = excerpt(configuration, self.finger as usize - 1, self.held_by); // 1 to 3, as `new` has checked
        let keys = self.holds_for.keys().chain(present.keys());
        keys.map(|key| (key, self.holds_for.get(key), present.get(key))).find(|(_, was, is)| was != is).map(
            |(key, was, is)| {
                let text = |value: Option<&String>| value.map_or("not set".into(), String::clone);
                let key = if key == RATE { key.clone() } else { format!("finger.{}.{key}", self.finger) };
                Misfit { key, was: text(was), is: text(is) }
            },
        )
    }
}

/// A key that findings depend on and that has changed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Misfit {
    /// The whole key.
    pub key: String,
    /// Its value when they were found.
    pub was: String,
    /// Its value now.
    pub is: String,
}

/// The sizes of some numbers with other signs.
pub(super) fn with_signs(sizes: &[f64], signs: [i8; 4]) -> Vec<f64> {
    sizes.iter().zip(signs).map(|(size, sign)| size.abs() * f64::from(sign)).collect()
}

fn index(finger: i32) -> Result<usize, HandError> {
    let index = usize::try_from(finger).ok().and_then(|number| number.checked_sub(1));
    index.filter(|&index| index < FINGERS).ok_or(HandError::NoSuchFinger(finger))
}

fn value(section: &'static str, key: &'static str, numbers: Numbers) -> FoundValue {
    FoundValue { section, key, numbers }
}

fn whole<T: Into<i64>>(values: [T; 4]) -> Numbers {
    Numbers::Whole(values.map(T::into).into())
}

/// Keys of one finger, and of the keys in tables, with their values as text. What is not set is not there.
fn excerpt(configuration: &Configuration, index: usize, keys: &[&str]) -> BTreeMap<String, String> {
    let mut leaves = BTreeMap::new();
    // Every configuration can be written: it came from such a text, or could have.
    let finger = toml_edit::ser::to_document(&configuration.fingers[index]).unwrap_or_default();
    for &key in keys {
        if key == RATE {
            leaves.insert(key.into(), configuration.hand.rate.to_string());
        } else if let Some(item) = key.split('.').try_fold(finger.as_item(), |item, part| item.get(part)) {
            collect(key, item, &mut leaves);
        }
    }
    leaves
}

fn collect(key: &str, item: &Item, leaves: &mut BTreeMap<String, String>) {
    match item.as_table_like() {
        Some(table) => table.iter().for_each(|(name, item)| collect(&format!("{key}.{name}"), item, leaves)),
        None => {
            leaves.insert(key.into(), item.to_string().trim().into());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::{Signs, Zeros};
    use nalgebra::Vector3;

    fn zeros() -> Findings {
        let joint_error = Vector3::zeros();
        Findings::Zeros(Zeros { encoder: [1, 2, 3, 4], gauge: [200.0; 4], joint_error, range_error: None })
    }

    fn keys(found: &Found) -> Vec<String> {
        found.values.iter().map(|value| format!("{}.{}", value.section, value.key)).collect()
    }

    #[test]
    fn a_run_holds_its_own_keys_and_no_others() {
        let configuration = Configuration::default();
        let found = Found::by_calibration(&zeros(), 2, &configuration).expect("a finger");
        assert_eq!(keys(&found), ["encoder.zero", "gauge.zero"]);
        let found = Found::bound(7.0, 2, &configuration).expect("a finger");
        assert_eq!(keys(&found), ["stiffness.bound"]);
        for finger in [0, 4, i32::MIN] {
            assert!(matches!(Found::bound(7.0, finger, &configuration), Err(HandError::NoSuchFinger(_))));
        }
    }

    #[test]
    fn later_runs_are_added_key_by_key() {
        let configuration = Configuration::default();
        let mut found = Found::by_calibration(&zeros(), 1, &configuration).expect("a finger");
        found.values.push(value("gauge", "newton_per_count", Numbers::Real(vec![1.0, 2.0, -3.0, 4.0])));
        let signs = Findings::Signs(Signs { motor: [1; 4], encoder: [-1; 4], gauge: [-1, 1, 1, -1] });
        found.add(Found::by_calibration(&signs, 1, &configuration).expect("a finger"));
        assert_eq!(
            keys(&found),
            ["encoder.zero", "gauge.zero", "gauge.newton_per_count", "motor.sign", "encoder.sign"]
        );
        assert_eq!(found.values[2].numbers, Numbers::Real(vec![-1.0, 2.0, 3.0, -4.0]));
    }

    #[test]
    fn what_findings_depend_on_is_compared() {
        let found = |configuration: &Configuration| {
            let calibration = Found::by_calibration(&zeros(), 2, configuration).expect("a finger");
            [calibration, Found::bound(7.0, 2, configuration).expect("a finger")]
        };
        type Change = fn(&mut Configuration);
        let changes: [(Change, Option<&str>, Option<&str>); 6] = [
            (|_| {}, None, None),
            (|hand| hand.fingers[0].geometry.motor_radius = [0.05; 4], None, None),
            (|hand| hand.fingers[1].encoder.zero = [9; 4], None, None),
            (
                |hand| hand.fingers[1].geometry.motor_radius[2] = 0.05,
                Some("finger.2.geometry.motor_radius"),
                Some("finger.2.geometry.motor_radius"),
            ),
            (|hand| hand.fingers[1].controller.dither = Some(1.0), None, Some("finger.2.controller.dither")),
            (|hand| hand.hand.rate = 500.0, None, Some("hand.rate")),
        ];
        for (change, calibration, bound) in changes {
            let mut changed = Configuration::default();
            let before = found(&changed);
            change(&mut changed);
            let misfits = before.map(|found| found.misfit(&changed).map(|misfit| misfit.key));
            assert_eq!(misfits.each_ref().map(Option::as_deref), [calibration, bound]);
        }
        let mut changed = Configuration::default();
        let [_, bound] = found(&changed);
        changed.fingers[1].controller.dither = Some(1.0);
        let misfit = bound.misfit(&changed).expect("a difference");
        assert_eq!((misfit.was.as_str(), misfit.is.as_str()), ("not set", "1.0"));
    }
}
