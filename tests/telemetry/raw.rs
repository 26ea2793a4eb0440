//! Sockets like those of telemetry, for processes that do not keep to the protocol.

use std::fs::File;
use std::io::{Error, Result};
use std::mem::{offset_of, size_of, zeroed};
use std::os::fd::{AsRawFd, FromRawFd, OwnedFd, RawFd};
use std::time::Duration;

/// A socket that preserves message boundaries.
pub struct RawSocket(OwnedFd);

impl RawSocket {
    /// Connects to an abstract name. Fails at once if too many connections already wait for the listener.
    pub fn connect(name: &str) -> Result<Self> {
        Self::open(name, |socket, address, length| {
            // SAFETY: the address has `length` bytes.
            unsafe { libc::connect(socket, address, length) }
        })
    }

    /// Listens at an abstract name.
    pub fn listen(name: &str) -> Result<Self> {
        Self::open(name, |socket, address, length| {
            // SAFETY: the address has `length` bytes.
            unsafe { if libc::bind(socket, address, length) < 0 { -1 } else { libc::listen(socket, 10) } }
        })
    }

    fn open(name: &str, act: impl FnOnce(RawFd, *const libc::sockaddr, libc::socklen_t) -> i32) -> Result<Self> {
        let kind = libc::SOCK_SEQPACKET | libc::SOCK_CLOEXEC | libc::SOCK_NONBLOCK;
        // SAFETY: the call takes numbers only, and the descriptor is new.
        let socket = unsafe { OwnedFd::from_raw_fd(check(libc::socket(libc::AF_UNIX, kind, 0))?) };
        // SAFETY: all zeros are a valid address.
        let mut address: libc::sockaddr_un = unsafe { zeroed() };
        address.sun_family = libc::AF_UNIX as libc::sa_family_t;
        for (place, byte) in address.sun_path[1..].iter_mut().zip(name.bytes()) {
            *place = byte as libc::c_char;
        }
        let length = offset_of!(libc::sockaddr_un, sun_path) + 1 + name.len();
        check(act(socket.as_raw_fd(), (&raw const address).cast(), length as libc::socklen_t))?;
        Ok(Self(socket))
    }

    /// Sends a message.
    pub fn send(&self, bytes: &[u8]) -> Result<()> {
        // SAFETY: `bytes` has this length.
        let sent = unsafe { libc::send(self.0.as_raw_fd(), bytes.as_ptr().cast(), bytes.len(), libc::MSG_NOSIGNAL) };
        check(sent as i32).map(drop)
    }

    /// Waits for a message. Returns the message and the file that comes with it. The message is empty if the connection
    /// has ended.
    pub fn receive(&self, longest: Duration) -> (Vec<u8>, Option<File>) {
        let mut poll = libc::pollfd { fd: self.0.as_raw_fd(), events: libc::POLLIN, revents: 0 };
        let (mut bytes, mut control) = (vec![0_u8; 200_000], [0_u64; 8]);
        let mut part = libc::iovec { iov_base: bytes.as_mut_ptr().cast(), iov_len: bytes.len() };
        // SAFETY: all pointers are to values that outlive the calls. A received descriptor is new.
        unsafe {
            assert!(libc::poll(&mut poll, 1, longest.as_millis() as i32) == 1, "no answer within {longest:?}");
            let mut message: libc::msghdr = zeroed();
            (message.msg_iov, message.msg_iovlen) = (&mut part, 1);
            message.msg_control = control.as_mut_ptr().cast();
            message.msg_controllen = size_of_val(&control);
            let count = libc::recvmsg(self.0.as_raw_fd(), &mut message, 0);
            bytes.truncate(count.max(0) as usize);
            let header = libc::CMSG_FIRSTHDR(&message);
            let file = (!header.is_null() && (*header).cmsg_type == libc::SCM_RIGHTS).then(|| {
                assert!((*header).cmsg_len >= size_of::<RawFd>());
                File::from_raw_fd(libc::CMSG_DATA(header).cast::<RawFd>().read_unaligned())
            });
            (bytes, file)
        }
    }
}

fn check(result: i32) -> Result<i32> {
    if result < 0 { Err(Error::last_os_error()) } else { Ok(result) }
}
