//! Sockets with abstract names, over which a reader gets the memory of a hand. The system removes an abstract name with
//! its socket, so nothing is left behind if a process is killed.
#![allow(unsafe_code, reason = "system calls with addresses and control messages")]

use crate::board::descriptor::{Descriptor, check};
use std::io;
use std::mem::{offset_of, size_of, zeroed};
use std::os::fd::RawFd;

/// Number of connections that the system holds until they are accepted.
const BACKLOG: libc::c_int = 16;

/// Space for a control message with one descriptor.
const CONTROL_BYTES: usize = 64;

/// A socket that preserves the boundaries of messages and never waits.
pub(super) struct Socket(Descriptor);

/// The process at the other end of a connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Peer {
    pub user: u32,
    /// Process ID. It is 0 if the process at the other end is not visible in the PID namespace of this process.
    pub process: i32,
}

/// A received message.
pub(super) struct Received {
    /// Number of bytes. It is 0 at the end of the connection.
    pub bytes: usize,
    pub file: Option<Descriptor>,
}

/// Control data, aligned for its header.
#[repr(C, align(8))]
struct Control([u8; CONTROL_BYTES]);

impl Socket {
    fn new() -> io::Result<Self> {
        let kind = libc::SOCK_SEQPACKET | libc::SOCK_CLOEXEC | libc::SOCK_NONBLOCK;
        // SAFETY: the call takes numbers only.
        Descriptor::opened(unsafe { libc::socket(libc::AF_UNIX, kind, 0) }).map(Self)
    }

    /// Listens at an abstract name.
    ///
    /// # Errors
    /// Returns `AddrInUse` if another socket has the name.
    pub fn listen(name: &str) -> io::Result<Self> {
        let socket = Self::new()?;
        let (address, length) = abstract_address(name)?;
        // SAFETY: the address is valid for `length` bytes.
        check(unsafe { libc::bind(socket.number()?, (&raw const address).cast(), length) })?;
        // SAFETY: the call takes numbers only.
        check(unsafe { libc::listen(socket.number()?, BACKLOG) })?;
        Ok(socket)
    }

    /// Connects to an abstract name.
    ///
    /// # Errors
    /// Returns `ConnectionRefused` if nobody listens, and `WouldBlock` if too many connections wait to be accepted.
    pub fn connect(name: &str) -> io::Result<Self> {
        let socket = Self::new()?;
        let (address, length) = abstract_address(name)?;
        // SAFETY: the address is valid for `length` bytes.
        check(unsafe { libc::connect(socket.number()?, (&raw const address).cast(), length) })?;
        Ok(socket)
    }

    /// Accepts a connection.
    ///
    /// # Errors
    /// Returns `WouldBlock` if there is none.
    pub fn accept(&self) -> io::Result<Self> {
        let flags = libc::SOCK_CLOEXEC | libc::SOCK_NONBLOCK;
        // SAFETY: null pointers request no address.
        let result = unsafe { libc::accept4(self.number()?, std::ptr::null_mut(), std::ptr::null_mut(), flags) };
        Descriptor::opened(result).map(Self)
    }

    /// Returns the process at the other end.
    pub fn peer(&self) -> io::Result<Peer> {
        let mut found = libc::ucred { pid: 0, uid: 0, gid: 0 };
        let mut length = size_of::<libc::ucred>() as libc::socklen_t;
        // SAFETY: `found` is writable and has `length` bytes.
        check(unsafe {
            let place = (&raw mut found).cast();
            libc::getsockopt(self.number()?, libc::SOL_SOCKET, libc::SO_PEERCRED, place, &mut length)
        })?;
        Ok(Peer { user: found.uid, process: found.pid })
    }

    /// Sends a message, with a file if there is one.
    ///
    /// # Errors
    /// Returns `WouldBlock` if the other end has not received enough of the earlier messages.
    pub fn send(&self, bytes: &[u8], file: Option<&Descriptor>) -> io::Result<()> {
        let mut part = libc::iovec { iov_base: bytes.as_ptr().cast_mut().cast(), iov_len: bytes.len() };
        let mut control = Control([0; CONTROL_BYTES]);
        // SAFETY: all zeros are a valid value of this plain structure.
        let mut message: libc::msghdr = unsafe { zeroed() };
        (message.msg_iov, message.msg_iovlen) = (&mut part, 1);
        if let Some(file) = file {
            message.msg_control = (&raw mut control).cast();
            // SAFETY: `control` is aligned and has room for the header and one descriptor, as the assertion below
            // states.
            unsafe {
                message.msg_controllen = libc::CMSG_SPACE(size_of::<RawFd>() as u32) as _;
                let header = libc::CMSG_FIRSTHDR(&message);
                (*header).cmsg_level = libc::SOL_SOCKET;
                (*header).cmsg_type = libc::SCM_RIGHTS;
                (*header).cmsg_len = libc::CMSG_LEN(size_of::<RawFd>() as u32) as _;
                libc::CMSG_DATA(header).cast::<RawFd>().write_unaligned(file.number());
            }
        }
        // SAFETY: the message refers to values that outlive the call.
        let sent = unsafe { libc::sendmsg(self.number()?, &message, libc::MSG_NOSIGNAL | libc::MSG_DONTWAIT) };
        if sent < 0 { Err(io::Error::last_os_error()) } else { Ok(()) }
    }

