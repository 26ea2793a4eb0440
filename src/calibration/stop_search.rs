//! One joint led against a stop until it no longer moves.

use super::instruments::Instruments;
use super::joint_lead::JointLead;
use super::obstacle::Obstacle;
use std::f64::consts::PI;

/// A joint is at its stop when it has moved less than this, rad, at full torque for so long, s.
const STILL: f64 = 0.004;
const DWELL: f64 = 0.25;

#[derive(Clone, Copy, Debug)]
pub(super) struct StopSearch {
    joint: usize,
    /// Farthest way, rad, signed.
    way: f64,
    start: Option<f64>,
    /// Where the joint began to be still, and for how long.
    still_at: f64,
    still: f64,
}

impl StopSearch {
    /// `way`: how far the joint may go before it must have met its stop, rad, with its direction.
    pub fn new(joint: usize, way: f64) -> Self {
        Self { joint, way, start: None, still_at: f64::NAN, still: 0.0 }
    }

    /// Leads on; the angle of the stop, rad by the configured zero, when it is met.
    pub fn step(
        &mut self,
        instruments: &Instruments,
        lead: &mut JointLead,
        speed: f64,
    ) -> Result<Option<f64>, Obstacle> {
        let angle = lead.joints[self.joint];
        let start = *self.start.get_or_insert(angle);
        lead.advance(self.joint, angle + PI.copysign(self.way), speed * instruments.period);
        if (angle - start).abs() > self.way.abs() {
            let degrees = (angle - start).abs().to_degrees();
            return Err(Obstacle::NoStop { joint: self.joint as u8, degrees });
        }
        if lead.strained(self.joint) && (angle - self.still_at).abs() < STILL {
            self.still += instruments.period;
        } else {
            (self.still, self.still_at) = (0.0, angle);
        }
        Ok((self.still >= DWELL).then_some(angle))
    }
}
