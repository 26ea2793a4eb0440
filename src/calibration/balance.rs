//! Gains of the gauges relative to each other: the tensions of a free finger lie along the null vector of R.
//!
//! R G^-1 t = g + friction, with what the gauges show t, their gains G and gravity g. At two levels of common tension,
//! in the same poses, g is the same and falls out of the difference; friction falls out of the mean of two ways in
//! opposite directions. So t_high - t_low is along G n, n the null vector. That tells G but for one common factor,
//! which no free finger shows.

use super::average::Average;
use super::instruments::Instruments;
use super::joint_lead::JointLead;
use super::obstacle::Obstacle;
use super::step::Sample;
use crate::model::Part;
use nalgebra::{Vector3, Vector4};

/// How far the joints are led to both sides, rad, and how fast, rad/s.
pub(super) const SWING: f64 = 0.15;
const SPEED: f64 = 0.3;
/// Left out after every change of direction, s.
const RUN_UP: f64 = 0.4;
/// The higher level: part of t_max in the tendon that pulls most. Rising, N/s.
const HIGH: f64 = 0.4;
const RISING: f64 = 10.0;
/// Gauges do not differ by more.
const LEAST: f64 = 0.5;
const MOST: f64 = 2.0;
/// A joint that pulls at its limit for so long is blocked, s.
const BLOCKED: f64 = 0.5;

#[derive(Clone, Copy, Debug)]
pub(super) struct Balance {
    centre: Vector3<f64>,
    /// 0: to one side and up in tension; 1 and 2: to and fro; the same again at the higher level.
    leg: usize,
    seconds: f64,
    strained: f64,
    /// N, of each leg that is measured.
    low: [Average; 2],
    high: [Average; 2],
}

impl Balance {
    /// About `centre`, rad, which must have room of [`SWING`] to both sides.
    pub fn new(centre: Vector3<f64>) -> Self {
        let none = [Average::default(); 2];
        Self { centre, leg: 0, seconds: 0.0, strained: 0.0, low: none, high: none }
    }

    /// Leads the joints on; what the gauges' newtons must be multiplied by, with a mean of 1, when done.
    pub fn step(
        &mut self,
        instruments: &Instruments,
        sample: &Sample,
        lead: &mut JointLead,
    ) -> Result<Option<Vector4<f64>>, Obstacle> {
        self.seconds += instruments.period;
        let high = self.leg >= 3;
        let level = if high {
            (HIGH * instruments.maximum / instruments.pretension.max() - 1.0) * instruments.minimum
        } else {
            0.0
        };
        let rise = RISING * instruments.period;
        lead.common += (level - lead.common).clamp(-rise, rise);
        // 0: the run-up to a level.
        let way = self.leg % 3;
        let target = self.centre.add_scalar(if way == 1 { -SWING } else { SWING });
        (0..3).for_each(|joint| lead.advance(joint, target[joint], SPEED * instruments.period));
        let there = lead.anchor == target && lead.common == level;
        if way > 0 && self.seconds > RUN_UP && !there {
            let averages = if high { &mut self.high } else { &mut self.low };
            averages[way - 1].add(instruments.tensions(sample.feedback));
        }
        let blocked = (0..3).find(|&joint| lead.strained(joint));
        self.strained = if blocked.is_some() { self.strained + instruments.period } else { 0.0 };
        if let Some(joint) = blocked.filter(|_| self.strained > BLOCKED) {
            return Err(Obstacle::JointBlocked { joint: joint as u8 });
        }
        if there {
            (self.leg, self.seconds) = (self.leg + 1, 0.0);
        }
        if self.leg < 6 {
            return Ok(None);
        }
        let mean = |averages: &[Average; 2]| (averages[0].mean() + averages[1].mean()) * 0.5;
        let rise = mean(&self.high) - mean(&self.low);
        let gains = instruments.pretension.component_div(&rise);
        let gains = gains / gains.mean();
        match gains.iter().position(|gain| !(LEAST..MOST).contains(gain)) {
            Some(index) => {
                let what = "the gain, relative to the other gauges,";
                Err(Obstacle::Implausible { part: Part::gauge(index), what, value: 1.0 / gains[index] })
            }
            None => Ok(Some(gains)),
        }
    }
}
