//! `[finger.controller]`: control laws and their parameters.

use serde::{Deserialize, Serialize};

/// The controllers of a finger.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub enum Scheme {
    /// Figure 9: an integral of the tension error.
    #[serde(rename = "figure 9")]
    Figure9,
    /// Figure 10 (Salisbury): PI control of the tension error, and a damper on the motor.
    #[serde(rename = "figure 10")]
    Figure10,
    /// Figure 11: an adaptive motor model converts tensions to torques.
    #[serde(rename = "figure 11")]
    Figure11,
    /// Feedback of the whole state of links, elastic tendons and motors.
    #[serde(rename = "state feedback")]
    StateFeedback,
}

/// The law that converts the deflection of the fingertip's spring to joint torques.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Law {
    /// tau = J^T Kx J (theta_d - theta), eqs. 3 and 6. It is a spring for small deflections.
    Report,
    /// tau = J^T Kx (x_d - x). It is a spring at any deflection. It does not distinguish the two joint solutions with
    /// the tip at x_d, which bend joint 2 to opposite sides. While joint 2 is bent to the opposite side from theta_d, a
    /// spring in joint space therefore acts instead.
    #[default]
    Exact,
}

/// Rate from which state feedback is the default, Hz. A file may select state feedback below this rate too. The
/// functions of state feedback that need a high rate therefore have a limit of their own, `FULL_RATE`.
const STATE_FEEDBACK_RATE: f64 = 750.0;

/// `[finger.controller]`. Values that are absent get defaults for the scheme and the rate.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredController {
    /// The controller of the whole finger. If it is absent, the method [`ConfiguredController::scheme()`] selects one
    /// by the rate.
    pub scheme: Option<Scheme>,
    /// The stiffness law for set points in joint angles. A fingertip set point always uses the exact law.
    pub law: Law,
    /// Whether the controller compensates the torques of gravity on the links.
    pub gravity_compensation: bool,
    /// K_T, dimensionless: the gain from the tension error to the pull of a motor.
    pub tension_gain: Option<f64>,
    /// K_TI, 1/s.
    pub tension_integral: Option<f64>,
    /// K_delta at the tendon, N s/m.
    pub motor_damping: Option<f64>,
    /// beta at 3 N/cm and a bent finger, s: the ratio of joint damping to joint stiffness in the stiffness law. beta
    /// is proportional to 1/sqrt(K_theta).
    pub rate_time: Option<f64>,
    /// Corner frequency of the low-pass filter on the motor speeds, Hz.
    pub speed_filter: Option<f64>,
    /// Corner frequency of the low-pass filter on the tensions from which the tendon stretch is computed, Hz.
    pub stretch_filter: Option<f64>,
    /// Limit of the speed of every joint of the set point, rad/s. A step becomes a straight line in joint space.
    pub set_point_speed: Option<f64>,
    /// Figure 11: bandwidth with which the motor model follows the gauges, 1/s.
    pub adaptation_gain: Option<f64>,
    /// State feedback: alpha, the gain from the tension error to the pull of a motor. The motors appear to have 1/alpha
    /// of their inertia.
    pub inertia_gain: Option<f64>,
    /// State feedback: damping ratio of the spring, 0.05 to 0.45. Too much damping makes a finger oscillate, because of
    /// the delay of one cycle: a finger with 0.5 or more can oscillate.
    pub damping_ratio: Option<f64>,
    /// State feedback: time constant of each of the five poles of the set point filter, s.
    pub set_point_time: Option<f64>,
    /// State feedback: amplitude of the dither of the joints, divided by their Coulomb friction. With 0 the joints have
    /// no dither.
    pub dither: Option<f64>,
    /// State feedback: smallest amplitude of the dither of the tensions, as a fraction of each tension. If all tendons
    /// have equal friction, the dither causes no joint torque. Otherwise it moves the tip a little. Its amplitude rises
    /// with `friction.pulley`. If `tension_dither` is 0, the tensions have no dither, whatever `friction.pulley` is.
    pub tension_dither: Option<f64>,
    /// State feedback: the part of the motors' friction that is fed forward, 0 to 1.
    pub friction_share: Option<f64>,
}

impl Default for ConfiguredController {
    fn default() -> Self {
        Self {
            scheme: None,
            law: Law::default(),
            gravity_compensation: true,
            tension_gain: None,
            tension_integral: None,
            motor_damping: None,
            rate_time: None,
            speed_filter: None,
            stretch_filter: None,
            set_point_speed: None,
            adaptation_gain: None,
            inertia_gain: None,
            damping_ratio: None,
            set_point_time: None,
            dither: None,
            tension_dither: None,
            friction_share: None,
        }
    }
}

impl ConfiguredController {
    /// Returns the controller of the finger at `rate`, Hz. Unless one is configured, it is state feedback from 750 Hz
    /// up and Figure 10 below. At 500 Hz state feedback is better in most respects, but loses control of a finger if a
    /// tenth of the replies are lost (`docs/stiffness.md`).
    #[must_use]
    pub fn scheme(&self, rate: f64) -> Scheme {
        self.scheme.unwrap_or(if rate >= STATE_FEEDBACK_RATE { Scheme::StateFeedback } else { Scheme::Figure10 })
    }
}
