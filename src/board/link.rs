//! The host's end of the cable: handshake, one exchange of frames per period, and error counts.

mod allowance;
mod asked;
mod handshake;
mod relayed;
mod traffic;

pub use allowance::Allowance;
pub use traffic::{Arrival, OutgoingCommand, OutgoingRequest, Received};

use relayed::RelayedRequest;

use super::link_error::LinkError;
use super::port::Port;
use super::protocol::{Decoder, Frame, HIGHEST_ADDRESS, Kind, MAX_WIRE, Message, WireFrame};
use super::transport::Transport;
use std::path::Path;

/// Counts of what a link has received, and of the writes that failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinkCounters {
    /// Bytes received.
    pub bytes: u64,
    /// Undamaged frames received.
    pub frames: u64,
    /// Pieces received that were not valid frames.
    pub damaged: u64,
    /// Undamaged frames that were not expected, or that this library cannot read.
    pub foreign: u64,
    /// Writes that the port accepted only in part or not at all. The last frame of such a write that reaches the board
    /// may be damaged, and the later frames of the write are missing.
    pub unsent: u64,
}

impl LinkCounters {
    /// Returns the sum of these counts and those of another link, modulo 2^64.
    pub fn wrapping_add(&self, other: &Self) -> Self {
        self.combined(other, u64::wrapping_add)
    }

    /// Returns these counts minus those of another link, modulo 2^64. A difference below 0 wraps around, and a later
    /// `wrapping_add` of larger counts wraps it back.
    pub fn wrapping_sub(&self, other: &Self) -> Self {
        self.combined(other, u64::wrapping_sub)
    }

    fn combined(&self, other: &Self, operation: impl Fn(u64, u64) -> u64) -> Self {
        Self {
            bytes: operation(self.bytes, other.bytes),
            frames: operation(self.frames, other.frames),
            damaged: operation(self.damaged, other.damaged),
            foreign: operation(self.foreign, other.foreign),
            unsent: operation(self.unsent, other.unsent),
        }
    }
}

/// The largest number of fingers on one port.
const MOST_FINGERS: usize = HIGHEST_ADDRESS as usize;

const DELIMITER: u8 = 0;

/// The connection to a board. After opening, only [`Link::identities`] allocates memory. At a serial port, no call
/// waits past its deadline.
#[derive(Debug)]
pub struct Link<T = Port> {
    transport: T,
    decoder: Decoder,
    input: [u8; 512],
    /// The part of `input` that the decoder has not yet seen.
    unread: std::ops::Range<usize>,
    /// Reading stopped at the deadline or at the byte limit although the port may have had more.
    cut_short: bool,
    /// The next frame needs a delimiter in front, because it follows an incomplete frame or the noise of plugging in.
    delimit_first: bool,
    /// The relayed request: a handshake request that this link sends for the thread that repairs the port.
    relayed: RelayedRequest,
    handshake_sequence: u8,
    read_at: u64,
    foreign: u64,
    unsent: u64,
}

impl Link {
    /// Opens the port at `path` at `baud` bit/s.
    pub fn open(path: &Path, baud: u32) -> Result<Self, LinkError> {
        Ok(Self::new(Port::open(path, baud)?))
    }
}

impl<T: Transport> Link<T> {
    /// Creates a link over a transport that is already open.
    pub fn new(transport: T) -> Self {
        Self {
            transport,
            decoder: Decoder::default(),
            input: [0; 512],
            unread: 0..0,
            cut_short: false,
            delimit_first: true,
            relayed: RelayedRequest::none(),
            handshake_sequence: 0,
            read_at: 0,
            foreign: 0,
            unsent: 0,
        }
    }

    /// Returns the transport, which carries the bytes.
    pub fn transport(&mut self) -> &mut T {
        &mut self.transport
    }

    /// Returns when the bytes of the last Reply became readable and when they were read, ns on the transport's clock.
    pub fn arrival(&self) -> (u64, u64) {
        (self.transport.ready_at(), self.read_at)
    }

    /// Returns the counts since the link was created.
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

    /// Sends the Commands of all fingers on the port, at most 15, in one write. Bytes that the port does not accept at
    /// once are lost, and the write is counted as unsent. The caller detects the loss, because no Reply arrives.
    pub fn send(&mut self, commands: &[OutgoingCommand]) -> Result<(), LinkError> {
        self.send_with(commands, &[])
    }

