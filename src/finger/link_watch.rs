//! The reaction to lost replies in a row. First the last command is held, or continued by prediction. Then the motor
//! torques fade to their final values: the last torques, limited to what the end state keeps. Finally the finger
//! faults, before the watchdog of its board trips. A fault needs at least two lost replies, and its Stop is sent at
//! least three periods after the last good reply. So a watchdog of less than three periods trips before the Stop if the
//! commands are lost too.

use crate::model::configuration::{ConfiguredHand, EndState};
use nalgebra::Vector4;
use serde::{Deserialize, Serialize};

/// Time for which the last command is held, ms.
const HELD_MS: f64 = 3.0;

/// Time after which the motor torques have reached their final values, ms. A torque without feedback winds a tendon up,
/// or unwinds it from its motor, within some milliseconds. The watchdog does not prevent that, because commands are
/// still sent.
const FADED_MS: f64 = 10.0;

/// Minimum number of lost replies in a row before the motor torques have reached their final values. [`FADED_MS`] is
/// shorter than this number of periods only at rates below 300 Hz, which a configuration does not permit.
const LEAST_FADED: u32 = 3;

/// Minimum number of lost replies in a row before the finger faults. At low rates too, one lost reply is not a fault.
const LEAST_LOST: u32 = 2;

/// Time-out of a simulation that runs in step, for example of a built-in simulated board, ms. Such a board is silent
/// when the machine is too busy to run it or to transfer its bytes. This is not a reason to stop the hand.
const SIMULATION_PATIENCE_MS: f64 = 5000.0;

/// Time after which an unanswered command to a simulation that runs in step is sent again, ms. The command or the reply
/// may have been discarded.
const REPEAT_MS: f64 = 100.0;

/// Motor torques that fade from the last command to their final values.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct Fading {
    /// Remaining part of the fade, 1 to 0.
    pub left: f64,
    /// Largest torque that a motor keeps after the fade, N cm: 0 with the end state *release*, and
    /// `hand.hold_torque_limit` with *hold*.
    pub rest: f64,
}

impl Fading {
    /// Returns whether a finger of this hand can have this fade.
    pub(super) fn possible(&self, hand: &ConfiguredHand) -> bool {
        (0.0..=1.0).contains(&self.left) && (0.0..=hand.hold_torque_limit).contains(&self.rest)
    }

    /// Returns the faded torques, N cm.
    pub fn torques(&self, commanded: &Vector4<f64>) -> Vector4<f64> {
        commanded.map(|torque| {
            let kept = torque.clamp(-self.rest, self.rest);
            kept + (torque - kept) * self.left
        })
    }
}

/// Counts lost replies in a row. It counts attempts and not time: when the whole machine pauses, no reply is lost.
pub(super) struct LinkWatch {
    /// Whether the finger is a simulation that runs in step.
    simulated: bool,
    /// Lost replies in a row so far.
    in_a_row: u32,
    /// Cycles from one repetition of an unanswered command to the next.
    repeat_after: u32,
    /// Lost replies in a row after which the torques begin to fade.
    held_for: u32,
    /// Lost replies in a row at which the torques have reached their final values.
    faded_at: u32,
    /// Lost replies in a row at which the finger faults.
    fault_at: u32,
    /// [`Fading::rest`] of every fade.
    rest: f64,
}

impl LinkWatch {
    /// Constructs the watch of a finger. `simulated` is true if the finger has a built-in simulated board, or another
    /// simulation that runs in step.
    pub fn new(hand: &ConfiguredHand, simulated: bool) -> Self {
        let cycles = |milliseconds: f64| (milliseconds * 1e-3 * hand.rate).ceil() as u32;
        // The board gets the Stop one period after the last lost reply. The board must get it within the watchdog's
        // time after the last good reply.
        let within_watchdog = (f64::from(hand.watchdog_ms) * 1e-3 * hand.rate).floor() as u32;
        Self {
            simulated,
            in_a_row: 0,
            repeat_after: cycles(REPEAT_MS),
            held_for: cycles(HELD_MS),
            faded_at: cycles(FADED_MS).max(LEAST_FADED),
            fault_at: match simulated {
                true => cycles(SIMULATION_PATIENCE_MS),
                false => within_watchdog.saturating_sub(1).max(LEAST_LOST),
            },
            rest: match hand.end_state {
                EndState::Release => 0.0,
                EndState::Hold => hand.hold_torque_limit,
            },
        }
    }

