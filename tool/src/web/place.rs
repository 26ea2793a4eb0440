//! The place that a connection occupies, one of a limited number of places, and the time limit of the connection.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use tokio::sync::OwnedSemaphorePermit;

/// Longest time from the acceptance of a connection until it has sent the header of its request.
pub const HEADER: Duration = Duration::from_secs(10);

/// Longest time from the acceptance of a connection until it has taken its answer. The WebSocket of a page has no such
/// limit.
const ANSWER: Duration = Duration::from_secs(60);

/// The place that a connection occupies, one of a limited number of places.
#[derive(Clone)]
pub struct Place(Arc<Mutex<Progress>>);

/// How far the exchange on a connection has come.
enum Progress {
    /// The header of the request has not arrived as a whole.
    Header(OwnedSemaphorePermit),
    /// The request is being answered.
    Answer { _permit: OwnedSemaphorePermit },
    /// The connection is the WebSocket of a page. Pages have a limit of their own.
    Page,
}

impl Place {
    /// Returns the place of a connection that has sent nothing yet.
    pub fn new(permit: OwnedSemaphorePermit) -> Self {
        Self(Arc::new(Mutex::new(Progress::Header(permit))))
    }

    /// Notes that the header of the request has arrived.
    pub fn header_arrived(&self) {
        self.change(|progress| match progress {
            Progress::Header(permit) => Progress::Answer { _permit: permit },
            later => later,
        });
    }

    /// Frees the place of a connection that becomes the WebSocket of a page.
    pub fn leave(&self) {
        self.change(|_| Progress::Page);
    }

    fn change(&self, change: impl FnOnce(Progress) -> Progress) {
        let mut progress = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let before = std::mem::replace(&mut *progress, Progress::Page);
        *progress = change(before);
    }

    /// Returns the time limit of the connection, counted from its acceptance; none for the WebSocket of a page.
    pub fn time(&self) -> Option<Duration> {
        match &*self.0.lock().unwrap_or_else(PoisonError::into_inner) {
            Progress::Header(_) => Some(HEADER),
            Progress::Answer { .. } => Some(ANSWER),
            Progress::Page => None,
        }
    }
}
