//! What the terminal shows: the state of a hand, and the choices of the person. The keys change the choices, and `draw`
//! draws the view.

use super::state::{HandState, Tracker};
use crate::jog::panel::JogPanel;

/// Largest number of fingers.
const FINGERS: i32 = 3;

/// Time for which a notice stays, ns.
const NOTICE_TIME: u64 = 8_000_000_000;

/// The link to the hand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Link {
    /// There is no hand. The text says why.
    Waiting(String),
    /// Messages arrive.
    Live,
    /// The hand has ended. The text says why.
    Ended(String),
}

/// The content of the terminal.
pub struct View {
    /// The newest state; none before the first hand.
    pub tracker: Option<Tracker>,
    /// The link to the hand.
    pub link: Link,
    /// The state that is shown while the view is frozen, and the time of it, ns of the monotonic clock.
    pub frozen: Option<(HandState, u64)>,
    /// The finger that is shown in detail, 1 to 3.
    pub selected: Option<i32>,
    /// Whether the help is shown.
    pub help: bool,
    /// Number of lines by which long fault texts are scrolled.
    pub scroll: usize,
    /// Present time, ns of the monotonic clock.
    pub now: u64,
    /// The controls of `sun2xp jog`.
    pub jog: Option<JogPanel>,
    notice: Option<(String, u64)>,
}

impl View {
    /// Returns the view before a hand is there.
    pub fn new(reason: String) -> Self {
        Self {
            tracker: None,
            link: Link::Waiting(reason),
            frozen: None,
            selected: None,
            help: false,
            scroll: 0,
            now: 0,
            jog: None,
            notice: None,
        }
    }

    /// Returns the state to show, and its time.
    pub fn shown(&self) -> Option<(&HandState, u64)> {
        match &self.frozen {
            Some((hand, time)) => Some((hand, *time)),
            None => self.tracker.as_ref().map(|tracker| (&tracker.state, self.now)),
        }
    }

    /// Stops the picture, or lets it continue. The state behind it is kept up to date.
    pub fn toggle_frozen(&mut self) {
        self.frozen = match self.frozen.take() {
            Some(_) => None,
            None => self.tracker.as_ref().map(|tracker| (tracker.state.clone(), self.now)),
        };
    }

    /// Shows a finger in detail, or no finger if this one is already shown.
    pub fn select(&mut self, finger: i32) {
        self.selected = (self.selected != Some(finger)).then_some(finger);
    }

    /// Shows the next finger in detail. After the last finger, shows no finger in detail.
    pub fn select_next(&mut self) {
        self.selected = match self.selected {
            None => Some(1),
            Some(FINGERS..) => None,
            Some(finger) => Some(finger + 1),
        };
    }

    /// Shows a notice for some seconds.
    pub fn notify(&mut self, text: String) {
        self.notice = Some((text, self.now));
    }

    /// Returns the notice.
    pub fn notice(&self) -> Option<&str> {
        self.notice.as_ref().filter(|(_, since)| self.now < since + NOTICE_TIME).map(|(text, _)| text.as_str())
    }
}
