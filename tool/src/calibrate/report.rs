//! The results of a calibration, for people and for other programs.

use crate::print::{Cell, Look, Screen, Table};
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;
use sun2xp::calibration::Findings;
use sun2xp::model::configuration::ConfiguredFinger;

/// The output of `--json`.
#[derive(Debug, Serialize)]
pub struct Report {
    pub fingers: Vec<Calibrated>,
    /// The file that has the results now. `None` with `--dry-run`.
    pub written: Option<PathBuf>,
}

/// What the calibration of one finger has found.
#[derive(Debug, Default, Serialize)]
pub struct Calibrated {
    pub finger: i32,
    /// Results that are not stored.
    pub measured: Vec<Measured>,
    /// The configured and the found values.
    pub values: Vec<Value>,
}

/// A result that is not stored.
#[derive(Debug, Serialize)]
pub struct Measured {
    name: &'static str,
    values: Vec<f64>,
    #[serde(skip)]
    digits: usize,
}

/// A value of the configuration before and after the calibration.
#[derive(Debug, Serialize)]
pub struct Value {
    key: String,
    unit: &'static str,
    configured: Vec<f64>,
    found: Vec<f64>,
    #[serde(skip)]
    digits: usize,
}

impl Measured {
    /// Returns the results of a task that are not stored.
    pub fn all(findings: &Findings) -> Vec<Self> {
        let new = |name, values: &[f64], digits| Self { name, values: values.to_vec(), digits };
        match findings {
            Findings::Signs(_) | Findings::RightWiring => Vec::new(),
            Findings::Zeros(zeros) => {
                let errors = zeros.joint_error.map(f64::to_degrees);
                let range = zeros.range_error.map(|range| range.map(f64::to_degrees));
                let range = range
                    .map(|range| new("measured minus configured range of the joints, degrees", range.as_slice(), 2));
                [new("joint angle errors before zeroing, degrees", errors.as_slice(), 2)]
                    .into_iter()
                    .chain(range)
                    .collect()
            }
            Findings::Identified(found) => vec![
                new("gauge gain / configured gain", found.gauge_gain.as_slice(), 4),
                new("motor torque that the gauges measure / commanded torque", found.motor_ratio.as_slice(), 3),
                new("viscous joint friction, N cm s/rad", found.joint_viscous.as_slice(), 3),
                new("residual of the motor travel, cm rms", &[found.travel_residual], 5),
            ],
        }
    }
}

impl Calibrated {
    /// Adds the configured and the found values.
    pub fn compare(&mut self, before: &ConfiguredFinger, after: &ConfiguredFinger) {
        let mut add = |key: &str, unit, of: fn(&ConfiguredFinger) -> Vec<f64>, digits| {
            let (configured, found) = (of(before), of(after));
            self.values.push(Value { key: key.into(), unit, configured, found, digits });
        };
        add("motor.sign", "", |finger| finger.motor.sign.iter().map(|&sign| sign.into()).collect(), 0);
        add("encoder.sign", "", |finger| finger.encoder.sign.iter().map(|&sign| sign.into()).collect(), 0);
        add("encoder.zero", "", |finger| finger.encoder.zero.iter().map(|&zero| zero.into()).collect(), 0);
        add("gauge.newton_per_count", "N per count", |finger| finger.gauge.newton_per_count.to_vec(), 5);
        add("gauge.zero", "", |finger| finger.gauge.zero.to_vec(), 1);
        add("tendon.stiffness", "N/cm", |finger| finger.tendon.stiffness.to_vec(), 1);
        add("friction.motor_coulomb", "N cm", |finger| finger.friction.motor_coulomb.to_vec(), 4);
        add("friction.conduit", "", |finger| finger.friction.conduit.to_vec(), 4);
        add("friction.pulley", "", |finger| finger.friction.pulley.to_vec(), 4);
        add("friction.joint_coulomb", "N cm", |finger| finger.friction.joint_coulomb.to_vec(), 4);
        add("monitors.friction_tolerance", "", |finger| vec![finger.monitors.friction_tolerance], 3);
        add("monitors.moment_arm_tolerance", "", |finger| vec![finger.monitors.moment_arm_tolerance], 3);
        add("monitors.gauge_tolerance", "", |finger| vec![finger.monitors.gauge_tolerance], 3);
        add("motor.inertia", "1e-7 kg m^2", |finger| finger.motor.inertia.map(|inertia| inertia * 1e7).to_vec(), 3);
        for (row, (configured, found)) in before.geometry.r.iter().zip(&after.geometry.r).enumerate() {
            let (configured, found) = (configured.to_vec(), found.to_vec());
            self.values.push(Value {
                key: format!("geometry.r, row {}", row + 1),
                unit: "cm",
                configured,
                found,
                digits: 4,
            });
        }
    }

    pub fn text(&self, screen: &Screen) -> String {
        let mut text = String::new();
        let mut measured = Table::without_header();
        for Measured { name, values, digits } in &self.measured {
            measured.row([(*name).into(), list(values, *digits).into()]);
        }
        // Writing to a String does not fail.
        let _ = write!(text, "{}", measured.text(screen));
        let mut table = Table::new([&format!("finger.{}", self.finger), "configured", "found", "changed"]);
        for Value { key, unit, configured, found, digits } in &self.values {
            let key = if unit.is_empty() { key.clone() } else { format!("{key}, {unit}") };
            let [configured, found] = [configured, found].map(|values| list(values, *digits));
            let (look, mark) = if configured == found { (Look::Plain, "") } else { (Look::Title, "*") };
            table.row([key.into(), configured.into(), Cell::new(look, found), mark.into()]);
        }
        text + &table.text(screen)
    }
}

fn list(values: &[f64], digits: usize) -> String {
    values.iter().map(|value| format!("{value:.digits$}")).collect::<Vec<_>>().join(" ")
}
