//! What a client requests.

use crate::error::{FieldError, within};

/// What a client requests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Action {
    /// Become the owner of the hand.
    Acquire = 1,
    /// End the ownership. Every finger goes to its end state.
    Release = 2,
    /// Recover fingers that have stopped.
    Recover = 3,
    /// Zero a finger.
    Calibrate = 4,
    /// Identify a finger: measure its gauge gains, tendon stiffness and friction.
    Identify = 5,
    /// Bring fingers to their end state at once.
    Stop = 6,
}

impl Action {
    /// All actions.
    pub const ALL: [Action; 6] =
        [Self::Acquire, Self::Release, Self::Recover, Self::Calibrate, Self::Identify, Self::Stop];

    /// The name of the action in Zenoh keys.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Acquire => "acquire",
            Self::Release => "release",
            Self::Recover => "recover",
            Self::Calibrate => "calibrate",
            Self::Identify => "identify",
            Self::Stop => "stop",
        }
    }

    pub(crate) fn decode(number: u8) -> Result<Self, FieldError> {
        within("action", u64::from(number), 1, Self::ALL.len() as u64)?;
        Ok(Self::ALL[usize::from(number) - 1])
    }
}
