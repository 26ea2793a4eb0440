//! Results of calibrations, or of the search for a bound of Kx, for one finger. The results are keys of the
//! configuration with the values that were found. The part of the configuration on which these values depend is kept
//! with them.

use crate::calibration::Findings;
use crate::hand::configuration_file::{FingersWithIo, to_document};
use crate::model::FingerNumber;
use crate::model::configuration::Configuration;
use std::collections::BTreeMap;
use toml_edit::{Formatted, Item, Value};

/// The keys that signs, zeros, friction and stiffness depend on. These keys say where the finger is connected, and how
/// counts and torques are converted to angles and forces.
const HELD_BY_CALIBRATION: &[&str] = &[
    "port",
    "board",
    "address",
    "geometry.r",
    "geometry.motor_radius",
    "encoder.counts_per_revolution",
    "motor.torque_constant",
];

/// The keys that a bound of Kx depends on.
const HELD_BY_BOUND: &[&str] = &[
    RATE,
    "geometry",
    "motor",
    "tendon",
    "joints",
    "links",
    "friction",
    "controller",
    "gauge.newton_per_count",
    "encoder.counts_per_revolution",
];

/// Number of significant digits that are stored and compared. No calibration routine is accurate to so many digits.
const DIGITS: usize = 6;

/// The only key in [`HELD_BY_BOUND`] that is not in the finger's table.
const RATE: &str = "hand.rate";

/// The results of one calibration, of several calibrations in a row, or of one search for a bound of Kx, for one
/// finger. When they are stored, only the keys in `values` are written.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Number of the finger, 1 to 3.
    finger: FingerNumber,
    values: Vec<FoundValue>,
    /// Keys and tables of keys that the values depend on.
    held_by: &'static [&'static str],
    /// The values of the keys in `held_by` when the results were found, rounded as in the file. They are rounded
    /// because the hand keeps all digits of earlier results, and the file does not.
    holds_for: BTreeMap<String, String>,
    /// The fingers whose hardware the program provided. Their ports and boards in the file do not matter.
    with_io: FingersWithIo,
}

/// A key of a finger, with the value that was found.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FoundValue {
    pub section: &'static str,
    pub key: &'static str,
    pub numbers: Numbers,
}

/// Numbers as written in a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Numbers {
    /// An array of whole numbers.
    Whole(Vec<i64>),
    /// An array of real numbers.
    Real(Vec<f64>),
    /// The rows of a matrix.
    Rows(Vec<Vec<f64>>),
    /// A real number.
    One(f64),
    /// Only signs. The real numbers in the file get these signs and keep their magnitudes, which were not measured.
    SignsOf([i8; 4]),
}

impl Found {
    /// The results of a calibration. `configuration` is the configuration with these results in it.
    pub fn by_calibration(findings: &Findings, finger: FingerNumber, configuration: &Configuration) -> Self {
        let of = &configuration.fingers[finger.index()];
        let values = match findings {
            Findings::RightWiring => Vec::new(),
            Findings::Signs(signs) => vec![
                value("motor", "sign", whole(signs.motor)),
                value("encoder", "sign", whole(signs.encoder)),
                value("gauge", "newton_per_count", Numbers::SignsOf(signs.gauge)),
            ],
            Findings::Zeros(zeros) => vec![
                value("encoder", "zero", whole(zeros.encoder)),
                value("gauge", "zero", Numbers::Real(zeros.gauge.into())),
            ],
            // The findings contain only the ratio of each new gauge gain to the previous one. The configuration
            // already contains the new gains, so they are taken from there.
            Findings::Identified(found) => {
                let mut values = vec![
                    value("gauge", "newton_per_count", Numbers::Real(of.gauge.newton_per_count.into())),
                    value("tendon", "stiffness", Numbers::Real(found.tendon_stiffness.as_slice().into())),
                    value("tendon", "stiffness_tolerance", Numbers::One(found.stiffness_tolerance)),
                    value("friction", "motor_coulomb", Numbers::Real(found.motor_coulomb.as_slice().into())),
                    value("friction", "conduit", Numbers::Real(found.conduit.as_slice().into())),
                    value("friction", "pulley", Numbers::Real(found.pulley.as_slice().into())),
                    value("friction", "joint_coulomb", Numbers::Real(found.joint_coulomb.as_slice().into())),
                    value("monitors", "friction_tolerance", Numbers::One(found.tolerances.friction)),
                    value("monitors", "gauge_tolerance", Numbers::One(found.tolerances.gauges)),
                ];
                if let Some(tolerance) = found.tolerances.moment_arms {
                    values.push(value("monitors", "moment_arm_tolerance", Numbers::One(tolerance)));
                }
                if let Some(inertia) = &found.rotor_inertia {
                    values.push(value("motor", "inertia", Numbers::Real(inertia.as_slice().into())));
                }
                if let Some(arms) = &found.moment_arms {
                    let rows = arms.rows().map(|row| row.to_vec());
                    values.push(value("geometry", "r", Numbers::Rows(rows.into())));
                    values.push(value("encoder", "zero", whole(arms.encoder_zero)));
                }
                values
            }
        };
        Self::new(finger, values, HELD_BY_CALIBRATION, configuration)
    }

