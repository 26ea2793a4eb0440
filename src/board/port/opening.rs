//! Opens, locks and configures a serial port.

use super::Port;
use super::input::Input;
use crate::board::descriptor::{Descriptor, check};
use crate::board::port_error::PortError;
use std::ffi::CString;
use std::io;
use std::os::unix::ffi::OsStrExt;
use std::path::Path;

impl Port {
    /// Opens, locks and configures the port at `path` for `baud` bit/s, and discards bytes that have already arrived.
    ///
    /// # Errors
    /// Returns an error if `path` is not a serial port, if this user may not open it, or if another program has it
    /// open. Returns an error if the driver does not support `baud` or refuses another setting.
    pub fn open(path: &Path, baud: u32) -> Result<Self, PortError> {
        let failed = |source| PortError::at_opening(path, source);
        let mut port = Self {
            descriptor: open(path)?,
            input: Input::new().map_err(failed)?,
            unread: false,
            hung_up: false,
            path: path.to_owned(),
            ready_at: 0,
            process: std::process::id(),
            locked: false,
        };
        port.lock()?;
        let set_up = |source| PortError::SetUp { path: path.to_owned(), source };
        let offered = port.configure(baud).map_err(set_up)?;
        // A UART tolerates a rate error of 3 %. A driver that does not support `baud` selects a very different rate.
        if offered.abs_diff(baud) > baud / 33 {
            return Err(PortError::Baud { path: path.to_owned(), wanted: baud, offered });
        }
        port.request_low_latency();
        // SAFETY: the descriptor was opened above.
        check(unsafe { libc::tcflush(port.descriptor.number(), libc::TCIFLUSH) }).map_err(set_up)?;
        // A change of the settings is an event, although no bytes arrive. If the port were watched before the change,
        // this event would make the first wait poll the port, which may take long (input.rs). So the port is watched
        // only after the change.
        port.input.watch(&port.descriptor).map_err(failed)?;
        Ok(port)
    }

    /// Keeps other programs out with TIOCEXCL and flock. TIOCEXCL does not stop a program that runs as root. flock also
    /// stops such a program, if that program locks the port itself. flock comes first, because TIOCEXCL also succeeds
    /// at a port that another program has locked. Its mark would then stay there, because TIOCEXCL marks the port and
    /// not the descriptor.
    fn lock(&mut self) -> Result<(), PortError> {
        let failed = |source| PortError::at_opening(&self.path, source);
        // SAFETY: the descriptor is open; neither call takes a pointer.
        match check(unsafe { libc::flock(self.descriptor.number(), libc::LOCK_EX | libc::LOCK_NB) }) {
            Ok(_) => self.locked = true,
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => return Err(PortError::Busy(self.path.clone())),
            Err(error) => return Err(failed(error)),
        }
        // SAFETY: as above.
        check(unsafe { libc::ioctl(self.descriptor.number(), libc::TIOCEXCL) }).map_err(failed)?;
        Ok(())
    }

    /// Sets raw mode, eight data bits, no parity, one stop bit, no flow control. Returns the rate that the driver
    /// selected for `baud`, bit/s.
    fn configure(&self, baud: u32) -> io::Result<u32> {
        let mut settings = self.settings()?;
        settings.c_iflag &= !(libc::IGNBRK | libc::BRKINT | libc::PARMRK | libc::ISTRIP | libc::INPCK);
        settings.c_iflag &= !(libc::INLCR | libc::IGNCR | libc::ICRNL | libc::IXON | libc::IXOFF | libc::IXANY);
        settings.c_iflag |= libc::IGNPAR;
        settings.c_oflag &= !libc::OPOST;
        settings.c_lflag &= !(libc::ECHO | libc::ECHONL | libc::ICANON | libc::ISIG | libc::IEXTEN);
        // HUPCL is cleared: with it, closing the port drops DTR, which resets many boards before they reach their end
        // state.
        settings.c_cflag &= !(libc::CSIZE | libc::PARENB | libc::PARODD | libc::CSTOPB | libc::CRTSCTS | libc::HUPCL);
        settings.c_cflag &= !(libc::CBAUD | libc::CIBAUD);
        settings.c_cflag |= libc::CS8 | libc::CREAD | libc::CLOCAL | libc::BOTHER;
        (settings.c_cc[libc::VMIN], settings.c_cc[libc::VTIME]) = (1, 0);
        (settings.c_ispeed, settings.c_ospeed) = (baud, baud);
        // SAFETY: the descriptor is open and `settings` is a termios2.
        check(unsafe { libc::ioctl(self.descriptor.number(), libc::TCSETS2, &settings) })?;
        let found = self.settings()?;
        let modes = |all: &libc::termios2| {
            let rates = libc::CBAUD | libc::CIBAUD;
            (all.c_iflag, all.c_oflag, all.c_lflag, all.c_cflag & !rates)
        };
        if modes(&found) != modes(&settings) || found.c_ispeed != found.c_ospeed {
            return Err(io::Error::other(
                "the driver does not keep the settings (8 data bits, no parity, 1 stop bit, no flow control, raw mode, \
                 the same rate in both directions)",
            ));
        }
        Ok(found.c_ospeed)
    }

