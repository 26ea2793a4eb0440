//! Observer of one tendon. It estimates what encoder and gauge do not measure: the speeds of motor side and joint side,
//! and the disturbance of the motor.

use super::matrix_exponential::exponential;
use nalgebra::{Matrix2, Matrix2x6, Matrix6, Matrix6x2, Vector2, Vector6};
use serde::{Deserialize, Serialize};

/// Largest number of steps of the Riccati recursion.
const MOST_STEPS: usize = 20_000;
/// Relative change of the gain at which the Riccati recursion ends.
const STEADY: f64 = 1e-10;

/// Number of samples after a lost reply for which separate gains are used.
const RECOVERY: usize = 8;

/// One tendon between its motor and the joints, in SI units at the tendon. The inertia J of the rotor is expressed as
/// the mass J/r^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ElasticTendon {
    /// m: mass of the rotor, kg.
    pub mass: f64,
    /// b: viscous friction of the motor, N s/m.
    pub viscous: f64,
    /// k: stiffness of the tendon, N/m.
    pub stiffness: f64,
    /// Tension at which the encoder is zeroed, N.
    pub home: f64,
}

/// Bandwidths of an observer, and accuracy of its sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ObserverDesign {
    /// Bandwidth of the joint side, rad/s.
    pub link: f64,
    /// Bandwidth of the disturbance, rad/s.
    pub disturbance: f64,
    /// Size of an encoder count, m of tendon.
    pub encoder_step: f64,
    /// Size of a gauge count, N.
    pub gauge_step: f64,
    /// Noise of the gauge, N rms.
    pub gauge_noise: f64,
}

/// A Kalman filter with a fixed gain for the state x = (mu, v, lambda, w, d, a):
///
/// mu' = v, v' = (u - t_home + d - k (mu - lambda) - b v) / m, lambda' = w, w' = a, a' = jerk + noise, d' = noise.
///
/// The measurements are mu and t - t_home = k (mu - lambda). mu = r m_theta is the travel of the motor, and lambda =
/// R^T theta is the travel of the joint side. u is the pull, and d is the additional force on the motor.
///
/// The links are described only by a triple integrator, and not by a model of their dynamics. A model of any part of
/// the dynamics would interpret an external force as motion, and the damper of the controller would permanently oppose
/// that motion. Without the state a, lambda would lag, and k times the lag would act as an additional mass.
#[derive(Clone, Debug)]
pub(crate) struct TendonObserver {
    tendon: ElasticTendon,
    transition: Matrix6<f64>,
    from_force: Vector6<f64>,
    from_jerk: Vector6<f64>,
    gain: Matrix6x2<f64>,
    /// Gains of the samples after a lost reply.
    recovery: [Matrix6x2<f64>; RECOVERY],
}

/// The estimate of an observer.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(crate) struct TendonEstimate {
    x: Vector6<f64>,
    /// Samples since the last lost reply. The count stops at [`RECOVERY`].
    since_loss: usize,
}

/// Motion of a tendon, SI units.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TendonMotion {
    /// Tension, N.
    pub tension: f64,
    /// v: speed of the motor side, m/s.
    pub motor_speed: f64,
    /// lambda: travel of the joint side, m.
    pub travel: f64,
    /// w: speed of the joint side, m/s.
    pub speed: f64,
    /// d: disturbance of the motor, N.
    pub disturbance: f64,
}

