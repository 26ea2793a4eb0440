//! Tests the estimate of contacts without touch sensors: against an independent derivation of the dynamics, and with a
//! short version of `benches/contact`.

#[allow(dead_code)]
#[path = "../../benches/contact/after_motion.rs"]
mod after_motion;
#[allow(dead_code)]
#[path = "../../benches/contact/cases.rs"]
mod cases;
#[path = "../core_lagrange/mod.rs"]
mod core_lagrange;
#[allow(dead_code)]
#[path = "../../benches/contact/false_alarms.rs"]
mod false_alarms;
#[allow(dead_code)]
#[path = "../../benches/contact/finger.rs"]
mod finger;
mod independent;
#[allow(dead_code)]
#[path = "../../benches/contact/motion.rs"]
mod motion;
#[allow(dead_code)]
#[path = "../../benches/contact/noticed.rs"]
mod noticed;
#[allow(dead_code)]
#[path = "../../benches/stiffness/parallel.rs"]
mod parallel;
mod simulated;
