//! Zeros gauges and encoders.

mod at_pose;
mod at_stops;
mod encoder_zero;
mod gauge_zero;
mod gauges;
mod grip;
mod standstill;
mod swing;

use super::findings::{Findings, Zeros};
use super::instruments::Instruments;
use super::joint_guide::JointGuide;
use super::obstacle::Obstacle;
use super::step::{Progress, Sample, Step};
use super::stop_search::StopSearch;
use super::take_up::TakeUp;
use crate::control::signals::Activity;
use crate::model::configuration::{ConfiguredFinger, ZeroingMethod};
use encoder_zero::Reading;
use gauge_zero::GaugeZero;
use grip::Grip;
use nalgebra::{Vector3, Vector4};
use std::ops::ControlFlow::{self, Continue};
use swing::Swing;

#[derive(Clone, Debug)]
pub(super) struct Zeroing {
    method: ZeroingMethod,
    pose: Vector3<f64>,
    stops: (Vector3<f64>, Vector3<f64>),
    torque: f64,
    speed: f64,
    configured: [i32; 4],
    phase: Phase,
    /// Reading with tight tendons at the beginning. `None` if they were slack.
    first: Option<Reading>,
    /// Gauge offsets, N.
    offset: Vector4<f64>,
    stops_found: (Vector3<f64>, Vector3<f64>),
}

#[derive(Clone, Copy, Debug)]
enum Phase {
    Start,
    /// Reads counts and tensions while the finger keeps its own controller.
    Read,
    Gauges(GaugeZero),
    /// Tightens the tendons. The gauge offsets are now known.
    Tighten(TakeUp),
    /// The finger was limp at the beginning. Reads its pose before the pushes of [`Phase::Try`].
    ReadHeld {
        guide: JointGuide,
        swing: Swing,
    },
    /// Checks whether something holds the finger in its pose.
    Try(Grip),
    ReadPose {
        grip: Grip,
        swing: Swing,
    },
    /// Reads the finger at its pretension. `joints` are the angles that the swing has measured, rad.
    RestInPose {
        grip: Grip,
        joints: Vector3<f64>,
        reading: Reading,
    },
    Seek {
        guide: JointGuide,
        joint: usize,
        upper: bool,
        search: StopSearch,
    },
    ReadStop {
        guide: JointGuide,
        joint: usize,
        upper: bool,
        swing: Swing,
    },
    Return {
        guide: JointGuide,
        joint: usize,
    },
    Rest {
        guide: JointGuide,
        seconds: f64,
    },
    ReadAgain {
        guide: JointGuide,
        reading: Reading,
    },
}

/// The result of a step of zeroing. Without an activity the finger continues under its own controller.
type Stepped = Result<ControlFlow<Findings, (Option<Activity>, Progress)>, Obstacle>;

/// The result of a step that continues with `activity`.
fn going(step: Step, part: f64, activity: Activity) -> Stepped {
    Ok(Continue((Some(activity), Progress { step, part })))
}

impl Zeroing {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let zeroing = &finger.zeroing;
        Self {
            method: finger.zeroing_method(),
            pose: Vector3::from(zeroing.pose_degrees.map(f64::to_radians)),
            stops: finger.stops(),
            torque: zeroing.torque,
            speed: zeroing.speed,
            configured: finger.encoder.zero,
            phase: Phase::Start,
            first: None,
            offset: Vector4::zeros(),
            stops_found: (Vector3::zeros(), Vector3::zeros()),
        }
    }

    /// Runs one cycle of the current phase. A finger under control is read first. Then every method zeros the gauges.
    /// Afterwards the methods differ: they zero the encoders in the configured pose or between the stops, or keep the
    /// zeros of the encoders.
    pub fn step(&mut self, instruments: &mut Instruments, sample: &Sample) -> Stepped {
        match self.phase {
            Phase::Start => self.begin(instruments, sample),
            Phase::Read => self.read_before(instruments, sample),
            Phase::Gauges(gauges) => self.zero_gauges(gauges, instruments, sample),
            Phase::Tighten(take_up) => self.take_up_slack(take_up, instruments, sample),
            Phase::ReadHeld { guide, swing } => self.read_held(guide, swing, instruments, sample),
            Phase::Try(grip) => self.try_pose(grip, instruments, sample),
            Phase::ReadPose { grip, swing } => self.read_pose(grip, swing, instruments, sample),
            Phase::RestInPose { grip, joints, reading } => {
                self.rest_in_pose(grip, joints, reading, instruments, sample)
            }
            Phase::Seek { guide, joint, upper, search } => {
                self.seek_stop(guide, joint, upper, search, instruments, sample)
            }
            Phase::ReadStop { guide, joint, upper, swing } => {
                self.read_stop(guide, joint, upper, swing, instruments, sample)
            }
            Phase::Return { guide, joint } => self.return_to_middle(guide, joint, instruments, sample),
            Phase::Rest { guide, seconds } => self.rest(guide, seconds, instruments, sample),
            Phase::ReadAgain { guide, reading } => self.read_between_stops(guide, reading, instruments, sample),
        }
    }

    fn findings(
        &self,
        instruments: &Instruments,
        encoder: [i32; 4],
        joint_error: Vector3<f64>,
        range_error: Option<Vector3<f64>>,
    ) -> Findings {
        let gauge = instruments.gauge_zero + self.offset.component_div(&instruments.newton_per_count);
        Findings::Zeros(Zeros { encoder, gauge: gauge.into(), joint_error, range_error })
    }
}