impl TendonObserver {
    /// Discretises the model over `period` (s) and iterates the Riccati equation to its fixed point. Returns None if
    /// the parameters differ so much in size that there is no finite fixed point.
    pub fn new(tendon: ElasticTendon, design: &ObserverDesign, period: f64) -> Option<Self> {
        let ElasticTendon { mass, viscous, stiffness, .. } = tendon;
        let mut rates = Matrix6::zeros();
        (rates[(0, 1)], rates[(2, 3)], rates[(3, 5)]) = (1.0, 1.0, 1.0);
        rates[(1, 0)] = -stiffness / mass;
        rates[(1, 1)] = -viscous / mass;
        rates[(1, 2)] = stiffness / mass;
        rates[(1, 4)] = 1.0 / mass;
        let (transition, integral) = exponential(&rates, period);
        let (half, _) = exponential(&rates, period / 2.0);
        let measured = measured(stiffness);

        // A uniform distribution has the variance width^2 / 12.
        let encoder = design.encoder_step.powi(2) / 12.0;
        let gauge = design.gauge_step.powi(2) / 12.0 + design.gauge_noise.powi(2);
        let noise = Matrix2::new(encoder, 0.0, 0.0, gauge);
        // For n integrators in series, a bandwidth w needs the noise density w^(2n) r T, with the variance r of the
        // sensor and the period T.
        let mut density = Matrix6::zeros();
        density[(5, 5)] = design.link.powi(6) * (encoder + gauge / (stiffness * stiffness)) * period;
        density[(4, 4)] = design.disturbance.powi(2) * gauge * period;
        // Integral over one period by Simpson's rule.
        let middle = half * density * half.transpose() * 4.0;
        let driven = (density + middle + transition * density * transition.transpose()) * (period / 6.0);

        let gain_of = |covariance: &Matrix6<f64>| {
            let innovation = measured * covariance * measured.transpose() + noise;
            covariance * measured.transpose() * inverse(&innovation)
        };
        let predicted = |covariance: &Matrix6<f64>| {
            let next = transition * covariance * transition.transpose() + driven;
            (next + next.transpose()) * 0.5
        };
        let mut covariance = driven * 100.0;
        let mut gain = gain_of(&covariance);
        for _ in 0..MOST_STEPS {
            covariance = predicted(&(covariance - gain * measured * covariance));
            let next = gain_of(&covariance);
            let changed = (next - gain).zip_map(&next, |change, value| change.abs() - STEADY * value.abs()).max();
            gain = next;
            if changed <= 0.0 {
                break;
            }
        }
        // After a lost reply there is a prediction without a correction.
        covariance = predicted(&covariance);
        let recovery = std::array::from_fn(|_| {
            let gain = gain_of(&covariance);
            covariance = predicted(&(covariance - gain * measured * covariance));
            gain
        });
        let from_force = integral.column(1) / mass;
        let finite = |gain: &Matrix6x2<f64>| gain.iter().all(|entry| entry.is_finite());
        let usable = finite(&gain) && recovery.iter().all(finite);
        let from_jerk = integral.column(5).into();
        usable.then_some(Self { tendon, transition, from_force, from_jerk, gain, recovery })
    }

    /// Returns the estimate of a tendon at rest, from the travel of the motor, m, and the tension, N.
    pub fn start(&self, motor_travel: f64, tension: f64) -> TendonEstimate {
        let stretch = (tension - self.tendon.home) / self.tendon.stiffness;
        let x = Vector6::new(motor_travel, 0.0, motor_travel - stretch, 0.0, 0.0, 0.0);
        TendonEstimate { x, since_loss: RECOVERY }
    }

    /// Continues from the estimate of another observer of the same tendon. The motor travel of this observer is `ratio`
    /// times the motor travel of the other. The motor angle and the tension are kept, even if the two observers have
    /// different stiffness or homing pretension.
    pub fn take_over(&self, previous: &Self, estimate: &mut TendonEstimate, ratio: f64) {
        let tension = previous.tension(&estimate.x);
        estimate.x[0] *= ratio;
        estimate.x[1] *= ratio;
        estimate.x[2] = estimate.x[0] - (tension - self.tendon.home) / self.tendon.stiffness;
    }

    /// Corrects the estimate with the measured travel of the motor, m, and tension, N.
    pub fn correct(&self, estimate: &mut TendonEstimate, motor_travel: f64, tension: f64) {
        let error = Vector2::new(motor_travel - estimate.x[0], tension - self.tension(&estimate.x));
        let gain = self.recovery.get(estimate.since_loss).unwrap_or(&self.gain);
        estimate.x += gain * error;
        estimate.since_loss = estimate.since_loss.saturating_add(1).min(RECOVERY);
    }

    /// Continues without a measurement. The acceleration is set to zero, because its estimate is too uncertain.
    pub fn miss(&self, estimate: &mut TendonEstimate) {
        estimate.x[5] = 0.0;
        estimate.since_loss = 0;
    }

    /// Predicts the next sample from the pull (N) that acts until then and the expected jerk of the travel, m/s^3.
    pub fn predict(&self, estimate: &mut TendonEstimate, pull: f64, jerk: f64) {
        estimate.x = self.transition * estimate.x + self.from_force * (pull - self.tendon.home) + self.from_jerk * jerk;
    }

    /// Returns the motion `offset` seconds after the estimate, under the same pull.
    pub fn motion(&self, estimate: &TendonEstimate, pull: f64, offset: f64) -> TendonMotion {
        let x = &estimate.x;
        let force = pull + x[4] - self.tension(x);
        let motor_acceleration = force / self.tendon.mass;
        let motor_travel = x[0] + offset * (x[1] + 0.5 * offset * motor_acceleration);
        let travel = x[2] + offset * (x[3] + 0.5 * offset * x[5]);
        TendonMotion {
            tension: self.tendon.home + self.tendon.stiffness * (motor_travel - travel),
            motor_speed: x[1] + offset * motor_acceleration,
            travel,
            speed: x[3] + offset * x[5],
            disturbance: x[4],
        }
    }

