//! A process ends with its last thread. Threads of this library do not count: they serve the planner's, and would keep
//! a process alive that nobody can end but by SIGKILL, because they block every signal.

use super::clock::now;
use super::threads::{own_threads, spawn_alike};
use std::fmt::Display;
use std::fs::{self, File};
use std::io::{Cursor, Read, Write};
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
            // As the last thread would have: with the status 0, after the exit handlers. They run in a thread of their
            // own, because one of them may call CloseHand, which waits for the other threads of the library. Where no
            // thread can be had, a later look may find one.
            self.ending = spawn_alike("sun2xp exit", || exit(0)).is_ok();
        }
    }
}

/// Whether every thread of the process but those of this library has ended. Where the system does not tell, none has.
fn planner_has_ended() -> bool {
    // The first thread stays as a zombie where others go on. Mostly it is alive, and there is nothing more to look at.
    has_ended(id()) && others_have_ended().unwrap_or(false)
}

fn others_have_ended() -> Option<bool> {
    let own = own_threads();
    for thread in fs::read_dir("/proc/self/task").ok()? {
        let number = thread.ok()?.file_name().into_string().ok()?;
        let is_own = number.parse().is_ok_and(|number| own.contains(&number));
        if !is_own && !has_ended(number) {
            return Some(false);
        }
    }
    Some(true)
}

/// Whether a thread is a zombie. Allocates nothing: the process may be out of memory.
fn has_ended(thread: impl Display) -> bool {
    state(thread).is_some_and(|state| matches!(state, b'Z' | b'X'))
}

/// The letter of its state.
fn state(thread: impl Display) -> Option<u8> {
    let mut path = Cursor::new([0; 64]);
    write!(path, "/proc/self/task/{thread}/stat").ok()?;
    let path = path.get_ref().split(|&byte| byte == 0).next()?;
    let mut stat = [0; 512];
    let mut file = File::open(str::from_utf8(path).ok()?).ok()?;
    let read = file.read(&mut stat).ok()?;
    // It stands behind the name of the thread, which is in parentheses and may hold any character.
    let end_of_name = stat[..read].iter().rposition(|&byte| byte == b')')?;
    stat.get(end_of_name + 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_threads_of_a_test_are_those_of_a_planner() {
        assert!(!planner_has_ended());
        assert_eq!(others_have_ended(), Some(false));
        assert!(!has_ended(id()) && !has_ended("no number"));
        assert!(matches!(state(id()), Some(b'R' | b'S')));
    }
}
