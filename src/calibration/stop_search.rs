//! Moves one joint against a stop until it no longer moves.

use super::instruments::Instruments;
use super::joint_guide::JointGuide;
use super::obstacle::Obstacle;
use std::f64::consts::PI;

/// A joint in search of a stop moves by at most the width of its range plus this angle, rad. On the way back to the
/// lower stop after a search for the upper stop, it moves by at most the width plus twice this angle.
pub(super) const BEYOND: f64 = 0.17;
/// A joint at full torque counts as still while it stays within this angle of one position, rad.
const STILL: f64 = 0.004;
/// A joint is at its stop when it has been still for this time, s.
const DWELL: f64 = 0.25;

#[derive(Clone, Copy, Debug)]
pub(super) struct StopSearch {
    joint: usize,
    /// Largest permitted distance, rad, with the sign of its direction.
    range: f64,
    start: Option<f64>,
    /// Angle at which the joint became still, rad.
    still_at: f64,
    /// Time for which the joint has been still, s.
    still: f64,
}

impl StopSearch {
    /// `range`: the distance within which the joint must reach its stop, rad, with the sign of its direction.
    pub fn new(joint: usize, range: f64) -> Self {
        Self { joint, range, start: None, still_at: f64::NAN, still: 0.0 }
    }

    /// Returns how far the joint has moved, rad.
    pub fn gone(&self, guide: &JointGuide) -> f64 {
        self.start.map_or(0.0, |start| (guide.joints[self.joint] - start).abs())
    }

    /// Runs one cycle of the motion. When the joint has reached the stop, returns the angle of the stop, rad, computed
    /// with the configured zeros of the encoders.
    pub fn step(
        &mut self,
        instruments: &Instruments,
        guide: &mut JointGuide,
        speed: f64,
    ) -> Result<Option<f64>, Obstacle> {
        let angle = guide.joints[self.joint];
        let start = *self.start.get_or_insert(angle);
        guide.advance(self.joint, angle + PI.copysign(self.range), speed * instruments.period);
        if (angle - start).abs() > self.range.abs() {
            let degrees = (angle - start).abs().to_degrees();
            return Err(Obstacle::NoStop { joint: self.joint as u8, degrees });
        }
        if guide.strained(self.joint) && (angle - self.still_at).abs() < STILL {
            self.still += instruments.period;
        } else {
            (self.still, self.still_at) = (0.0, angle);
        }
        Ok((self.still >= DWELL).then_some(angle))
    }
}
