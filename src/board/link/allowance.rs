//! How long, and how much, is read while something is awaited: a board that sends without end must not hold its reader.

/// The most that one receive takes, bytes: ten times what the 15 fingers of a port answer in a period, and more than a
/// line at 12 Mbaud carries in the longest one.
const MOST_BYTES: usize = 4096;

/// What may still be read.
#[derive(Clone, Debug)]
pub struct Allowance {
    deadline: u64,
    /// None: as much as comes until the deadline.
    bytes: Option<usize>,
    used_up: bool,
    /// The last read found something.
    found: bool,
}

impl Allowance {
    /// For the Replies of one period: until `deadline` (ns on the transport's clock), and no more than a line can
    /// carry.
    pub fn for_replies(deadline: u64) -> Self {
        Self { bytes: Some(MOST_BYTES), ..Self::until(deadline) }
    }

    /// For an answer that may come after much else.
    pub(super) fn until(deadline: u64) -> Self {
        Self { deadline, bytes: None, used_up: false, found: false }
    }

    /// ns on the transport's clock.
    pub(super) fn deadline(&self) -> u64 {
        self.deadline
    }

    /// Whether there may be one more read at `now`. One at or after the deadline is allowed: it takes what is there
    /// already.
    pub(super) fn permits(&mut self, now: u64) -> bool {
        let permitted = !self.used_up;
        self.used_up |= now >= self.deadline;
        permitted
    }

    /// So many bytes were read.
    pub(super) fn take(&mut self, bytes: usize) {
        if let Some(left) = &mut self.bytes {
            *left = left.saturating_sub(bytes);
            self.used_up |= *left == 0;
        }
        self.found = bytes > 0;
        // Nothing came until the deadline.
        self.used_up |= !self.found;
    }

    /// Whether there may be more than was read.
    pub(super) fn left_some(&self) -> bool {
        self.found
    }
}
