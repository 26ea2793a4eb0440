//! The requests outside the servo's cycle. They are repeated until the board answers. Only [`Link::stop`] sends its
//! request once.

use super::asked::Asked;
use super::{Allowance, Link, LinkCounters};
use crate::board::link_error::LinkError;
use crate::board::protocol::{
    ANY_ADDRESS, Configure, Configured, Frame, HIGHEST_ADDRESS, Hello, Identity, Kind, MAX_WIRE, Message, Reason,
    Refused, Status, Stop, VERSION, WireFrame,
};
use crate::board::terms::Terms;
use crate::board::transport::Transport;

/// The longest wait for the answer to one request, ns. With a USB bridge in its slowest setting, the answer takes about
/// 35 ms.
const PATIENCE: u64 = 50_000_000;

impl<T: Transport> Link<T> {
    /// Finds the finger with this address, 1 to 15, and agrees on `terms` with it. This starts no motor. If the finger
    /// is in the end state *hold*, the hold ends and the motors go off. Retries until `deadline` (ns on the transport's
    /// clock), because a board may still be starting. Returns at once if waiting cannot help.
    ///
    /// Do not call this in the servo's cycle, because it discards Replies of other fingers on the port.
    pub fn shake_hands(
        &mut self,
        address: u8,
        terms: &Terms,
        deadline: u64,
    ) -> Result<(Identity, Configured), LinkError> {
        let identity = self.identity(address, deadline)?;
        let configured = self.agree(address, terms, &identity, deadline)?;
        Ok((identity, configured))
    }

    /// Asks the finger with this address, 1 to 15, for its identity. Sends only Hello, which changes nothing on a
    /// board. Retries until `deadline` (ns on the transport's clock).
    ///
    /// Do not call this in the servo's cycle, because it discards Replies of other fingers on the port.
    pub fn identity(&mut self, address: u8, deadline: u64) -> Result<Identity, LinkError> {
        self.transport.discard_input()?;
        self.unread = 0..0;
        self.identify(address, deadline)
    }

    /// Agrees on `terms` with the finger with this address and identity. This starts no motor. If the finger is in the
    /// end state *hold*, the hold ends and the motors go off. Retries until `deadline` (ns on the transport's clock).
    ///
    /// Do not call this in the servo's cycle, because it discards Replies of other fingers on the port.
    pub fn agree(
        &mut self,
        address: u8,
        terms: &Terms,
        identity: &Identity,
        deadline: u64,
    ) -> Result<Configured, LinkError> {
        let configure = terms.configure(identity)?;
        self.configure(address, configure, deadline)
    }

    /// Asks every finger at the port for its identity, and returns the fingers that answer, sorted by address. Sends
    /// only Hello, which changes nothing on a board. Waits until `deadline` (ns on the transport's clock) for the first
    /// answer, and then at most 100 ms for each other finger of the board.
    ///
    /// # Errors
    /// Returns an error if the port fails, if no finger answers, or if the first finger refuses or has another protocol
    /// version.
    pub fn identities(&mut self, deadline: u64) -> Result<Vec<(u8, Identity)>, LinkError> {
        let (first, identity) = self.first_identity(deadline)?;
        let mut found = vec![(first, identity)];
        for address in (1..=HIGHEST_ADDRESS).filter(|&address| address != first) {
            if identity.addresses & 1 << address != 0 {
                let deadline = self.transport.now() + 2 * PATIENCE;
                match self.identify(address, deadline) {
                    Ok(identity) => found.push((address, identity)),
                    Err(LinkError::Port(error)) => return Err(error.into()),
                    // A defective finger must not hide the others of its board.
                    Err(_) => {}
                }
            }
        }
        found.sort_by_key(|&(address, _)| address);
        Ok(found)
    }

    /// Asks any finger at the port for its identity, and returns the answer.
    fn first_identity(&mut self, deadline: u64) -> Result<(u8, Identity), LinkError> {
        let before = self.counters();
        let began = self.transport.now();
        let hello = Frame::Hello(Hello { lowest_version: VERSION, highest_version: VERSION });
        while self.transport.now() < deadline {
            let Some(answer) = self.exchange(ANY_ADDRESS, hello, deadline)? else { continue };
            if let Some(identity) = identity_in(&answer)? {
                return Ok((answer.address, identity));
            }
        }
        Err(self.unidentified(ANY_ADDRESS, &before, began))
    }

    fn identify(&mut self, address: u8, deadline: u64) -> Result<Identity, LinkError> {
        let began = self.transport.now();
        let before = self.counters();
        let hello = Frame::Hello(Hello { lowest_version: VERSION, highest_version: VERSION });
        let mut attempts = 0u32;
        while self.transport.now() < deadline {
            // After two failed attempts, every second attempt is addressed to any finger. This distinguishes a wrong
            // address from a board that does not answer.
            let asked = if attempts >= 2 && attempts.is_multiple_of(2) { ANY_ADDRESS } else { address };
            attempts = attempts.saturating_add(1);
            let Some(answer) = self.exchange(asked, hello, deadline)? else { continue };
            match identity_in(&answer)? {
                Some(identity) if answer.address == address => return Ok(identity),
                Some(Identity { addresses, .. }) if addresses & 1 << address == 0 => {
                    return Err(LinkError::WrongAddress { address, addresses });
                }
                _ => {}
            }
        }
        Err(self.unidentified(address, &before, began))
    }

