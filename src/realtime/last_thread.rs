//! A process ends with its last thread. Threads of this library do not count: they serve the planner's, and would keep a process
//! alive that nobody can end but by SIGKILL, because they block every signal.

use super::clock::now;
use super::threads::{own_threads, spawn_alike};
use std::fs;
use std::process::{exit, id};

/// How often the threads are looked at, ns.
const LOOKING: u64 = 1_000_000_000;

/// Ends the process when the planner's last thread has ended.
#[derive(Debug, Default)]
pub struct PlannerWatch {
    /// ns.
    next_look: u64,
    /// A thread ends the process already.
    ending: bool,
}

impl PlannerWatch {
    /// To be called often: looks once a second.
    pub fn look(&mut self) {
        if self.ending || now() < self.next_look {
            return;
        }
        self.next_look = now() + LOOKING;
        if planner_has_ended() {
            // As the last thread would have: with the status 0, after the exit handlers. They run in a thread of their own, because one
            // of them may call CloseHand, which waits for the other threads of the library. Where no thread can be had, a later look
            // may find one.
            self.ending = spawn_alike("sun2xp exit", || exit(0)).is_ok();
        }
    }
}

/// Whether every thread of the process but those of this library has ended. Where the system does not tell, none has.
fn planner_has_ended() -> bool {
    // The first thread stays as a zombie where others go on. Mostly it is alive, and there is nothing more to look at.
    has_ended(&id().to_string()) && others_have_ended().unwrap_or(false)
}

fn others_have_ended() -> Option<bool> {
    let own = own_threads();
    for thread in fs::read_dir("/proc/self/task").ok()? {
        let number = thread.ok()?.file_name().into_string().ok()?;
        let is_own = number.parse().is_ok_and(|number| own.contains(&number));
        if !is_own && !has_ended(&number) {
            return Some(false);
        }
    }
    Some(true)
}

/// Whether a thread is a zombie.
fn has_ended(thread: &str) -> bool {
    // Its state stands behind its name, which is in parentheses and may hold any character.
    let stat = fs::read_to_string(format!("/proc/self/task/{thread}/stat")).unwrap_or_default();
    stat.rsplit_once(") ").is_some_and(|(_, fields)| fields.starts_with(['Z', 'X']))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_threads_of_a_test_are_those_of_a_planner() {
        assert!(!planner_has_ended());
        assert_eq!(others_have_ended(), Some(false));
        assert!(!has_ended(&id().to_string()) && !has_ended("no number"));
    }
}
