//! The steps of a conversation, and functions that construct them.

use super::frames::sealed;
use sun2xp::board::protocol::*;
use sun2xp::model::configuration::EndState;

/// A step: an action on the board with the answer that must follow, or a check of the motors.
#[derive(Clone)]
pub enum Step {
    /// Sends bytes and compares the answer. `None` means that the board must stay silent.
    Send(Vec<u8>, Option<Answer>),
    /// Waits for this time, ms.
    Wait(u64),
    /// Gives the board these faults, which stay until the next such step.
    Faults(Status),
    /// Compares the present torques of the motors with these, torque units.
    Torques([i16; 4]),
}

/// The expected answer.
#[derive(Clone)]
pub enum Answer {
    Identity,
    /// This status and those of the other answers are compared without *zero valid*, which depends on the board.
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

/// Sends `bytes` before those of `step`, in the same piece.
pub fn after(bytes: &[u8], step: Step) -> Step {
    match step {
        Step::Send(sent, answer) => Step::Send([bytes, &sent].concat(), answer),
        other => other,
    }
}
