//! The host's end of the cable: handshake, one exchange of frames a period, and what went wrong.

use super::link_error::LinkError;
use super::port::Port;
use super::protocol::{
    ANY_ADDRESS, Command, Configure, Configured, Decoder, Frame, HIGHEST_ADDRESS, Hello, Identity, Kind, MAX_WIRE,
    Message, Reason, Refused, Reply, Stop, VERSION, WireFrame,
};
use super::terms::Terms;
use super::transport::Transport;
use std::path::Path;

/// A Command on its way to one finger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OutgoingCommand {
    /// The finger, 1 to 15.
    pub address: u8,
    /// Comes back in the Reply.
    pub sequence: u8,
    /// What its motors shall do.
    pub command: Command,
}

/// A Reply that came in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Received {
    /// The finger.
    pub address: u8,
    /// Of the Command that it answers.
    pub sequence: u8,
    /// What it says.
    pub reply: Reply,
}

/// What passed through a link, in all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinkCounters {
    /// Bytes that came in.
    pub bytes: u64,
    /// Frames that came in whole.
    pub frames: u64,
    /// Pieces that came in and were no frame.
    pub damaged: u64,
    /// Whole frames that nobody waited for, or that this library does not know.
    pub foreign: u64,
    /// Writes that the port did not take, wholly or in part; the board saw a damaged frame or none.
    pub unsent: u64,
}

impl LinkCounters {
    /// Together with what passed through another link.
    pub fn plus(&self, other: &Self) -> Self {
        self.with(other, u64::saturating_add)
    }

    /// Without what passed through another link.
    pub fn less(&self, other: &Self) -> Self {
        self.with(other, u64::saturating_sub)
    }

    fn with(&self, other: &Self, of: impl Fn(u64, u64) -> u64) -> Self {
        Self {
            bytes: of(self.bytes, other.bytes),
            frames: of(self.frames, other.frames),
            damaged: of(self.damaged, other.damaged),
            foreign: of(self.foreign, other.foreign),
            unsent: of(self.unsent, other.unsent),
        }
    }
}

/// How long an answer to a handshake frame may take before the frame is sent again, ns. A USB bridge in its slowest setting
/// answers after some 35 ms.
const PATIENCE: u64 = 50_000_000;

/// Most fingers on one port.
const MOST_FINGERS: usize = HIGHEST_ADDRESS as usize;

const DELIMITER: u8 = 0;

/// A board's cable. Allocates nothing after it was opened, and never waits past a deadline.
#[derive(Debug)]
pub struct Link<T = Port> {
    transport: T,
    decoder: Decoder,
    input: [u8; 512],
    /// Where in `input` the bytes lie that the decoder has not seen.
    unread: std::ops::Range<usize>,
    /// Next outgoing frame follows an incomplete one, or the noise of plugging in.
    delimit_first: bool,
    handshake_sequence: u8,
    read_at: u64,
    foreign: u64,
    unsent: u64,
}

impl Link {
    /// Opens the port at `path` for `baud` bits a second.
    pub fn open(path: &Path, baud: u32) -> Result<Self, LinkError> {
        Ok(Self::new(Port::open(path, baud)?))
    }
}

impl<T: Transport> Link<T> {
    /// A link over something that is open already.
    pub fn new(transport: T) -> Self {
        Self {
            transport,
            decoder: Decoder::default(),
            input: [0; 512],
            unread: 0..0,
            delimit_first: true,
            handshake_sequence: 0,
            read_at: 0,
            foreign: 0,
            unsent: 0,
        }
    }

    /// What carries the bytes.
    pub fn transport(&mut self) -> &mut T {
        &mut self.transport
    }

    /// When the bytes of the last Reply could be read, and when they were read, ns on the transport's clock.
    pub fn arrival(&self) -> (u64, u64) {
        (self.transport.ready_at(), self.read_at)
    }

    /// What passed so far.
    pub fn counters(&self) -> LinkCounters {
        let decoder = self.decoder.counters();
        LinkCounters {
            bytes: decoder.bytes,
            frames: decoder.frames,
            damaged: decoder.damaged,
            foreign: self.foreign,
            unsent: self.unsent,
        }
    }

