//! One finger's servo: its thread and mailbox, which connect the pure control computation to the board and the planner.

mod adjustable;
mod black_box;
mod control_input;
mod cycle_record;
pub mod events;
mod faults;
mod fingertip_state;
mod group_gate;
mod link_handover;
mod link_watch;
mod losses;
mod mailbox;
mod motion_settings;
mod order;
mod outlet;
mod path_buffer;
mod recording;
mod reference;
mod reflexes;
mod relay;
#[cfg(feature = "internals")]
mod replay;
mod report;
mod sent;
mod served_port;
mod servo;
mod servo_thread;
mod stage;
mod stop_signal;
mod supervision;
mod touch;
mod validity;

pub use adjustable::Adjustable;
pub use black_box::{BlackBox, KEYFRAMES, Recorder};
pub use control_input::ControlInput;
pub use cycle_record::{ControlRecord, ControllerSource, CycleRecord, KeptRecord};
pub use faults::{Action, Description, Fault, FaultKind, PartKind, Quantity, Severity, Warnings};
pub use fingertip_state::FingertipState;
pub use group_gate::GroupGate;
pub use link_handover::{
    LinkRepairEnd, LinkServoEnd, ReleasedLink, RepairedLink, RestoredBoard, RestoredFinger, link_handover,
};
pub use link_watch::Fading;
pub use losses::Losses;
pub use mailbox::Mailbox;
pub use mailbox::groups::PreparedSetPoint;
pub use mailbox::paths::PreparedPath;
pub use order::{CalibrationRun, Order};
pub use outlet::{Keyframe, Outlet};
pub use path_buffer::{MOST_PIECES, MOST_POSES};
#[cfg(feature = "internals")]
pub use recording::ALTERED;
pub use recording::{Origin, Recording, RecordingError};
pub use reference::Reference;
pub use reflexes::{
    Bulletin, Condition, MOST_RULES, Reaction, ReactionLimits, Reflex, ReflexServer, Reflexes, reflexes,
};
pub use relay::Relay;
#[cfg(feature = "internals")]
pub use replay::{ContinuousReplay, Difference, NotReplayable, Recomputed, Replayed, Step, Unsound, without_remedy};
pub use report::FingerReport;
pub use sent::Replaced;
pub use served_port::ServedPort;
pub use servo::FingerServo;
pub use servo_thread::{REPLY_WINDOW, Servo};
pub use stage::Stage;
pub use stop_signal::{StopCounts, StopSignal, stop_all, stop_calls};
pub use touch::{Elements, TouchReading};
pub use validity::Validity;
