//! The phases of identification.

use super::balance::{Balance, SWING};
use super::joint_friction::JointFriction;
use super::motor_friction::MotorFriction;
use super::pressing::Pressing;
use super::tendon_stiffness::TendonStiffness;
use super::{Identification, Phase};
use crate::calibration::findings::{Findings, Identified};
use crate::calibration::instruments::Instruments;
use crate::calibration::joint_guide::JointGuide;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::{Progress, Sample, Step, Stepped};
use crate::calibration::stop_search::StopSearch;
use crate::calibration::take_up::TakeUp;
use crate::control::signals::Activity;
use crate::model::configuration::GaugeReference;
use std::ops::ControlFlow::{Break, Continue};

/// A joint in search of its lower stop moves at most this far beyond its range, rad.
const BEYOND: f64 = 0.17;
/// A joint has returned when it is this close to its start, rad.
const NEAR: f64 = 0.05;
/// Torque limit of every joint while gauges are compared, N cm. The guide must hold the joints against the torques that
/// wrong gauge gains cause.
const BALANCING: f64 = 10.0;
/// Distance that a joint keeps from its stops while gauges are compared, in addition to its swing, rad.
const ROOM: f64 = 0.1;
/// A joint that returns to its start is blocked if its torque stays at the limit for this time, s.
const BLOCKED: f64 = 0.5;

/// The result of a step that continues with `activity`.
fn going(step: Step, part: f64, activity: Activity) -> Stepped {
    Ok(Continue((activity, Progress { step, part })))
}

impl Identification {
    pub(super) fn take_up_slack(&mut self, mut take_up: TakeUp, instruments: &Instruments, sample: &Sample) -> Stepped {
        if let Some(activity) = take_up.step(instruments, sample)? {
            self.phase = Phase::Tighten(take_up);
            return going(Step::TakingUpSlack, 0.0, activity);
        }
        let guide = JointGuide::new(instruments, sample, BALANCING);
        self.start = guide.joints;
        self.phase = Phase::Balance { guide, balance: self.balance_near(&guide) };
        going(Step::ComparingGauges, 0.0, guide.activity(instruments, sample))
    }

    pub(super) fn compare_gauges(
        &mut self,
        mut guide: JointGuide,
        mut balance: Balance,
        instruments: &mut Instruments,
        sample: &Sample,
    ) -> Stepped {
        guide.measure(instruments, sample);
        let found = balance.step(instruments, sample, &mut guide)?;
        let activity = guide.activity(instruments, sample);
        self.phase = match found {
            None => Phase::Balance { guide, balance },
            Some(gain) => {
                instruments.gain = gain;
                self.search_of(0, JointGuide::new(instruments, sample, self.torque))
            }
        };
        going(Step::ComparingGauges, 0.02, activity)
    }

    pub(super) fn seek_stop(
        &mut self,
        mut guide: JointGuide,
        joint: usize,
        mut search: StopSearch,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        guide.measure(instruments, sample);
        let found = search.step(instruments, &mut guide, self.speed)?;
        if let Some(angle) = found {
            self.stop[joint] = angle;
        }
        self.phase = match found {
            None => Phase::Seek { guide, joint, search },
            Some(_) if joint < 2 => self.search_of(joint + 1, guide),
            Some(_) => self.swing_of(0, guide),
        };
        going(Step::SeekingStops, 0.05 + 0.05 * joint as f64, guide.activity(instruments, sample))
    }

    pub(super) fn swing_joint(
        &mut self,
        mut guide: JointGuide,
        mut friction: JointFriction,
        joint: usize,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        guide.measure(instruments, sample);
        let found = friction.step(instruments, sample, &mut guide)?;
        if let Some((coulomb, viscous)) = found {
            self.joint_coulomb[joint] = coulomb;
            self.joint_viscous[joint] = viscous;
        }
        self.phase = match found {
            None => Phase::Swing { guide, friction, joint },
            Some(_) if joint < 2 => self.swing_of(joint + 1, guide),
            Some(_) => Phase::Press {
                pressing: Pressing::new(instruments),
                stiffness: TendonStiffness::new(instruments),
                friction: MotorFriction::new(),
            },
        };
        going(Step::MovingJoints, 0.2 + 0.1 * joint as f64, guide.activity(instruments, sample))
    }

