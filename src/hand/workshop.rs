//! What a port is mended with: its link, once the servo has lent it, and what its boards were at open.

use crate::board::protocol::{Configured, Identity, Status};
use crate::board::{Link, LinkError, Port, Terms};
use crate::finger::{Fault, FaultKind, LinkRepairEnd, RepairedLink};
use crate::hand::{HandError, RecoveryError};
use crate::model::configuration::FINGERS;
use crate::realtime::now;
use std::path::PathBuf;

/// How long a board may take to answer, ns, each time it is tried: short, because it is tried again.
const ANSWER: u64 = 300_000_000;

/// What a port is mended with.
pub(super) struct Workshop {
    path: PathBuf,
    baud: u32,
    /// Whether a port that has failed is opened again.
    pub reconnect: bool,
    /// In the order of the servo's.
    pub boards: Vec<KnownBoard>,
    handover: LinkRepairEnd<Port>,
    /// The servo has lent its link, and not got it back.
    released: bool,
    /// That link, or a new one; none where the port is gone.
    link: Option<Link<Port>>,
    /// Its boards have answered, and are those of open.
    pub checked: bool,
}

/// What a board was at open.
pub(super) struct KnownBoard {
    /// 1 to 3.
    pub finger: i32,
    pub address: u8,
    pub terms: Terms,
    pub identity: Identity,
    pub zero_valid: bool,
}

impl Workshop {
    /// `path` and `baud`: how the port is opened. `reconnect`: whether it is, once it has failed. `boards` in the order
    /// of the servo's fingers.
    pub fn new(
        path: PathBuf,
        baud: u32,
        reconnect: bool,
        boards: Vec<KnownBoard>,
        handover: LinkRepairEnd<Port>,
    ) -> Self {
        Self { path, baud, reconnect, boards, handover, released: false, link: None, checked: false }
    }

    /// Takes the link, if the servo has lent it.
    pub fn fetch(&mut self) -> bool {
        if let Some(released) = self.handover.released.pop() {
            (self.released, self.checked) = (true, false);
            self.link = (!released.failed).then_some(released.link);
        }
        self.released
    }

    /// Whether the servo has failed: it takes nothing back.
    pub fn servo_ended(&self) -> bool {
        self.handover.released.is_abandoned()
    }

    /// Opens the port where it is gone, and shakes hands with its boards: the same ones, with their zeros.
    pub fn mend(&mut self) -> Result<[Option<Configured>; FINGERS], HandError> {
        self.checked = false;
        let first = self.boards.first().map_or(0, |board| board.finger);
        let mut link = match self.link.take() {
            Some(link) => link,
            None if self.reconnect => Link::open(&self.path, self.baud)
                .map_err(|source| HandError::Link { finger: first as usize, source })?, // 1 to 3
            None => return Err(RecoveryError::NotReconnected(first).into()),
        };
        let met = self.meet(&mut link);
        // A port that has failed is closed here; the next attempt opens it.
        if !matches!(met, Err(HandError::Link { source: LinkError::Port(_), .. })) {
            self.link = Some(link);
        }
        self.checked = met.is_ok();
        met
    }

    /// Shakes hands with the boards of the port: the same ones as at open, with their zeros.
    fn meet(&self, link: &mut Link<Port>) -> Result<[Option<Configured>; FINGERS], HandError> {
        let mut all = [None; FINGERS];
        for (board, place) in self.boards.iter().zip(&mut all) {
            let KnownBoard { finger, address, ref terms, .. } = *board;
            // One whose port had failed was not told to stop; cable and power may be back before its watchdog's time is
            // over.
            let _ = link.stop(address, 0);
            let (identity, configured) = link
                .shake_hands(address, terms, now() + ANSWER)
                .map_err(|source| HandError::Link { finger: finger as usize, source })?; // 1 to 3
            board.check(&identity, configured.status)?;
            *place = Some(configured);
        }
        Ok(all)
    }

    pub fn give_back(&mut self, configured: [Option<Configured>; FINGERS], stop_calls: u32) {
        if let Some(link) = self.link.take() {
            self.released = false;
            // There is room: the servo has taken the last one, or it would not have lent this one.
            let _ = self.handover.repaired.push(RepairedLink { link, configured, stop_calls });
        }
    }
}

impl KnownBoard {
    fn check(&self, identity: &Identity, status: Status) -> Result<(), HandError> {
        let faulted = |fault| Err(HandError::Faulted { finger: self.finger, fault });
        if *identity != self.identity {
            return faulted(Fault::new(FaultKind::IdentityChanged));
        }
        if self.zero_valid && !status.has(Status::ZERO_VALID) {
            return faulted(Fault::of(FaultKind::ZeroLost, f64::from(status.0)));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::identities::tests::identity;
    use crate::model::configuration::{ConfiguredFinger, ConfiguredHand};

    /// So no two boards of a hand have one number after a recovery either.
    #[test]
    fn a_board_with_another_number_is_not_the_one_of_open() {
        let terms = Terms::new(&ConfiguredHand::default(), &ConfiguredFinger::default());
        let board = KnownBoard { finger: 1, address: 1, terms, identity: identity(5), zero_valid: false };
        assert!(board.check(&identity(5), Status::default()).is_ok());
        let error = board.check(&identity(6), Status::default()).expect_err("another board");
        let changed = |fault: Fault| fault.kind == FaultKind::IdentityChanged;
        assert!(matches!(error, HandError::Faulted { finger: 1, fault } if changed(fault)), "{error}");
    }
}
