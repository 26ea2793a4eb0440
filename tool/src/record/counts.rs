//! What has been recorded.

use std::fmt::{self, Display, Formatter};
use sun2xp::model::Counted;
use sun2xp::telemetry::Message;

/// Numbers of recorded cycles and events, and of lost cycles.
#[derive(Default)]
pub struct Counts {
    pub cycles: u64,
    pub events: u64,
    pub lost: u64,
}

impl Counts {
    /// Counts a message.
    pub fn add(&mut self, message: &Message) {
        match message {
            Message::Cycle { .. } => self.cycles += 1,
            Message::Event(_) => self.events += 1,
            _ => {}
        }
    }
}

impl Display for Counts {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        let [cycles, lost] = [self.cycles, self.lost].map(|number| Counted(number, "cycle", "cycles"));
        write!(formatter, "{cycles}, {}, {lost} lost", Counted(self.events, "event", "events"))
    }
}
