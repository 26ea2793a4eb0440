//! The first phases of zeroing, until the gauges are zeroed and the tendons are tight.

use super::gauge_zero::GaugeZero;
use super::swing::Swing;
use super::{Phase, Stepped, Zeroing, going};
use crate::calibration::instruments::Instruments;
use crate::calibration::joint_guide::JointGuide;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::{Progress, Sample, Step};
use crate::calibration::take_up::TakeUp;
use crate::control::signals::Activity;
use crate::model::configuration::ZeroingMethod;
use nalgebra::{Vector3, Vector4};
use std::ops::ControlFlow::{Break, Continue};

/// A finger is under control if every desired tension exceeds this part of t_min.
const PULLED: f64 = 0.3;

/// The result of a step that leaves the finger under its own controller.
fn as_before(part: f64) -> Stepped {
    Ok(Continue((None, Progress { step: Step::ReadingEncoders, part })))
}

impl Zeroing {
    pub(super) fn begin(&mut self, instruments: &Instruments, sample: &Sample) -> Stepped {
        if self.method == ZeroingMethod::Kept && !sample.zero_valid {
            return Err(Obstacle::NotKept);
        }
        self.phase = if sample.report.desired_tensions.min() > PULLED * instruments.minimum {
            Phase::Read
        } else {
            // The tendons must stay slack until the gauges are zeroed, because a controller that uses wrong tensions
            // would pull the finger away.
            Phase::Gauges(GaugeZero::new(None))
        };
        as_before(0.0)
    }

    pub(super) fn read_before(&mut self, instruments: &Instruments, sample: &Sample) -> Stepped {
        let mut first = self.first.unwrap_or_default();
        if first.step(instruments, sample, true) {
            if self.method == ZeroingMethod::Pose {
                first.still()?;
            }
            self.phase = Phase::Gauges(GaugeZero::new(Some(first.tensions())));
        }
        self.first = Some(first);
        as_before(0.1)
    }

    pub(super) fn zero_gauges(
        &mut self,
        mut gauges: GaugeZero,
        instruments: &mut Instruments,
        sample: &Sample,
    ) -> Stepped {
        let offset = match gauges.step(instruments, sample)? {
            Break(offset) => offset,
            Continue(activity) => {
                self.phase = Phase::Gauges(gauges);
                return going(Step::ZeroingGauges, 0.2, activity);
            }
        };
        self.offset = offset;
        instruments.offset = offset;
        match (self.method, self.first) {
            (ZeroingMethod::Kept, _) => Ok(Break(self.findings(instruments, self.configured, Vector3::zeros(), None))),
            (ZeroingMethod::Pose, Some(first)) => Ok(Break(self.at_pose(instruments, &first, &offset))),
            (ZeroingMethod::Pose, None) | (ZeroingMethod::Stops, _) => {
                self.phase = Phase::Tighten(TakeUp::new());
                going(Step::TakingUpSlack, 0.25, Activity::Turn(Vector4::zeros()))
            }
        }
    }

    pub(super) fn take_up_slack(&mut self, mut take_up: TakeUp, instruments: &Instruments, sample: &Sample) -> Stepped {
        if let Some(activity) = take_up.step(instruments, sample)? {
            self.phase = Phase::Tighten(take_up);
            return going(Step::TakingUpSlack, 0.25, activity);
        }
        let guide = JointGuide::new(instruments, sample, self.torque);
        if self.method == ZeroingMethod::Pose {
            self.phase = Phase::ReadHeld { guide, swing: Swing::new(instruments, self.torque) };
            return going(Step::TryingPose, 0.3, Activity::Tighten(instruments.offset));
        }
        self.phase = self.search_lower(0, guide);
        going(Step::SeekingStops, 0.3, guide.activity(instruments, sample))
    }
}
