//! Network interfaces whose other end is a descriptor: each read and each write is one IP packet.
#![allow(unsafe_code, reason = "the interface is made by a control call")]

use super::namespace::ip;
use std::fs::{File, OpenOptions};
use std::io;
use std::os::fd::AsRawFd;
use std::os::unix::fs::OpenOptionsExt;

/// Makes the interface `tun0` in the namespace of this thread, with an address such as 10.17.0.1/24. Reads do not wait.
///
/// The interface has no checksum or segmentation offload, so each packet is one that a cable would carry.
///
/// # Errors
/// Returns an error if the kernel has no such interfaces, or if this process may not make one.
pub fn open(address: &str) -> io::Result<File> {
    let device = OpenOptions::new().read(true).write(true).custom_flags(libc::O_NONBLOCK).open("/dev/net/tun")?;
    // SAFETY: all fields of this structure may be zero.
    let mut request: libc::ifreq = unsafe { std::mem::zeroed() };
    for (to, from) in request.ifr_name.iter_mut().zip(b"tun0") {
        *to = *from as libc::c_char;
    }
    request.ifr_ifru.ifru_flags = (libc::IFF_TUN | libc::IFF_NO_PI) as libc::c_short;
    // SAFETY: the descriptor is open, and the kernel reads and writes one ifreq.
    if unsafe { libc::ioctl(device.as_raw_fd(), libc::TUNSETIFF, &mut request) } != 0 {
        return Err(io::Error::last_os_error());
    }
    ip(&["address", "add", address, "dev", "tun0"])?;
    ip(&["link", "set", "tun0", "up", "mtu", "1500"])?;
    Ok(device)
}