    /// Returns whether the finger and its controller run in step, as built-in simulated fingers do. If they do, the
    /// next command is sent only after the reply to the last one, however late the reply is. In a cycle without a
    /// reply, the controller does not run and the simulated finger does not move. If they did not run in step, a busy
    /// machine could let the controller count time that did not pass at the finger, or let the physics run without its
    /// controller. The finger would then move wildly.
    pub fn in_step(&self) -> bool {
        self.simulated
    }

    /// Returns whether an unanswered command must be sent again.
    pub fn repeats(&self) -> bool {
        self.in_a_row.is_multiple_of(self.repeat_after)
    }

    /// Notes a reply. Returns whether so many replies were lost that the controller must restart from the measured
    /// tensions.
    pub fn answered(&mut self) -> bool {
        std::mem::take(&mut self.in_a_row) >= self.faded_at && !self.in_step()
    }

    /// Notes a lost reply. Returns the number of lost replies in a row if it is so large that the finger must fault.
    pub fn missed(&mut self) -> Option<u32> {
        self.in_a_row += 1;
        (self.in_a_row >= self.fault_at).then_some(self.in_a_row)
    }

    /// Returns the number of lost replies in a row if they explain why the watchdog of the board has tripped. They
    /// explain it if they are at least half of the number at which the finger faults. In this case the servo has sent
    /// commands for about half of the watchdog's time or longer. If these commands had reached the board, its watchdog
    /// would not have tripped.
    pub fn explains_watchdog(&self) -> Option<u32> {
        (2 * self.in_a_row >= self.fault_at).then_some(self.in_a_row)
    }

    /// Returns the fade of the next command; none while the command is held, and for a simulation that runs in step.
    pub fn fading(&self) -> Option<Fading> {
        if self.in_a_row <= self.held_for || self.in_step() {
            return None;
        }
        let left = f64::from(self.faded_at.saturating_sub(self.in_a_row)) / f64::from(self.faded_at - self.held_for);
        Some(Fading { left, rest: self.rest })
    }

    /// Returns the number of lost replies in a row at which the finger faults.
    pub fn fault_at(&self) -> u32 {
        self.fault_at
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn torques_are_held_then_faded_and_the_finger_faults_within_the_watchdogs_time() {
        for (rate, last_held, first_faded, faulted) in [(1000.0, 3, 10, 17), (2000.0, 6, 20, 35), (500.0, 2, 5, 8)] {
            let mut watch = LinkWatch::new(&ConfiguredHand { rate, ..Default::default() }, false);
            for lost in 1..=faulted {
                assert_eq!(watch.missed(), (lost == faulted).then_some(lost), "{rate} Hz");
                match watch.fading() {
                    None => assert!(lost <= last_held, "{rate} Hz, {lost}"),
                    Some(fading) => {
                        assert!(lost > last_held && (fading.left == 0.0) == (lost >= first_faded), "{rate} Hz, {lost}");
                    }
                }
            }
            // The Stop is sent one period later.
            assert!(f64::from(faulted + 1) / rate <= 0.018);
            assert!(watch.answered(), "the controller restarts");
            assert!(watch.fading().is_none() && !watch.answered());
        }
        // With the shortest watchdog, two periods, one lost reply is still not a fault.
        let mut slow = LinkWatch::new(&ConfiguredHand { rate: 500.0, watchdog_ms: 4, ..Default::default() }, false);
        assert_eq!((slow.missed(), slow.missed()), (None, Some(2)));
    }

    #[test]
    fn a_watchdog_that_trips_after_mostly_lost_replies_is_explained_by_them() {
        let mut watch = LinkWatch::new(&ConfiguredHand::default(), false);
        for lost in 1..=16 {
            assert_eq!(watch.missed(), None);
            assert_eq!(watch.explains_watchdog(), (lost >= 9).then_some(lost), "{lost} of 17");
        }
        watch.answered();
        assert_eq!(watch.explains_watchdog(), None);
    }

    #[test]
    fn torques_fade_to_what_the_end_state_keeps() {
        let commanded = Vector4::new(3.0, -3.0, 0.5, 0.0);
        let half = Fading { left: 0.5, rest: 1.0 }.torques(&commanded);
        assert_eq!(half, Vector4::new(2.0, -2.0, 0.5, 0.0));
        assert_eq!(Fading { left: 0.0, rest: 0.0 }.torques(&commanded), Vector4::zeros());
    }
}
