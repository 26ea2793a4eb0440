//! The library against `sun2xp board`, a separate program, through configured ports.

#[path = "../common/attempts.rs"]
mod attempts;
#[allow(dead_code)]
#[path = "../c/mod.rs"]
mod c;
mod endings;
mod examples;
mod faults;
mod floods;
mod killed;
mod leaks;
mod motion;
mod numbers;
mod opening;
#[allow(dead_code)]
#[path = "../common/priority.rs"]
mod priority;
mod reconnection;
#[path = "../common/recoveries.rs"]
mod recoveries;
mod recovery;
mod rig;
#[path = "../common/settling.rs"]
mod settling;
mod stopping;

use c::pauses;