    /// Does the same as [`send`](Self::send), and also sends TactileRequests, at most 15, after the Commands. Their
    /// answers then follow the Replies and delay none of the Replies.
    pub fn send_with(&mut self, commands: &[OutgoingCommand], requests: &[OutgoingRequest]) -> Result<(), LinkError> {
        // An incomplete frame of the last period is now useless, and must not damage the next Reply. It is kept if
        // reading was cut short, because the rest of it may still be unread. It is also kept if it may be the answer to
        // a relayed request.
        if self.unread.is_empty() && !self.cut_short && !self.relayed.is_awaited() {
            self.decoder.abandon();
        }
        const LARGEST: usize = Kind::Command.wire_length() + Kind::TactileRequest.wire_length();
        let mut bytes = [0; 1 + MOST_FINGERS * LARGEST + 1 + MAX_WIRE];
        // The first byte is reserved for a delimiter.
        let mut length = 1;
        let commands = commands.iter().take(MOST_FINGERS).map(|outgoing| Message {
            address: outgoing.address,
            sequence: outgoing.sequence,
            frame: Frame::Command(outgoing.command),
        });
        let requests = requests.iter().take(MOST_FINGERS).map(|outgoing| Message {
            address: outgoing.address,
            sequence: outgoing.sequence,
            frame: Frame::TactileRequest(outgoing.request),
        });
        for message in commands.chain(requests) {
            let wire = WireFrame::new(&message);
            let wire = wire.as_bytes();
            if let Some(room) = bytes.get_mut(length..length + wire.len()) {
                room.copy_from_slice(wire);
                length += wire.len();
            }
        }
        let relayed = self.relayed.take();
        if let Some(room) = bytes.get_mut(length..length + relayed.len()) {
            room.copy_from_slice(relayed);
            length += relayed.len();
        }
        self.write(&mut bytes[..length])
    }

    /// Returns the next Reply, or `None` at `deadline` (ns on the transport's clock) or after 4096 bytes. If the
    /// deadline is in the past, returns only a Reply that has already arrived.
    ///
    /// A refused Command is an error: the board has lost its configuration, or another board is connected.
    pub fn receive(&mut self, deadline: u64) -> Result<Option<Received>, LinkError> {
        self.receive_within(&mut Allowance::for_replies(deadline))
    }

    /// Does the same as [`receive`](Self::receive), for one of several Replies that are awaited together. The calls for
    /// all these Replies share one allowance. Returns `None` when the allowance is used up.
    pub fn receive_within(&mut self, allowance: &mut Allowance) -> Result<Option<Received>, LinkError> {
        loop {
            match self.next_arrival(allowance)? {
                Some(Arrival::Reply(received)) => return Ok(Some(received)),
                Some(Arrival::Tactile { .. } | Arrival::Relayed(_)) => self.foreign += 1,
                None => return Ok(None),
            }
        }
    }

    /// Does the same as [`receive_within`](Self::receive_within), but also returns the answers to TactileRequests and
    /// to a relayed request.
    pub fn next_arrival(&mut self, allowance: &mut Allowance) -> Result<Option<Arrival>, LinkError> {
        while let Some(message) = self.next_message(allowance)? {
            let Message { address, sequence, frame } = message;
            match frame {
                Frame::Reply(reply) => return Ok(Some(Arrival::Reply(Received { address, sequence, reply }))),
                Frame::TactileEvent(event) => return Ok(Some(Arrival::Tactile { address, sequence, event })),
                // A refused handshake frame is no error here. The refusal answers a relayed request, or it came too
                // late and is only counted.
                Frame::Refused(refused) if refused.request == Kind::Command as u8 => {
                    return Err(LinkError::Refused { address, refused });
                }
                _ if self.relayed.is_answered_by(&message) => {
                    self.relayed.answered();
                    return Ok(Some(Arrival::Relayed(message)));
                }
                _ => self.foreign += 1,
            }
        }
        Ok(None)
    }

    /// Stores the bytes of a relayed request. The next [`send`](Self::send) sends them after its Commands.
    pub fn relay(&mut self, request: &[u8]) {
        self.relayed.set(request);
    }

    /// Returns whether the answer to a relayed request is awaited.
    pub fn awaits_relayed(&self) -> bool {
        self.relayed.is_awaited()
    }

    /// Counts an arrival that was not awaited.
    pub fn count_foreign(&mut self) {
        self.foreign += 1;
    }

    /// Writes `bytes[1..]`, or all of `bytes` with a delimiter as the first byte if one is needed.
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

    /// Returns the next message, or `None` when the allowance is used up. A message that has already been read is
    /// returned even then.
    fn next_message(&mut self, allowance: &mut Allowance) -> Result<Option<Message>, LinkError> {
        loop {
            if let Some(message) = self.message_at_hand() {
                return Ok(Some(message));
            }
            if !allowance.permits(self.transport.now()) {
                self.cut_short = allowance.left_some();
                return Ok(None);
            }
            let taken = self.transport.read_until(&mut self.input, allowance.deadline())?;
            self.read_at = self.transport.now();
            self.unread = 0..taken;
            self.cut_short = false;
            allowance.take(taken);
        }
    }

    /// Returns the next message among the bytes already read.
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
