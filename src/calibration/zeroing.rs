//! Zeros of gauges and encoders.

mod at_pose;
mod at_stops;
mod gauges;

use super::encoder_zero::Reading;
use super::findings::{Findings, Zeros};
use super::gauge_zero::GaugeZero;
use super::grip::Grip;
use super::instruments::Instruments;
use super::joint_lead::JointLead;
use super::obstacle::Obstacle;
use super::step::{Progress, Sample, Step};
use super::stop_search::StopSearch;
use super::take_up::TakeUp;
use crate::control::signals::Activity;
use crate::model::configuration::{ConfiguredFinger, ZeroingMethod};
use nalgebra::{Vector3, Vector4};
use std::ops::ControlFlow::{self, Continue};

#[derive(Clone, Debug)]
pub(super) struct Zeroing {
    method: ZeroingMethod,
    pose: Vector3<f64>,
    stops: (Vector3<f64>, Vector3<f64>),
    torque: f64,
    speed: f64,
    configured: [i32; 4],
    phase: Phase,
    /// With the tendons tight, at the beginning, if they were.
    first: Option<Reading>,
    /// N.
    offset: Vector4<f64>,
    met: (Vector3<f64>, Vector3<f64>),
}

#[derive(Clone, Copy, Debug)]
enum Phase {
    Start,
    /// The finger is held as it was before.
    Read,
    Gauges(GaugeZero),
    /// With the offsets known.
    Tighten(TakeUp),
    /// Limp until now: whether something holds it in its pose.
    Try(Grip),
    ReadPose {
        grip: Grip,
        reading: Reading,
    },
    Seek {
        lead: JointLead,
        joint: usize,
        upper: bool,
        search: StopSearch,
    },
    Return {
        lead: JointLead,
        joint: usize,
    },
    Rest {
        lead: JointLead,
        seconds: f64,
    },
    ReadAgain {
        lead: JointLead,
        reading: Reading,
    },
}

/// What a step of zeroing yields. No activity: the finger goes on with what it did before.
type Stepped = Result<ControlFlow<Findings, (Option<Activity>, Progress)>, Obstacle>;

/// The routine goes on with `activity`.
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
            met: (Vector3::zeros(), Vector3::zeros()),
        }
    }

    /// Runs one cycle of the current phase. Every method begins with the gauges. Then the encoders are zeroed in the
    /// configured pose or between the stops, unless their zeros are kept.
    pub fn step(&mut self, instruments: &mut Instruments, sample: &Sample) -> Stepped {
        match self.phase {
            Phase::Start => self.begin(instruments, sample),
            Phase::Read => self.read_before(instruments, sample),
            Phase::Gauges(gauges) => self.zero_gauges(gauges, instruments, sample),
            Phase::Tighten(take_up) => self.take_up_slack(take_up, instruments, sample),
            Phase::Try(grip) => self.try_pose(grip, instruments, sample),
            Phase::ReadPose { grip, reading } => self.read_pose(grip, reading, instruments, sample),
            Phase::Seek { lead, joint, upper, search } => {
                self.seek_stop(lead, joint, upper, search, instruments, sample)
            }
            Phase::Return { lead, joint } => self.return_to_middle(lead, joint, instruments, sample),
            Phase::Rest { lead, seconds } => self.rest(lead, seconds, instruments, sample),
            Phase::ReadAgain { lead, reading } => self.read_between_stops(lead, reading, instruments, sample),
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
