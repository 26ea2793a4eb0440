//! A reader of a hand's telemetry, in another process or in the hand's own process.

use super::attach_error::AttachError;
use super::block_ring::{BlockReader, Found};
use super::handshake::{LARGEST_REPLY, REQUEST, Reply};
use super::marks::MARKS;
use super::memory_file::{self, Mapping};
use super::message::{Description, Message};
use super::names::{hands, socket_name};
use super::process::Process;
use super::socket::{Socket, own_user};
use super::waiting::wait;
use std::io::{self, ErrorKind};
use std::time::{Duration, Instant};
use thiserror::Error;

/// Longest time in which a hand must answer.
const ANSWER_TIME: Duration = Duration::from_secs(3);

/// Interval between two attempts to connect while the hand has not accepted earlier connections.
const CONNECT_INTERVAL: Duration = Duration::from_millis(20);

/// Largest number of blocks that one call of [`Reader::read`] returns. A reader that has slept for long would otherwise
/// get in one call everything that the ring holds.
const MOST_BLOCKS: usize = 64;

/// An attached reader. Dropping it detaches it.
pub struct Reader {
    description: Description,
    socket: Socket,
    /// The hand's process; none if this process cannot see it.
    process: Option<Process>,
    ring: BlockReader<Mapping>,
    bytes: Vec<u8>,
    /// For each finger, the number of cycles that have arrived or are lost; none before the first block.
    counted: Option<[u64; MARKS]>,
    lost: [u64; MARKS],
    ended: bool,
}

/// What a call of [`Reader::read`] has received, besides the messages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Received {
    /// Cycles of each finger that were lost since the last call. They are missing before or between the messages of
    /// this call.
    pub lost: [u64; MARKS],
}

/// Why there are no further messages.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum Ended {
    /// The hand was closed, or its process has ended.
    #[error("the hand was closed, or its program has ended")]
    Closed,
    /// The memory contains something that no hand writes.
    #[error(
        "the shared memory of the hand is damaged ({0}): close the hand and open it again, and use the sun2xp program \
         of the same version as the library of the hand"
    )]
    Damaged(String),
}

impl Reader {
    /// Attaches to the hand with this name, or to the only hand.
    ///
    /// # Errors
    /// Returns an error if there is no such hand, if there are several and none is named, or if the hand does not
    /// answer.
    pub fn attach(name: Option<&str>) -> Result<Self, AttachError> {
        let name = match name {
            Some(name) => name.to_owned(),
            None => match <[String; 1]>::try_from(hands().map_err(AttachError::Names)?) {
                Ok([only]) => only,
                Err(names) if names.is_empty() => return Err(AttachError::NoHand),
                Err(names) => return Err(AttachError::Several(names)),
            },
        };
        let deadline = Instant::now() + ANSWER_TIME;
        let socket = connect(&name, deadline)?;
        let peer = socket.peer().map_err(|source| AttachError::System { doing: "identify the hand", source })?;
        if peer.user != own_user() {
            return Err(AttachError::Foreign(name));
        }
        let process = Process::open(peer.process);
        // A hand that refuses the reader may have closed the connection already. Its reason can still be received.
        let _ = socket.send(REQUEST, None);
        let (reply, mapping) = answer(&name, &socket, process.as_ref(), deadline)?;
        let (description, position) = reply;
        let incomprehensible = |reason: &str| AttachError::Incomprehensible { name, reason: reason.into() };
        let ring = BlockReader::new(mapping, position).ok_or_else(|| incomprehensible("memory file too small"))?;
        let (bytes, lost) = (Vec::new(), [0; MARKS]);
        Ok(Self { description, socket, process, ring, bytes, counted: None, lost, ended: false })
    }

    /// Returns the description of the hand.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Returns the number of cycles of each finger that were lost since this reader was attached.
    pub fn lost(&self) -> [u64; MARKS] {
        self.lost
    }

    /// Appends the messages that have arrived to `messages`. If there are none, waits for them until `timeout` has
    /// passed.
    ///
    /// # Errors
    /// Returns [`Ended::Closed`] after the last message of a hand that was closed or whose process has ended, and
    /// [`Ended::Damaged`] if the memory contains something that no hand writes.
    pub fn read(&mut self, timeout: Duration, messages: &mut Vec<Message>) -> Result<Received, Ended> {
        let before = self.lost;
        if !self.take_blocks(messages)? {
            if self.ended {
                return Err(Ended::Closed);
            }
            wait(&self.socket, self.process.as_ref(), timeout);
            // The end is noticed first, and then the ring is read once more. So nothing that was written before the end
            // is lost.
            self.ended = self.has_ended();
            self.take_blocks(messages)?;
        }
        Ok(Received { lost: std::array::from_fn(|finger| self.lost[finger] - before[finger]) })
    }