    /// The bound of Kx of a finger, N/cm, found with `configuration`.
    pub fn bound(bound: f64, finger: FingerNumber, configuration: &Configuration) -> Self {
        let values = vec![value("stiffness", "bound", Numbers::One(bound))];
        Self::new(finger, values, HELD_BY_BOUND, configuration)
    }

    fn new(
        finger: FingerNumber,
        values: Vec<FoundValue>,
        held_by: &'static [&'static str],
        configuration: &Configuration,
    ) -> Self {
        let holds_for = excerpt(configuration, finger, held_by);
        let with_io = FingersWithIo::of_open_hand(configuration);
        Self { finger, values, held_by, holds_for, with_io }
    }

    /// Returns the number of the finger.
    pub fn finger(&self) -> FingerNumber {
        self.finger
    }

    /// Adds the results of a later calibration of the same finger.
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

    /// The fingers whose hardware the program provided. The configuration that [`Found::misfit`] compares must have
    /// been read without the ports and boards of these fingers.
    pub(super) fn with_io(&self) -> FingersWithIo {
        self.with_io
    }

    /// The first key that the results depend on and that has another value in `configuration`; none if all are equal. A
    /// key that the results themselves write does not count.
    pub(super) fn misfit(&self, configuration: &Configuration) -> Option<Misfit> {
        let present = excerpt(configuration, self.finger, self.held_by);
        let own = |key: &str| self.values.iter().any(|value| key == format!("{}.{}", value.section, value.key));
        let keys = self.holds_for.keys().chain(present.keys()).filter(|key| !own(key));
        keys.map(|key| (key, self.holds_for.get(key), present.get(key))).find(|(_, was, is)| was != is).map(
            |(key, was, is)| {
                let text = |value: Option<&String>| value.map_or("not set".into(), String::clone);
                let key = if key == RATE { key.clone() } else { format!("finger.{}.{key}", self.finger) };
                Misfit { key, was: text(was), is: text(is) }
            },
        )
    }
}

/// A key that results depend on, and that no longer has the value with which they were found.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Misfit {
    /// The key with its table.
    pub key: String,
    /// Its value when the results were found.
    pub was: String,
    /// Its current value.
    pub is: String,
}

/// The magnitudes of `sizes` with the signs in `signs`.
pub(super) fn with_signs(sizes: &[f64], signs: [i8; 4]) -> Vec<f64> {
    sizes.iter().zip(signs).map(|(size, sign)| size.abs() * f64::from(sign)).collect()
}

fn value(section: &'static str, key: &'static str, numbers: Numbers) -> FoundValue {
    FoundValue { section, key, numbers }
}

fn whole<T: Into<i64>>(values: [T; 4]) -> Numbers {
    Numbers::Whole(values.map(T::into).into())
}

/// The values of some keys, as text. A table stands for all of its keys. A key that is not set is left out.
fn excerpt(configuration: &Configuration, finger: FingerNumber, keys: &[&str]) -> BTreeMap<String, String> {
    let mut leaves = BTreeMap::new();
    // Every configuration can be serialised, because it was read from a TOML text or could have been read from one.
    let finger = to_document(&configuration.fingers[finger.index()]).unwrap_or_default();
    let has_board = finger.contains_key("board");
    for &key in keys {
        if key == "port" && has_board {
            // The search for the board has set the port, which is not in the file and can change.
            continue;
        }
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
            leaves.insert(key.into(), item.as_value().map_or_else(String::new, shown));
        }
    }
}

/// Returns the text of a value, with its real numbers rounded.
fn shown(value: &Value) -> String {
    match value {
        Value::Float(number) => rounded(*number.value()).to_string(),
        Value::Array(values) => format!("[{}]", values.iter().map(shown).collect::<Vec<_>>().join(", ")),
        other => other.to_string().trim().into(),
    }
}

/// Rounds to [`DIGITS`] significant digits.
pub(super) fn rounded(value: f64) -> Value {
    let digits = DIGITS - 1;
    // Rust can parse every number that it prints, so `unwrap_or` never returns the unrounded value.
    Value::Float(Formatted::new(format!("{value:.digits$e}").parse().unwrap_or(value)))
}

#[cfg(test)]
mod tests;