    pub(super) fn press_against_stops(
        &mut self,
        mut pressing: Pressing,
        mut stiffness: TendonStiffness,
        mut friction: MotorFriction,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        if pressing.under_way() {
            stiffness.add(instruments, sample);
            friction.add(instruments, sample);
        }
        let part = 0.5 + 0.4 * pressing.part();
        if let Some(tensions) = pressing.step(instruments, &instruments.tensions(sample.feedback)) {
            self.phase = Phase::Press { pressing, stiffness, friction };
            return going(Step::Pressing, part, Activity::Tense(instruments.for_controller(tensions)));
        }
        let found = self.identified(&stiffness, &friction, instruments)?;
        let mut guide = JointGuide::new(instruments, sample, self.torque);
        // The finger still presses against its stops, so the return begins at its present pose.
        guide.anchor = guide.joints;
        self.phase = Phase::Return { guide, joint: 0, strained: 0.0, found };
        going(Step::Returning, 0.9, guide.activity(instruments, sample))
    }

    pub(super) fn return_to_start(
        &mut self,
        mut guide: JointGuide,
        mut joint: usize,
        strained: f64,
        found: Identified,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        guide.measure(instruments, sample);
        guide.advance(joint, self.start[joint], self.speed * instruments.period);
        let strained = if guide.strained(joint) { strained + instruments.period } else { 0.0 };
        if strained > BLOCKED {
            return Err(Obstacle::JointBlocked { joint: joint as u8 });
        }
        if (guide.joints[joint] - self.start[joint]).abs() < NEAR {
            if joint == 2 {
                return Ok(Break(Findings::Identified(found)));
            }
            joint += 1;
        }
        self.phase = Phase::Return { guide, joint, strained, found };
        going(Step::Returning, 0.95, guide.activity(instruments, sample))
    }

    /// Creates a comparison of the gauges about the present pose, or about the nearest one that leaves room for the
    /// swing.
    fn balance_near(&self, guide: &JointGuide) -> Balance {
        let room = SWING + ROOM;
        let (low, high) = (self.stops.0.add_scalar(room), self.stops.1.add_scalar(-room));
        Balance::new(guide.joints.zip_zip_map(&low, &high, |joint, low, high| joint.min(high).max(low)))
    }

    fn search_of(&self, joint: usize, guide: JointGuide) -> Phase {
        let range = self.stops.1[joint] - self.stops.0[joint];
        Phase::Seek { guide, joint, search: StopSearch::new(joint, -(range + BEYOND)) }
    }

    fn swing_of(&self, joint: usize, guide: JointGuide) -> Phase {
        Phase::Swing { guide, friction: JointFriction::new(joint, self.stop[joint]), joint }
    }

    /// Combines all results. The configured reference determines the mean of the gauge gains.
    fn identified(
        &self,
        stiffness: &TendonStiffness,
        friction: &MotorFriction,
        instruments: &Instruments,
    ) -> Result<Identified, Obstacle> {
        let (tendon_stiffness, travel_residual) = stiffness.solve()?;
        let [coulomb, conduit, ratio] = friction.solve()?;
        let found = Identified {
            tendon_stiffness,
            travel_residual,
            gauge_gain: instruments.gain,
            motor_coulomb: coulomb.component_mul(&instruments.radius),
            conduit,
            motor_ratio: ratio.map(f64::recip),
            joint_coulomb: self.joint_coulomb,
            joint_viscous: self.joint_viscous,
        };
        Ok(match self.reference {
            GaugeReference::Gauges => found,
            GaugeReference::Motors => found.scaled(ratio.mean()),
        })
    }
}
