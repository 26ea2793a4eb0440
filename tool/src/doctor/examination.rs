//! Checks whether this machine and its ports can run a hand as configured, and finds what to change if they cannot.

use super::finding::Finding;
use super::{machine, measured, ports};
use std::path::Path;
use std::time::Duration;
use sun2xp::hand::{Fingers, HandError, SimulatedHand, check, find_boards};
use sun2xp::model::configuration::Configuration;

/// Checks the machine, whose files are below `root` (`/`, except in tests), and the ports of a hand. No program may
/// have the hand open. The measurements take about `duration`. The motors stay off.
///
/// # Errors
/// Returns an error if the configuration cannot be used, if a board is not found by its unique number or is found at
/// two ports, or if the system cannot start a thread or open a pseudo-terminal.
pub fn examine(configuration: &Configuration, root: &Path, duration: Duration) -> Result<Vec<Finding>, HandError> {
    check(configuration)?;
    let mut found = configuration.clone();
    find_boards(&mut found, configuration.hand.fingers)?;
    let configuration = &found;
    let mut findings = machine::findings(configuration, root);
    findings.extend(measured::wake_ups(configuration, duration / 2)?);
    let simulated = SimulatedHand::start(configuration, Fingers::ALL)?;
    findings.extend(ports::findings(configuration, &simulated, root, duration / 2)?);
    Ok(findings)
}
