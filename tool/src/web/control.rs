//! Commands from pages to the hand that this process has opened.

use crate::jog::commands::Command;
use serde::Serialize;
use std::io;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Weak};
use std::thread;
use sun2xp::Hand;
use sun2xp::model::configuration::Configuration;
use tokio::sync::mpsc::UnboundedSender;

/// Number of commands of pages that may wait. A recovery takes seconds, and commands wait for it.
const WAITING: usize = 32;

/// The hand, and the thread that carries the commands out one after the other. Neither keeps the hand open.
pub struct Control {
    hand: Weak<Hand>,
    configuration: Arc<Configuration>,
    orders: Sender<Order>,
    waiting: Arc<AtomicUsize>,
}

struct Order {
    command: Command,
    answers: Option<UnboundedSender<Answer>>,
}

/// What became of a command.
#[derive(Debug, Serialize)]
pub struct Answer {
    #[serde(rename = "type")]
    kind: &'static str,
    /// Whether the hand has accepted it.
    done: bool,
    /// What was done, or why not.
    text: String,
}

impl Answer {
    fn new(done: bool, text: String) -> Self {
        Self { kind: "answer", done, text }
    }

    /// Returns the message to the page.
    pub fn json(&self) -> String {
        // Two strings and a truth value always have a JSON text.
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
        let waiting = Arc::new(AtomicUsize::new(0));
        let control = Self { hand: Arc::downgrade(hand), configuration: Arc::new(configuration), orders, waiting };
        let (hand, configuration) = (Weak::clone(&control.hand), Arc::clone(&control.configuration));
        let waiting = Arc::clone(&control.waiting);
        let run = move || carry_out(&receiver, &waiting, &hand, &configuration);
        thread::Builder::new().name("sun2xp commands".into()).spawn(run)?;
        Ok(control)
    }

    /// Carries a command out, and sends the result to `answers`.
    pub fn order(&self, command: Command, answers: UnboundedSender<Answer>) {
        if command == Command::Stop {
            // A stop waits for nothing. The page may have left.
            let _ = answers.send(execute(&command, &self.hand, &self.configuration));
            return;
        }
        if self.waiting.load(Ordering::Relaxed) >= WAITING {
            let _ = answers.send(Answer::new(false, "the hand is busy: too many commands wait".into()));
            return;
        }
        self.queue(Order { command, answers: Some(answers) });
    }

    /// Ends the pushes of a page that has left.
    pub fn release(&self, fingers: &[i32]) {
        for &finger in fingers {
            self.queue(Order { command: Command::Push { finger, force: [0.0; 3] }, answers: None });
        }
    }

    fn queue(&self, order: Order) {
        self.waiting.fetch_add(1, Ordering::Relaxed);
        // The thread ends only with the process.
        let _ = self.orders.send(order);
    }
}

fn carry_out(orders: &Receiver<Order>, waiting: &AtomicUsize, hand: &Weak<Hand>, configuration: &Configuration) {
    for Order { command, answers } in orders {
        waiting.fetch_sub(1, Ordering::Relaxed);
        let answer = execute(&command, hand, configuration);
        // The page may have left.
        let _ = answers.map(|answers| answers.send(answer));
    }
}

fn execute(command: &Command, hand: &Weak<Hand>, configuration: &Configuration) -> Answer {
    let Some(hand) = hand.upgrade() else { return Answer::new(false, "the hand is closed".into()) };
    match command.execute(&hand, configuration) {
        Ok(text) => Answer::new(true, text),
        Err(refused) => Answer::new(false, refused.to_string()),
    }
}
