//! The push of a person on the tip of a simulated finger: what was sent, and what acts.

use std::collections::VecDeque;

/// Forces in the palm's frame, N.
type Force = [f64; 3];

/// The push on one finger.
#[derive(Clone, Debug, Default)]
pub struct Push {
    /// The push that the person wants. As soon as the outcome of every sent push is known, `wanted` becomes the push
    /// that acts. This drops a wanted push that the hand has not done.
    pub wanted: Force,
    /// The newest push that the hand has done.
    acting: Force,
    /// The pushes that were sent, and of which it is not known yet whether the hand has done them.
    sent: VecDeque<Force>,
}

impl Push {
    /// Returns the push that acts.
    pub fn acting(&self) -> Force {
        self.acting
    }

    /// Notes whether the wanted push was sent.
    pub fn note(&mut self, sent: bool) {
        if sent {
            self.sent.push_back(self.wanted);
        } else {
            self.wanted = self.sent.back().copied().unwrap_or(self.acting);
        }
    }

    /// Notes whether the hand has done the oldest push that was sent. A push that was refused changes nothing.
    pub fn conclude(&mut self, done: bool) {
        let Some(force) = self.sent.pop_front() else { return };
        if done {
            self.acting = force;
        }
        if self.sent.is_empty() {
            self.wanted = self.acting;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn want(push: &mut Push, force: Force, sent: bool) {
        push.wanted = force;
        push.note(sent);
    }

    #[test]
    fn a_push_acts_when_the_hand_has_done_it() {
        let (weak, strong) = ([0.1, 0.0, 0.0], [0.2, 0.0, 0.0]);
        let mut push = Push::default();
        want(&mut push, weak, true);
        want(&mut push, strong, true);
        assert_eq!((push.acting(), push.wanted), ([0.0; 3], strong));
        // The first one is refused, and the second one is not.
        push.conclude(false);
        assert_eq!((push.acting(), push.wanted), ([0.0; 3], strong));
        push.conclude(true);
        assert_eq!((push.acting(), push.wanted), (strong, strong));
        want(&mut push, weak, true);
        push.conclude(false);
        assert_eq!((push.acting(), push.wanted), (strong, strong));
    }

    #[test]
    fn a_push_that_is_not_sent_is_not_wanted_any_more() {
        let (weak, strong) = ([0.1, 0.0, 0.0], [0.2, 0.0, 0.0]);
        let mut push = Push::default();
        want(&mut push, weak, false);
        assert_eq!(push.wanted, [0.0; 3]);
        want(&mut push, weak, true);
        want(&mut push, strong, false);
        assert_eq!(push.wanted, weak);
        push.conclude(true);
        assert_eq!(push.acting(), weak);
    }
}
