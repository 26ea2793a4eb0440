//! Repair of a port: reopens it, checks that its boards are the same as at open, and shakes hands with them again.

use crate::board::protocol::{Capabilities, Configured, Identity, Status};
use crate::board::{Connection, Link, LinkError, Port, Terms, Transport};
use crate::finger::{Fault, FaultKind, LinkRepairEnd, RepairedLink, RestoredBoard, RestoredFinger, StopCounts};
use crate::hand::hardware::warn_of_doubtful_zero;
use crate::hand::{HandError, RecoveryError};
use crate::model::FingerNumber;
use crate::model::configuration::FINGERS;
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
    /// The released link or a new one. `None` while the servo has the link, and while the port is gone.
    link: Option<Link<Connection>>,
    /// Whether the boards are known to be the same as at open. Either the link has not failed, or the boards have
    /// answered after its failure, and their identities were the same as at open.
    pub checked: bool,
    /// Place of the finger that was last given to the servo while other fingers of the port ran.
    given: Option<usize>,
}

/// A board's properties at open, and how often it has restarted since then.
pub(super) struct KnownBoard {
    /// Number of the finger, 1 to 3.
    pub finger: FingerNumber,
    pub address: u8,
    pub terms: Terms,
    pub identity: Identity,
    pub zero_valid: bool,
    /// Whether the program itself drives the hardware of this finger (`FingerIo`). Such hardware keeps its terms until
    /// the hand is closed.
    pub has_io: bool,
    /// How often the board was found without terms after open. This means that it has restarted.
    pub restarts: u32,
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
            (self.released, self.checked) = (true, !released.failed);
            self.link = (!released.failed).then_some(released.link);
        }
        self.released
    }

    /// Whether the servo has ended. A servo that has ended does not take a link back.
    pub fn servo_ended(&self) -> bool {
        self.handover.released.is_abandoned()
    }

    /// Opens the port if it is gone, and asks its boards for their identities. They must be the same as at open. This
    /// changes nothing on a board, so a hold continues.
    pub fn reopen(&mut self) -> Result<(), HandError> {
        self.with_link(compare_all)
    }

    /// Opens the port if it is gone, and shakes hands with its boards. They must be the same as at open, with valid
    /// zeros. Sends no Stop and no terms before every board has proved to be the same.
    pub fn restore(&mut self) -> Result<[Option<Configured>; FINGERS], HandError> {
        let released = self.link.is_some();
        match self.with_link(shake_hands) {
            // The port vanished after the servo had released its link, and may be there again.
            Err(_) if released && self.link.is_none() && self.reconnect => self.with_link(shake_hands),
            outcome => outcome,
        }
    }

    /// Opens the port if it is gone, and calls `work` with its boards and its link.
    fn with_link<R>(
        &mut self,
        work: impl FnOnce(&mut [KnownBoard], &mut Link<Connection>) -> Result<R, HandError>,
    ) -> Result<R, HandError> {
        self.checked = false;
        let mut link = match self.link.take() {
            Some(link) => link,
            None => self.open()?,
        };
        let outcome = work(&mut self.boards, &mut link);
        let failed = matches!(outcome, Err(HandError::Link { source: LinkError::Port(_), .. }));
        // Dropping the link to a port closes the failed port, and the next attempt opens it. The link to hardware of
        // the program is kept.
        if !failed || link.transport().port().is_none() {
            self.link = Some(link);
        }
        self.checked = outcome.is_ok();
        outcome
    }

    /// Opens the port again after it has gone.
    fn open(&self) -> Result<Link<Connection>, HandError> {
        let finger = self.boards.first().map_or(FingerNumber::ONE, |board| board.finger);
        if !self.reconnect {
            return Err(RecoveryError::NotReconnected(finger).into());
        }
        let port = Port::open(&self.path, self.baud);
        let port = port.map_err(|error| HandError::Link { finger, source: error.into() })?;
        Ok(Link::new(Connection::from(port)))
    }

    /// Gives the link back to the servo, and makes every finger of the port recover. For each finger, in the order of
    /// the boards, `stops` has the counts of stop requests and faults before the recovery began.
    pub fn give_back(&mut self, configured: [Option<Configured>; FINGERS], stops: &[StopCounts; FINGERS]) {
        if let Some(link) = self.link.take() {
            self.released = false;
            let board = |place: usize| {
                let restored = |configured| self.boards[place].restored(configured, stops[place]);
                configured[place].map(restored)
            };
            let boards = [board(0), board(1), board(2)];
            // The ring has room for one link. The servo has released its link, so it has already taken the link of the
            // last push.
            let _ = self.handover.repaired.push(RepairedLink { link, boards });
        }
    }

    /// Shakes hands with the board at `place` while the servo keeps the link, because other fingers of the port run.
    /// Then makes that finger recover. `stops` has the counts of stop requests and faults before the recovery began.
    /// `repairs` counts the repairs of the finger. Returns false if another finger still waits for its servo.
    pub fn restore_beside_others(
        &mut self,
        place: usize,
        stops: StopCounts,
        repairs: &AtomicU32,
    ) -> Result<bool, HandError> {
        let Some(board) = self.boards.get_mut(place) else { return Ok(false) };
        board.compare(&mut self.handover.relay)?;
        let configured = board.configure(&mut self.handover.relay)?;
        let board = RestoredFinger { address: board.address, board: board.restored(configured, stops) };
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

    /// Must be called after the servo has released the link. If a finger was given to the servo and the servo has not
    /// taken it, subtracts the repair of this finger from its count: the servo discards the finger, and the repair of
    /// the link repeats the handshake of this finger. `repairs` has the counts in the order of the boards.
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

/// Asks the boards for their identities. They must be the same as at open.
fn compare_all(boards: &mut [KnownBoard], link: &mut Link<Connection>) -> Result<(), HandError> {
    boards.iter().try_for_each(|board| board.compare(link))
}

/// Compares the identities of all boards, and then configures the boards.
fn shake_hands(
    boards: &mut [KnownBoard],
    link: &mut Link<Connection>,
) -> Result<[Option<Configured>; FINGERS], HandError> {
    compare_all(boards, link)?;
    let mut all = [None; FINGERS];
    for (board, place) in boards.iter_mut().zip(&mut all) {
        *place = Some(board.configure(link)?);
    }
    Ok(all)
}

impl KnownBoard {
    /// Asks the board for its identity, which must agree with the one at open. Changes nothing on the board.
    fn compare<T: Transport>(&self, link: &mut Link<T>) -> Result<(), HandError> {
        let deadline = link.transport().now() + ANSWER;
        let identity = link.identity(self.address, deadline).map_err(|error| self.failed(error))?;
        match identity.agrees_with(&self.identity) {
            true => Ok(()),
            false => Err(self.faulted(Fault::new(FaultKind::IdentityChanged))),
        }
    }

    /// Stops the board and agrees on the terms with it. Its zeros must be the same as at open. Call
    /// [`KnownBoard::compare`] first, because another board than the one at open must not receive a Stop or terms.
    fn configure<T: Transport>(&mut self, link: &mut Link<T>) -> Result<Configured, HandError> {
        // A board whose port failed has not received a Stop. If cable and power are back before its watchdog trips, the
        // board still executes its last command. If another board of the port does not answer `compare_all`, this one
        // gets no Stop in this attempt, and its watchdog stops it.
        let loses_touch = self.identity.capabilities.has(Capabilities::TACTILE);
        if self.has_io || self.zero_valid && !loses_touch {
            // Hardware of the program does not confirm a Stop that fails. The call of `agree` below stops it again, and
            // reports the error of the program.
            let _ = link.stop(self.address, 0);
        } else {
            // A board that never reports valid zeros has lost its counts exactly if it has lost its terms. A board with
            // tactile elements has lost their readings exactly if it has lost its terms. The board gets new terms
            // below, so `restarts` keeps the finding for the next attempt.
            let deadline = link.transport().now() + ANSWER;
            let status = link.confirmed_stop(self.address, deadline).map_err(|error| self.failed(error))?;
            self.restarts += u32::from(!status.has(Status::CONFIGURED));
        }
        let deadline = link.transport().now() + ANSWER;
        let configured = link.agree(self.address, &self.terms, &self.identity, deadline);
        let configured = configured.map_err(|error| self.failed(error))?;
        let status = configured.status;
        if status.has(Status::ZERO_VALID) {
            return Ok(configured);
        }
        // If hardware of the program has lost its counts since open, the bit *configured* of its status is 0, even
        // after a successful `agree`.
        if self.zero_valid || self.restarts > 0 || self.has_io && !status.has(Status::CONFIGURED) {
            return Err(self.faulted(Fault::of(FaultKind::ZeroLost, f64::from(status.0))));
        }
        if self.has_io {
            warn_of_doubtful_zero(self.finger);
        }
        Ok(configured)
    }

    /// The board after its handshake, for its servo.
    fn restored(&self, configured: Configured, stops: StopCounts) -> RestoredBoard {
        RestoredBoard { configured, stops, restarts: self.restarts }
    }

    fn failed(&self, source: LinkError) -> HandError {
        HandError::Link { finger: self.finger, source }
    }

    fn faulted(&self, fault: Fault) -> HandError {
        HandError::Faulted { finger: self.finger, fault }
    }
}

#[cfg(test)]
mod tests;
