//! Where the fingers of a hand are: simulated, at a port, or on a board.

use super::{Configuration, ConfiguredFinger};

impl Configuration {
    /// Returns the fingers that the hand has.
    pub fn of_hand(&self) -> impl Iterator<Item = &ConfiguredFinger> {
        self.hand.fingers.members().map(|number| &self.fingers[number.index()])
    }
}

impl ConfiguredFinger {
    /// Returns whether the finger has a simulated board instead of a port.
    #[must_use]
    pub fn simulated(&self) -> bool {
        self.board.is_none() && self.port == "simulated"
    }

    /// Gives the finger a simulated board instead of its port.
    pub fn simulate(&mut self) {
        (self.port, self.board) = ("simulated".into(), None);
    }

    /// Returns whether two fingers are on one port: their ports have the same path, or their `board` keys name the same
    /// number.
    pub fn shares_port(&self, other: &Self) -> bool {
        let named = |finger: &Self| finger.port != "simulated";
        self.board.is_some() && self.board == other.board || named(self) && named(other) && self.port == other.port
    }
}
