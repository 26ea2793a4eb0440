//! Ends a process when all threads of the planner have ended. If no thread calls exit, a process ends with its last
//! thread. The library's threads must not keep the process alive. They block every signal, so if no other thread were
//! left, only SIGKILL could end the process.

use super::clock::now;
use super::threads::{own_threads, spawn_alike};
use std::fmt::Display;
use std::fs::{self, File};
use std::io::{Cursor, Read, Write};
use std::process::{exit, id};

/// Interval between two checks of the threads, ns.
const CHECK_INTERVAL: u64 = 1_000_000_000;

/// Ends the process when the planner's last thread has ended.
#[derive(Debug, Default)]
pub struct PlannerWatch {
    /// Time of the next check, ns.
    next_check: u64,
    /// Whether the thread that ends the process has already been started.
    ending: bool,
}

impl PlannerWatch {
    /// Checks whether the planner's threads have ended, at most once a second. The caller must call this function more
    /// often than once a second.
    pub fn check(&mut self) {
        if self.ending || now() < self.next_check {
            return;
        }
        self.next_check = now() + CHECK_INTERVAL;
        if planner_has_ended() {
            // The exit handlers run, and the process ends with status 0, as it would after the end of its last thread.
            // The handlers run in a new thread, because a handler may close the hand, and closing waits for the threads
            // of the hand, one of which calls this function. If the system refuses the new thread now, a later check
            // tries again.
            self.ending = spawn_alike("sun2xp exit", || exit(0)).is_ok();
        }
    }
}

/// Returns whether all threads of the process, except the threads of this library, have ended. Returns false if /proc
/// cannot be read.
fn planner_has_ended() -> bool {
    // The main thread stays as a zombie if it ends before other threads. Usually the main thread is alive, and then the
    // other threads need not be checked.
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

/// Returns whether a thread is a zombie or dead. It allocates no memory, because the process may be out of memory.
fn has_ended(thread: impl Display) -> bool {
    state(thread).is_some_and(|state| matches!(state, b'Z' | b'X'))
}

/// Returns the letter that /proc gives for the state of the thread.
fn state(thread: impl Display) -> Option<u8> {
    let mut path = Cursor::new([0; 64]);
    write!(path, "/proc/self/task/{thread}/stat").ok()?;
    let path = path.get_ref().split(|&byte| byte == 0).next()?;
    let mut stat = [0; 512];
    let mut file = File::open(str::from_utf8(path).ok()?).ok()?;
    let read = file.read(&mut stat).ok()?;
    // The state follows the thread's name, which is in parentheses and may contain any character.
    let end_of_name = stat[..read].iter().rposition(|&byte| byte == b')')?;
    stat.get(end_of_name + 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_threads_of_a_test_count_as_threads_of_a_planner() {
        assert!(!planner_has_ended());
        assert_eq!(others_have_ended(), Some(false));
        assert!(!has_ended(id()) && !has_ended("no number"));
        assert!(matches!(state(id()), Some(b'R' | b'S')));
    }
}