    /// Reads blocks. Returns whether there were any.
    fn take_blocks(&mut self, messages: &mut Vec<Message>) -> Result<bool, Ended> {
        for block in 0..MOST_BLOCKS {
            match self.ring.read(&mut self.bytes) {
                Found::Block(marks) => {
                    self.count(marks);
                    self.decode(messages)?;
                }
                Found::Nothing => return Ok(block > 0),
                // The marks of the next block show what was lost.
                Found::Overtaken => {}
                Found::Damaged => return Err(Ended::Damaged("a block has an impossible position or length".into())),
            }
        }
        Ok(true)
    }

    fn count(&mut self, marks: [u64; MARKS]) {
        if let Some(counted) = self.counted {
            for (lost, (now, before)) in self.lost.iter_mut().zip(marks.into_iter().zip(counted)) {
                *lost = lost.saturating_add(now.saturating_sub(before));
            }
        }
        self.counted = Some(marks);
    }

    fn decode(&mut self, messages: &mut Vec<Message>) -> Result<(), Ended> {
        let mut rest = &self.bytes[..];
        while !rest.is_empty() {
            let (message, after) =
                postcard::take_from_bytes::<Message>(rest).map_err(|error| Ended::Damaged(error.to_string()))?;
            if let (Message::Cycle { finger, .. }, Some(counted)) = (&message, &mut self.counted) {
                counted[finger.index()] = counted[finger.index()].saturating_add(1);
            }
            messages.push(message);
            rest = after;
        }
        Ok(())
    }

    /// Discards the bytes with which the hand has announced new blocks. Returns whether the hand has been closed or its
    /// process has ended.
    fn has_ended(&self) -> bool {
        let mut bytes = [0; 16];
        loop {
            match self.socket.receive(&mut bytes) {
                Ok(received) if received.bytes == 0 => return true,
                Ok(_) => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    return self.process.as_ref().is_some_and(Process::has_ended);
                }
                Err(_) => return true,
            }
        }
    }
}

fn connect(name: &str, deadline: Instant) -> Result<Socket, AttachError> {
    loop {
        match Socket::connect(&socket_name(name)) {
            Ok(socket) => return Ok(socket),
            Err(error) if error.kind() == ErrorKind::WouldBlock && Instant::now() < deadline => {
                std::thread::sleep(CONNECT_INTERVAL);
            }
            Err(error) => {
                return Err(match error.kind() {
                    ErrorKind::WouldBlock => AttachError::Silent(name.into()),
                    ErrorKind::ConnectionRefused | ErrorKind::InvalidInput => {
                        AttachError::Unknown { wanted: name.into(), open: hands().unwrap_or_default() }
                    }
                    _ => AttachError::System { doing: "connect to the hand", source: error },
                });
            }
        }
    }
}

/// Waits for the answer, and maps the memory that comes with it. Returns the description, the position at which to
/// begin, and the memory.
fn answer(
    name: &str,
    socket: &Socket,
    process: Option<&Process>,
    deadline: Instant,
) -> Result<((Description, u64), Mapping), AttachError> {
    let name = || name.to_owned();
    let mut bytes = vec![0; LARGEST_REPLY];
    let mut reset = false;
    let received = loop {
        match socket.receive(&mut bytes) {
            Ok(received) => break received,
            // The hand has closed the connection without reading the request. What it sent before is received next.
            Err(error) if error.kind() == ErrorKind::ConnectionReset && !reset => reset = true,
            Err(error) if error.kind() != ErrorKind::WouldBlock => return Err(AttachError::Closed(name())),
            Err(_) if process.is_some_and(Process::has_ended) => return Err(AttachError::Closed(name())),
            Err(_) if Instant::now() >= deadline => return Err(AttachError::Silent(name())),
            Err(_) => wait(socket, process, deadline.saturating_duration_since(Instant::now())),
        }
    };
    if received.bytes == 0 {
        return Err(AttachError::Closed(name()));
    }
    let incomprehensible = |reason: String| AttachError::Incomprehensible { name: name(), reason };
    match postcard::from_bytes(&bytes[..received.bytes]) {
        Ok(Reply::Attached { description, words, position }) => {
            let map = |file| memory_file::open(&file, usize::try_from(words).map_err(io::Error::other)?);
            let file = received.file.ok_or_else(|| incomprehensible("no memory file".into()))?;
            let mapping = map(file).map_err(|error| match error.kind() {
                ErrorKind::InvalidData => incomprehensible(error.to_string()),
                _ => AttachError::System { doing: "map the memory of the hand", source: error },
            })?;
            Ok(((*description, position), mapping))
        }
        Ok(Reply::Refused(reason)) => Err(AttachError::Refused { name: name(), reason }),
        Err(error) => Err(incomprehensible(error.to_string())),
    }
}
