//! The end state of a simulated finger, after a Stop or the silence of the host.

use super::{MILLISECOND, SimulatedFinger, State};
use crate::board::protocol::{Frame, Stopped};
use crate::model::configuration::EndState;

impl SimulatedFinger {
    pub(in crate::simulated) fn stop(&mut self, now: u64) -> Frame {
        match self.state {
            State::Enabled => self.end(now),
            State::Ready => (self.state, self.ended_at) = (State::Ended { holds_until: None }, Some(now)),
            // A repeated Stop does not prolong the hold.
            State::Idle | State::Ended { .. } => {}
        }
        Frame::Stopped(Stopped { status: self.status() })
    }

    /// Enters the end state that the host has set in its terms.
    pub(super) fn end(&mut self, now: u64) {
        let holds_until = match self.terms.end_state {
            EndState::Hold if self.terms.hold_time_ms > 0 => {
                self.torques = Self::clipped(self.torques, [self.terms.hold_torque_limit; 4]);
                Some(now + u64::from(self.terms.hold_time_ms) * MILLISECOND)
            }
            EndState::Release | EndState::Hold => {
                self.torques = [0; 4];
                None
            }
        };
        (self.state, self.ended_at) = (State::Ended { holds_until }, Some(now));
    }

    /// Clips each torque to plus or minus its limit.
    pub(super) fn clipped(torques: [i16; 4], limits: [u16; 4]) -> [i16; 4] {
        std::array::from_fn(|motor| {
            let limit = limits[motor].min(i16::MAX as u16) as i16;
            torques[motor].clamp(-limit, limit)
        })
    }
}