    /// Receives a message into `bytes`. Bytes of the message for which there is no room are lost.
    ///
    /// # Errors
    /// Returns `WouldBlock` if there is no message.
    pub fn receive(&self, bytes: &mut [u8]) -> io::Result<Received> {
        let mut part = libc::iovec { iov_base: bytes.as_mut_ptr().cast(), iov_len: bytes.len() };
        let mut control = Control([0; CONTROL_BYTES]);
        // SAFETY: all zeros are a valid value of this plain structure.
        let mut message: libc::msghdr = unsafe { zeroed() };
        (message.msg_iov, message.msg_iovlen) = (&mut part, 1);
        message.msg_control = (&raw mut control).cast();
        message.msg_controllen = CONTROL_BYTES as _;
        // SAFETY: the message refers to values that are writable and outlive the call.
        let count = unsafe { libc::recvmsg(self.number()?, &mut message, libc::MSG_CMSG_CLOEXEC | libc::MSG_DONTWAIT) };
        let Ok(bytes) = usize::try_from(count) else { return Err(io::Error::last_os_error()) };
        let mut file = None;
        // SAFETY: the system has filled `control` with whole control messages. Every descriptor in them is new, and no
        // other code knows it.
        unsafe {
            let mut header = libc::CMSG_FIRSTHDR(&message);
            while let Some(found) = header.as_ref() {
                if found.cmsg_level == libc::SOL_SOCKET && found.cmsg_type == libc::SCM_RIGHTS {
                    let payload = found.cmsg_len - libc::CMSG_LEN(0) as usize;
                    for place in 0..payload / size_of::<RawFd>() {
                        let number = libc::CMSG_DATA(header).cast::<RawFd>().add(place).read_unaligned();
                        // A second descriptor is closed at once.
                        file = file.or(Descriptor::opened(number).ok());
                    }
                }
                header = libc::CMSG_NXTHDR(&message, header);
            }
        }
        Ok(Received { bytes, file })
    }

    /// Ends the connection for both ends, even if a forked child has a copy of the socket.
    pub fn shut_down(&self) {
        if let Ok(number) = self.number() {
            // SAFETY: the call takes numbers only. If the connection has ended already, the call changes nothing.
            unsafe { libc::shutdown(number, libc::SHUT_RDWR) };
        }
    }

    /// Returns the descriptor.
    ///
    /// # Errors
    /// Returns EBADF if another part of the program has closed it.
    pub fn number(&self) -> io::Result<RawFd> {
        match self.0.is_own() {
            true => Ok(self.0.number()),
            false => Err(io::Error::from_raw_os_error(libc::EBADF)),
        }
    }
}

// SAFETY: the macro only computes with its argument.
const _: () = assert!(unsafe { libc::CMSG_SPACE(size_of::<RawFd>() as u32) } as usize <= CONTROL_BYTES);

/// Returns the user of this process.
pub(super) fn own_user() -> u32 {
    // SAFETY: the call takes no argument and cannot fail.
    unsafe { libc::geteuid() }
}

fn abstract_address(name: &str) -> io::Result<(libc::sockaddr_un, libc::socklen_t)> {
    // SAFETY: all zeros are a valid value of this plain structure.
    let mut address: libc::sockaddr_un = unsafe { zeroed() };
    address.sun_family = libc::AF_UNIX as libc::sa_family_t;
    // An abstract name begins with a byte 0.
    let Some(place) = address.sun_path.get_mut(1..=name.len()) else { return Err(io::ErrorKind::InvalidInput.into()) };
    for (letter, byte) in place.iter_mut().zip(name.bytes()) {
        *letter = byte as libc::c_char;
    }
    let length = offset_of!(libc::sockaddr_un, sun_path) + 1 + name.len();
    Ok((address, length as libc::socklen_t))
}
