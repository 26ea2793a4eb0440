//! The thread that carries commands out, so that the keys never wait for the hand.

use super::commands::Command;
use super::stopper::Stopper;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};
use sun2xp::Hand;
use sun2xp::model::configuration::Configuration;

/// Largest number of commands that are not carried out yet, including the one in progress. The end of a push is sent in
/// any case, because the push would otherwise go on.
const MOST_WAITING: usize = 4;

/// What became of a command that was sent.
pub struct Outcome {
    pub command: Command,
    /// What was done, or why the hand refused the command, in words. None if an emergency stop has dropped the command.
    pub result: Option<Result<String, String>>,
}

/// The handle of the thread, for the code that handles the keys.
pub struct Worker {
    commands: Option<Sender<(u64, Command)>>,
    outcomes: Receiver<Outcome>,
    stopper: Stopper,
    /// Number of commands that are not carried out yet.
    waiting: Arc<AtomicUsize>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Starts the thread. When this value is dropped, the thread finishes the present command, drops the waiting ones,
    /// and ends. Then it no longer holds the hand.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn start(hand: Arc<Hand>, configuration: Configuration) -> io::Result<Self> {
        let (commands, to_do) = channel::<(u64, Command)>();
        let (done, outcomes) = channel();
        let (stopper, waiting) = (Stopper::default(), Arc::new(AtomicUsize::new(0)));
        let (stopped, left) = (stopper.clone(), waiting.clone());
        let thread = thread::Builder::new().name("commands".into()).spawn(move || {
            for (stops, command) in to_do {
                let result = stopped.carry_out(&command, stops, |stopped| {
                    command.execute(&hand, &configuration, stopped).map_err(|refused| refused.to_string())
                });
                // The receiver still exists, because `drop` waits for this thread.
                let _ = done.send(Outcome { command, result });
                left.fetch_sub(1, Ordering::SeqCst);
            }
        })?;
        Ok(Self { commands: Some(commands), outcomes, stopper, waiting, thread: Some(thread) })
    }

    /// Sends a command. Returns false, and does not send it, if several commands are still waiting. A key that repeats
    /// while a finger recovers would otherwise move the finger much later. The end of a push is always sent.
    #[must_use]
    pub fn send(&self, command: Command) -> bool {
        let room = command.ends_push() || self.waiting.load(Ordering::SeqCst) < MOST_WAITING;
        let Some(commands) = self.commands.as_ref().filter(|_| room) else { return false };
        self.waiting.fetch_add(1, Ordering::SeqCst);
        commands.send((self.stopper.stops(), command)).is_ok()
    }

    /// Returns the emergency stop.
    pub fn stopper(&self) -> &Stopper {
        &self.stopper
    }

    /// Returns what became of the commands since the last call: one outcome for each command, in the order of sending.
    pub fn outcomes(&self) -> impl Iterator<Item = Outcome> {
        self.outcomes.try_iter()
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.stopper.end();
        self.commands = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::jog::commands::desired_joints;
    use std::time::Duration;

    /// Longest time until an outcome. The machine of the tests may be busy.
    const PATIENCE: Duration = Duration::from_secs(60);

    #[test]
    fn commands_that_wait_at_the_end_are_not_carried_out() {
        let configuration = Configuration::default();
        let hand = Arc::new(Hand::open(configuration.clone()).expect("the simulated hand opens"));
        let before = desired_joints(&hand, 2).expect("runs");
        hand.stop(1).expect("open");
        let worker = Worker::start(hand.clone(), configuration).expect("a thread");
        // The recovery takes some time, and the other commands wait for it.
        assert!(worker.send(Command::Recover { finger: 1 }));
        for _ in 1..MOST_WAITING {
            assert!(worker.send(Command::MoveJoints { finger: 2, by: [0.0, 0.05, 0.0] }));
        }
        drop(worker);
        assert_eq!(desired_joints(&hand, 2).expect("runs"), before);
    }

    #[test]
    fn the_end_of_a_push_is_carried_out_after_the_commands_that_wait() {
        let configuration = Configuration::default();
        let hand = Arc::new(Hand::open(configuration.clone()).expect("the simulated hand opens"));
        hand.stop(1).expect("open");
        let worker = Worker::start(hand, configuration).expect("a thread");
        // The recovery takes some time, and the other commands wait for it.
        assert!(worker.send(Command::Recover { finger: 1 }));
        for _ in 1..MOST_WAITING {
            assert!(worker.send(Command::MoveJoints { finger: 2, by: [0.0; 3] }));
        }
        let end = Command::Push { finger: 1, force: [0.0; 3] };
        assert!(worker.send(end));
        let outcome = |_| worker.outcomes.recv_timeout(PATIENCE).expect("an outcome");
        let outcomes: Vec<Outcome> = (0..=MOST_WAITING).map(outcome).collect();
        let Outcome { command, result } = &outcomes[MOST_WAITING];
        assert_eq!((command, result), (&end, &Some(Ok("finger 1: no push".to_owned()))));
    }
}
