//! The host's end of the cable: handshake, one exchange of frames a period, and what went wrong.

mod allowance;
mod handshake;

pub use allowance::Allowance;

use super::link_error::LinkError;
use super::port::Port;
use super::protocol::{Command, Decoder, Frame, HIGHEST_ADDRESS, Kind, Message, Reply, WireFrame};
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
    /// Reading stopped at the deadline or at the limit of bytes although the port had more.
    cut_short: bool,
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
            cut_short: false,
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

    /// Sends the Commands of all fingers on the port, 15 at most, in one write. What the port does not take at once is
    /// lost and counted: the missing Reply will tell the same.
    pub fn send(&mut self, commands: &[OutgoingCommand]) -> Result<(), LinkError> {
        // Half a Reply of the last period is of no use any more, and must not take the next one with it. Where reading
        // was cut short, its other half comes next.
        if self.unread.is_empty() && !self.cut_short {
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

    /// The next Reply, or none at `deadline` (ns on the transport's clock). With a deadline in the past: a Reply that
    /// is there already. A refused Command is an error: the board lost its configuration, or is no longer the board it
    /// was.
    pub fn receive(&mut self, deadline: u64) -> Result<Option<Received>, LinkError> {
        self.receive_within(&mut Allowance::for_replies(deadline))
    }

    /// The same for one of several Replies that are awaited together: all calls share one allowance. None when it is
    /// used up.
    pub fn receive_within(&mut self, allowance: &mut Allowance) -> Result<Option<Received>, LinkError> {
        while let Some(Message { address, sequence, frame }) = self.next_message(allowance)? {
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

    /// The next message; none when the allowance is used up. What was read within it is handed out in any case.
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