    /// Returns the settings of the port. [`Port`] uses TCGETS2 and TCSETS2, because tcgetattr and tcsetattr do not
    /// support arbitrary baud rates.
    fn settings(&self) -> io::Result<libc::termios2> {
        // SAFETY: all zeros is a valid termios2.
        let mut settings: libc::termios2 = unsafe { std::mem::zeroed() };
        // SAFETY: the descriptor is open and `settings` is a termios2.
        check(unsafe { libc::ioctl(self.descriptor.number(), libc::TCGETS2, &mut settings) })?;
        Ok(settings)
    }

    /// Requests low latency from the driver. Without this request, FTDI bridges hold bytes back for 16 ms. A driver
    /// that does not know the request refuses it. Such a driver does not need the request, so a refusal is not an
    /// error. [`Port::latency_timer_ms`] returns the resulting latency.
    fn request_low_latency(&self) {
        let mut serial = SerialStruct([0; SERIAL_STRUCT_WORDS]);
        // SAFETY: the descriptor is open. The size and the alignment of `serial` are at least those of the kernel's
        // serial_struct.
        let known = unsafe { libc::ioctl(self.descriptor.number(), libc::TIOCGSERIAL, &mut serial) } == 0;
        if known {
            serial.0[SERIAL_STRUCT_FLAGS] |= ASYNC_LOW_LATENCY;
            // SAFETY: as above.
            unsafe { libc::ioctl(self.descriptor.number(), libc::TIOCSSERIAL, &serial) };
        }
    }
}

/// The kernel's `struct serial_struct`. Only its fifth int is used, which is `flags` (after type, line, port and irq).
/// The kernel's structure is 72 bytes long on 64-bit machines. The rest of this type is a margin.
#[repr(C, align(8))]
struct SerialStruct([libc::c_int; SERIAL_STRUCT_WORDS]);

const SERIAL_STRUCT_WORDS: usize = 32;
const SERIAL_STRUCT_FLAGS: usize = 4;
const ASYNC_LOW_LATENCY: libc::c_int = 1 << 13;

fn open(path: &Path) -> Result<Descriptor, PortError> {
    let failed = |source| PortError::at_opening(path, source);
    let name = CString::new(path.as_os_str().as_bytes()).map_err(|_| failed(io::ErrorKind::InvalidFilename.into()))?;
    let flags = libc::O_RDWR | libc::O_NOCTTY | libc::O_NONBLOCK | libc::O_CLOEXEC;
    // SAFETY: `name` is a C string.
    let descriptor = Descriptor::opened(unsafe { libc::open(name.as_ptr(), flags) }).map_err(failed)?;
    // SAFETY: the descriptor is open.
    match unsafe { libc::isatty(descriptor.number()) } {
        1 => Ok(descriptor),
        _ => match io::Error::last_os_error() {
            // These errors mean that a sandbox forbids the system call of isatty.
            error if matches!(error.raw_os_error(), Some(libc::EPERM | libc::ENOSYS)) => Err(failed(error)),
            _ => Err(PortError::NotASerialPort(path.to_owned())),
        },
    }
}
