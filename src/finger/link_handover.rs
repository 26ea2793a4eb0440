//! A servo lends its link to whoever mends it: opening ports and shaking hands take long, and are not for a servo.
//! Whole values in rings of one place; neither side waits.

use crate::board::Link;
use crate::board::protocol::Configured;
use crate::model::configuration::FINGERS;
use crate::realtime::{Consumer, Producer, ring};

/// A link that no finger uses any more.
pub struct Lent<T> {
    /// It.
    pub link: Link<T>,
    /// Its port has failed: it is of no use but to be closed.
    pub failed: bool,
}

/// A link whose boards have shaken hands anew.
pub struct Mended<T> {
    /// It.
    pub link: Link<T>,
    /// What the boards of its fingers, in their order, have confirmed.
    pub configured: [Option<Configured>; FINGERS],
    /// Emergency stops that had been called for when this was asked for.
    pub stop_calls: u32,
}

/// The servo's end.
pub struct Lender<T> {
    pub(super) lend: Producer<Lent<T>>,
    pub(super) mended: Consumer<Mended<T>>,
}

/// The mender's end.
pub struct Borrower<T> {
    /// From the servo.
    pub lent: Consumer<Lent<T>>,
    /// To the servo.
    pub mended: Producer<Mended<T>>,
}

/// Both ends.
pub fn link_handover<T>() -> (Lender<T>, Borrower<T>) {
    let (lend, lent) = ring(1);
    let (to_servo, from_mender) = ring(1);
    (Lender { lend, mended: from_mender }, Borrower { lent, mended: to_servo })
}
