//! Prediction of the part of the motors' disturbances that oscillates with the dither.
//!
//! The dither needs large pulls, because it accelerates the rotors. An error of a torque constant, of a rotor's inertia
//! or of a friction therefore causes a disturbance at the frequency of the dither. The observer finds a disturbance
//! with a delay of some cycles. A compensation that is so late leaves most of the oscillation. The oscillation moves
//! the joints, because the errors of the motors differ. But at a known frequency, the delay is a known phase, so the
//! disturbance can be predicted.

use super::full_rate::FULL_RATE;
use super::observer::TendonObserver;
use nalgebra::{Vector2, Vector4, Vector6};
use serde::{Deserialize, Serialize};

/// Time constant with which the oscillation of the disturbance is found, s. With 0.05 s, some fingers with amplifiers
/// that lag by 2 ms oscillate at walls.
const OSCILLATION: f64 = 0.15;
/// Time constant with which the mean of the disturbance is found, s.
const MEAN: f64 = 0.05;

/// Change of the phasors below which they count as steady.
const ACCURACY: f64 = 1e-12;
/// Largest number of cycles that are computed until the error of an observer is a steady oscillation.
const MOST_CYCLES: usize = 5000;

/// Largest magnitude of [`PeriodicDisturbance::lead`]. If the encoder or the gauge is much too coarse, the observer
/// hardly follows the oscillation, and the lead would be larger than this. Nothing is added then.
const LARGEST_LEAD: f64 = 3.0;

/// Fits d = mean + Re(D e^(j omega t)) to the disturbance that the observer of each motor estimates. Returns the
/// oscillation that will act in the next period minus the estimated oscillation.
///
/// If the returned difference were multiplied by a factor above 1, the joints would move less while the tip presses
/// against a wall. But the pull of a motor whose rotor is held would oscillate more and more.
#[derive(Clone, Debug)]
pub(super) struct PeriodicDisturbance {
    /// Real and imaginary part of e^(j omega T) / H - 1 for each motor. H is the phasor of the estimate divided by the
    /// phasor of the disturbance, and T is the period.
    lead: [Vector4<f64>; 2],
    /// Gains per cycle.
    oscillation: f64,
    mean: f64,
}

/// What is known of the disturbances, N.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(super) struct PeriodicDisturbanceState {
    mean: Vector4<f64>,
    /// Real part of D.
    cosines: Vector4<f64>,
    /// Imaginary part of D, with the opposite sign.
    sines: Vector4<f64>,
}

impl PeriodicDisturbance {
    /// `frequency` is omega in rad/s, and `rate` is in Hz.
    pub fn new(observers: &[TendonObserver; 4], frequency: f64, rate: f64) -> Self {
        // At 500 Hz, the delay is so long that some fingers with the stiffest joint springs oscillate if the
        // prediction is used.
        let leads: [Vector2<f64>; 4] = match rate < FULL_RATE {
            true => [Vector2::zeros(); 4],
            false => std::array::from_fn(|motor| lead(&observers[motor], frequency / rate)),
        };
        Self {
            lead: [Vector4::from_fn(|motor, _| leads[motor].x), Vector4::from_fn(|motor, _| leads[motor].y)],
            oscillation: 2.0 / (OSCILLATION * rate),
            mean: 1.0 / (MEAN * rate),
        }
    }

    /// Returns the state in which these disturbances, N, are constant.
    pub fn start(&self, disturbances: &Vector4<f64>) -> PeriodicDisturbanceState {
        PeriodicDisturbanceState { mean: *disturbances, ..PeriodicDisturbanceState::default() }
    }

    /// Returns what must be added to the estimated disturbances, N. `phase` contains the sine and the cosine of omega
    /// t.
    pub fn advance(
        &self,
        state: &mut PeriodicDisturbanceState,
        disturbances: &Vector4<f64>,
        phase: &Vector2<f64>,
    ) -> Vector4<f64> {
        let (sin, cos) = (phase.x, phase.y);
        let unknown = disturbances - state.mean - state.cosines * cos - state.sines * sin;
        state.mean += unknown * self.mean;
        state.cosines += unknown * (self.oscillation * cos);
        state.sines += unknown * (self.oscillation * sin);
        let [real, imaginary] = &self.lead;
        let cosines = real.component_mul(&state.cosines) + imaginary.component_mul(&state.sines);
        let sines = real.component_mul(&state.sines) - imaginary.component_mul(&state.cosines);
        cosines * cos + sines * sin
    }
}