    /// Finds the finger `address`, 1 to 15, and agrees on `terms` with it. Tries until `deadline` (ns on the transport's
    /// clock), because a board may still be starting; gives up at once where waiting cannot help. The motors stay off.
    ///
    /// Not for the servo's cycle: it throws away Replies of other fingers on the port.
    pub fn shake_hands(
        &mut self,
        address: u8,
        terms: &Terms,
        deadline: u64,
    ) -> Result<(Identity, Configured), LinkError> {
        self.transport.discard_input()?;
        self.unread = 0..0;
        let identity = self.identify(address, deadline)?;
        let configure = terms.configure(&identity)?;
        let configured = self.configure(address, configure, deadline)?;
        Ok((identity, configured))
    }

    fn identify(&mut self, address: u8, deadline: u64) -> Result<Identity, LinkError> {
        let began = self.transport.now();
        let before = self.counters();
        let hello = Frame::Hello(Hello { lowest_version: VERSION, highest_version: VERSION });
        let mut attempts = 0u32;
        while self.transport.now() < deadline {
            // After two attempts in vain every other one asks whoever is there, to tell a wrong address from a dead board.
            let asked = if attempts >= 2 && attempts.is_multiple_of(2) { ANY_ADDRESS } else { address };
            attempts = attempts.saturating_add(1);
            let Some(answer) = self.ask(asked, hello, deadline)? else { continue };
            match answer.frame {
                Frame::Identity(Identity { version, .. }) if version != VERSION => {
                    return Err(LinkError::WrongVersion { lowest: version, highest: version });
                }
                Frame::Identity(identity) if answer.address == address => return Ok(identity),
                Frame::Identity(identity) if identity.addresses & 1 << address == 0 => {
                    return Err(LinkError::WrongAddress { address, addresses: identity.addresses });
                }
                Frame::Refused(Refused { reason: Reason::Version, detail, .. }) => {
                    let [lowest, highest] = detail.to_le_bytes();
                    return Err(LinkError::WrongVersion { lowest, highest });
                }
                Frame::Refused(refused) => return Err(LinkError::Refused { address: answer.address, refused }),
                _ => {}
            }
        }
        let after = self.counters();
        Err(if after.bytes == before.bytes {
            LinkError::Silent { milliseconds: self.transport.now().saturating_sub(began) / 1_000_000 }
        } else if after.frames == before.frames {
            LinkError::Unintelligible { bytes: after.bytes - before.bytes, damaged: after.damaged - before.damaged }
        } else {
            LinkError::Unanswered { address, request: Kind::Hello }
        })
    }

