//! Zeros of gauges and encoders.

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
use std::ops::ControlFlow::{self, Break, Continue};

/// A stop may be so far from where it is expected, rad, before it counts as something else in the way.
const TOLERANCE: f64 = 0.035;
/// How much further than its range a joint is led in search of a stop, rad.
const BEYOND: f64 = 0.17;
/// How near to the middle of its range a joint is brought back, rad.
const NEAR: f64 = 0.05;
/// Part of t_min that every tendon is to be pulled with where the finger is under control already.
const PULLED: f64 = 0.3;
/// How long the finger comes to rest before its counts are read, s.
const RESTING: f64 = 0.3;

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

#[derive(Clone, Debug)]
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

    pub fn step(&mut self, instruments: &mut Instruments, sample: &Sample) -> Stepped {
        let going = |step, part, activity| Ok(Continue((Some(activity), Progress { step, part })));
        let as_before = |part| Ok(Continue((None, Progress { step: Step::ReadingEncoders, part })));
        match &mut self.phase {
            Phase::Start => {
                if self.method == ZeroingMethod::Kept && !sample.zero_valid {
                    return Err(Obstacle::NotKept);
                }
                self.phase = if sample.report.desired_tensions.min() > PULLED * instruments.minimum {
                    Phase::Read
                } else {
                    // Not to be tightened before the gauges are zeroed: wrong ones would pull the finger away.
                    Phase::Gauges(GaugeZero::new(None))
                };
                as_before(0.0)
            }
            Phase::Read => {
                let mut first = self.first.unwrap_or_default();
                if first.step(instruments, sample) {
                    if self.method == ZeroingMethod::Pose {
                        first.still()?;
                    }
                    self.phase = Phase::Gauges(GaugeZero::new(Some(first.tensions())));
                }
                self.first = Some(first);
                as_before(0.1)
            }
            Phase::Gauges(gauges) => match gauges.step(instruments, sample)? {
                Continue(activity) => going(Step::ZeroingGauges, 0.2, activity),
                Break(offset) => {
                    self.offset = offset;
                    instruments.offset = offset;
                    match (self.method, self.first) {
                        (ZeroingMethod::Kept, _) => {
                            Ok(Break(self.findings(instruments, self.configured, Vector3::zeros(), None)))
                        }
                        (ZeroingMethod::Pose, Some(first)) => Ok(Break(self.at_pose(instruments, &first, &offset))),
                        (ZeroingMethod::Pose, None) | (ZeroingMethod::Stops, _) => {
                            self.phase = Phase::Tighten(TakeUp::new());
                            going(Step::TakingUpSlack, 0.25, Activity::Turn(Vector4::zeros()))
                        }
                    }
                }
            },
            Phase::Tighten(take_up) => match take_up.step(instruments, sample)? {
                Some(activity) => going(Step::TakingUpSlack, 0.25, activity),
                None if self.method == ZeroingMethod::Pose => {
                    self.phase = Phase::Try(Grip::new(instruments, sample, self.torque));
                    going(Step::TryingPose, 0.3, Activity::Tighten(instruments.offset))
                }
                None => {
                    let lead = JointLead::new(instruments, sample, self.torque);
                    let search = StopSearch::new(0, -self.longest(0));
                    self.phase = Phase::Seek { lead, joint: 0, upper: false, search };
                    going(Step::SeekingStops, 0.3, lead.activity(instruments, sample))
                }
            },
            Phase::Try(grip) => {
                let (activity, done) = grip.step(instruments, sample, self.speed)?;
                if done {
                    self.phase = Phase::ReadPose { grip: *grip, reading: Reading::default() };
                }
                going(Step::TryingPose, 0.6, activity)
            }
            Phase::ReadPose { grip, reading } => {
                let (activity, _) = grip.step(instruments, sample, self.speed)?;
                if !reading.step(instruments, sample) {
                    return going(Step::ReadingEncoders, 0.9, activity);
                }
                reading.still()?;
                grip.returned(&reading.joints(instruments, &Vector4::zeros()))?;
                let reading = *reading;
                Ok(Break(self.at_pose(instruments, &reading, &Vector4::zeros())))
            }
            &mut Phase::Seek { ref mut lead, joint, upper, ref mut search } => {
                lead.measure(instruments, sample);
                let met = search.step(instruments, lead, self.speed)?;
                let activity = lead.activity(instruments, sample);
                let part = 0.3 + 0.2 * (joint as f64 + if upper { 0.5 } else { 0.0 });
                let lead = *lead;
                match (met, upper) {
                    (None, _) => {}
                    (Some(angle), false) => {
                        self.met.0[joint] = angle;
                        let search = StopSearch::new(joint, self.longest(joint));
                        self.phase = Phase::Seek { lead, joint, upper: true, search };
                    }
                    (Some(angle), true) => {
                        self.met.1[joint] = angle;
                        self.check_range(joint)?;
                        self.phase = Phase::Return { lead, joint };
                    }
                }
                going(Step::SeekingStops, part, activity)
            }
            &mut Phase::Return { ref mut lead, joint } => {
                let middle = 0.5 * (self.met.0[joint] + self.met.1[joint]);
                lead.measure(instruments, sample);
                lead.advance(joint, middle, self.speed * instruments.period);
                let (activity, arrived) =
                    (lead.activity(instruments, sample), (lead.joints[joint] - middle).abs() < NEAR);
                if arrived {
                    let lead = *lead;
                    self.phase = if joint < 2 {
                        let search = StopSearch::new(joint + 1, -self.longest(joint + 1));
                        Phase::Seek { lead, joint: joint + 1, upper: false, search }
                    } else {
                        Phase::Rest { lead, seconds: 0.0 }
                    };
                }
                going(Step::SeekingStops, 0.3 + 0.2 * (joint as f64 + 0.9), activity)
            }
            Phase::Rest { lead, seconds } => {
                *seconds += instruments.period;
                lead.measure(instruments, sample);
                let activity = lead.activity(instruments, sample);
                if *seconds >= RESTING {
                    self.phase = Phase::ReadAgain { lead: *lead, reading: Reading::default() };
                }
                going(Step::ReadingEncoders, 0.95, activity)
            }
            Phase::ReadAgain { lead, reading } => {
                lead.measure(instruments, sample);
                let activity = lead.activity(instruments, sample);
                if !reading.step(instruments, sample) {
                    return going(Step::ReadingEncoders, 0.95, activity);
                }
                // The offsets are in the readings by now.
                let none = Vector4::zeros();
                // Stretch that is wrongly taken out is so in opposite directions at the two stops.
                let too_far = (self.met.0 + self.met.1 - self.stops.0 - self.stops.1) * 0.5;
                let joints = reading.joints(instruments, &none) - too_far;
                let zeros = reading.zeros(instruments, &none, &joints, self.configured);
                let range = (self.met.1 - self.met.0) - (self.stops.1 - self.stops.0);
                Ok(Break(self.findings(instruments, zeros, too_far, Some(range))))
            }
        }
    }

    /// How far a joint is led at most, rad.
    fn longest(&self, joint: usize) -> f64 {
        self.stops.1[joint] - self.stops.0[joint] + BEYOND
    }

    fn check_range(&self, joint: usize) -> Result<(), Obstacle> {
        let (found, expected) = (self.met.1[joint] - self.met.0[joint], self.stops.1[joint] - self.stops.0[joint]);
        let number = joint as u8;
        if found < expected - TOLERANCE {
            let (degrees, expected) = (found.to_degrees(), expected.to_degrees());
            return Err(Obstacle::EarlyStop { joint: number, degrees, expected });
        }
        if found > expected + TOLERANCE {
            return Err(Obstacle::NoStop { joint: number, degrees: found.to_degrees() });
        }
        Ok(())
    }

    /// The finger was in the configured pose when it was read.
    fn at_pose(&self, instruments: &Instruments, reading: &Reading, offset: &Vector4<f64>) -> Findings {
        let zeros = reading.zeros(instruments, offset, &self.pose, self.configured);
        self.findings(instruments, zeros, reading.joints(instruments, offset) - self.pose, None)
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
