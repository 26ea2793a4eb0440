//! Commands from pages to the hand that this process has opened.

use crate::jog::commands::Command;
use crate::jog::stopper::Stopper;
use serde::Serialize;
use std::io;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Weak};
use std::thread::{self, JoinHandle};
use sun2xp::Hand;
use sun2xp::model::configuration::Configuration;
use tokio::sync::mpsc::UnboundedSender;

/// Number of commands of pages that may wait. A recovery takes seconds, and commands wait for it. A command that ends a
/// push is accepted even if more commands wait, because the push would otherwise go on.
const WAITING: usize = 32;

/// The thread that carries the commands out one after the other. It holds the hand only while it carries one out.
/// Dropping this value waits for the present command, and drops those that wait.
pub struct Control {
    orders: Option<Sender<Order>>,
    stopper: Stopper,
    waiting: Arc<AtomicUsize>,
    thread: Option<JoinHandle<()>>,
}

struct Order {
    command: Command,
    /// Number of emergency stops when the command was sent.
    stops: u64,
    answers: Option<UnboundedSender<Answer>>,
}

/// The result of a command.
#[derive(Debug, Serialize)]
pub struct Answer {
    #[serde(rename = "type")]
    kind: &'static str,
    command: Command,
    /// Whether the hand has accepted it.
    done: bool,
    /// What was done, or why not.
    text: String,
}

impl Answer {
    fn new(command: Command, done: bool, text: String) -> Self {
        Self { kind: "answer", command, done, text }
    }

    /// Returns the message to the page.
    pub fn json(&self) -> String {
        // Strings, numbers and a truth value always have a JSON text.
        serde_json::to_string(self).unwrap_or_default()
    }
}

impl Control {
    /// Starts the thread.
    ///
    /// # Errors
    /// Returns an error if the system has no thread left.
    pub fn start(hand: &Arc<Hand>, configuration: Configuration) -> io::Result<Self> {
        let (orders, receiver) = channel();
        let (stopper, waiting) = (Stopper::default(), Arc::new(AtomicUsize::new(0)));
        let executor = Executor {
            hand: Arc::downgrade(hand),
            configuration,
            stopper: stopper.clone(),
            waiting: Arc::clone(&waiting),
        };
        let thread = thread::Builder::new().name("sun2xp commands".into()).spawn(move || executor.run(&receiver))?;
        Ok(Self { orders: Some(orders), stopper, waiting, thread: Some(thread) })
    }

    /// Carries a command out, and sends the result to `answers`.
    pub fn order(&self, command: Command, answers: UnboundedSender<Answer>) {
        if command == Command::Stop {
            // A stop waits for nothing. It drops the commands that wait, also those of other pages, except the ends of
            // pushes.
            self.stopper.stop();
            // The page may have left.
            let _ = answers.send(Answer::new(command, true, "all fingers are stopped".into()));
            return;
        }
        if !command.ends_push() && self.waiting.load(Ordering::Relaxed) >= WAITING {
            let text = "the hand is busy, and too many commands wait: send the command again later";
            let _ = answers.send(Answer::new(command, false, text.into()));
            return;
        }
        self.queue(command, Some(answers));
    }

    /// Ends the pushes of a page that has left.
    pub fn release(&self, fingers: &[i32]) {
        for &finger in fingers {
            self.queue(Command::Push { finger, force: [0.0; 3] }, None);
        }
    }

    fn queue(&self, command: Command, answers: Option<UnboundedSender<Answer>>) {
        self.waiting.fetch_add(1, Ordering::Relaxed);
        let order = Order { command, stops: self.stopper.stops(), answers };
        // The thread receives orders until this value is dropped, so sending does not fail.
        let _ = self.orders.as_ref().map(|orders| orders.send(order));
    }
}

impl Drop for Control {
    fn drop(&mut self) {
        self.stopper.end();
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// The answer to a command that is not carried out.
const DROPPED: &str = "the command was dropped by an emergency stop, or because sun2xp ends: recover the fingers or \
                       start sun2xp again, and send the command again";

/// What the thread needs to carry commands out.
struct Executor {
    hand: Weak<Hand>,
    configuration: Configuration,
    stopper: Stopper,
    waiting: Arc<AtomicUsize>,
}

impl Executor {
    fn run(&self, orders: &Receiver<Order>) {
        for Order { command, stops, answers } in orders {
            self.waiting.fetch_sub(1, Ordering::Relaxed);
            let dropped = || (false, DROPPED.into());
            let result = self.stopper.carry_out(&command, stops, |stopped| self.execute(&command, stopped));
            let (done, text) = result.unwrap_or_else(dropped);
            // The page may have left.
            if let Some(answers) = answers {
                let _ = answers.send(Answer::new(command, done, text));
            }
        }
    }

    /// Returns whether the hand has accepted the command, and what was done, or why not. `stopped` is as in
    /// [`Command::execute`].
    fn execute(&self, command: &Command, stopped: &dyn Fn() -> bool) -> (bool, String) {
        let Some(hand) = self.hand.upgrade() else {
            return (false, "the hand is closed: start sun2xp jog again".into());
        };
        match command.execute(&hand, &self.configuration, stopped) {
            Ok(text) => (true, text),
            Err(refused) => (false, refused.to_string()),
        }
    }
}
