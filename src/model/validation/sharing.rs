//! Conditions for fingers that share a thread or a port.

use super::ranges::unusable;
use crate::model::configuration::{Configuration, Unusable};
use crate::model::{FingerNumber, Shown};

impl Configuration {
    /// Checks the threads and ports of two fingers against each other.
    pub(super) fn check_sharing(&self, first: FingerNumber, second: FingerNumber) -> Result<(), Unusable> {
        let (one, other) = (&self.fingers[first.index()], &self.fingers[second.index()]);
        let same_thread = self.thread(first) == self.thread(second);
        if same_thread && (one.core != other.core || one.priority != other.priority) {
            return unusable(
                "thread",
                format!(
                    "fingers {first} and {second} share thread {}, but have different cores or \
                     priorities: give all fingers of the thread the same core and priority",
                    self.thread(first)
                ),
            );
        }
        if !one.shares_port(other) {
            return Ok(());
        }
        let board = one.board.map(|number| format!("of the board {number}"));
        let board = board.filter(|_| one.port == "simulated");
        let port = board.unwrap_or_else(|| Shown(&one.port).to_string());
        if !same_thread {
            let thread = self.thread(first);
            let reason = format!(
                "fingers {first} and {second} share the port {port} but not a thread, and one thread \
                 must serve all fingers of a port: set thread = {thread} for every finger of the port"
            );
            return unusable("thread", reason);
        }
        if self.address(first) == self.address(second) {
            let reason = format!(
                "fingers {first} and {second} share the address {} on the port {port}: leave \
                 `address` out, or give each finger the address that its board has",
                self.address(first)
            );
            return unusable("address", reason);
        }
        if one.baud != other.baud {
            let reason = format!(
                "fingers {first} and {second} share the port {port}, but one has {} baud and the other \
                 {}: give all fingers of the port the same baud",
                one.baud, other.baud
            );
            return unusable("baud", reason);
        }
        Ok(())
    }
}
