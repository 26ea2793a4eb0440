//! Recordings of `sun2xp record` and black boxes, as the bytes of structured arrays.

use crate::errors::Refusal;
use crate::waiting::in_thread;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use std::collections::BTreeMap;
use std::path::PathBuf;
use sun2xp_tool::trace::{self, Item, Mark, Row};

/// Name, type and shape of a field, as numpy.dtype takes them.
type Field = (&'static str, &'static str, Vec<usize>);

/// Largest length of a stage's name, characters. The name's numpy type is therefore U11.
const LONGEST_STAGE: usize = 11;

/// The cycles of a finger.
#[derive(Default)]
struct Cycles {
    fields: Vec<Field>,
    bytes: Vec<u8>,
    /// Whether the first row, which determines the fields, is complete.
    known: bool,
}

/// Time, ns; finger; cycle; kind; text.
type MarkTuple = (u64, Option<i32>, Option<u64>, &'static str, String);

/// What `read` has read of a file.
#[derive(Default)]
struct Contents {
    description: String,
    cycles: BTreeMap<i32, Cycles>,
    marks: Vec<MarkTuple>,
    complete: bool,
    /// The earliest beginning of a cycle in the file, ns. Cycles of fingers that are not read count too.
    begin: Option<u64>,
}

/// The description as JSON; for each finger the fields and the bytes of its cycles; the marks; whether the file is
/// complete; the beginning of its first cycle, ns.
type Read<'py> = (String, BTreeMap<i32, (Vec<Field>, Bound<'py, PyByteArray>)>, Vec<MarkTuple>, bool, Option<u64>);

/// Reads a recording or a black box.
#[pyfunction]
pub fn read_file(py: Python<'_>, path: PathBuf, fingers: Vec<i32>) -> PyResult<Read<'_>> {
    let contents = in_thread(py, move || read(&path, &fingers))?;
    let contents = contents.map_err(|text| Refusal::Recording(text).raise(py))?;
    let array = |cycles: Cycles| (cycles.fields, PyByteArray::new(py, &cycles.bytes));
    let cycles = contents.cycles.into_iter().map(|(finger, cycles)| (finger, array(cycles))).collect();
    Ok((contents.description, cycles, contents.marks, contents.complete, contents.begin))
}

fn read(path: &std::path::Path, fingers: &[i32]) -> Result<Contents, String> {
    let mut contents = Contents::default();
    let wanted = |finger: i32| fingers.is_empty() || fingers.contains(&finger);
    let (description, complete) = trace::read_with(path, &|_| {}, &mut |item| {
        match item {
            Item::Cycle(row) => {
                let (finger, began) = (row.sample.finger.get(), row.sample.began);
                contents.begin = Some(contents.begin.map_or(began, |begin| begin.min(began)));
                if wanted(finger) {
                    contents.cycles.entry(finger).or_default().add(&row);
                }
            }
            Item::Mark(Mark { time, finger, cycle, kind, text }) if finger.is_none_or(wanted) => {
                contents.marks.push((time, finger, cycle, kind.name(), text));
            }
            _ => {}
        }
        Ok(())
    })
    .map_err(|failure| failure.to_string())?;
    contents.description = serde_json::to_string(&description).map_err(|error| error.to_string())?;
    contents.complete = complete;
    Ok(contents)
}

impl Cycles {
    fn add(&mut self, row: &Row) {
        let sample = &row.sample;
        // In a cycle without the controller, the sample has the values of an earlier cycle.
        let computed = sample.computed.then_some(sample);
        self.whole("time", sample.began.cast_signed());
        self.whole("cycle", sample.cycle.cast_signed());
        self.text("stage", &sample.stage_name());
        self.whole("fault", sample.fault().map_or(0, |fault| fault.kind.number().into()));
        self.flag("reply", row.feedback.is_some());
        self.flag("computed", sample.computed);
        self.vector("joints", computed.map(|sample| sample.joints));
        self.vector("joint_set_point", computed.and_then(|sample| sample.joint_set_point));
        self.vector("joint_rates", computed.map(|sample| sample.joint_rates));
        self.vector("tip", computed.map(|sample| sample.tip));
        self.vector("tip_set_point", computed.and_then(|sample| sample.tip_set_point));
        self.vector("tip_force", computed.map(|sample| sample.tip_force));
        self.matrix("kx", computed.and_then(|sample| sample.kx));
        self.matrix("tip_stiffness", computed.map(|sample| sample.stiffness));
        self.vector("joint_torques", computed.map(|sample| sample.joint_torques));
        self.vector("measured_joint_torques", computed.map(|sample| sample.measured_joint_torques));
        self.vector("desired_tensions", computed.map(|sample| sample.desired_tensions));
        self.vector("tensions", computed.map(|sample| sample.tensions));
        self.vector("motor_torques", computed.map(|sample| sample.motor_torques));
        self.number("torque_scale", computed.map(|sample| sample.torque_scale));
        self.number("stiffness_scale", computed.map(|sample| sample.stiffness_scale));
        self.vector("contact_force", computed.map(|sample| sample.contact_force));
        self.flag("touching", computed.is_some_and(|sample| sample.touching));
        self.number("slide_speed", computed.map(|sample| sample.slide));
        self.number("wake_up", sample.wake_up);
        self.number("cycle_end", sample.whole);
        self.known = true;
    }

    fn field(&mut self, name: &'static str, kind: &'static str, shape: &[usize]) {
        if !self.known {
            self.fields.push((name, kind, shape.to_vec()));
        }
    }

    fn whole(&mut self, name: &'static str, value: i64) {
        self.field(name, "i8", &[]);
        self.bytes.extend(value.to_ne_bytes());
    }

    fn flag(&mut self, name: &'static str, value: bool) {
        self.field(name, "?", &[]);
        self.bytes.push(value.into());
    }

    /// Adds a text of numpy: UTF-32, filled with zeros.
    fn text(&mut self, name: &'static str, value: &str) {
        self.field(name, "U11", &[]);
        let characters = value.chars().map(u32::from).chain(std::iter::repeat(0)).take(LONGEST_STAGE);
        self.bytes.extend(characters.flat_map(u32::to_ne_bytes));
    }

    /// Adds a number. It is NaN if the cycle does not have it.
    fn number(&mut self, name: &'static str, value: Option<f64>) {
        self.field(name, "f8", &[]);
        self.bytes.extend(value.unwrap_or(f64::NAN).to_ne_bytes());
    }

    fn vector<const N: usize>(&mut self, name: &'static str, values: Option<[f64; N]>) {
        self.field(name, "f8", &[N]);
        self.bytes.extend(values.unwrap_or([f64::NAN; N]).into_iter().flat_map(f64::to_ne_bytes));
    }

    fn matrix(&mut self, name: &'static str, rows: Option<[[f64; 3]; 3]>) {
        self.field(name, "f8", &[3, 3]);
        self.bytes.extend(rows.unwrap_or([[f64::NAN; 3]; 3]).into_iter().flatten().flat_map(f64::to_ne_bytes));
    }
}
