//! The operations that are named in the remedies of faults and errors.

/// An operation of the library that a remedy asks the caller to perform. The text of the remedy describes the operation
/// in words. The C interface adds the name of the call that performs the operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Open the hand.
    Open,
    /// Close the hand.
    Close,
    /// Recover a faulted finger.
    Recover,
    /// Zero the sensors of a finger.
    Zero,
    /// Query the status of a finger.
    QueryStatus,
}
