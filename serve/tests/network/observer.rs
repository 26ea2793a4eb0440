//! What a hand does, cycle by cycle, as its telemetry shows it. The telemetry is read on the machine of the hand, so it
//! does not depend on the network.

use std::time::{Duration, Instant};
use sun2xp::Stage;
use sun2xp::telemetry::{Message, Reader, Sample, View};

/// Longest time from the start of a hand until a reader can attach to it.
const APPEARS: Duration = Duration::from_secs(20);

/// A reader of the telemetry of a hand.
pub struct Observer {
    reader: Reader,
    view: View,
    messages: Vec<Message>,
}

impl Observer {
    /// Attaches to the hand whose telemetry has this name. The thread must be in the network namespace of the hand.
    pub fn attach(name: &str) -> Self {
        let deadline = Instant::now() + APPEARS;
        loop {
            match Reader::attach(Some(name)) {
                Ok(reader) => {
                    let view = View::new(&reader.description().configuration);
                    return Self { reader, view, messages: Vec::new() };
                }
                Err(error) => assert!(Instant::now() < deadline, "{error}"),
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Waits for cycles for at most `timeout`, and returns those that have arrived. The hand must be open.
    pub fn samples(&mut self, timeout: Duration) -> Vec<Sample> {
        self.messages.clear();
        self.reader.read(timeout, &mut self.messages).unwrap_or_else(|ended| panic!("{ended}"));
        self.messages.iter().filter_map(|message| self.view.take(message)).collect()
    }

    /// Returns how many cycles telemetry has lost since this observer was attached, for all fingers together.
    pub fn lost(&self) -> u64 {
        self.reader.lost().iter().sum()
    }

    /// Drops everything that has arrived.
    pub fn skip(&mut self) {
        while !self.samples(Duration::ZERO).is_empty() {}
    }

    /// Reads cycles until `find` returns something, for at most `timeout`.
    pub fn until<Found>(&mut self, timeout: Duration, mut find: impl FnMut(&Sample) -> Option<Found>) -> Option<Found> {
        let deadline = Instant::now() + timeout;
        while Instant::now() < deadline {
            let found = self.samples(Duration::from_millis(20)).iter().find_map(&mut find);
            if found.is_some() {
                return found;
            }
        }
        None
    }
}

/// Returns whether the finger of this sample is a spring whose Kx is `stiffness`, N/cm, times the unit matrix.
pub fn has_stiffness(sample: &Sample, stiffness: f64) -> bool {
    let wanted = |row: usize, column: usize| if row == column { stiffness } else { 0.0 };
    sample.stage == Stage::Running
        && sample.kx.is_some_and(|kx| (0..9).all(|at| (kx[at / 3][at % 3] - wanted(at / 3, at % 3)).abs() < 1e-9))
}
