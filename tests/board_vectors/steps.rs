//! The steps of a conversation: an action on the board and the result that must follow.

use super::frames::sealed;
use sun2xp::board::protocol::*;
use sun2xp::model::configuration::EndState;

/// An action on the board and the result that must follow.
#[derive(Clone)]
pub enum Step {
    /// Sends bytes and compares the answer. `None` means that the board must stay silent.
    Send(Vec<u8>, Option<Answer>),
    /// Lets this much time pass, ms.
    Wait(u64),
    /// Faults that are present from now on.
    Faults(Status),
    /// The present torques of the motors, torque units.
    Torques([i16; 4]),
}

#[derive(Clone)]
pub enum Answer {
    Identity,
    /// The status in this answer and the next two. *zero valid* depends on the board and is left out.
    Configured(Status),
    Reply(Status),
    Stopped(Status),
    Refused {
        reason: u8,
        detail: u16,
    },
}

pub const READY: Status = Status::CONFIGURED;
pub const ENDED: Status = Status(Status::CONFIGURED.0 | Status::ENDED.0);
pub const ENABLED: Status = Status(Status::CONFIGURED.0 | Status::ENABLED.0);
pub const NO_TORQUE: Step = Step::Torques([0; 4]);

/// Terms that every board under test must be able to carry out.
pub const TERMS: Configure = Configure {
    version: 1,
    watchdog_ms: 20,
    end_state: EndState::Release,
    hold_time_ms: 60,
    hold_torque_limit: 500,
    torque_limits: [10_000, 10_000, 10_000, 9_000],
    torque_constants: [23_400; 4],
};
pub const HOLD: Configure = Configure { end_state: EndState::Hold, ..TERMS };

pub fn sent(frame: Frame, answer: Answer) -> Step {
    // The sequence number is arbitrary. The answer repeats it.
    let wire = WireFrame::new(&Message { address: 1, sequence: 0xA5, frame });
    Step::Send(wire.as_bytes().to_vec(), Some(answer))
}

pub fn raw(content: &[u8], reason: u8, detail: u16) -> Step {
    Step::Send(sealed(content), Some(Answer::Refused { reason, detail }))
}

pub fn refused(reason: u8, detail: u16) -> Answer {
    Answer::Refused { reason, detail }
}

pub fn configure(terms: Configure, answer: Answer) -> Step {
    sent(Frame::Configure(terms), answer)
}

pub fn stop(status: Status) -> Step {
    sent(Frame::Stop(Stop), Answer::Stopped(status))
}

pub fn command(torques: [i16; 4], status: Status) -> Step {
    sent(Frame::Command(Command { toggle: true, enable: true, torques }), Answer::Reply(status))
}

pub fn disabled(torques: [i16; 4], status: Status) -> Step {
    sent(Frame::Command(Command { toggle: false, enable: false, torques }), Answer::Reply(status))
}

pub fn hello(lowest_version: u8, highest_version: u8, answer: Answer) -> Step {
    sent(Frame::Hello(Hello { lowest_version, highest_version }), answer)
}
