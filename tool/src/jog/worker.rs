//! The thread that carries commands out, so that the keys never wait for the hand.

use super::commands::Command;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};
use sun2xp::Hand;
use sun2xp::model::configuration::Configuration;

/// The end of the keys.
pub struct Worker {
    commands: Option<Sender<(u64, Command)>>,
    results: Receiver<(String, bool)>,
    /// Number of emergency stops. Commands that were sent before the last stop are not carried out.
    stops: Arc<AtomicU64>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Starts the thread. It ends when this value is dropped, and then no longer holds the hand.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn start(hand: Arc<Hand>, configuration: Configuration) -> io::Result<Self> {
        let (commands, to_do) = channel::<(u64, Command)>();
        let (done, results) = channel();
        let stops = Arc::new(AtomicU64::new(0));
        let stops_seen = stops.clone();
        let thread = thread::Builder::new().name("commands".into()).spawn(move || {
            for (stop, command) in to_do {
                if stops_seen.load(Ordering::SeqCst) != stop {
                    continue;
                }
                let result = match command.execute(&hand, &configuration) {
                    Ok(text) => (text, false),
                    Err(refused) => (refused.to_string(), true),
                };
                if done.send(result).is_err() {
                    return;
                }
            }
        })?;
        Ok(Self { commands: Some(commands), results, stops, thread: Some(thread) })
    }

    /// Sends a command.
    pub fn send(&self, command: Command) {
        if let Some(commands) = &self.commands {
            // The thread ends only after this value.
            let _ = commands.send((self.stops.load(Ordering::SeqCst), command));
        }
    }

    /// Stops all fingers at once, and drops the commands that are still waiting.
    pub fn stop(&self) {
        sun2xp::stop_all();
        self.stops.fetch_add(1, Ordering::SeqCst);
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
