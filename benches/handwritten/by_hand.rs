//! `step.c` compiled and loaded, with the structures that it takes.

use nalgebra::{Matrix3x4, Vector4};
use std::error::Error;
use std::ffi::{CString, c_void};
use std::path::Path;
use std::process::Command;
use sun2xp::control::{Feedback, SetPoint};
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};

/// Gains that are configured for both sides, because the library's table is its own: those of the scheme at 1000 Hz.
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
        let [tension_gain, tension_integral, motor_damping, rate_time, speed_filter, stretch_filter] = match scheme {
            Scheme::Figure9 => [0.0, 75.0, 310.0, 0.050, 180.0, 2.0],
            _ => [2.0, 250.0, 450.0, 0.015, 400.0, 6.0],
        };
        let set_point_speed = 2.0;
        Self { tension_gain, tension_integral, motor_damping, rate_time, speed_filter, stretch_filter, set_point_speed }
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

/// `struct parameters`.
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

/// Of what the locked tendons carry, from 750 Hz up.
const SHARE: f64 = 0.95;

impl Parameters {
    pub fn new(finger: &ConfiguredFinger, gains: &Gains, rate: f64) -> Result<Self, Box<dyn Error>> {
        use std::array::from_fn;
        let tendons = finger.tendons()?;
        let (motor, encoder, minimum) = (&finger.motor, &finger.encoder, finger.tendon.minimum);
        let travel = tendons.joints_from_travel();
        let stretched = Matrix3x4::from_fn(|i, j| tendons.r[(i, j)] * finger.tendon.stiffness[j]);
        let cholesky = (stretched * tendons.r.transpose()).cholesky().ok_or("R has no rank of 3")?;
        let inverse = cholesky.l().try_inverse().ok_or("R has no rank of 3")?;
        let compliance: [f64; 3] = from_fn(|i| inverse.column(i).norm_squared());
        let limit: [f64; 4] = from_fn(|i| motor.torque_limit[i] / tendons.radius[i]);
        let ghost: [f64; 4] = from_fn(|i| tendons.q[(i, 3)]);
        let ratio = from_fn(|i| from_fn(|j| ghost[i] / ghost[j]));
        let ratios: &[[f64; 4]; 4] = &ratio;
        let idle = from_fn(|i| from_fn(|j| minimum * ratios[i][j]));
        let low_pass = |corner: f64| 1.0 - (-std::f64::consts::TAU * corner / rate).exp();
        let [l0, l1, l2] = finger.links().0;
        let (low, high) = finger.joint_limits();
        let levers = [(l0 + l1) * (l0 + l1), l1 * l1 + l2 * l2, l2 * l2];
        let home: Vector4<f64> = tendons.pretension(minimum);
        Ok(Self {
            period: 1.0 / rate,
            radians_per_count: from_fn(|i| {
                f64::from(encoder.sign[i]) * std::f64::consts::TAU / f64::from(encoder.counts_per_revolution[i])
            }),
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
            joint_damping: levers.map(|lever| lever * 3.0 * gains.rate_time * gains.rate_time),
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

/// `struct set_point`.
#[repr(C)]
pub struct PlainSetPoint {
    joints: [f64; 3],
    stiffness: [[f64; 6]; 6],
    damping: f64,
}

impl From<&SetPoint> for PlainSetPoint {
    fn from(set_point: &SetPoint) -> Self {
        Self {
            joints: set_point.joints.into(),
            stiffness: std::array::from_fn(|i| std::array::from_fn(|j| set_point.stiffness[(i, j)])),
            damping: set_point.damping,
        }
    }
}

/// `struct report`.
#[derive(Clone, Copy, Default)]
#[repr(C)]
pub struct PlainReport {
    pub joints: [f64; 3],
    pub joint_rates: [f64; 3],
    pub tensions: [f64; 4],
    pub desired_tensions: [f64; 4],
    pub joint_torques: [f64; 3],
    pub torque_scale: f64,
    pub stiffness_scale: f64,
    pub motor_torques: [f64; 4],
    pub under_tension: i32,
}

/// `struct spring`.
#[derive(Clone, Copy, Default)]
#[repr(C)]
pub struct PlainSpring {
    stiffness: [[f64; 6]; 6],
    exact: f64,
    damping: f64,
}

/// `struct state`.
#[derive(Clone, Copy, Default)]
#[repr(C)]
pub struct PlainState {
    tendons: [[f64; 4]; 6],
    still_seconds: f64,
    pulls_and_heat: [[f64; 4]; 2],
    anchor: [f64; 3],
    springs: [PlainSpring; 2],
    report: PlainReport,
    age: u32,
    following: i32,
}

/// `struct feedback`.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct PlainFeedback {
    motor_counts: [i32; 4],
    gauge_counts: [u16; 4],
}

impl From<&Feedback> for PlainFeedback {
    fn from(feedback: &Feedback) -> Self {
        Self { motor_counts: feedback.motor_counts, gauge_counts: feedback.gauge_counts }
    }
}

/// `figure9_step` and `figure10_step`.
pub type Step = unsafe extern "C" fn(
    *const Parameters,
    *mut PlainState,
    *const PlainFeedback,
    *const PlainSetPoint,
    *mut [f64; 4],
    *mut PlainReport,
);

/// `start`.
pub type Start = unsafe extern "C" fn(*const Parameters, *mut PlainState, *const PlainFeedback);

/// The functions of `step.c`.
pub struct ByHand {
    pub start: Start,
    pub figure9: Step,
    pub figure10: Step,
    pub compiler: String,
}

impl ByHand {
    /// Compiles with `$CC`, or cc, for the same processor as the library: the oldest of its kind.
    pub fn compile() -> Result<Self, Box<dyn Error>> {
        let compiler = std::env::var("CC").unwrap_or("cc".into());
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/handwritten/step.c");
        let library = Path::new(env!("CARGO_TARGET_TMPDIR")).join("handwritten-step.so");
        let options = ["-std=c11", "-O3", "-shared", "-fPIC", "-Wall", "-Wextra", "-Werror", source, "-lm", "-o"];
        let status = Command::new(&compiler).args(options).arg(&library).status();
        if !status.map_err(|error| format!("cannot run {compiler} ({error}): install a C compiler"))?.success() {
            return Err(format!("{compiler} does not compile {source}").into());
        }
        let version = Command::new(&compiler).arg("--version").output()?.stdout;
        let version = String::from_utf8_lossy(&version).lines().next().unwrap_or_default().to_string();
        let path = CString::new(library.into_os_string().into_encoded_bytes())?;
        // SAFETY: a path that ends in 0. The library stays loaded until the process ends, so its symbols stay good; their
        // types are those of step.c.
        unsafe {
            let library = libc::dlopen(path.as_ptr(), libc::RTLD_NOW);
            if library.is_null() {
                return Err("cannot load what was compiled".into());
            }
            let symbol = |name: &std::ffi::CStr| libc::dlsym(library, name.as_ptr());
            let symbols = [c"start", c"figure9_step", c"figure10_step"].map(symbol);
            if symbols.iter().any(|symbol| symbol.is_null()) {
                return Err("step.c lacks a function".into());
            }
            let [start, figure9, figure10] = symbols;
            Ok(Self {
                start: std::mem::transmute::<*mut c_void, Start>(start),
                figure9: std::mem::transmute::<*mut c_void, Step>(figure9),
                figure10: std::mem::transmute::<*mut c_void, Step>(figure10),
                compiler: version,
            })
        }
    }
}
