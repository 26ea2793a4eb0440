//! Determines the gains of the gauges relative to each other from the tensions of a free finger.
//!
//! Let t be the tensions that the gauges report, G their gains and g the torque of gravity. Then R G^-1 t = g +
//! friction. Gravity is the same at two levels of common tension in the same pose, so it cancels in the difference
//! between them. Friction cancels in the mean of two motions in opposite directions. So t_high - t_low is parallel to
//! G n, with n the null vector of R. This gives G up to a common factor. The tensions of a free finger do not show this
//! factor.

use crate::calibration::average::Average;
use crate::calibration::instruments::Instruments;
use crate::calibration::joint_guide::JointGuide;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::Sample;
use crate::model::Part;
use nalgebra::{Vector3, Vector4};

/// Amplitude of the joint motion to either side, rad.
pub(super) const SWING: f64 = 0.15;
/// Speed of the joint motion, rad/s.
const SPEED: f64 = 0.3;
/// Samples are ignored for this time after every change of direction, s.
const RUN_UP: f64 = 0.4;
/// The tension of the higher level in the tendon with the largest pretension, as a fraction of t_max.
const HIGH: f64 = 0.4;
/// Rate at which the common tension changes, N/s.
const RISING: f64 = 10.0;
/// Smallest plausible factor of a gauge, relative to the mean factor.
const LEAST: f64 = 0.5;
/// Largest plausible factor of a gauge, relative to the mean factor.
const MOST: f64 = 2.0;
/// A joint is blocked if its torque stays at the limit for this time, s.
const BLOCKED: f64 = 0.5;

#[derive(Clone, Copy, Debug)]
pub(super) struct Balance {
    centre: Vector3<f64>,
    /// 0: to one side. 1 and 2: to the other side and back. 3: to the same side while the tension rises to the higher
    /// level. 4 and 5: to the other side and back at that level.
    leg: usize,
    seconds: f64,
    strained: f64,
    /// Mean tensions of each measured leg, N.
    low: [Average; 2],
    high: [Average; 2],
}

impl Balance {
    /// Creates a comparison about the pose `centre`, rad, which must leave room of [`SWING`] on both sides.
    pub fn new(centre: Vector3<f64>) -> Self {
        let none = [Average::default(); 2];
        Self { centre, leg: 0, seconds: 0.0, strained: 0.0, low: none, high: none }
    }

    /// Runs one cycle of the motion. When done, returns the factors for the gauges' tensions. The mean of the factors
    /// is 1.
    pub fn step(
        &mut self,
        instruments: &Instruments,
        sample: &Sample,
        guide: &mut JointGuide,
    ) -> Result<Option<Vector4<f64>>, Obstacle> {
        self.seconds += instruments.period;
        let high = self.leg >= 3;
        let level = if high {
            (HIGH * instruments.maximum / instruments.pretension.max() - 1.0) * instruments.minimum
        } else {
            0.0
        };
        let rise = RISING * instruments.period;
        guide.common += (level - guide.common).clamp(-rise, rise);
        // Leg 0 of each level only moves the finger to the start of leg 1.
        let leg = self.leg % 3;
        let target = self.centre.add_scalar(if leg == 1 { -SWING } else { SWING });
        (0..3).for_each(|joint| guide.advance(joint, target[joint], SPEED * instruments.period));
        let there = guide.anchor == target && guide.common == level;
        if leg > 0 && self.seconds > RUN_UP && !there {
            let averages = if high { &mut self.high } else { &mut self.low };
            averages[leg - 1].add(instruments.tensions(sample.feedback));
        }
        let blocked = (0..3).find(|&joint| guide.strained(joint));
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
