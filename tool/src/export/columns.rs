//! The columns of a CSV file: names, units and values.

use super::quoted;
use crate::trace::Row;
use std::fmt::{self, Display, Formatter};
use sun2xp::simulated::ObjectState;

/// A value of a cycle.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// The cycle does not have this value.
    None,
    Number(f64),
    Whole(i64),
    Text(String),
}

impl Display for Value {
    /// A number is written with the digits that are needed to read the same bits again.
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Value::None => Ok(()),
            Value::Number(number) => write!(formatter, "{number}"),
            Value::Whole(number) => write!(formatter, "{number}"),
            Value::Text(text) => formatter.write_str(&quoted(text)),
        }
    }
}

/// One column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    pub name: String,
    /// The unit as it is written in names, such as `N_per_cm`; empty for numbers without unit.
    pub unit: &'static str,
    pub value: Value,
}

impl Column {
    /// The name with the unit.
    pub fn full_name(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{}_{}", self.name, self.unit) }
    }
}

/// The columns of a row, in a list that grows.
#[derive(Default)]
struct Columns(Vec<Column>);

impl Columns {
    fn one(&mut self, name: &str, unit: &'static str, value: Value) {
        self.0.push(Column { name: name.into(), unit, value });
    }

    fn number(&mut self, name: &str, unit: &'static str, value: Option<f64>) {
        self.one(name, unit, value.map_or(Value::None, Value::Number));
    }

    /// One column for each part of a vector. The parts of `None` are empty.
    fn vector<const N: usize>(&mut self, name: &str, parts: [&str; N], unit: &'static str, values: Option<[f64; N]>) {
        for (index, part) in parts.into_iter().enumerate() {
            self.number(&format!("{name}_{part}"), unit, values.map(|values| values[index]));
        }
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];
const ENTRIES: [&str; 9] = ["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"];

/// Returns the entries of a matrix row by row.
fn entries(matrix: [[f64; 3]; 3]) -> [f64; 9] {
    std::array::from_fn(|entry| matrix[entry / 3][entry % 3])
}

/// Returns the columns of the object of a simulated hand, in the palm's frame.
pub fn object_columns(object: &ObjectState) -> Vec<Column> {
    let mut columns = Columns::default();
    columns.number("simulated_time", "s", Some(object.time));
    columns.vector("position", AXES, "cm", Some(object.position));
    columns.vector("rotation", ENTRIES, "", Some(entries(object.rotation)));
    columns.vector("velocity", AXES, "cm_per_s", Some(object.velocity));
    columns.vector("angular_velocity", AXES, "rad_per_s", Some(object.angular_velocity));
    for (finger, force) in (1..).zip(object.forces) {
        columns.vector(&format!("force_{finger}"), AXES, "N", Some(force));
    }
    columns.0
}

/// Returns the columns of a cycle, always the same ones in the same order.
pub fn columns(row: &Row) -> Vec<Column> {
    const JOINTS: [&str; 3] = ["0", "1", "2"];
    const PARTS: [&str; 4] = ["1", "2", "3", "4"];
    let sample = &row.sample;
    // If the controller did not run in this cycle, its values in the sample do not belong to this cycle.
    let computed = sample.computed.then_some(sample);
    let mut columns = Columns::default();
    columns.one("began", "ns", Value::Whole(sample.began.cast_signed()));
    columns.one("cycle", "", Value::Whole(sample.cycle.cast_signed()));
    columns.one("stage", "", Value::Text(sample.stage.to_string()));
    columns.one("reply", "", Value::Whole(row.feedback.is_some().into()));
    columns.one("computed", "", Value::Whole(sample.computed.into()));
    columns.vector("joint", JOINTS, "rad", computed.map(|sample| sample.joints));
    columns.vector("joint_set_point", JOINTS, "rad", computed.and_then(|sample| sample.joint_set_point));
    columns.vector("joint_rate", JOINTS, "rad_per_s", computed.map(|sample| sample.joint_rates));
    columns.vector("tip", AXES, "cm", computed.map(|sample| sample.tip));
    columns.vector("tip_set_point", AXES, "cm", computed.and_then(|sample| sample.tip_set_point));
    columns.vector("tip_force", AXES, "N", computed.map(|sample| sample.tip_force));
    columns.vector("kx", ENTRIES, "N_per_cm", computed.and_then(|sample| sample.kx).map(entries));
    columns.vector("tip_stiffness", ENTRIES, "N_per_cm", computed.map(|sample| entries(sample.stiffness)));
    columns.vector("joint_torque", JOINTS, "Ncm", computed.map(|sample| sample.joint_torques));
    columns.vector("joint_torque_measured", JOINTS, "Ncm", computed.map(|sample| sample.measured_joint_torques));
    columns.vector("tension_desired", PARTS, "N", computed.map(|sample| sample.desired_tensions));
    columns.vector("tension", PARTS, "N", computed.map(|sample| sample.tensions));
    columns.number("t_min", "N", Some(sample.t_min));
    columns.number("t_max", "N", Some(sample.t_max));
    columns.vector("motor_torque", PARTS, "Ncm", computed.map(|sample| sample.motor_torques));
    columns.number("torque_scale", "", computed.map(|sample| sample.torque_scale));
    columns.number("stiffness_scale", "", computed.map(|sample| sample.stiffness_scale));
    columns.vector("contact_force", AXES, "N", computed.map(|sample| sample.contact_force));
    columns.one("touching", "", computed.map_or(Value::None, |sample| Value::Whole(sample.touching.into())));
    columns.number("slide", "cm_per_s", computed.map(|sample| sample.slide));
    columns.number("wake_up", "us", sample.wake_up);
    columns.number("cycle_end", "us", sample.whole);
    for (index, part) in PARTS.into_iter().enumerate() {
        let count = row.feedback.map(|feedback| Value::Whole(feedback.motor_counts[index].into()));
        columns.one(&format!("motor_{part}"), "count", count.unwrap_or(Value::None));
    }
    for (index, part) in PARTS.into_iter().enumerate() {
        let count = row.feedback.map(|feedback| Value::Whole(feedback.gauge_counts[index].into()));
        columns.one(&format!("gauge_{part}"), "count", count.unwrap_or(Value::None));
    }
    columns.one("status", "", Value::Whole(row.status.into()));
    columns.0
}