    /// Returns lambda of the estimate, m.
    pub fn travel(&self, estimate: &TendonEstimate) -> f64 {
        estimate.x[2]
    }

    /// Returns 1 - K C and A. K is the gain, C converts a state to the measurements, and A is the transition of the
    /// state in one period. The error of a prediction times 1 - K C is the error of the corrected estimate, and the
    /// error of the estimate times A is the error of the next prediction.
    pub fn error_transition(&self) -> (Matrix6<f64>, Matrix6<f64>) {
        (Matrix6::identity() - self.gain * measured(self.tendon.stiffness), self.transition)
    }

    fn tension(&self, x: &Vector6<f64>) -> f64 {
        self.tendon.home + self.tendon.stiffness * (x[0] - x[2])
    }
}

/// Returns C, which converts a state to the measurements.
fn measured(stiffness: f64) -> Matrix2x6<f64> {
    Matrix2x6::new(1.0, 0.0, 0.0, 0.0, 0.0, 0.0, stiffness, 0.0, -stiffness, 0.0, 0.0, 0.0)
}

/// Returns the inverse of a positive definite matrix. The measurement noise keeps its determinant above zero.
fn inverse(matrix: &Matrix2<f64>) -> Matrix2<f64> {
    Matrix2::new(matrix.m22, -matrix.m12, -matrix.m21, matrix.m11) / matrix.determinant()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TENDON: ElasticTendon = ElasticTendon { mass: 2.66, viscous: 8.9, stiffness: 3e4, home: 5.0 };

    fn design(disturbance: f64) -> ObserverDesign {
        ObserverDesign { link: 2000.0, disturbance, encoder_step: 1.5e-6, gauge_step: 0.024, gauge_noise: 0.03 }
    }

    /// Simulates a motor that pulls a joint at rest with 20 N, of which friction takes 3 N. Returns the tension and d
    /// that the observer finds. The simulation integrates in small steps, independent of the observer's matrices.
    fn found(disturbance: f64) -> (f64, f64) {
        let observer = TendonObserver::new(TENDON, &design(disturbance), 1e-3).expect("an observer");
        let (mut travel, mut speed) = (0.0f64, 0.0f64);
        let mut estimate = observer.start(0.0, TENDON.home);
        for _ in 0..1000 {
            let tension = TENDON.home + TENDON.stiffness * travel;
            observer.correct(&mut estimate, travel, tension);
            observer.predict(&mut estimate, 20.0, 0.0);
            for _ in 0..1000 {
                let tension = TENDON.home + TENDON.stiffness * travel;
                // The viscous friction is higher than the observer's, so that the motor comes to rest.
                speed += 1e-6 * (20.0 - 3.0 - tension - 200.0 * speed) / TENDON.mass;
                travel += 1e-6 * speed;
            }
        }
        let motion = observer.motion(&estimate, 20.0, 0.0);
        (motion.tension, motion.disturbance)
    }

    #[test]
    fn the_observer_finds_the_friction_of_the_motor() {
        let (tension, disturbance) = found(200.0);
        assert!((tension - 17.0).abs() < 1e-3, "{tension}");
        assert!((disturbance + 3.0).abs() < 1e-2, "{disturbance}");
        // Without the state d, the observer attributes the friction to the tension.
        let (tension, disturbance) = found(0.0);
        assert!((tension - 17.0).abs() > 0.01 && disturbance.abs() < 1e-6, "{tension} {disturbance}");
    }

    #[test]
    fn the_gain_after_a_lost_reply_returns_to_the_steady_gain() {
        let observer = TendonObserver::new(TENDON, &design(200.0), 1e-3).expect("an observer");
        let apart = |gain: &Matrix6x2<f64>| (gain - observer.gain).component_div(&observer.gain).amax();
        assert!(apart(&observer.recovery[0]) > 0.1);
        assert!(apart(&observer.recovery[RECOVERY - 1]) < 0.1 * apart(&observer.recovery[0]));
    }

    #[test]
    fn constant_motion_is_followed_without_lag() {
        let observer = TendonObserver::new(TENDON, &design(200.0), 1e-3).expect("an observer");
        let mut estimate = observer.start(0.0, TENDON.home);
        for cycle in 0..2000 {
            let travel = 0.05 * 1e-3 * f64::from(cycle);
            observer.correct(&mut estimate, travel, TENDON.home);
            observer.predict(&mut estimate, TENDON.home + TENDON.viscous * 0.05, 0.0);
        }
        let motion = observer.motion(&estimate, TENDON.home + TENDON.viscous * 0.05, 0.0);
        assert!((motion.speed - 0.05).abs() < 1e-6 && (motion.motor_speed - 0.05).abs() < 1e-6, "{motion:?}");
        assert!((motion.travel - 0.1).abs() < 1e-7);
    }
}
