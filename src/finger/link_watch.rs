//! Lost replies in a row. At first the last command is held, or what follows from it is predicted; then the motors are
//! led to what they do at rest; at last the finger faults, while its board's watchdog is not yet over.

use crate::model::configuration::{ConfiguredHand, EndState};
use nalgebra::Vector4;
use serde::{Deserialize, Serialize};

/// So long, ms, the last command is held.
const HELD_MS: f64 = 3.0;

/// After so long, ms, the motors are at rest: a torque that nobody watches winds a tendon up, or off its motor, within
/// some ms, and the watchdog does not see it, as commands go on.
const BLIND_MS: f64 = 10.0;

/// At slow rates so many lost replies in a row are let pass all the same.
const LEAST_BLIND: u32 = 3;

/// At slow rates one lost reply is no fault all the same.
const LEAST_LOST: u32 = 2;

/// A built-in simulated board is silent when the machine is too busy to run it, or to carry its bytes: no reason to
/// stop the hand.
const SIMULATION_PATIENCE_MS: f64 = 5000.0;

/// So long, ms, such a board has to answer before its command is sent again: either may have been thrown away.
const REPEAT_MS: f64 = 100.0;

/// Motor torques on their way from the last command to rest.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct Fading {
    /// The part of the way that is left, 0 to 1.
    pub left: f64,
    /// What every motor keeps at rest, N cm at most: 0 with the end state *release*.
    pub rest: f64,
}

impl Fading {
    /// Whether a finger of this hand can fade like this.
    pub(super) fn possible(&self, hand: &ConfiguredHand) -> bool {
        (0.0..=1.0).contains(&self.left) && (0.0..=hand.hold_torque_limit).contains(&self.rest)
    }

    /// N cm.
    pub fn torques(&self, commanded: &Vector4<f64>) -> Vector4<f64> {
        commanded.map(|torque| {
            let rest = torque.clamp(-self.rest, self.rest);
            rest + (torque - rest) * self.left
        })
    }
}

/// Counts them. In attempts, not in time: a machine that pauses everything has lost no reply.
pub(super) struct LinkWatch {
    /// The finger has a built-in board.
    simulated: bool,
    in_a_row: u32,
    repeat: u32,
    held: u32,
    blind: u32,
    lost: u32,
    rest: f64,
}

impl LinkWatch {
    /// `simulated`: the finger has a built-in board.
    pub fn new(hand: &ConfiguredHand, simulated: bool) -> Self {
        let cycles = |milliseconds: f64| (milliseconds * 1e-3 * hand.rate).ceil() as u32;
        // The board is told to stop one period after the last lost reply: within the watchdog's time after the last
        // good one.
        let within_watchdog = (f64::from(hand.watchdog_ms) * 1e-3 * hand.rate).floor() as u32;
        Self {
            simulated,
            in_a_row: 0,
            repeat: cycles(REPEAT_MS),
            held: cycles(HELD_MS),
            blind: cycles(BLIND_MS).max(LEAST_BLIND),
            lost: match simulated {
                true => cycles(SIMULATION_PATIENCE_MS),
                false => within_watchdog.saturating_sub(1).max(LEAST_LOST),
            },
            rest: match hand.end_state {
                EndState::Release => 0.0,
                EndState::Hold => hand.hold_torque_limit,
            },
        }
    }

    /// Whether the finger and its controller go on together, as built-in ones do: the next command leaves when the last
    /// one was answered, however late, and a cycle without a reply is none for the controller. The board stands still
    /// meanwhile. A controller that counted time which did not pass at the finger, or physics that went on without
    /// their controller, would throw the finger about on a busy machine.
    pub fn in_step(&self) -> bool {
        self.simulated
    }

    /// Whether it is time to send an unanswered command again.
    pub fn repeats(&self) -> bool {
        self.in_a_row.is_multiple_of(self.repeat)
    }

    /// A reply came: whether the finger was not seen for so long that its controller begins anew, with what the tendons
    /// pull now.
    pub fn answered(&mut self) -> bool {
        std::mem::take(&mut self.in_a_row) >= self.blind && !self.in_step()
    }

    /// None came: whether it is a fault, and after how many.
    pub fn missed(&mut self) -> Option<u32> {
        self.in_a_row += 1;
        (self.in_a_row >= self.lost).then_some(self.in_a_row)
    }

    /// How the next command fades; none while it is held.
    pub fn fading(&self) -> Option<Fading> {
        if self.in_a_row <= self.held || self.in_step() {
            return None;
        }
        let left = f64::from(self.blind.saturating_sub(self.in_a_row)) / f64::from(self.blind - self.held);
        Some(Fading { left, rest: self.rest })
    }

    /// More replies in a row than can be missed.
    pub fn most(&self) -> u32 {
        self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn held_then_faded_then_faulted_within_the_watchdogs_time() {
        for (rate, last_held, first_at_rest, faulted) in [(1000.0, 3, 10, 17), (2000.0, 6, 20, 35), (500.0, 2, 5, 8)] {
            let mut watch = LinkWatch::new(&ConfiguredHand { rate, ..Default::default() }, false);
            for lost in 1..=faulted {
                assert_eq!(watch.missed(), (lost == faulted).then_some(lost), "{rate} Hz");
                match watch.fading() {
                    None => assert!(lost <= last_held, "{rate} Hz, {lost}"),
                    Some(fading) => {
                        assert!(
                            lost > last_held && (fading.left == 0.0) == (lost >= first_at_rest),
                            "{rate} Hz, {lost}"
                        );
                    }
                }
            }
            // The Stop leaves one period later.
            assert!(f64::from(faulted + 1) / rate <= 0.018);
            assert!(watch.answered(), "begins anew");
            assert!(watch.fading().is_none() && !watch.answered());
        }
        // A watchdog of two periods, the least, lets one lost reply pass all the same.
        let mut slow = LinkWatch::new(&ConfiguredHand { rate: 500.0, watchdog_ms: 4, ..Default::default() }, false);
        assert_eq!((slow.missed(), slow.missed()), (None, Some(2)));
    }

    #[test]
    fn torques_fade_to_what_the_end_state_keeps() {
        let commanded = Vector4::new(3.0, -3.0, 0.5, 0.0);
        let half = Fading { left: 0.5, rest: 1.0 }.torques(&commanded);
        assert_eq!(half, Vector4::new(2.0, -2.0, 0.5, 0.0));
        assert_eq!(Fading { left: 0.0, rest: 0.0 }.torques(&commanded), Vector4::zeros());
    }
}
