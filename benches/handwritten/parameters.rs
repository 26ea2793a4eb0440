//! `struct parameters` of `structures.h`, and the gains that the library and `step.c` both use.

use nalgebra::{Matrix3, Matrix3x4, Vector4};
use std::error::Error;
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};

/// Gains of the scheme at 1000 Hz. The library and `step.c` both receive these values, because `step.c` does not have
/// the library's table of gains.
pub struct Gains {
    tension_gain: f64,
    tension_integral: f64,
    motor_damping: f64,
    rate_time: f64,
    speed_filter: f64,
    stretch_filter: f64,
    set_point_speed: f64,
}

impl Gains {
    pub fn new(scheme: Scheme) -> Self {
        match scheme {
            Scheme::Figure9 => Self {
                tension_gain: 0.0,
                tension_integral: 75.0,
                motor_damping: 310.0,
                rate_time: 0.050,
                speed_filter: 180.0,
                stretch_filter: 2.0,
                set_point_speed: 2.0,
            },
            _ => Self {
                tension_gain: 2.0,
                tension_integral: 250.0,
                motor_damping: 450.0,
                rate_time: 0.015,
                speed_filter: 400.0,
                stretch_filter: 6.0,
                set_point_speed: 2.0,
            },
        }
    }

    pub fn configure(&self, finger: &mut ConfiguredFinger) {
        let controller = &mut finger.controller;
        if controller.scheme != Some(Scheme::Figure9) {
            controller.tension_gain = Some(self.tension_gain);
        }
        controller.tension_integral = Some(self.tension_integral);
        controller.motor_damping = Some(self.motor_damping);
        controller.rate_time = Some(self.rate_time);
        controller.speed_filter = Some(self.speed_filter);
        controller.stretch_filter = Some(self.stretch_filter);
        controller.set_point_speed = Some(self.set_point_speed);
    }
}

/// The fields of `struct parameters` in `structures.h`, in the same order.
#[repr(C)]
pub struct Parameters {
    period: f64,
    radians_per_count: [f64; 4],
    newton_per_count: [f64; 4],
    gauge_zero: [f64; 4],
    speed_gain: f64,
    stretch_gain: f64,
    from_motors: [[f64; 4]; 3],
    from_tensions: [[f64; 4]; 3],
    home: [f64; 4],
    tight: f64,
    spring_part: f64,
    slew_step: f64,
    links: [f64; 3],
    joint_damping: [f64; 3],
    inverse_cholesky: [[f64; 3]; 3],
    compliance: [f64; 3],
    share: f64,
    low: [f64; 3],
    high: [f64; 3],
    limit_stiffness: [f64; 3],
    from_torque: [[f64; 3]; 4],
    ghost: [f64; 4],
    inverse_ghost: [f64; 4],
    ratio: [[f64; 4]; 4],
    idle: [[f64; 4]; 4],
    at_rest: [f64; 4],
    strongest: [f64; 4],
    coulomb: [f64; 4],
    past_conduit: [f64; 4],
    least_tension: f64,
    tension_gain: f64,
    integral_gain: f64,
    motor_damping: f64,
    limit: [f64; 4],
    continuous: [f64; 4],
    heat_gain: f64,
    radius_m: [f64; 4],
    signed_radius: [f64; 4],
    encoder_zero: [i32; 4],
}

/// The spring may use at most this fraction of the stiffness with which the tendons hold the joints while the motors
/// are locked. The value is for 750 Hz and above.
const SHARE: f64 = 0.95;

