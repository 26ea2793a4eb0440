//! Zeros the encoders with the two stops of every joint.

use super::encoder_zero::Reading;
use super::swing::Swing;
use super::{Phase, Stepped, Zeroing, going};
use crate::calibration::instruments::Instruments;
use crate::calibration::joint_guide::JointGuide;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::{Sample, Step};
use crate::calibration::stop_search::{BEYOND, StopSearch};
use nalgebra::Vector4;
use std::f64::consts::PI;
use std::ops::ControlFlow::Break;

/// Largest permitted difference between the measured and the configured range of a joint, rad. A larger one means an
/// obstacle or a missing stop.
const TOLERANCE: f64 = 0.035;
/// A joint has returned when it is this close to the middle of its range, rad.
const NEAR: f64 = 0.05;
/// Time for the finger to come to rest before its counts are read, s.
const RESTING: f64 = 0.3;

impl Zeroing {
    pub(super) fn seek_stop(
        &mut self,
        mut guide: JointGuide,
        joint: usize,
        upper: bool,
        mut search: StopSearch,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        guide.measure(instruments, sample);
        self.phase = match search.step(instruments, &mut guide, self.speed)? {
            None => Phase::Seek { guide, joint, upper, search },
            Some(_) => Phase::ReadStop { guide, joint, upper, swing: Swing::new(instruments, self.torque) },
        };
        let part = 0.3 + 0.2 * (joint as f64 + if upper { 0.5 } else { 0.0 });
        going(Step::SeekingStops, part, guide.activity(instruments, sample))
    }

    pub(super) fn read_stop(
        &mut self,
        mut guide: JointGuide,
        joint: usize,
        upper: bool,
        mut swing: Swing,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        guide.measure(instruments, sample);
        let beyond = guide.joints[joint] + if upper { PI } else { -PI };
        guide.advance(joint, beyond, self.speed * instruments.period);
        let done = swing.step(instruments, sample, &mut guide);
        let part = 0.3 + 0.2 * (joint as f64 + if upper { 0.7 } else { 0.2 });
        let activity = guide.activity(instruments, sample);
        // The instruments have already subtracted the offsets of the gauges.
        let angle = swing.reading.joints(instruments, &Vector4::zeros())[joint];
        self.phase = match (done, upper) {
            (false, _) => Phase::ReadStop { guide, joint, upper, swing },
            (true, false) => {
                self.stops_found.0[joint] = angle;
                self.search_upper(joint, guide)
            }
            (true, true) => {
                self.stops_found.1[joint] = angle;
                self.check_range(joint)?;
                Phase::Return { guide, joint }
            }
        };
        going(Step::SeekingStops, part, activity)
    }

    pub(super) fn return_to_middle(
        &mut self,
        mut guide: JointGuide,
        joint: usize,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        let middle = 0.5 * (self.stops_found.0[joint] + self.stops_found.1[joint]);
        guide.measure(instruments, sample);
        guide.advance(joint, middle, self.speed * instruments.period);
        let arrived = (guide.joints[joint] - middle).abs() < NEAR;
        self.phase = match (arrived, joint) {
            (false, _) => Phase::Return { guide, joint },
            (true, 0 | 1) => self.search_lower(joint + 1, guide),
            (true, _) => Phase::Rest { guide, seconds: 0.0 },
        };
        going(Step::SeekingStops, 0.3 + 0.2 * (joint as f64 + 0.9), guide.activity(instruments, sample))
    }

    pub(super) fn rest(
        &mut self,
        mut guide: JointGuide,
        seconds: f64,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        let seconds = seconds + instruments.period;
        guide.measure(instruments, sample);
        self.phase = if seconds >= RESTING {
            Phase::ReadAgain { guide, reading: Reading::default() }
        } else {
            Phase::Rest { guide, seconds }
        };
        going(Step::ReadingEncoders, 0.95, guide.activity(instruments, sample))
    }

    pub(super) fn read_between_stops(
        &mut self,
        mut guide: JointGuide,
        mut reading: Reading,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        guide.measure(instruments, sample);
        if !reading.step(instruments, sample, true) {
            self.phase = Phase::ReadAgain { guide, reading };
            return going(Step::ReadingEncoders, 0.95, guide.activity(instruments, sample));
        }
        // The instruments have already subtracted the offsets of the gauges.
        let none = Vector4::zeros();
        // A wrong `tendon.stiffness` shifts the computed angles of the two stops of a joint in opposite directions, so
        // their mean is correct.
        let too_far = (self.stops_found.0 + self.stops_found.1 - self.stops.0 - self.stops.1) * 0.5;
        let joints = reading.joints(instruments, &none) - too_far;
        let zeros = reading.zeros(instruments, &none, &joints, self.configured);
        let range = (self.stops_found.1 - self.stops_found.0) - (self.stops.1 - self.stops.0);
        Ok(Break(self.findings(instruments, zeros, too_far, Some(range))))
    }

    pub(super) fn search_lower(&self, joint: usize, guide: JointGuide) -> Phase {
        Phase::Seek { guide, joint, upper: false, search: StopSearch::new(joint, -self.longest(joint)) }
    }

    fn search_upper(&self, joint: usize, guide: JointGuide) -> Phase {
        Phase::Seek { guide, joint, upper: true, search: StopSearch::new(joint, self.longest(joint)) }
    }

    /// Returns the largest distance that a joint may move in search of a stop, rad.
    fn longest(&self, joint: usize) -> f64 {
        self.stops.1[joint] - self.stops.0[joint] + BEYOND
    }

    fn check_range(&self, joint: usize) -> Result<(), Obstacle> {
        let (found, expected) =
            (self.stops_found.1[joint] - self.stops_found.0[joint], self.stops.1[joint] - self.stops.0[joint]);
        if (found - expected).abs() > TOLERANCE {
            let [degrees, expected] = [found, expected].map(f64::to_degrees);
            return Err(Obstacle::WrongRange { joint: joint as u8, degrees, expected });
        }
        Ok(())
    }
}
