//! The thread that carries commands out, so that the keys never wait for the hand.

use super::commands::Command;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};
use sun2xp::Hand;
use sun2xp::model::configuration::Configuration;

/// Largest number of commands that wait.
const MOST_WAITING: usize = 4;

/// The handle of the thread, for the code that handles the keys.
pub struct Worker {
    commands: Option<Sender<(u64, Command)>>,
    results: Receiver<(String, bool)>,
    stopper: Stopper,
    /// Number of commands that are not carried out yet.
    waiting: Arc<AtomicUsize>,
    thread: Option<JoinHandle<()>>,
}

/// Stops all fingers, from any thread.
#[derive(Clone, Default)]
pub struct Stopper {
    /// Number of emergency stops. Commands that were sent before the last stop are not carried out.
    stops: Arc<AtomicU64>,
}

impl Stopper {
    /// Stops all fingers at once, and drops the commands that are still waiting.
    pub fn stop(&self) {
        sun2xp::stop_all();
        self.stops.fetch_add(1, Ordering::SeqCst);
    }

    fn stops(&self) -> u64 {
        self.stops.load(Ordering::SeqCst)
    }
}

impl Worker {
    /// Starts the thread. It ends when this value is dropped, and then no longer holds the hand.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn start(hand: Arc<Hand>, configuration: Configuration) -> io::Result<Self> {
        let (commands, to_do) = channel::<(u64, Command)>();
        let (done, results) = channel();
        let (stopper, waiting) = (Stopper::default(), Arc::new(AtomicUsize::new(0)));
        let (stopped, left) = (stopper.clone(), waiting.clone());
        let thread = thread::Builder::new().name("commands".into()).spawn(move || {
            for (stop, command) in to_do {
                if stopped.stops() == stop {
                    let result = match command.execute(&hand, &configuration) {
                        Ok(text) => (text, false),
                        Err(refused) => (refused.to_string(), true),
                    };
                    // The receiver is gone only when the program ends.
                    let _ = done.send(result);
                }
                left.fetch_sub(1, Ordering::SeqCst);
            }
        })?;
        Ok(Self { commands: Some(commands), results, stopper, waiting, thread: Some(thread) })
    }

    /// Sends a command. Returns false, and does not send it, if several commands are still waiting. A key that repeats
    /// while a finger recovers would otherwise move the finger much later.
    #[must_use]
    pub fn send(&self, command: Command) -> bool {
        let Some(commands) = self.commands.as_ref().filter(|_| self.waiting.load(Ordering::SeqCst) < MOST_WAITING)
        else {
            return false;
        };
        self.waiting.fetch_add(1, Ordering::SeqCst);
        commands.send((self.stopper.stops(), command)).is_ok()
    }

    /// Returns the emergency stop.
    pub fn stopper(&self) -> &Stopper {
        &self.stopper
    }

    /// Returns the newest result since the last call: its text, and whether the command was refused.
    pub fn result(&self) -> Option<(String, bool)> {
        self.results.try_iter().last()
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.commands = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
