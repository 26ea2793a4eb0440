//! Opens a hand on another machine.

use crate::network_hand::NetworkHand;
use crate::refusals::{forbidden, recovery_refusal, refusal, system};
use std::path::Path;
use std::sync::Arc;
use sun2xp::Configuration;
use sun2xp::capi::{RemoteHand, RemoteRefusal, RemoteSource};
use sun2xp::finger::stop_calls;
use sun2xp_remote_client as client;

/// Opens the hand that the table `[remote]` of a configuration names.
pub(crate) fn open(source: RemoteSource, configuration: &Configuration) -> Result<Arc<dyn RemoteHand>, RemoteRefusal> {
    // The hand reacts to every emergency stop call that is made after this line.
    let seen = stop_calls();
    let read = match &source {
        RemoteSource::File(path) => client::RemoteConfiguration::read(path),
        // A text has no folder of its own: its files are relative to the working directory.
        RemoteSource::Text(text) => client::RemoteConfiguration::from_text(text, Path::new(".")),
    };
    // The caller has found the table already. The file may have been replaced since then.
    let remote = read.map_err(refusal)?.ok_or_else(|| {
        system(
            libc::EIO,
            "the table [remote] was removed from the file during this call: put it back, and open the hand again",
        )
    })?;
    let hand = client::RemoteHand::open(&remote).map_err(|error| match error.kind() {
        // To a client that opens the hand, the server answers *not owner* only if the client does not have the
        // permission "command". If another client owns the hand, the answer is *owned*.
        client::RemoteErrorKind::NotOwner => forbidden(&remote.hand),
        _ => recovery_refusal(error),
    })?;
    NetworkHand::start(hand, configuration, seen)
}
