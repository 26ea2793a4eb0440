//! Tests of one finger in memory, on simulated time, from the planner's commands to the simulated board. They test, for
//! example, set points, paths, reflexes, events, faults and warnings.

mod black_box;
mod busy_machine;
mod calibrating;
mod commands;
mod continuous_replay;
mod corrections;
mod events;
#[allow(dead_code)]
#[path = "../common/finger_on_a_cable.rs"]
mod finger_on_a_cable;
mod floods;
mod gravity;
mod kinds;
mod limits;
mod locked_memory;
mod motion;
mod named_hands;
mod opening;
mod path_stiffness;
mod reflexes;
mod refused_paths;
mod rig;
mod set_points;
mod slewing;
mod slow_planner;
mod touch;
