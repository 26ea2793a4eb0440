//! An open hand in the table of handles. It belongs to this machine or to another machine.

use crate::board::HandIo;
use crate::capi::refusal::Refusal;
use crate::capi::remote_hand::{RemoteHand, RemoteOpener, RemoteSource, over_the_network};
use crate::files::line_of_error;
use crate::hand::{ConfigurationError, Configured, FingersWithIo, Hand, HandError};
use std::ffi::{CStr, OsStr, c_char};
use std::os::unix::ffi::OsStrExt;
use std::path::PathBuf;
use std::sync::Arc;

/// The reason for which a text that is not UTF-8 is refused.
pub(super) const NOT_UTF_8: &str = "the line is not UTF-8 text: encode it in UTF-8";

#[allow(clippy::large_enum_variant, reason = "the table keeps it in a box")]
pub(super) enum OpenedHand {
    Local(Hand),
    Remote(Arc<dyn RemoteHand>),
}

/// Where the configuration of a hand comes from.
pub(super) enum Source {
    /// The file that OpenHand finds. If OpenHand finds none, the hand has the default configuration, without a file.
    Found,
    File(PathBuf),
    /// A text that is possibly not UTF-8. It is checked only when it is read, after the check of the number of open
    /// hands: of several errors, a call reports the one that the manual lists first, and EMFILE comes before EINVAL.
    Text(Vec<u8>),
}

/// A configuration, and the hardware that the program provides.
pub(super) struct SourceWithIo {
    source: Source,
    /// The hardware. It is `None` if the C call takes no hardware.
    io: Option<HandIo>,
}

impl From<Source> for SourceWithIo {
    fn from(source: Source) -> Self {
        Self { source, io: None }
    }
}

impl Source {
    /// The file at a path of the program, or the file that OpenHand finds if `path` is null.
    ///
    /// # Safety
    /// `path` is null, or points to a text that ends with 0.
    pub unsafe fn at(path: *const c_char) -> Self {
        if path.is_null() {
            return Self::Found;
        }
        // SAFETY: by the contract of this function.
        let path = unsafe { CStr::from_ptr(path) };
        Self::File(PathBuf::from(OsStr::from_bytes(path.to_bytes())))
    }

    /// A configuration in the memory of the program. The text is possibly not UTF-8.
    ///
    /// # Safety
    /// `configuration` points to a text that ends with 0.
    pub unsafe fn in_memory(configuration: *const c_char) -> Self {
        // SAFETY: by the contract of this function.
        Self::Text(unsafe { CStr::from_ptr(configuration) }.to_bytes().to_vec())
    }

    pub fn with_io(self, io: HandIo) -> SourceWithIo {
        SourceWithIo { source: self, io: Some(io) }
    }

    fn read(&self, with_io: FingersWithIo) -> Result<Configured, HandError> {
        let configured = match self {
            Self::Found => Configured::find_with_io(with_io),
            Self::File(path) => Configured::read_with_io(path, with_io),
            Self::Text(text) => Configured::from_text_with_io(utf_8(text)?, with_io),
        };
        configured.map_err(HandError::from)
    }

    /// Returns the source from which another library reads the same configuration. Returns `None` if the configuration
    /// came neither from a text nor from a file.
    fn into_remote(self, found: &Configured) -> Option<RemoteSource> {
        match self {
            Self::Text(text) => String::from_utf8(text).ok().map(RemoteSource::Text),
            Self::Found | Self::File(_) => found.file.clone().map(RemoteSource::File),
        }
    }
}

fn utf_8(text: &[u8]) -> Result<&str, ConfigurationError> {
    str::from_utf8(text).map_err(|error| ConfigurationError::Invalid {
        file: "configuration text".into(),
        line: Some(line_of_error(text, error)),
        reason: NOT_UTF_8.into(),
    })
}

/// Opens the hand that a configuration describes. With a table `[remote]` it is a hand on another machine, and
/// otherwise a hand of this machine. In a library without network code, `open_remote` opens hands on other machines.
/// Also returns whether the refusals of the calls for this hand are printed.
pub(super) fn open(from: SourceWithIo, open_remote: RemoteOpener) -> Result<(OpenedHand, bool), Refusal> {
    let SourceWithIo { source, io } = from;
    let configured = source.read(io.as_ref().map(FingersWithIo::of).unwrap_or_default())?;
    let print_refusals = configured.configuration.hand.print_refusals;
    let opener = over_the_network();
    if !configured.is_remote() {
        return match opener {
            Some(_) => Err(Refusal::OnlyRemote),
            None => {
                let hand = Hand::open_as_with_io(configured, io.unwrap_or_default())?;
                Ok((OpenedHand::Local(hand), print_refusals))
            }
        };
    }
    if io.is_some() {
        return Err(Refusal::NotRemote);
    }
    let Some(source) = source.into_remote(&configured) else { return Err(Refusal::OnlyRemote) };
    let hand = opener.unwrap_or(open_remote)(source, &configured.configuration)?;
    Ok((OpenedHand::Remote(hand), print_refusals))
}

impl OpenedHand {
    /// Begins to bring a hand of this machine to its end state, as [`Hand::request_end`] does. Does nothing for a hand
    /// on another machine.
    pub fn request_end(&self) {
        if let Self::Local(hand) = self {
            hand.request_end();
        }
    }

    /// Brings the hand to its end state. It need not be dropped afterwards.
    pub fn end(&self) {
        match self {
            Self::Local(hand) => hand.end(),
            Self::Remote(hand) => hand.close(),
        }
    }
}

impl Drop for OpenedHand {
    fn drop(&mut self) {
        if let Self::Remote(hand) = self {
            hand.close();
        }
    }
}
