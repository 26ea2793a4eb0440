//! Position control of the motors: each motor moves its end of the tendon to a target.

use nalgebra::Vector4;
use serde::{Deserialize, Serialize};

/// Stiffness at servo rates of 1000 Hz and more, N/m. The rotor of the default motor then has a bandwidth of 20 Hz.
const STIFFNESS: f64 = 40_000.0;
/// Damping at servo rates of 1000 Hz and more, N s/m.
const DAMPING: f64 = 450.0;
/// Integral gain relative to the stiffness, 1/s. The integral overcomes the friction of the motor.
const INTEGRAL: f64 = 15.0;
/// Error up to which the integral keeps its value, m. Without a dead band, stiction would cause a limit cycle at rest.
const DEAD_BAND: f64 = 1e-5;

#[derive(Clone, Debug)]
pub(super) struct TravelServo {
    period: f64,
    stiffness: f64,
    damping: f64,
}

/// The targets of the four motors, and the integrals.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(super) struct Targets {
    /// Targets, m of tendon, positive inward.
    pub travel: Vector4<f64>,
    /// Speeds of the targets, m/s.
    pub speed: Vector4<f64>,
    /// Integral parts of the pulls, N.
    pub integral: Vector4<f64>,
}

impl TravelServo {
    pub fn new(rate: f64) -> Self {
        // Below 1000 Hz the delay of a cycle permits only a lower bandwidth.
        let slower = (rate / 1000.0).min(1.0);
        Self { period: 1.0 / rate, stiffness: STIFFNESS * slower * slower, damping: DAMPING * slower }
    }

    /// Sets the targets to the present travel, m. The pulls of motors at rest do not change.
    pub fn stop(&self, targets: &mut Targets, travel: &Vector4<f64>) {
        targets.integral += (targets.travel - travel) * self.stiffness;
        targets.travel = *travel;
    }

    /// Returns the pulls, N, each limited to `strongest`, N. `travel` is the travel of the motors, m, and `speeds` are
    /// their speeds, m/s.
    pub fn pulls(
        &self,
        targets: &mut Targets,
        travel: &Vector4<f64>,
        speeds: &Vector4<f64>,
        strongest: &Vector4<f64>,
    ) -> Vector4<f64> {
        Vector4::from_fn(|motor, _| {
            let (strongest, integral) = (strongest[motor], &mut targets.integral[motor]);
            let error = targets.travel[motor] - travel[motor];
            let rest = self.stiffness * error + self.damping * (targets.speed[motor] - speeds[motor]);
            let outside = error - error.clamp(-DEAD_BAND, DEAD_BAND);
            let change = INTEGRAL * self.stiffness * outside * self.period;
            // While the pull is at its limit, the integral does not grow further toward the limit.
            let pull = rest + *integral;
            if pull.abs() < strongest || change * pull < 0.0 {
                *integral = (*integral + change).clamp(-strongest, strongest);
            }
            (rest + *integral).clamp(-strongest, strongest)
        })
    }
}
