//! Root and Dispatcher (section 3 of the report): opens and closes a hand, reads its configuration, passes commands to
//! the fingers and collects their reports.

mod adjustment;
mod admission;
mod black_box;
mod black_box_file;
mod board_search;
mod calibrating;
mod calibration_file;
mod configuration_file;
mod dispatcher;
mod error;
mod events;
mod faults;
mod fingers;
mod fingertip;
mod found;
mod gravity;
mod groups;
mod identities;
mod kinematics;
mod limits;
mod missing_permissions;
mod motion_limits;
mod notice;
mod object;
mod opening;
mod paths;
mod port_repair;
mod reconnection;
mod recovery;
mod reflexes;
mod root;
mod servo_threads;
mod set_points;
mod simulated_hand;
mod status;
mod touch;
mod waiting;

pub use crate::finger::stop_all;
pub use crate::model::Fingers;
pub use black_box_file::save_recording;
pub use board_search::{FoundFinger, SearchedPort, find_boards, search_boards};
pub use calibrating::{Calibrating, CalibrationState};
pub use calibration_file::store_findings;
pub use configuration_file::{
    Configured, Wrong, deserialize, find_configuration, parse_configuration, read_configuration,
};
pub(crate) use error::ErrorKind;
pub use error::{ConfigurationError, HandError, PathError, RecoveryError, ReflexError, SetPointError};
pub use events::{EventListener, EventQueue};
pub use faults::FingerFault;
pub use fingertip::FingerTip;
pub use found::Found;
pub use groups::{FingerCommand, Pose};
pub use kinematics::{JointTorques, PalmPose};
pub use limits::FingerLimits;
pub use missing_permissions::{MissingPermission, missing_permissions};
pub use motion_limits::MotionLimits;
pub use opening::{check, ports};
pub use paths::{PathPose, Plan, plan_path};
pub use recovery::Recovering;
pub use root::Hand;
pub use servo_threads::priority;
pub use simulated_hand::SimulatedHand;
pub use status::FingerStatus;
pub use waiting::{Until, Waiting};