impl Parameters {
    pub fn new(finger: &ConfiguredFinger, gains: &Gains, rate: f64) -> Result<Self, Box<dyn Error>> {
        use std::array::from_fn;
        let tendons = finger.tendons()?;
        let (motor, encoder, minimum) = (&finger.motor, &finger.encoder, finger.tendon.minimum);
        let travel = tendons.joints_from_travel();
        let inverse = inverse_cholesky(finger, &tendons.r)?;
        let compliance: [f64; 3] = from_fn(|i| inverse.column(i).norm_squared());
        let limit: [f64; 4] = from_fn(|i| motor.torque_limit[i] / tendons.radius[i]);
        let ghost: [f64; 4] = from_fn(|i| tendons.q[(i, 3)]);
        let ratio = from_fn(|i| from_fn(|j| ghost[i] / ghost[j]));
        let ratios: &[[f64; 4]; 4] = &ratio;
        let idle = from_fn(|i| from_fn(|j| minimum * ratios[i][j]));
        let low_pass = |corner: f64| 1.0 - (-std::f64::consts::TAU * corner / rate).exp();
        let [l0, l1, l2] = finger.links().0;
        let (low, high) = finger.joint_limits();
        let home: Vector4<f64> = tendons.pretension(minimum);
        Ok(Self {
            period: 1.0 / rate,
            radians_per_count: radians_per_count(finger),
            newton_per_count: finger.gauge.newton_per_count,
            gauge_zero: finger.gauge.zero,
            speed_gain: low_pass(gains.speed_filter),
            stretch_gain: low_pass(gains.stretch_filter),
            from_motors: from_fn(|j| from_fn(|i| travel[(j, i)] * tendons.radius[i])),
            from_tensions: from_fn(|j| from_fn(|i| -travel[(j, i)] / finger.tendon.stiffness[i])),
            home: home.into(),
            tight: 0.8 * minimum,
            spring_part: 1.0 - (-1.0 / (0.01 * rate)).exp(),
            slew_step: gains.set_point_speed / rate,
            links: [l0, l1, l2],
            joint_damping: joint_damping([l0, l1, l2], gains.rate_time),
            inverse_cholesky: from_fn(|i| from_fn(|j| inverse[(i, j)])),
            compliance,
            share: SHARE,
            low: low.into(),
            high: high.into(),
            limit_stiffness: compliance.map(|compliance| (0.3 * SHARE / compliance).min(150.0)),
            from_torque: from_fn(|i| from_fn(|j| tendons.q[(i, j)])),
            ghost,
            inverse_ghost: ghost.map(f64::recip),
            ratio,
            idle,
            at_rest: from_fn(|i| ratios[i].iter().fold(0.0, |most, ratio| ratio.max(most)) * minimum),
            strongest: from_fn(|i| limit[i].min(finger.tendon.maximum)),
            coulomb: from_fn(|i| finger.friction.motor_coulomb[i] / tendons.radius[i]),
            past_conduit: finger.friction.conduit.map(|conduit| 1.0 / (1.0 + conduit)),
            least_tension: minimum,
            tension_gain: gains.tension_gain,
            integral_gain: gains.tension_integral / rate,
            motor_damping: gains.motor_damping,
            limit,
            continuous: from_fn(|i| (motor.continuous_torque[i] / tendons.radius[i]).min(limit[i])),
            heat_gain: 1.0 - (-1.0 / (rate * motor.thermal_time)).exp(),
            radius_m: from_fn(|i| tendons.radius[i] * 0.01),
            signed_radius: from_fn(|i| tendons.radius[i] * f64::from(motor.sign[i])),
            encoder_zero: encoder.zero,
        })
    }
}

/// Returns the radians per count, with sign.
fn radians_per_count(finger: &ConfiguredFinger) -> [f64; 4] {
    let encoder = &finger.encoder;
    std::array::from_fn(|i| {
        f64::from(encoder.sign[i]) * std::f64::consts::TAU / f64::from(encoder.counts_per_revolution[i])
    })
}

/// Returns the inverse of the Cholesky factor of the joint stiffness with locked motors.
fn inverse_cholesky(finger: &ConfiguredFinger, r: &Matrix3x4<f64>) -> Result<Matrix3<f64>, Box<dyn Error>> {
    let stretched = Matrix3x4::from_fn(|i, j| r[(i, j)] * finger.tendon.stiffness[j]);
    let cholesky = (stretched * r.transpose()).cholesky().ok_or("the rank of R is below 3")?;
    Ok(cholesky.l().try_inverse().ok_or("the rank of R is below 3")?)
}

/// Returns the constants from which `step.c` computes the damping of the joints. The lengths of the links are in cm,
/// and `rate_time` is in s.
fn joint_damping([l0, l1, l2]: [f64; 3], rate_time: f64) -> [f64; 3] {
    let levers = [(l0 + l1) * (l0 + l1), l1 * l1 + l2 * l2, l2 * l2];
    levers.map(|lever| lever * 3.0 * rate_time * rate_time)
}
