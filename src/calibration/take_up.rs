//! Takes up the slack: applies the pretension without joint torque, with the gauge offsets known so far.

use super::instruments::Instruments;
use super::obstacle::Obstacle;
use super::step::Sample;
use crate::control::sensing::stillness::Stillness;
use crate::control::signals::Activity;
use nalgebra::Vector4;

/// A tendon counts as tight above this part of t_min.
const TIGHT: f64 = 0.8;
/// Time for which all tendons must be tight and all motors at rest, s.
const SETTLED: f64 = 0.3;
/// Time limit for taking up the slack, s.
const LIMIT: f64 = 5.0;

#[derive(Clone, Copy, Debug)]
pub(super) struct TakeUp {
    seconds: f64,
    settled: f64,
    stillness: Stillness,
}

impl TakeUp {
    pub fn new() -> Self {
        Self { seconds: 0.0, settled: 0.0, stillness: Stillness::new(Vector4::zeros()) }
    }

    /// Returns the activity, or `None` when all tendons have been tight and all motors at rest for [`SETTLED`]. After
    /// [`LIMIT`], returns `None` if the tendons are tight, and otherwise an error.
    pub fn step(&mut self, instruments: &Instruments, sample: &Sample) -> Result<Option<Activity>, Obstacle> {
        self.seconds += instruments.period;
        let tensions = instruments.tensions(sample.feedback);
        let angles = instruments.travel(sample.feedback).component_div(&instruments.radius);
        self.stillness.note(&angles, instruments.period);
        if tensions.min() >= TIGHT * instruments.minimum && self.stillness.at_rest() {
            self.settled += instruments.period;
        } else {
            self.settled = 0.0;
        }
        if self.settled >= SETTLED {
            return Ok(None);
        }
        if self.seconds > LIMIT {
            // Motors with much static friction may stick and slip without end, so they never count as at rest. Their
            // tendons can be tight nevertheless.
            if tensions.min() >= TIGHT * instruments.minimum {
                return Ok(None);
            }
            let tendon = sample.report.slackest;
            return Err(Obstacle::Slack { tendon: tendon as u8 + 1, newton: tensions[tendon] });
        }
        Ok(Some(Activity::Tighten(instruments.offset)))
    }
}
