//! Repair of a port: reopens it and shakes hands again, and checks that its boards are the same as at open.

use crate::board::protocol::{Configured, Identity, Status};
use crate::board::{Connection, Link, LinkError, Port, Terms, Transport};
use crate::finger::{Fault, FaultKind, LinkRepairEnd, RepairedLink, RestoredBoard, RestoredFinger, StopCounts};
use crate::hand::{HandError, RecoveryError};
use crate::model::FingerNumber;
use crate::model::configuration::FINGERS;
use crate::realtime::now;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

/// Time for a board to answer one attempt, ns. It is short, because the attempt is repeated.
const ANSWER: u64 = 300_000_000;

/// A port that may need repair. It holds the port's link while the servo has released the link.
pub(super) struct PortRepair {
    path: PathBuf,
    baud: u32,
    /// Whether the port is opened again after it has failed.
    pub reconnect: bool,
    /// The boards, in the order of the servo's fingers.
    pub boards: Vec<KnownBoard>,
    handover: LinkRepairEnd<Connection>,
    /// Whether the servo has released its link and has not got it back.
    released: bool,
    /// The released link or a new one; `None` while the port is gone.
    link: Option<Link<Connection>>,
    /// Whether the boards have answered and are the same as at open.
    pub checked: bool,
    /// Place of the finger that was given to the servo last, beside others.
    given: Option<usize>,
}

/// A board's properties at open.
pub(super) struct KnownBoard {
    /// Number of the finger, 1 to 3.
    pub finger: FingerNumber,
    pub address: u8,
    pub terms: Terms,
    pub identity: Identity,
    pub zero_valid: bool,
}

impl PortRepair {
    /// `reconnect` says whether the port, given by `path` and `baud`, is opened again after it has failed. `boards` are
    /// in the order of the servo's fingers.
    pub fn new(
        path: PathBuf,
        baud: u32,
        reconnect: bool,
        boards: Vec<KnownBoard>,
        handover: LinkRepairEnd<Connection>,
    ) -> Self {
        Self { path, baud, reconnect, boards, handover, released: false, link: None, checked: false, given: None }
    }

    /// Takes the link if the servo has released it. Returns whether the servo has released it.
    pub fn take_link(&mut self) -> bool {
        if let Some(released) = self.handover.released.pop() {
            (self.released, self.checked) = (true, false);
            self.link = (!released.failed).then_some(released.link);
        }
        self.released
    }

    /// Whether the servo has ended. Then it does not take a link back.
    pub fn servo_ended(&self) -> bool {
        self.handover.released.is_abandoned()
    }

    /// Opens the port if it is gone, and shakes hands with its boards. They must be the same as at open, with valid
    /// zeros.
    pub fn restore(&mut self) -> Result<[Option<Configured>; FINGERS], HandError> {
        self.checked = false;
        let Some(first) = self.boards.first().map(|board| board.finger) else { return Ok([None; FINGERS]) };
        let mut link = match self.link.take() {
            Some(link) => link,
            None if self.reconnect => {
                let port = Port::open(&self.path, self.baud);
                let port = port.map_err(|error| HandError::Link { finger: first, source: error.into() })?;
                Link::new(Connection::from(port))
            }
            None => return Err(RecoveryError::NotReconnected(first).into()),
        };
        let outcome = self.shake_hands(&mut link);
        let failed = matches!(outcome, Err(HandError::Link { source: LinkError::Port(_), .. }));
        // A failed port is closed by dropping its link. The next attempt opens it. Hardware of the program stays.
        if !failed || link.transport().port().is_none() {
            self.link = Some(link);
        }
        self.checked = outcome.is_ok();
        outcome
    }

    /// Shakes hands with the boards of the port. They must be the same as at open, with valid zeros.
    fn shake_hands(&self, link: &mut Link<Connection>) -> Result<[Option<Configured>; FINGERS], HandError> {
        let mut all = [None; FINGERS];
        for (board, place) in self.boards.iter().zip(&mut all) {
            *place = Some(board.shake_hands(link)?);
        }
        Ok(all)
    }

    /// Gives the link back to the servo, and makes every finger of the port recover. For each finger, `stops` has the
    /// numbers of requests to stop that were made before the recovery began, in the order of the boards.
    pub fn give_back(&mut self, configured: [Option<Configured>; FINGERS], stops: &[StopCounts; FINGERS]) {
        if let Some(link) = self.link.take() {
            self.released = false;
            let board =
                |place: usize| configured[place].map(|configured| RestoredBoard { configured, stops: stops[place] });
            // The ring has room for one link. The servo has released `link`, so it has taken the link of the last push.
            let _ = self.handover.repaired.push(RepairedLink { link, boards: [board(0), board(1), board(2)] });
        }
    }

