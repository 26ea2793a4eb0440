//! Conversion of encoder counts to motor angles (eq. 28 of COINS TR 90-48), and of strain gauge counts to tensions.

use crate::control::number_checks::{positive, signs};
use crate::control::signals::{Feedback, Measured};
use crate::model::configuration::{ConfiguredFinger, Unusable};
use nalgebra::Vector4;
use std::f64::consts::TAU;

/// Scales, signs and zeros of the eight sensors.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SensorScales {
    /// The factor 2 pi / 2000 of eq. 28, with the configured counts per revolution instead of 2000, and with the sign
    /// of the encoder.
    radians_per_count: [f64; 4],
    /// m_0 of eq. 28.
    encoder_zero: [i32; 4],
    newton_per_count: [f64; 4],
    gauge_zero: [f64; 4],
}

impl SensorScales {
    pub fn new(finger: &ConfiguredFinger) -> Result<Self, Unusable> {
        let encoder = &finger.encoder;
        signs("encoder.sign", &encoder.sign)?;
        positive("encoder.counts_per_revolution", &encoder.counts_per_revolution.map(f64::from))?;
        // A negative scale belongs to a gauge whose count falls when the tendon tightens.
        positive("gauge.newton_per_count", &finger.gauge.newton_per_count.map(f64::abs))?;
        let radians_per_count = std::array::from_fn(|motor| {
            f64::from(encoder.sign[motor]) * TAU / f64::from(encoder.counts_per_revolution[motor])
        });
        Ok(Self {
            radians_per_count,
            encoder_zero: encoder.zero,
            newton_per_count: finger.gauge.newton_per_count,
            gauge_zero: finger.gauge.zero,
        })
    }

    /// Converts the counts of all eight sensors.
    #[inline]
    pub fn measured(&self, feedback: &Feedback) -> Measured {
        Measured { motor_angles: self.motor_angles(feedback), tensions: self.tensions(feedback) }
    }

    /// Returns m_theta of eq. 28, rad. It increases as the motor pulls its tendon in.
    #[inline]
    pub fn motor_angles(&self, feedback: &Feedback) -> Vector4<f64> {
        Vector4::from_fn(|motor, _| {
            // The wrapping difference is correct even if the counter has wrapped around.
            let counts = feedback.motor_counts[motor].wrapping_sub(self.encoder_zero[motor]);
            f64::from(counts) * self.radians_per_count[motor]
        })
    }

    /// Returns the tensions, N.
    #[inline]
    pub fn tensions(&self, feedback: &Feedback) -> Vector4<f64> {
        Vector4::from_fn(|tendon, _| {
            (f64::from(feedback.gauge_counts[tendon]) - self.gauge_zero[tendon]) * self.newton_per_count[tendon]
        })
    }
}
