//! A router without a hand: several hands connect to it, and clients find all of them there.

use crate::ServeError;
use crate::access::at_router;
use crate::session;
use crate::settings::Settings;
use zenoh::{Session, Wait};

/// A router.
#[must_use = "a router ends when this value is dropped"]
pub struct Router(Session);

impl Router {
    /// Starts a router with these settings.
    ///
    /// # Errors
    /// Returns an error if the network cannot be used.
    pub fn start(settings: &Settings) -> Result<Self, ServeError> {
        session::open(settings, &at_router(&settings.clients), session::LARGEST_OF_ROUTER).map(Self)
    }

    /// Ends the router.
    pub fn end(self) {
        // A session that cannot be closed any more has ended already.
        let _ = self.0.close().wait();
    }
}
