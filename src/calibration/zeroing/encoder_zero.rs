//! Computes the encoder zeros (m_0 of eq. 28 of COINS TR 90-48) from one known pose.

use super::standstill::Standstill;
use crate::calibration::average::Average;
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::Sample;
use nalgebra::{Vector3, Vector4};

/// Duration of a reading, s.
const READING: f64 = 0.3;
/// Time constant of the check that the joints stand still while the tensions rise and fall, s.
const SWINGING: f64 = 0.1;

/// Averages counts and tensions of a finger at rest.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Reading {
    seconds: f64,
    travel: Average,
    tensions: Average,
    standstill: Standstill,
}

impl Reading {
    /// Creates a reading during which the tensions rise and fall. Motors may tremble then. The mean values of the
    /// reading are free of this motion, so the check that the joints stand still filters it out with the longer time
    /// constant [`SWINGING`].
    pub fn swinging() -> Self {
        Self { standstill: Standstill::new(SWINGING), ..Self::default() }
    }

    /// Adds one cycle. Only cycles for which `counts` is true contribute to the means. Returns whether the time of a
    /// reading at rest is over.
    pub fn step(&mut self, instruments: &Instruments, sample: &Sample, counts: bool) -> bool {
        self.seconds += instruments.period;
        let (travel, tensions) = (instruments.travel(sample.feedback), instruments.tensions(sample.feedback));
        if counts {
            self.travel.add(travel);
            self.tensions.add(tensions);
        }
        self.standstill.note(&instruments.joints(&travel, &tensions), instruments.period);
        self.seconds >= READING
    }

    /// Returns an error if the finger moved during the reading.
    pub fn still(&self) -> Result<(), Obstacle> {
        match self.standstill.moved() {
            None => Ok(()),
            Some((joint, distance)) => Err(Obstacle::Moved { joint: joint as u8, degrees: distance.to_degrees() }),
        }
    }

    /// Returns the mean tensions, N, with the offsets known at the time of the reading.
    pub fn tensions(&self) -> Vector4<f64> {
        self.tensions.mean()
    }

    /// Returns the joint angles, rad, computed with the configured zeros of the encoders. `offset` is the error of the
    /// measured tensions, N, which was determined after the reading.
    pub fn joints(&self, instruments: &Instruments, offset: &Vector4<f64>) -> Vector3<f64> {
        instruments.joints(&self.travel.mean(), &(self.tensions() - offset))
    }

    /// Returns the encoder zeros with which this reading gives the joint angles `joints`, rad. `configured` contains
    /// the zeros of the configuration.
    pub fn zeros(
        &self,
        instruments: &Instruments,
        offset: &Vector4<f64>,
        joints: &Vector3<f64>,
        configured: [i32; 4],
    ) -> [i32; 4] {
        let too_far = self.travel.mean() - instruments.travel_at(joints, &(self.tensions() - offset));
        // A counter rounds down to whole counts, so its count is half a count too low on average.
        let counts = too_far.component_div(&instruments.cm_per_count()).add_scalar(0.5);
        std::array::from_fn(|motor| configured[motor].wrapping_add(counts[motor].round() as i32))
    }
}
