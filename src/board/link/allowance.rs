//! Limits how long and how much one receive reads, so that a board that sends without end cannot block its reader.

/// A receive begins no read after this number of bytes. It is about ten times the number of bytes of the Replies of 15
/// fingers, and more than a line at 12 Mbaud carries in the longest period.
const MOST_BYTES: usize = 4096;

/// The time and the number of bytes that remain for a receive.
#[derive(Clone, Debug)]
pub struct Allowance {
    deadline: u64,
    /// `None`: no limit until the deadline.
    bytes: Option<usize>,
    used_up: bool,
    /// The last read returned at least one byte.
    found: bool,
}

impl Allowance {
    /// Creates the allowance for the Replies of one period: until `deadline` (ns on the transport's clock), and no
    /// read after 4096 bytes.
    pub fn for_replies(deadline: u64) -> Self {
        Self { bytes: Some(MOST_BYTES), ..Self::until(deadline) }
    }

    /// Creates the allowance for an answer that may follow many other bytes: no byte limit.
    pub(super) fn until(deadline: u64) -> Self {
        Self { deadline, bytes: None, used_up: false, found: false }
    }

    /// Ends the wait: only bytes that have already arrived are read from now on.
    pub fn end(&mut self) {
        self.deadline = 0;
    }

    /// Returns the deadline, ns on the transport's clock.
    pub(super) fn deadline(&self) -> u64 {
        self.deadline
    }

    /// Returns whether one more read is permitted at `now`. One read at or after the deadline is permitted; it takes
    /// bytes that have already arrived.
    pub(super) fn permits(&mut self, now: u64) -> bool {
        let permitted = !self.used_up;
        self.used_up |= now >= self.deadline;
        permitted
    }

    /// Deducts the bytes that a read returned.
    pub(super) fn take(&mut self, bytes: usize) {
        if let Some(left) = &mut self.bytes {
            *left = left.saturating_sub(bytes);
            self.used_up |= *left == 0;
        }
        self.found = bytes > 0;
        // A read returns no bytes only at the deadline, or if no byte can arrive before the deadline.
        self.used_up |= !self.found;
    }

    /// Returns whether the port may have more bytes than were read.
    pub(super) fn left_some(&self) -> bool {
        self.found
    }
}
