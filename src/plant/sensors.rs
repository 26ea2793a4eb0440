//! The sensors that the board reads: motor encoders and strain gauges.

use super::Plant;
use crate::model::configuration::ConfiguredFinger;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng;
use std::f64::consts::TAU;

/// Largest count of the 12-bit converter behind each gauge.
const GAUGE_FULL_SCALE: f64 = 4095.0;

/// Encoders and gauges of one finger. The same `simulation.seed` gives the same sequence of gauge noise.
#[derive(Clone, Debug)]
pub struct Sensors {
    /// Counts per radian, with the sign of the encoder.
    counts_per_radian: [f64; 4],
    encoder_zero: [i32; 4],
    newton_per_count: [f64; 4],
    gauge_zero: [f64; 4],
    /// Shown tension divided by the true one.
    gauge_gain: [f64; 4],
    /// Factor by which a defect changes each gauge's gain.
    rescaled: [f64; 4],
    /// Error of each gauge that does not depend on the tension, N.
    gauge_offset: [f64; 4],
    gauge_noise: f64,
    random: Pcg64,
    /// Constant count of each dead gauge.
    dead: [Option<u16>; 4],
    /// Current error of each gauge due to drift, N.
    drift: [f64; 4],
    /// Rate of each gauge's drift, N/s.
    drift_speed: [f64; 4],
    /// Error of each encoder, counts.
    jumped: [i32; 4],
    /// The gauge counts of the last reading.
    shown: [u16; 4],
}

impl Sensors {
    /// Constructs the sensors of `finger`.
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let encoder = &finger.encoder;
        Self {
            counts_per_radian: std::array::from_fn(|motor| {
                f64::from(encoder.sign[motor]) * f64::from(encoder.counts_per_revolution[motor]) / TAU
            }),
            encoder_zero: encoder.zero,
            newton_per_count: finger.gauge.newton_per_count,
            gauge_zero: finger.gauge.zero,
            gauge_gain: finger.simulation.gauge_gain_ratio,
            rescaled: [1.0; 4],
            gauge_offset: finger.simulation.gauge_offset,
            gauge_noise: finger.simulation.gauge_noise,
            random: Pcg64::seed_from_u64(finger.simulation.seed),
            dead: [None; 4],
            drift: [0.0; 4],
            drift_speed: [0.0; 4],
            jumped: [0; 4],
            shown: [0; 4],
        }
    }

    /// Kills a gauge. From now on it shows `count`, or the count of its last reading if `count` is `None`.
    pub fn kill_gauge(&mut self, gauge: usize, count: Option<u16>) {
        self.dead[gauge] = Some(count.unwrap_or(self.shown[gauge]));
    }

    /// Sets the gain of a gauge to `ratio` times its original value.
    pub fn rescale_gauge(&mut self, gauge: usize, ratio: f64) {
        self.rescaled[gauge] = ratio;
    }

    /// Makes a gauge drift at `speed`, N/s.
    pub fn let_gauge_drift(&mut self, gauge: usize, speed: f64) {
        self.drift_speed[gauge] = speed;
    }

    /// Adds `counts` to an encoder's count. A negative number removes counts.
    pub fn jump(&mut self, encoder: usize, counts: i32) {
        self.jumped[encoder] = self.jumped[encoder].wrapping_add(counts);
    }

    /// Repairs all sensors.
    pub fn repair(&mut self) {
        (self.dead, self.drift, self.drift_speed, self.jumped) = ([None; 4], [0.0; 4], [0.0; 4], [0; 4]);
        self.rescaled = [1.0; 4];
    }

    /// Advances the drift of the gauges by `seconds`.
    pub fn pass(&mut self, seconds: f64) {
        for gauge in 0..4 {
            self.drift[gauge] += self.drift_speed[gauge] * seconds;
        }
    }

    /// Reads all eight sensors: encoder counts (the inverse of eq. 28, rounded down) and gauge counts (0 to 4095, with
    /// noise).
    pub fn read(&mut self, plant: &Plant) -> ([i32; 4], [u16; 4]) {
        let (angles, tensions) = (plant.motor_angles(), plant.filtered_tensions());
        let motor_counts = std::array::from_fn(|motor| {
            let counts = (angles[motor] * self.counts_per_radian[motor]).floor();
            // The counter wraps around.
            self.encoder_zero[motor].wrapping_add(counts as i64 as i32).wrapping_add(self.jumped[motor])
        });
        let gauge_counts = std::array::from_fn(|tendon| {
            let noise: f64 = StandardNormal.sample(&mut self.random);
            let shown = self.rescaled[tendon] * self.gauge_gain[tendon] * tensions[tendon] + self.gauge_offset[tendon];
            let tension = shown + self.drift[tendon] + self.gauge_noise * noise;
            let counts = tension / self.newton_per_count[tendon] + self.gauge_zero[tendon];
            let counts = counts.round().clamp(0.0, GAUGE_FULL_SCALE) as u16;
            self.dead[tendon].unwrap_or(counts)
        });
        self.shown = gauge_counts;
        (motor_counts, gauge_counts)
    }
}
