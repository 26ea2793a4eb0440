//! The trait [`RemoteHand`], through which the C calls use a hand on another machine. The package `remote/library`
//! implements this trait over the network. libsun2xp implements it by passing the calls on to that package's library
//! ([`crate::capi::loaded_hand`]).

use crate::calibration::Task;
use crate::capi::event_struct::sun2xp_event;
use crate::capi::fault_struct::sun2xp_fault;
use crate::capi::fingertip_struct::sun2xp_tip;
use crate::capi::limits_struct::sun2xp_limits;
use crate::capi::status_struct::sun2xp_status;
use crate::finger::Action;
use crate::hand::{FingerCommand, HandError, Until};
use crate::model::configuration::Configuration;
use std::ffi::c_int;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

/// Why a hand on another machine refuses a call.
#[derive(Debug)]
pub enum RemoteRefusal {
    /// A reason for which a hand of this machine refuses calls too.
    Hand(HandError),
    /// Another reason.
    Other {
        /// SUN2XP_ERROR_...
        number: c_int,
        /// The errno of the refusal.
        errno: c_int,
        /// One line with the cause and the remedy, without the name of the call.
        text: String,
        /// The calls that help.
        actions: Vec<Action>,
    },
}

impl From<HandError> for RemoteRefusal {
    fn from(error: HandError) -> Self {
        Self::Hand(error)
    }
}

/// Where the configuration of a hand on another machine comes from.
#[derive(Clone, Debug)]
pub enum RemoteSource {
    /// A file with a table `[remote]`.
    File(PathBuf),
    /// A text with a table `[remote]`.
    Text(String),
}

/// A hand on another machine. Fingers are numbered 1 to 3. The number 0 stands for all fingers, and only calls that say
/// so accept it. Units are those of `sun2xp.h`. Every call is refused, and changes nothing, if there is no such finger
/// or if the hand cannot be reached.
#[allow(clippy::missing_errors_doc, reason = "the reasons are above")]
pub trait RemoteHand: Send + Sync {
    /// Sends commands to up to three fingers. Does not wait for the network.
    fn send(&self, commands: &[FingerCommand]) -> Result<(), RemoteRefusal>;

    /// The measured joint angles, rad.
    fn position(&self, finger: c_int) -> Result<[f64; 3], RemoteRefusal>;

    /// The result of sun2xp_tip.
    fn tip(&self, finger: c_int) -> Result<sun2xp_tip, RemoteRefusal>;

    /// The result of sun2xp_status.
    fn status(&self, finger: c_int) -> Result<sun2xp_status, RemoteRefusal>;

    /// The result of sun2xp_limits.
    fn limits(&self, finger: c_int) -> Result<sun2xp_limits, RemoteRefusal>;

    /// The result of sun2xp_fault.
    fn fault(&self, finger: c_int) -> Result<sun2xp_fault, RemoteRefusal>;

    /// Stops a finger. The number 0 stands for all fingers.
    fn stop(&self, finger: c_int) -> Result<(), RemoteRefusal>;

    /// Makes a faulted finger a spring again. The number 0 stands for all fingers. Takes long.
    fn recover(&self, finger: c_int) -> Result<(), RemoteRefusal>;

    /// Calibrates a finger. Takes long.
    fn calibrate(&self, finger: c_int, task: Task) -> Result<(), RemoteRefusal>;

    /// Waits until a finger has arrived or settled. The number 0 stands for all fingers.
    fn wait(&self, finger: c_int, until: Until, limit: Duration) -> Result<(), RemoteRefusal>;

    /// Takes the next event, if there is one.
    fn next_event(&self) -> Result<Option<sun2xp_event>, RemoteRefusal>;

    /// Waits until there is an event, for at most `limit`, or without a limit if `limit` is none. Does not take the
    /// event.
    fn wait_for_event(&self, limit: Option<Duration>) -> Result<(), RemoteRefusal>;

    /// Brings the hand to its end state and releases it. A second call does nothing.
    fn close(&self);
}

/// A function that opens a hand on another machine. Its arguments are the source of the configuration, and the
/// configuration that was read from this source. The function uses only the table `[hand]` of the configuration, which
/// says whether values out of range are refused or clamped.
pub type RemoteOpener = fn(RemoteSource, &Configuration) -> Result<Arc<dyn RemoteHand>, RemoteRefusal>;

static OVER_THE_NETWORK: OnceLock<RemoteOpener> = OnceLock::new();

/// Makes this library open only hands on other machines, with this opener. Only the first call has an effect.
pub fn open_only_remote_hands(opener: RemoteOpener) {
    // Only a library that is initialised twice makes a second call, and it passes the same function again.
    let _ = OVER_THE_NETWORK.set(opener);
}

/// Returns the function that opens hands over the network, or none in a library without network code.
pub(super) fn over_the_network() -> Option<RemoteOpener> {
    OVER_THE_NETWORK.get().copied()
}
