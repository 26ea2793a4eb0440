//! The messages to the page. docs/monitor-web.md describes them.

use crate::model::geometry::Geometry;
use serde::Serialize;
use sun2xp::Fault;
use sun2xp::simulated::ObjectState;

/// Names of the values of a sample, in their order.
pub const COLUMNS: [&str; 25] = [
    "t",
    "cycle",
    "q0",
    "q1",
    "q2",
    "d0",
    "d1",
    "d2",
    "t0",
    "t1",
    "t2",
    "t3",
    "w0",
    "w1",
    "w2",
    "w3",
    "f0",
    "f1",
    "f2",
    "p0",
    "p1",
    "p2",
    "torque_scale",
    "stiffness_scale",
    "wake",
];

/// A sample: the values of [`COLUMNS`]. A value that does not exist is null in JSON.
pub type Row = [f64; COLUMNS.len()];

/// A message.
#[derive(Debug, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum ToPage<'a> {
    Hand(Box<HandMessage<'a>>),
    Gone { reason: &'a str },
    Batch(Batch<'a>),
    State(StateMessage),
    Status(StatusMessage),
    Events { events: [EventMessage; 1] },
}

/// A hand. The page starts again with this message, unless it already shows the hand with this identity.
#[derive(Debug, Serialize)]
pub struct HandMessage<'a> {
    /// Identifies the hand. The identity stays the same while the page is disconnected and connects again.
    pub identity: String,
    pub name: &'a str,
    pub process: u32,
    pub library: &'a str,
    /// Time of opening, s since 1970.
    pub started: u64,
    /// Rate, Hz.
    pub rate: f64,
    /// Whether the page may move the hand.
    pub control: bool,
    pub columns: [&'static str; COLUMNS.len()],
    pub fingers: Vec<FingerMessage>,
    pub geometry: Geometry,
}

#[derive(Debug, Serialize)]
pub struct FingerMessage {
    pub number: i32,
    pub simulated: bool,
    pub tension: Bounds,
    pub links: Vec<LinkMessage>,
}

/// t_min and t_max, N.
#[derive(Debug, Serialize)]
pub struct Bounds {
    pub low: f64,
    pub high: f64,
}

/// Limits of a joint, rad.
#[derive(Debug, Serialize)]
pub struct LinkMessage {
    pub limits: [f64; 2],
}

/// Samples of all fingers.
#[derive(Debug, Serialize)]
pub struct Batch<'a> {
    pub number: u64,
    /// Number of cycles, of all fingers together, that the reader of the hand has lost since the reader was attached.
    pub lost: u64,
    /// Cycles of all fingers in this batch, and in all batches up to this one.
    pub cycles: [u64; 2],
    pub fingers: Vec<Rows<'a>>,
    pub object: Option<&'a ObjectState>,
}

#[derive(Debug, Serialize)]
pub struct Rows<'a> {
    pub finger: i32,
    pub rows: &'a [Row],
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StateMessage {
    pub finger: i32,
    pub stage: String,
    pub fault: Option<FaultMessage>,
    /// Kx as it was sent, by rows, N/cm.
    pub kx: Option<[[f64; 3]; 3]>,
    /// Stiffness of the tip in the present pose, by rows, N/cm; none for a finger that is not a spring.
    pub stiffness: Option<[[f64; 3]; 3]>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaultMessage {
    pub name: &'static str,
    /// Name, part and value.
    pub detail: String,
    pub text: &'static str,
    pub remedy: &'static str,
}

#[derive(Debug, Serialize)]
pub struct StatusMessage {
    pub finger: i32,
    pub wake_up: Quantiles,
    pub cycle: Quantiles,
    pub lost_replies: u64,
    pub skipped_periods: u64,
    pub recoveries: u32,
    pub warnings: Vec<FaultMessage>,
}

/// Quantiles of a duration, us.
#[derive(Debug, Serialize)]
pub struct Quantiles {
    pub median: f64,
    pub p99: f64,
    pub p999: f64,
    pub most: f64,
}

#[derive(Debug, Serialize)]
pub struct EventMessage {
    /// Number in the order in which the monitor got the events. A page that gets an event again ignores it.
    pub number: u64,
    pub finger: i32,
    pub cycle: u64,
    /// Time on the clock of the samples, s.
    pub time: f64,
    /// Time, s since 1970.
    pub wall: f64,
    pub severity: &'static str,
    /// Kind, part and values in words.
    pub name: String,
    /// What such an event means.
    pub text: &'static str,
}

impl FaultMessage {
    /// Describes a fault.
    pub fn new(fault: &Fault) -> Self {
        let description = fault.kind.description();
        // In the text of a fault, name, part and value come first. After a colon, the text says what has happened.
        let whole = fault.to_string();
        let detail = whole.split_once(": ").map_or(whole.as_str(), |(detail, _)| detail).to_owned();
        Self { name: description.name, detail, text: description.text, remedy: description.remedy }
    }
}
