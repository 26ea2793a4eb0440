//! The keys of a hand. In Rust, only this file and the access control of the server (`serve/src/access.rs`) build them.

use crate::{Action, ClientName, HandName};

/// Selects the statuses of all hands behind a router.
pub const EVERY_STATUS: &str = "sun2xp/*/status";

/// The keys of one hand.
#[derive(Clone, Debug)]
pub struct HandKeys(HandName);

impl HandKeys {
    /// The keys of the hand with this name.
    #[must_use]
    pub fn new(hand: HandName) -> Self {
        Self(hand)
    }

    fn key(&self, rest: &str) -> String {
        format!("sun2xp/{}/{rest}", self.0)
    }

    /// The key of States.
    #[must_use]
    pub fn state(&self) -> String {
        self.key("state")
    }

    /// The key of Events.
    #[must_use]
    pub fn events(&self) -> String {
        self.key("events")
    }

    /// The key of Statuses.
    #[must_use]
    pub fn status(&self) -> String {
        self.key("status")
    }

    /// The key under which this client learns that a Target was refused.
    #[must_use]
    pub fn refused(&self, client: &ClientName) -> String {
        self.key(&format!("refused/{client}"))
    }

    /// The key of this client's Targets.
    #[must_use]
    pub fn target(&self, client: &ClientName) -> String {
        self.key(&format!("target/{client}"))
    }

    /// The key of this client's Requests for an action.
    #[must_use]
    pub fn request(&self, action: Action, client: &ClientName) -> String {
        self.key(&format!("{}/{client}", action.name()))
    }

    /// Selects the Targets of every client.
    #[must_use]
    pub fn every_target(&self) -> String {
        self.key("target/*")
    }

    /// Selects the Requests of every client for an action.
    #[must_use]
    pub fn every_request(&self, action: Action) -> String {
        self.key(&format!("{}/*", action.name()))
    }

    /// Returns the client whose Targets have this key; none if it is not a key of Targets.
    #[must_use]
    pub fn client_of_target(&self, key: &str) -> Option<ClientName> {
        self.client(key, "target")
    }

    /// Returns the client whose Requests for this action have this key; none if it is not a key of such Requests.
    #[must_use]
    pub fn client_of_request(&self, action: Action, key: &str) -> Option<ClientName> {
        self.client(key, action.name())
    }

    fn client(&self, key: &str, what: &str) -> Option<ClientName> {
        let rest = key.strip_prefix("sun2xp/")?.strip_prefix(self.0.as_str())?;
        rest.strip_prefix('/')?.strip_prefix(what)?.strip_prefix('/')?.parse().ok()
    }
}

/// Returns the name of the hand whose Status has this key; none if the key is not one of a Status.
#[must_use]
pub fn hand_of_status(key: &str) -> Option<HandName> {
    key.strip_prefix("sun2xp/")?.strip_suffix("/status")?.parse().ok()
}
