//! Reads the encoders while all tensions rise and fall together.
//!
//! The friction of a conduit makes the tension on the motor's side larger than at the gauge after winding in, and
//! smaller after letting out. The gauge does not show the stretch that this difference causes. At rest, the direction
//! in which each tendon last slid is unknown, and a motor that sticks or trembles leaves the friction anywhere between
//! these two extremes. While the tensions rise, every tendon slides toward its motor, and while they fall, away from
//! it. The mean of both is free of the friction.

use super::encoder_zero::Reading;
use crate::calibration::instruments::Instruments;
use crate::calibration::joint_guide::JointGuide;
use crate::calibration::step::Sample;
use nalgebra::Vector3;

/// Rise of the common tension above the pretension, as a fraction of the pretension.
const RISE: f64 = 0.8;
/// Largest tension, as a fraction of t_max, or of the largest pull of the weakest motor if that is smaller.
const HARDEST: f64 = 0.6;
/// Duration of a rise or fall, s. The motors must not be so slow that they stick.
const RAMP: f64 = 0.3;
/// Number of rises. A fall follows each rise.
const ROUNDS: f64 = 3.0;
/// Only cycles with a common tension between these fractions of the rise contribute to the reading. At the beginning of
/// a rise or fall, a tendon may still stick.
const COUNTS: (f64, f64) = (0.25, 0.75);

#[derive(Clone, Copy, Debug)]
pub(super) struct Swing {
    /// Rise of the common tension, N.
    rise: f64,
    seconds: f64,
    pub reading: Reading,
}

impl Swing {
    /// `torque`: the largest torque of a joint while its tensions rise and fall, N cm.
    pub fn new(instruments: &Instruments, torque: f64) -> Self {
        let pushes = (0..6).map(|push| {
            let torques = Vector3::ith(push / 2, if push % 2 == 0 { torque } else { -torque });
            instruments.distribution.distribute(&torques).tensions.max()
        });
        let hardest = HARDEST * instruments.maximum.min(instruments.strongest);
        let room = (hardest - pushes.fold(0.0, f64::max)) / instruments.pretension.max();
        Self { rise: RISE.min(room).max(0.0) * instruments.minimum, seconds: 0.0, reading: Reading::swinging() }
    }

    /// Sets the common tension of `guide` for this cycle. Returns whether the reading is complete.
    pub fn step(&mut self, instruments: &Instruments, sample: &Sample, guide: &mut JointGuide) -> bool {
        self.seconds += instruments.period;
        let phase = (self.seconds / RAMP) % 2.0;
        let height = phase.min(2.0 - phase);
        self.reading.step(instruments, sample, (COUNTS.0..COUNTS.1).contains(&height));
        let done = self.seconds >= 2.0 * RAMP * ROUNDS;
        guide.common = if done { 0.0 } else { self.rise * height };
        done
    }
}
