//! The pure core: one servo cycle is a function of feedback, set point and controller state. It knows neither threads nor
//! ports nor clocks, and allocates nothing.

mod signals;

pub use signals::{Activity, Command, Feedback, Report, SetPoint};