/// Returns e^(j turn) / H - 1. `turn` is omega T, rad.
///
/// The observer expects a constant disturbance. So if the disturbance has the phasor 1, each prediction adds
/// e^(j turn) - 1 to the error. `error` converges to the phasor of the prediction error in the steady oscillation.
fn lead(observer: &TendonObserver, turn: f64) -> Vector2<f64> {
    const DISTURBANCE: usize = 4;
    let (correction, transition) = observer.error_transition();
    let step = transition * correction;
    let (sin, cos) = turn.sin_cos();
    let mut error = [Vector6::zeros(), Vector6::zeros()];
    for _ in 0..MOST_CYCLES {
        let [mut real, mut imaginary] = error.map(|part| step * part);
        real[DISTURBANCE] += cos - 1.0;
        imaginary[DISTURBANCE] += sin;
        let next = [real * cos + imaginary * sin, imaginary * cos - real * sin];
        let change = (next[0] - error[0]).amax().max((next[1] - error[1]).amax());
        error = next;
        if change < ACCURACY {
            break;
        }
    }
    let [real, imaginary] = error.map(|part| (correction * part)[DISTURBANCE]);
    let estimate = Vector2::new(1.0 - real, -imaginary);
    let quotient = Vector2::new(cos * estimate.x + sin * estimate.y, sin * estimate.x - cos * estimate.y);
    let lead = quotient / estimate.norm_squared() - Vector2::x();
    // The comparison is false for NaN, so a lead that is NaN becomes zero.
    if lead.norm() < LARGEST_LEAD { lead } else { Vector2::zeros() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::state_feedback::observer::{ElasticTendon, ObserverDesign};

    /// Hz.
    const RATE: f64 = 1000.0;
    /// rad/s.
    const FREQUENCY: f64 = 276.0;
    const TENDON: ElasticTendon = ElasticTendon { mass: 2.66, viscous: 8.9, stiffness: 3e4, home: 5.0 };

    fn observer() -> TendonObserver {
        let design = ObserverDesign {
            link: 1634.0,
            disturbance: 13e3,
            encoder_step: 1.5e-6,
            gauge_step: 0.024,
            gauge_noise: 0.03,
        };
        TendonObserver::new(TENDON, &design, 1.0 / RATE).expect("an observer")
    }

    /// Simulates a motor whose tendon is fixed, with a constant disturbance and one that oscillates by 1 N. Returns the
    /// largest errors of the estimate and of the prediction in the last 0.1 s, N, each compared with the disturbance in
    /// the middle of the next period. The simulation integrates in small steps, and does not use the observer's
    /// matrices.
    fn errors(constant: f64) -> (f64, f64) {
        let observer = observer();
        let periodic = PeriodicDisturbance::new(&std::array::from_fn(|_| observer.clone()), FREQUENCY, RATE);
        let mut state = periodic.start(&Vector4::zeros());
        let mut estimate = observer.start(0.0, TENDON.home);
        let (mut travel, mut speed) = (0.0f64, 0.0f64);
        let (mut of_estimate, mut of_prediction) = (0.0f64, 0.0f64);
        let disturbance = |time: f64| constant + (FREQUENCY * time + 0.3).cos();
        for cycle in 0..1500 {
            let time = f64::from(cycle) / RATE;
            observer.correct(&mut estimate, travel, TENDON.home + TENDON.stiffness * travel);
            observer.predict(&mut estimate, TENDON.home, 0.0);
            let estimated = observer.motion(&estimate, TENDON.home, 0.0).disturbance;
            let phase = Vector2::new((FREQUENCY * time).sin(), (FREQUENCY * time).cos());
            let added = periodic.advance(&mut state, &Vector4::repeat(estimated), &phase)[2];
            let next = disturbance(time + 1.5 / RATE);
            if cycle >= 1400 {
                of_estimate = of_estimate.max((estimated - next).abs());
                of_prediction = of_prediction.max((estimated + added - next).abs());
            }
            for step in 0..100 {
                let force = disturbance(time + f64::from(step) * 1e-5) - TENDON.stiffness * travel;
                speed += 1e-5 * (force - TENDON.viscous * speed) / TENDON.mass;
                travel += 1e-5 * speed;
            }
        }
        (of_estimate, of_prediction)
    }

    #[test]
    fn the_oscillation_of_the_next_period_is_predicted() {
        for constant in [0.0, -4.0] {
            let (of_estimate, of_prediction) = errors(constant);
            assert!(of_estimate > 0.9, "{of_estimate}");
            assert!(of_prediction < 0.02, "{of_prediction}");
        }
    }

    #[test]
    fn a_constant_disturbance_is_not_changed() {
        let periodic = PeriodicDisturbance::new(&std::array::from_fn(|_| observer()), FREQUENCY, RATE);
        let disturbances = Vector4::new(3.0, -2.0, 0.5, 0.0);
        let mut state = periodic.start(&disturbances);
        for cycle in 0..100 {
            let (sin, cos) = (FREQUENCY * f64::from(cycle) / RATE).sin_cos();
            assert_eq!(periodic.advance(&mut state, &disturbances, &Vector2::new(sin, cos)), Vector4::zeros());
        }
    }
}
