//! The phases of identification.

use super::oscillating::Oscillating;
use super::pressing::Pressing;
use super::ranges::Ranges;
use super::shaking::{SWING, Shaking};
use super::tendon_stiffness::TendonStiffness;
use super::{Identification, Phase};
use crate::calibration::findings::{Findings, Identified};
use crate::calibration::instruments::Instruments;
use crate::calibration::joint_guide::JointGuide;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::{Progress, Sample, Step, Stepped};
use crate::calibration::stop_search::{BEYOND, StopSearch};
use crate::calibration::take_up::TakeUp;
use crate::control::signals::Activity;
use crate::control::spring::joint_hold::HOLDING_STIFFNESS;
use std::ops::ControlFlow::{Break, Continue};

/// A joint has returned when it is this close to its start, rad. The angle within which friction holds the joint is
/// added.
const NEAR: f64 = 0.05;
/// Torque limit of every joint that moves back and forth, N cm. The guide must hold the joints against the torques that
/// wrong gauge gains and the friction of pulleys cause.
const SHAKING: f64 = 12.0;
/// Distance that a joint keeps from its stops while it moves back and forth, in addition to its swing, rad.
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
        let guide = JointGuide::new(instruments, sample, SHAKING);
        self.start = guide.joints;
        self.phase = Phase::Shake { guide, shaking: self.shaking_near(&guide) };
        going(Step::MovingJoints, 0.0, guide.activity(instruments, sample))
    }

    pub(super) fn shake_joints(
        &mut self,
        mut guide: JointGuide,
        mut shaking: Shaking,
        instruments: &mut Instruments,
        sample: &Sample,
    ) -> Stepped {
        guide.measure(instruments, sample);
        let done = shaking.step(instruments, sample, &mut guide)?;
        let part = 0.02 + 0.4 * shaking.part();
        if !done {
            self.phase = Phase::Shake { guide, shaking };
            return going(Step::MovingJoints, part, guide.activity(instruments, sample));
        }
        self.free = shaking.joints.solve(instruments)?;
        self.motors = shaking.motors.solve(&self.free.gains)?;
        (self.joint_friction, self.motor_friction) = (shaking.joints, shaking.motors);
        instruments.gain = self.free.gains;
        if !Oscillating::possible(instruments) {
            return self.begin_search(part, instruments, sample);
        }
        let guide = JointGuide::new(instruments, sample, SHAKING);
        self.phase = Phase::Oscillate { guide, oscillating: Oscillating::new(instruments, &guide, shaking.centre) };
        going(Step::OscillatingTensions, part, guide.activity(instruments, sample))
    }

    pub(super) fn oscillate(
        &mut self,
        mut guide: JointGuide,
        mut oscillating: Oscillating,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        guide.measure(instruments, sample);
        let done = oscillating.step(instruments, sample, &mut guide);
        let part = 0.42 + 0.04 * oscillating.part();
        if !done {
            self.phase = Phase::Oscillate { guide, oscillating };
            return going(Step::OscillatingTensions, part, guide.activity(instruments, sample));
        }
        self.rotor_inertia = oscillating.inertia(instruments, &self.motors.ratio);
        self.begin_search(part, instruments, sample)
    }

    fn begin_search(&mut self, part: f64, instruments: &Instruments, sample: &Sample) -> Stepped {
        let guide = JointGuide::new(instruments, sample, self.torque + self.friction_torque(instruments));
        self.phase = self.search_of(0, guide);
        going(Step::SeekingStops, part, guide.activity(instruments, sample))
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
        self.phase = match found {
            None => Phase::Seek { guide, joint, search },
            Some(_) if joint < 2 => self.search_of(joint + 1, guide),
            Some(_) => Phase::Range { guide, ranges: Ranges::new(&self.stops, self.stops_known) },
        };
        going(Step::SeekingStops, 0.46 + 0.02 * joint as f64, guide.activity(instruments, sample))
    }

    pub(super) fn move_between_stops(
        &mut self,
        mut guide: JointGuide,
        mut ranges: Ranges,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        guide.measure(instruments, sample);
        let part = 0.52 + 0.13 * ranges.part();
        self.phase = match ranges.step(instruments, sample, &mut guide, self.speed, &self.motors.conduit)? {
            None => Phase::Range { guide, ranges },
            Some(arms) => {
                self.moment_arms = arms;
                Phase::Press { pressing: Pressing::new(instruments), stiffness: TendonStiffness::new(instruments) }
            }
        };
        going(Step::SeekingStops, part, guide.activity(instruments, sample))
    }

    pub(super) fn press_against_stops(
        &mut self,
        mut pressing: Pressing,
        mut stiffness: TendonStiffness,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        stiffness.add(instruments, sample, &self.motors.conduit, pressing.under_way());
        let part = 0.65 + 0.25 * pressing.part();
        if let Some(tensions) = pressing.step(instruments, &instruments.tensions(sample.feedback)) {
            self.phase = Phase::Press { pressing, stiffness };
            return going(Step::Pressing, part, Activity::Tense(instruments.for_controller(tensions)));
        }
        let found = self.identified(&stiffness.solve(instruments)?, instruments)?;
        // The finger still presses against its stops, so the return begins at its present pose.
        let guide = JointGuide::new(instruments, sample, self.torque + self.friction_torque(instruments));
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
            return Err(Obstacle::JointBlocked { joint: joint as u8, returning: true });
        }
        // Within this angle of its anchor, friction holds a joint against the spring of the guide.
        let held = self.friction_torque(instruments) / HOLDING_STIFFNESS;
        if (guide.joints[joint] - self.start[joint]).abs() < NEAR + held {
            if joint == 2 {
                return Ok(Break(Findings::Identified(found)));
            }
            joint += 1;
        }
        self.phase = Phase::Return { guide, joint, strained, found };
        going(Step::Returning, 0.95, guide.activity(instruments, sample))
    }

    /// Creates a motion about the present pose, or about the nearest one that leaves room for the swing.
    fn shaking_near(&self, guide: &JointGuide) -> Shaking {
        let room = SWING + ROOM;
        let (low, high) = (self.stops.0.add_scalar(room), self.stops.1.add_scalar(-room));
        Shaking::new(guide.joints.zip_zip_map(&low, &high, |joint, low, high| joint.min(high).max(low)))
    }

    /// Returns the largest torque with which the friction of joints and pulleys resists a motion at the pretension,
    /// N cm.
    fn friction_torque(&self, instruments: &Instruments) -> f64 {
        let pulleys = instruments.tendons.r.abs() * self.free.pulley.component_mul(&instruments.pretension);
        (self.free.coulomb + pulleys).max()
    }

    fn search_of(&self, joint: usize, guide: JointGuide) -> Phase {
        let range = self.stops.1[joint] - self.stops.0[joint];
        Phase::Seek { guide, joint, search: StopSearch::new(joint, -(range + BEYOND)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pages_give_the_torque_of_the_motion_back_and_forth() {
        for page in [include_str!("../../../docs/sun2xp.toml"), include_str!("../../../docs/calibration.md")] {
            assert!(page.contains(&format!("up to {SHAKING} N cm")));
        }
    }
}
