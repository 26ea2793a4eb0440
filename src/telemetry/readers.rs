//! The hand's ends of the connections to its readers.

use super::handshake::{BATCH, REQUEST, Reply};
use super::socket::{Socket, own_user};
use crate::board::descriptor::Descriptor;
use crate::realtime::now;
use std::io;

/// Largest number of readers, including those that have not sent their request yet.
pub(super) const MOST_READERS: usize = 16;

/// Time in which a reader must send its request, ns.
const REQUEST_TIME: u64 = 2_000_000_000;

/// An accepted connection whose reader has not sent its request yet.
struct Candidate {
    socket: Socket,
    since: u64,
}

/// The socket at which readers connect, and their connections.
pub(super) struct Readers {
    listener: Socket,
    candidates: Vec<Candidate>,
    attached: Vec<Socket>,
}

/// What a candidate has sent.
enum Sent {
    Nothing,
    Request,
    Other,
    Ended,
}

impl Readers {
    pub fn new(listener: Socket) -> Self {
        let room = || Vec::with_capacity(MOST_READERS);
        Self { listener, candidates: Vec::with_capacity(MOST_READERS), attached: room() }
    }

    /// Returns the number of readers that are attached.
    pub fn attached(&self) -> usize {
        self.attached.len()
    }

    /// Accepts connections, and drops those that have ended. Returns the sockets of readers that wait for their answer.
    /// Allocates nothing if no connection is answered or refused.
    pub fn serve(&mut self) -> Vec<Socket> {
        self.accept();
        // A reader that sends anything after its request does not keep to the protocol.
        self.attached.retain(|socket| matches!(sent(socket), Sent::Nothing));
        let time = now();
        let mut requests = Vec::new();
        let mut place = 0;
        while place < self.candidates.len() {
            let candidate = &self.candidates[place];
            match sent(&candidate.socket) {
                Sent::Nothing if time.saturating_sub(candidate.since) < REQUEST_TIME => place += 1,
                Sent::Request => requests.push(self.candidates.swap_remove(place).socket),
                Sent::Other => {
                    let reason = "the reader has another version of the format: use the sun2xp program of the same \
                                  version as the library of the hand";
                    refuse(&candidate.socket, reason);
                    self.candidates.swap_remove(place);
                }
                Sent::Nothing | Sent::Ended => drop(self.candidates.swap_remove(place)),
            }
        }
        requests
    }

    fn accept(&mut self) {
        // Only a limited number is accepted at a time, so that a process that connects again and again does not occupy
        // this thread.
        for _ in 0..MOST_READERS {
            let Ok(socket) = self.listener.accept() else { return };
            // The reader of another user gets no answer.
            if !socket.peer().is_ok_and(|peer| peer.user == own_user()) {
                continue;
            }
            if self.candidates.len() + self.attached.len() < MOST_READERS {
                self.candidates.push(Candidate { socket, since: now() });
            } else {
                refuse(&socket, "the hand has 16 readers already: end one of them");
            }
        }
    }

    /// Attaches a reader. If the reader does not take the reply, its connection is closed.
    pub fn attach(&mut self, socket: Socket, reply: &Reply, memory: &Descriptor) {
        let sent = encode(reply).and_then(|bytes| socket.send(&bytes, Some(memory)));
        if sent.is_ok() {
            self.attached.push(socket);
        }
    }

    /// Wakes the readers that wait for a batch. A reader whose socket is full has not taken the earlier wake-ups yet,
    /// and needs no further one.
    pub fn wake(&self) {
        self.attached.iter().for_each(|socket| drop(socket.send(BATCH, None)));
    }
}

impl Drop for Readers {
    fn drop(&mut self) {
        // A forked child may have copies of the sockets, so that dropping the sockets would not end the connections.
        let candidates = self.candidates.iter().map(|candidate| &candidate.socket);
        self.attached.iter().chain(candidates).for_each(Socket::shut_down);
        self.listener.shut_down();
    }
}

fn sent(socket: &Socket) -> Sent {
    let mut bytes = [0; REQUEST.len() + 1];
    match socket.receive(&mut bytes) {
        Ok(received) if received.bytes == 0 => Sent::Ended,
        Ok(received) if &bytes[..received.bytes] == REQUEST => Sent::Request,
        Ok(_) => Sent::Other,
        Err(error) if error.kind() == io::ErrorKind::WouldBlock => Sent::Nothing,
        Err(_) => Sent::Ended,
    }
}

/// Refuses a reader. If it does not take the reply, it sees the end of the connection.
pub(super) fn refuse(socket: &Socket, reason: &str) {
    let _ = encode(&Reply::Refused(reason.into())).and_then(|bytes| socket.send(&bytes, None));
}

fn encode(reply: &Reply) -> io::Result<Vec<u8>> {
    postcard::to_stdvec(reply).map_err(io::Error::other)
}