    /// Returns why no identity has arrived from this address since `began` (ns on the transport's clock). `before` are
    /// the counters at that time.
    fn unidentified(&self, address: u8, before: &LinkCounters, began: u64) -> LinkError {
        let after = self.counters();
        if after.bytes == before.bytes {
            LinkError::Silent { milliseconds: self.transport.now().saturating_sub(began) / 1_000_000 }
        } else if after.frames == before.frames {
            LinkError::Unintelligible { bytes: after.bytes - before.bytes, damaged: after.damaged - before.damaged }
        } else {
            LinkError::Unanswered { address, request: Kind::Hello }
        }
    }

    fn configure(&mut self, address: u8, configure: Configure, deadline: u64) -> Result<Configured, LinkError> {
        let mut running = None;
        while self.transport.now() < deadline {
            let Some(answer) = self.exchange(address, Frame::Configure(configure), deadline)? else { continue };
            match answer.frame {
                Frame::Configured(configured) if configured.terms == configure => return Ok(configured),
                Frame::Configured(_) => return Err(LinkError::OtherTerms { address }),
                // If a program has died, the motors follow its last Command until the watchdog trips. The board then
                // accepts the terms, so the request is repeated.
                Frame::Refused(refused) if refused.reason == Reason::Running => {
                    running = Some(refused);
                    self.wait_until((self.transport.now() + PATIENCE).min(deadline))?;
                }
                Frame::Refused(refused) => return Err(LinkError::Refused { address, refused }),
                _ => {}
            }
        }
        Err(match running {
            Some(refused) => LinkError::Refused { address, refused },
            None => LinkError::Unanswered { address, request: Kind::Configure },
        })
    }

    /// Sends one Stop, which makes the finger enter its end state. Returns whether the finger confirmed the Stop by
    /// `deadline` (ns on the transport's clock) and within 50 ms. If the Stop was lost, the finger's watchdog makes the
    /// finger enter its end state a little later. Replies that arrive while this call waits are discarded.
    pub fn stop(&mut self, address: u8, deadline: u64) -> Result<bool, LinkError> {
        let answer = self.exchange(address, Frame::Stop(Stop), deadline)?;
        Ok(matches!(answer, Some(Message { frame: Frame::Stopped(_), .. })))
    }

    /// Stops the finger and returns its status. Repeats the Stop until the finger confirms it. Returns an error at
    /// `deadline` (ns on the transport's clock).
    pub fn confirmed_stop(&mut self, address: u8, deadline: u64) -> Result<Status, LinkError> {
        while self.transport.now() < deadline {
            let Some(answer) = self.exchange(address, Frame::Stop(Stop), deadline)? else { continue };
            match answer.frame {
                Frame::Stopped(stopped) => return Ok(stopped.status),
                Frame::Refused(refused) => return Err(LinkError::Refused { address, refused }),
                _ => {}
            }
        }
        Err(LinkError::Unanswered { address, request: Kind::Stop })
    }

    /// Sends a request and waits for its answer or refusal until `deadline`, at most for [`PATIENCE`].
    fn exchange(&mut self, address: u8, request: Frame, deadline: u64) -> Result<Option<Message>, LinkError> {
        self.handshake_sequence = self.handshake_sequence.wrapping_add(1);
        let sequence = self.handshake_sequence;
        let request = Message { address, sequence, frame: request };
        let (asked, wire) = (Asked::by(&request), WireFrame::new(&request));
        let mut bytes = [0; 1 + MAX_WIRE];
        let length = 1 + wire.as_bytes().len();
        bytes[1..length].copy_from_slice(wire.as_bytes());
        // A delimiter before every handshake frame ends any frame that the board has partly received.
        self.delimit_first = true;
        self.write(&mut bytes[..length])?;

        let mut allowance = Allowance::until(deadline.min(self.transport.now() + PATIENCE));
        while let Some(message) = self.next_message(&mut allowance)? {
            if asked.is_answered_by(&message) {
                return Ok(Some(message));
            }
            self.foreign += 1;
        }
        Ok(None)
    }

    /// Waits until the time `until`, ns, and discards what arrives. Returns an error at once if the port hangs up.
    fn wait_until(&mut self, until: u64) -> Result<(), LinkError> {
        let mut allowance = Allowance::until(until);
        while self.next_message(&mut allowance)?.is_some() {
            self.foreign += 1;
        }
        Ok(())
    }
}

/// Returns the identity in an answer to a Hello, or none if the answer is neither an identity nor a refusal.
///
/// # Errors
/// Returns an error if the finger refuses the Hello, or has another protocol version.
fn identity_in(answer: &Message) -> Result<Option<Identity>, LinkError> {
    match answer.frame {
        Frame::Identity(identity) if identity.version == VERSION => Ok(Some(identity)),
        Frame::Identity(Identity { version, .. }) => Err(LinkError::WrongVersion { lowest: version, highest: version }),
        Frame::Refused(Refused { reason: Reason::Version, detail, .. }) => {
            let [lowest, highest] = detail.to_le_bytes();
            Err(LinkError::WrongVersion { lowest, highest })
        }
        Frame::Refused(refused) => Err(LinkError::Refused { address: answer.address, refused }),
        _ => Ok(None),
    }
}