    fn configure(&mut self, address: u8, configure: Configure, deadline: u64) -> Result<Configured, LinkError> {
        let mut running = None;
        while self.transport.now() < deadline {
            let Some(answer) = self.ask(address, Frame::Configure(configure), deadline)? else { continue };
            match answer.frame {
                Frame::Configured(configured) if configured.terms == configure => return Ok(configured),
                Frame::Configured(_) => return Err(LinkError::OtherTerms { address }),
                // A program that died a moment ago leaves the motors following until the watchdog ends that.
                Frame::Refused(refused) if refused.reason == Reason::Running => {
                    running = Some(refused);
                    self.let_pass((self.transport.now() + PATIENCE).min(deadline))?;
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

    /// Sends the Commands of all fingers on the port, 15 at most, in one write. What the port does not take at once is
    /// lost and counted: the missing Reply will tell the same.
    pub fn send(&mut self, commands: &[OutgoingCommand]) -> Result<(), LinkError> {
        // Half a Reply of the last period is of no use any more, and must not take the next one with it.
        if self.unread.is_empty() {
            self.decoder.abandon();
        }
        let mut bytes = [0; 1 + MOST_FINGERS * Kind::Command.wire_length()];
        // The first byte is left for a delimiter.
        let mut length = 1;
        for outgoing in commands.iter().take(MOST_FINGERS) {
            let frame = Frame::Command(outgoing.command);
            let wire = WireFrame::new(&Message { address: outgoing.address, sequence: outgoing.sequence, frame });
            let wire = wire.as_bytes();
            if let Some(room) = bytes.get_mut(length..length + wire.len()) {
                room.copy_from_slice(wire);
                length += wire.len();
            }
        }
        self.write(&mut bytes[..length])
    }

    /// The next Reply, or none at `deadline` (ns on the transport's clock). With a deadline in the past: a Reply that is
    /// there already. A refused Command is an error: the board lost its configuration, or is no longer the board it was.
    pub fn receive(&mut self, deadline: u64) -> Result<Option<Received>, LinkError> {
        while let Some(Message { address, sequence, frame }) = self.next_message(deadline)? {
            match frame {
                Frame::Reply(reply) => return Ok(Some(Received { address, sequence, reply })),
                // A refused handshake frame has missed its time.
                Frame::Refused(refused) if refused.request == Kind::Command as u8 => {
                    return Err(LinkError::Refused { address, refused });
                }
                _ => self.foreign += 1,
            }
        }
        Ok(None)
    }

    /// Tells the finger to go to its end state now, as well as that can be done: whether it confirmed by `deadline` (ns on
    /// the transport's clock). Without an answer its watchdog does the same a little later.
    /// Replies that come meanwhile are thrown away.
    pub fn stop(&mut self, address: u8, deadline: u64) -> Result<bool, LinkError> {
        let answer = self.ask(address, Frame::Stop(Stop), deadline)?;
        Ok(matches!(answer, Some(Message { frame: Frame::Stopped(_), .. })))
    }

    /// Sends a request and waits for its answer or refusal, for a while.
    fn ask(&mut self, address: u8, request: Frame, deadline: u64) -> Result<Option<Message>, LinkError> {
        self.handshake_sequence = self.handshake_sequence.wrapping_add(1);
        let sequence = self.handshake_sequence;
        let wire = WireFrame::new(&Message { address, sequence, frame: request });
        let mut bytes = [0; 1 + MAX_WIRE];
        let length = 1 + wire.as_bytes().len();
        bytes[1..length].copy_from_slice(wire.as_bytes());
        // A delimiter before every handshake frame: whatever the board has half received is not its beginning.
        self.delimit_first = true;
        self.write(&mut bytes[..length])?;

        let deadline = deadline.min(self.transport.now() + PATIENCE);
        while let Some(message) = self.next_message(deadline)? {
            let answers = match message.frame {
                Frame::Refused(refused) => refused.request == request.kind() as u8,
                // An answer's type is its request's with the top bit set.
                frame => frame.kind() as u8 == request.kind() as u8 | 0x8,
            };
            let meant = message.sequence == sequence && (message.address == address || address == ANY_ADDRESS);
            if answers && meant {
                return Ok(Some(message));
            }
            self.foreign += 1;
        }
        Ok(None)
    }

    /// Lets time pass without missing a hang-up.
    fn let_pass(&mut self, until: u64) -> Result<(), LinkError> {
        while self.next_message(until)?.is_some() {
            self.foreign += 1;
        }
        Ok(())
    }

    /// Writes `bytes[1..]`, or `bytes` with a delimiter in front where one is needed.
    fn write(&mut self, bytes: &mut [u8]) -> Result<(), LinkError> {
        let bytes = match bytes {
            [first, ..] if self.delimit_first => {
                *first = DELIMITER;
                &*bytes
            }
            [_, frames @ ..] => frames,
            [] => return Ok(()),
        };
        let sent = self.transport.write(bytes)?;
        self.delimit_first = sent < bytes.len();
        self.unsent += u64::from(self.delimit_first);
        Ok(())
    }

    fn next_message(&mut self, deadline: u64) -> Result<Option<Message>, LinkError> {
        loop {
            if let Some(message) = self.message_at_hand() {
                return Ok(Some(message));
            }
            // One read past the deadline is enough: even an endless stream of rubbish holds nobody up.
            let last = self.transport.now() >= deadline;
            let taken = self.transport.read_until(&mut self.input, deadline)?;
            self.read_at = self.transport.now();
            self.unread = 0..taken;
            if last || taken == 0 {
                return Ok(self.message_at_hand());
            }
        }
    }

    /// The next message among the bytes that were read.
    fn message_at_hand(&mut self) -> Option<Message> {
        while !self.unread.is_empty() {
            let mut bytes = &self.input[self.unread.clone()];
            let message = self.decoder.next(&mut bytes).map(|packet| Message::read(&packet));
            self.unread.start = self.unread.end - bytes.len();
            match message {
                Some(Ok(message)) => return Some(message),
                Some(Err(_)) => self.foreign += 1,
                None => {}
            }
        }
        None
    }
}
