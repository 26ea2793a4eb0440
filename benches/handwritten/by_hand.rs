//! Compiles and loads `step.c`, and defines the structures of its interface other than `struct parameters`.

use crate::parameters::Parameters;
use std::error::Error;
use std::ffi::{CString, c_void};
use std::path::Path;
use std::process::Command;
use sun2xp::control::{Feedback, SetPoint};

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
    /// Name and version of the compiler.
    pub compiler: String,
}

impl ByHand {
    /// Compiles with `$CC`, or cc, for the same baseline processor as the library.
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
        // SAFETY: the path ends with a zero byte. The library stays loaded until the process ends, so its symbols stay
        // valid. Their types are those of step.c.
        unsafe {
            let library = libc::dlopen(path.as_ptr(), libc::RTLD_NOW);
            if library.is_null() {
                return Err("cannot load the compiled step".into());
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
