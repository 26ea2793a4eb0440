//! The emergency stop that a person triggers. It also drops the commands that still wait.

use super::commands::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Stops all fingers, from any thread.
#[derive(Clone, Default)]
pub struct Stopper {
    /// Number of emergency stops. Commands that were sent before the last stop are not carried out, except the end of a
    /// push.
    stops: Arc<AtomicU64>,
    /// Whether the hand is about to be closed. Then no further command is carried out.
    ending: Arc<AtomicBool>,
}

impl Stopper {
    /// Stops all fingers at once, and drops the commands that are still waiting, except the end of a push.
    pub fn stop(&self) {
        // The number rises first. In the reverse order, a recovery that begins between the two statements would cancel
        // the stop and move the finger again.
        self.stops.fetch_add(1, Ordering::SeqCst);
        sun2xp::stop_all();
    }

    /// Drops the commands that are still waiting, and all later ones, before the hand is closed.
    pub fn end(&self) {
        self.ending.store(true, Ordering::SeqCst);
    }

    /// Returns the number of stops, which a command keeps until it is carried out.
    pub fn stops(&self) -> u64 {
        self.stops.load(Ordering::SeqCst)
    }

    /// Calls `execute` for a command that was sent after `stops` stops. Returns none if a later stop or the end has
    /// dropped the command. `execute` gets the function `stopped`, which returns whether a later stop has come
    /// meanwhile. A recovery must call `stopped` after it has begun. Otherwise the recovery would undo a stop that
    /// comes between the check here and the beginning of the recovery.
    pub fn carry_out<T>(
        &self,
        command: &Command,
        stops: u64,
        execute: impl FnOnce(&dyn Fn() -> bool) -> T,
    ) -> Option<T> {
        let stopped = || self.stops() != stops && !command.ends_push();
        if self.ending.load(Ordering::SeqCst) || stopped() {
            return None;
        }
        Some(execute(&stopped))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_carried_out_after_the_end() {
        let stopper = Stopper::default();
        let carry_out = |command, stops| stopper.carry_out(&command, stops, |_| 1);
        let end_of_push = Command::Push { finger: 1, force: [0.0; 3] };
        assert_eq!(carry_out(Command::Open, 0), Some(1));
        // The number of stops is 0. A command with another number is treated as one that was sent before a later stop.
        assert_eq!(carry_out(Command::Open, 1), None);
        assert_eq!(carry_out(Command::Push { finger: 1, force: [0.0, 0.0, 0.1] }, 1), None);
        assert_eq!(carry_out(end_of_push, 1), Some(1), "a stop does not let a push go on");
        stopper.end();
        assert_eq!(carry_out(Command::Open, 0), None);
        assert_eq!(carry_out(end_of_push, 0), None);
    }

    #[test]
    fn a_command_learns_of_a_stop_that_comes_while_it_is_carried_out() {
        let stopper = Stopper::default();
        let seen = stopper.carry_out(&Command::Recover { finger: 1 }, 0, |stopped| {
            let before = stopped();
            // A real stop would stop the hands of the other tests.
            stopper.stops.fetch_add(1, Ordering::SeqCst);
            (before, stopped())
        });
        assert_eq!(seen, Some((false, true)));
    }
}
