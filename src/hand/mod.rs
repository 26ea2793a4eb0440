//! Root and Dispatcher: opens and closes a hand, reads its configuration, routes commands to the fingers and collects
//! their reports (section 3 of the report).

mod adjustment;
mod admission;
mod announcement;
mod calibrating;
mod calibration_file;
mod configuration_file;
mod dispatcher;
mod error;
mod fingertip;
mod off_line_schedule;
mod opening;
mod root;

pub use calibrating::{Calibrating, Standing};
pub use configuration_file::{configured, read};
pub use error::HandError;
pub use fingertip::FingerTip;
pub use off_line_schedule::{Costs, Limit, Scheduled, Sensor, fastest_rate, off_line_schedule};
pub use root::{FingerStatus, Hand};
