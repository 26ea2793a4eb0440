//! The client's side of a WebSocket, as a web page uses it.

use super::http::{connect, response, write_request};
use std::io::{BufReader, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::os::fd::AsRawFd;

/// A connected WebSocket.
pub struct Socket {
    stream: BufReader<TcpStream>,
}

/// What the server sends.
#[derive(Debug, PartialEq)]
pub enum Frame {
    Text(String),
    /// The server closes the socket, with a code and a reason.
    Close(u16, String),
    /// The connection has ended.
    End,
}

impl Socket {
    /// Asks for a WebSocket, with the usual headers and `headers`. Returns the status if the server refuses.
    pub fn open(address: SocketAddr, path: &str, headers: &[(&str, &str)]) -> Result<Self, u16> {
        let mut stream = connect(address);
        let host = address.to_string();
        let mut all = vec![
            ("Upgrade", "websocket"),
            ("Connection", "Upgrade"),
            ("Sec-WebSocket-Version", "13"),
            ("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="),
        ];
        if !headers.iter().any(|(name, _)| *name == "Host") {
            all.push(("Host", &host));
        }
        all.extend(headers);
        write_request(&mut stream, "GET", path, &all, "");
        let mut stream = BufReader::new(stream);
        match response(&mut stream).status {
            101 => Ok(Self { stream }),
            refused => Err(refused),
        }
    }

    /// Sends a text. A failed write is ignored, because the server may close the connection before it has read the
    /// whole text.
    pub fn send(&mut self, text: &str) {
        let length = text.len();
        let mut frame = vec![0x81];
        match u8::try_from(length) {
            Ok(short @ 0..=125) => frame.push(0x80 | short),
            _ => {
                frame.push(0x80 | 126);
                frame.extend(u16::try_from(length).expect("a short text").to_be_bytes());
            }
        }
        // A mask of zeros leaves the text as it is.
        frame.extend([0; 4]);
        frame.extend(text.as_bytes());
        let _ = self.stream.get_mut().write_all(&frame);
    }

    /// Makes the receive buffer small, so that it is soon full if nothing is read.
    pub fn narrow(&self) {
        let (descriptor, size): (_, libc::c_int) = (self.stream.get_ref().as_raw_fd(), 4096);
        let length = size_of_val(&size) as libc::socklen_t;
        // SAFETY: the descriptor is open, and `size` exists during the call.
        let set = unsafe {
            libc::setsockopt(descriptor, libc::SOL_SOCKET, libc::SO_RCVBUF, (&raw const size).cast(), length)
        };
        assert_eq!(set, 0);
    }

    /// Returns the number of bytes that have arrived and were not read.
    pub fn unread(&self) -> libc::c_int {
        let mut count: libc::c_int = 0;
        // SAFETY: the descriptor is open, and `count` exists during the call.
        let read = unsafe { libc::ioctl(self.stream.get_ref().as_raw_fd(), libc::FIONREAD, &raw mut count) };
        assert_eq!(read, 0);
        count
    }

    /// Returns the next text, or how the connection ends. Pings are not answered.
    pub fn next(&mut self) -> Frame {
        loop {
            match self.frame() {
                Ok((1, payload)) => return Frame::Text(String::from_utf8(payload).expect("UTF-8")),
                Ok((8, payload)) => {
                    let code = payload.first_chunk().map_or(0, |code| u16::from_be_bytes(*code));
                    let reason = payload.get(2..).unwrap_or_default();
                    return Frame::Close(code, String::from_utf8_lossy(reason).into_owned());
                }
                Ok(_) => {}
                Err(ErrorKind::WouldBlock) => panic!("the server sends nothing"),
                Err(_) => return Frame::End,
            }
        }
    }

    fn frame(&mut self) -> Result<(u8, Vec<u8>), ErrorKind> {
        let mut read = |length: usize| {
            let mut bytes = vec![0; length];
            self.stream.read_exact(&mut bytes).map_err(|error| error.kind())?;
            Ok::<_, ErrorKind>(bytes)
        };
        let start = read(2)?;
        let length = match start[1] {
            126 => u64::from(u16::from_be_bytes(read(2)?.try_into().expect("two bytes"))),
            127 => u64::from_be_bytes(read(8)?.try_into().expect("eight bytes")),
            short => u64::from(short),
        };
        Ok((start[0] & 0x0f, read(usize::try_from(length).expect("a length"))?))
    }
}