    /// Shakes hands with the board at `place` while the servo keeps the link, because other fingers of the port run.
    /// Then makes that finger recover. `stops` has the numbers of requests to stop that were made before the recovery
    /// began. `repairs` counts the repairs of the finger. Returns false if another finger still waits for its servo.
    pub fn restore_beside_others(
        &mut self,
        place: usize,
        stops: StopCounts,
        repairs: &AtomicU32,
    ) -> Result<bool, HandError> {
        let Some(board) = self.boards.get(place) else { return Ok(false) };
        let configured = board.shake_hands(&mut self.handover.relay)?;
        let board = RestoredFinger { address: board.address, board: RestoredBoard { configured, stops } };
        Ok(self.give(place, board, repairs))
    }

    /// Gives a finger to the servo, and counts its repair. The repair is counted first, so that no finger has more
    /// recoveries than repairs. Returns false if another finger still waits for its servo.
    fn give(&mut self, place: usize, board: RestoredFinger, repairs: &AtomicU32) -> bool {
        repairs.fetch_add(1, Ordering::Release);
        let given = self.handover.restored.push(board).is_ok();
        match given {
            true => self.given = Some(place),
            false => {
                repairs.fetch_sub(1, Ordering::Release);
            }
        }
        given
    }

    /// Takes back the count of a finger that was given to the servo, and that the servo has not taken. The servo has
    /// released the link, and discards the finger. The repair of the link replaces its handshake. `repairs` has the
    /// counts in the order of the boards.
    pub fn discard_given(&mut self, repairs: &[AtomicU32; FINGERS]) {
        if let Some(place) = self.given.take().filter(|_| !self.is_taken()) {
            repairs[place].fetch_sub(1, Ordering::Release);
        }
    }

    /// Returns whether the servo has taken the finger of [`PortRepair::restore_beside_others`].
    pub fn is_taken(&self) -> bool {
        self.handover.restored.is_empty()
    }
}

impl KnownBoard {
    /// Stops the board and shakes hands with it. It must be the same as at open, with valid zeros.
    fn shake_hands<T: Transport>(&self, link: &mut Link<T>) -> Result<Configured, HandError> {
        let KnownBoard { finger, address, ref terms, .. } = *self;
        // A board whose port failed has not received a Stop. If cable and power are back before its watchdog trips, the
        // board still executes its last command.
        let _ = link.stop(address, 0);
        let (identity, configured) =
            link.shake_hands(address, terms, now() + ANSWER).map_err(|source| HandError::Link { finger, source })?;
        self.check(&identity, configured.status)?;
        Ok(configured)
    }

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
    use crate::finger::link_handover;
    use crate::hand::identities::tests::identity;
    use crate::model::configuration::{ConfiguredFinger, ConfiguredHand};

    /// The check also ensures that the numbers of a hand's boards still differ after a recovery.
    #[test]
    fn a_board_with_another_number_is_not_the_one_of_open() {
        let terms = Terms::new(&ConfiguredHand::default(), &ConfiguredFinger::default());
        let board =
            KnownBoard { finger: FingerNumber::ONE, address: 1, terms, identity: identity(5), zero_valid: false };
        assert!(board.check(&identity(5), Status::default()).is_ok());
        let error = board.check(&identity(6), Status::default()).expect_err("another board");
        let changed = |fault: Fault| fault.kind == FaultKind::IdentityChanged;
        assert!(matches!(error, HandError::Faulted { finger: FingerNumber::ONE, fault } if changed(fault)), "{error}");
    }

    /// A finger that the servo takes and that faults at once must not have more recoveries than repairs, so its repair
    /// is counted before the servo gets it. A finger that the servo does not take has no repair.
    #[test]
    fn a_repair_is_counted_exactly_if_the_servo_can_take_the_finger() {
        let (_servo, repair_end) = link_handover();
        let mut repair = PortRepair::new(PathBuf::new(), 0, false, Vec::new(), repair_end);
        let repairs = [const { AtomicU32::new(0) }; FINGERS];
        let counts = || repairs.each_ref().map(|repairs| repairs.load(Ordering::Acquire));
        let board = RestoredBoard { configured: Configured::default(), stops: StopCounts::default() };
        let mut give = |place: usize| {
            let address = place as u8 + 1;
            (repair.give(place, RestoredFinger { address, board }, &repairs[place]), counts())
        };
        assert_eq!(give(1), (true, [0, 1, 0]));
        assert_eq!(give(2), (false, [0, 1, 0]), "finger 2 still waits");
        // The servo has released the link without taking finger 2.
        repair.discard_given(&repairs);
        repair.discard_given(&repairs);
        assert_eq!(counts(), [0, 0, 0]);
    }
}
