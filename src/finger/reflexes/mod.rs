//! Reflexes: rules that a servo carries out by itself, without its planner. An aperiodic server gives them a fixed
//! budget in every cycle.

mod bulletin;
mod installed;
mod reaction;
mod rule;
mod rule_set;
mod server;

pub use bulletin::Bulletin;
pub use installed::{Reflexes, reflexes};
pub use reaction::ReactionLimits;
pub use rule::{Condition, Reaction, Reflex};
pub use rule_set::MOST_RULES;
pub use server::ReflexServer;
pub(in crate::finger) use server::{Facts, Fired};
