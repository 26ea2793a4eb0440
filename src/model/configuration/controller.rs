//! `[finger.controller]`: which laws run, and with which numbers.

use serde::{Deserialize, Serialize};

/// Which tendon controller runs.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub enum Scheme {
    /// Figure 9: an integral on the tension error.
    #[serde(rename = "figure 9")]
    Figure9,
    /// Figure 10 (Salisbury): proportional and integral on the tension error, and a damper on the motor.
    #[serde(rename = "figure 10")]
    Figure10,
    /// Figure 11: the motor model that turns tensions into torques adapts.
    #[serde(rename = "figure 11")]
    Figure11,
    /// Feedback of the whole state of links, elastic tendons and motors.
    #[serde(rename = "state feedback")]
    StateFeedback,
}

/// How the torque of the fingertip's spring is found.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// tau = J^T Kx J (theta_d - theta), eqs. 3 and 6: the spring for small deflections.
    #[default]
    Report,
    /// tau = J^T Kx (x_d - x): the spring at any deflection, but blind to which of two joint solutions has the tip at
    /// x_d.
    Exact,
}

/// `[finger.controller]`. What is left out is chosen for the rate.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredController {
    /// The tendon controller; none: what [`ConfiguredController::scheme`] says.
    pub scheme: Option<Scheme>,
    /// The stiffness law behind SendPos. A fingertip set point always has the exact one.
    pub law: Law,
    /// Whether the torques of gravity on the links are compensated.
    pub gravity_compensation: bool,
    /// K_T, dimensionless: tension commanded for a tension error.
    pub tension_gain: Option<f64>,
    /// K_TI, 1/s.
    pub tension_integral: Option<f64>,
    /// K_delta at the tendon, N s/m.
    pub motor_damping: Option<f64>,
    /// beta at 3 N/cm and a bent finger, s: joint rate against joint angle in the stiffness law; scaled with
    /// 1/sqrt(K_theta).
    pub rate_time: Option<f64>,
    /// Low-pass of the motor speeds, Hz.
    pub speed_filter: Option<f64>,
    /// Low-pass of the tensions that the tendon stretch is computed from, Hz.
    pub stretch_filter: Option<f64>,
    /// Bound on the speed of every joint of the set point, rad/s: a step becomes a straight line in joint space.
    pub set_point_speed: Option<f64>,
    /// Figure 11: how fast the motor model follows what the gauges show, 1/s.
    pub adaptation_gain: Option<f64>,
    /// State feedback: alpha, tension commanded for a tension error; the motors then feel 1/alpha of their inertia.
    pub inertia_gain: Option<f64>,
    /// State feedback: damping ratio of the spring.
    pub damping_ratio: Option<f64>,
    /// State feedback: time constant of each of the five poles that the set point passes, s.
    pub set_point_time: Option<f64>,
    /// State feedback: amplitude of the dither over the Coulomb friction of the joints; 0: none.
    pub dither: Option<f64>,
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
        }
    }
}

impl ConfiguredController {
    /// The tendon controller at `rate`, Hz. Unless one is configured, state feedback from 750 Hz up, and Figure 10
    /// below: at 500 Hz state feedback is better in most respects, but not in all, and does not bear a link that loses
    /// a tenth of the replies (`docs/stiffness.md`).
    pub fn scheme(&self, rate: f64) -> Scheme {
        self.scheme.unwrap_or(if rate >= 750.0 { Scheme::StateFeedback } else { Scheme::Figure10 })
    }
}
