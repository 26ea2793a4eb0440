//! Moves every joint from its lower to its upper stop and back while the others press against their lower stops, and
//! reads motor travel and tensions at each stop.

use super::moment_arms::{MomentArms, Rest};
use super::winding::Winding;
use crate::calibration::average::Average;
use crate::calibration::instruments::Instruments;
use crate::calibration::joint_guide::JointGuide;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::Sample;
use crate::calibration::stop_search::{BEYOND, StopSearch};
use nalgebra::{Vector3, Vector4};
use std::f64::consts::PI;

/// Duration of a reading, s.
const READING: f64 = 0.2;
/// Distance from the expected stop at which a joint slows down, rad. Farther away it moves faster by the factor
/// [`HASTE`].
const SLOW: f64 = 0.3;
const HASTE: f64 = 2.0;

#[derive(Clone, Copy, Debug)]
enum Stage {
    ReadLower,
    Up,
    ReadUpper,
    Down,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Ranges {
    stage: Stage,
    joint: usize,
    search: StopSearch,
    seconds: f64,
    travel: Average,
    tensions: Average,
    winding: Winding,
    /// Width of each joint's range, rad.
    width: Vector3<f64>,
    /// Whether every joint must have an upper stop.
    needed: bool,
    /// The readings; `None` if a joint has no upper stop.
    arms: Option<MomentArms>,
}

impl Ranges {
    /// `stops` are the configured angles of the lower and upper stops, rad. If `needed` is false, a joint
    /// without an upper stop ends the motion without a result.
    pub fn new(stops: &(Vector3<f64>, Vector3<f64>), needed: bool) -> Self {
        let width = stops.1 - stops.0;
        Self {
            stage: Stage::ReadLower,
            joint: 0,
            search: StopSearch::new(0, width[0] + BEYOND),
            seconds: 0.0,
            travel: Average::default(),
            tensions: Average::default(),
            winding: Winding::default(),
            width,
            needed,
            arms: Some(MomentArms::default()),
        }
    }

    /// Returns the part that is done, 0 to 1.
    pub fn part(&self) -> f64 {
        self.joint as f64 / 3.0
    }

    /// Runs one cycle of the motion. `conduit` is the friction of the conduits. When the motion is complete, returns
    /// the readings, or `Some(None)` if a joint has no upper stop.
    pub fn step(
        &mut self,
        instruments: &Instruments,
        sample: &Sample,
        guide: &mut JointGuide,
        speed: f64,
        conduit: &Vector4<f64>,
    ) -> Result<Option<Option<MomentArms>>, Obstacle> {
        let travel = instruments.travel(sample.feedback);
        let tensions = instruments.tensions(sample.feedback);
        self.winding.follow(&travel, &tensions, conduit, &instruments.compliance);
        self.press(guide);
        match self.stage {
            Stage::ReadLower | Stage::ReadUpper => {
                self.seconds += instruments.period;
                self.travel.add(travel);
                self.tensions.add(tensions);
                if self.seconds >= READING {
                    return Ok(self.read());
                }
            }
            Stage::Up | Stage::Down => {
                let gone = self.search.gone(guide);
                let speed = if gone < self.width[self.joint] - SLOW { HASTE * speed } else { speed };
                match (self.search.step(instruments, guide, speed), self.stage) {
                    (Ok(None), _) => {}
                    (Ok(Some(_)), Stage::Up) => self.stage = Stage::ReadUpper,
                    (Ok(Some(_)), _) => {
                        self.joint += 1;
                        self.stage = Stage::ReadLower;
                    }
                    (Err(Obstacle::NoStop { .. }), Stage::Up) if !self.needed => {
                        self.arms = None;
                        self.turn_back();
                    }
                    (Err(obstacle), _) => return Err(obstacle),
                }
            }
        }
        Ok(None)
    }

    /// Presses the joints at rest against their lower stops with the full torque. [`JointGuide`] pulls each joint
    /// toward an anchor. The anchors of the joints at rest are set anew in every cycle, because the measured angles of
    /// these joints drift while another joint moves: the moment arms are not known yet.
    fn press(&self, guide: &mut JointGuide) {
        let moving = match self.stage {
            Stage::ReadLower => None,
            Stage::Up | Stage::ReadUpper | Stage::Down => Some(self.joint),
        };
        for joint in (0..3).filter(|&joint| moving != Some(joint)) {
            let beyond = guide.joints[joint] - PI;
            guide.advance(joint, beyond, PI);
        }
    }

    /// Ends a reading, and begins the next motion. After the last reading, returns all of them.
    fn read(&mut self) -> Option<Option<MomentArms>> {
        let (travel, tensions) = (self.travel.mean(), self.tensions.mean());
        let rest = Rest { travel, tensions, winding: self.winding.friction };
        (self.travel, self.tensions, self.seconds) = (Average::default(), Average::default(), 0.0);
        if let Stage::ReadUpper = self.stage {
            if let Some(arms) = &mut self.arms {
                arms.upper[self.joint] = rest;
            }
            self.turn_back();
            return None;
        }
        if let Some(arms) = &mut self.arms {
            arms.lower[self.joint] = rest;
        }
        if self.joint == 3 || self.arms.is_none() {
            return Some(self.arms);
        }
        self.search = StopSearch::new(self.joint, self.width[self.joint] + BEYOND);
        self.stage = Stage::Up;
        None
    }

    fn turn_back(&mut self) {
        self.search = StopSearch::new(self.joint, -(self.width[self.joint] + 2.0 * BEYOND));
        self.stage = Stage::Down;
    }
}
