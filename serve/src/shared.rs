//! What the threads of the server share.

use crate::desk::Desk;
use crate::settings::Settings;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::thread::JoinHandle;
use sun2xp::Hand;
use sun2xp::realtime::{Mutex, now};
use sun2xp_remote_protocol::HandKeys;

/// What the threads of the server share.
pub struct Shared {
    /// The hand.
    pub hand: Arc<Hand>,
    /// What `[serve]` says.
    pub settings: Settings,
    /// The keys of the hand.
    pub keys: HandKeys,
    /// The desk. No thread keeps it locked while the thread sends over the network or waits.
    pub desk: Mutex<Desk>,
    /// Whether a request that takes long is in progress.
    pub busy: AtomicBool,
    /// Whether the server is ending. An ending server refuses all Requests other than stop.
    pub ending: AtomicBool,
    /// Whether the Requests that were in progress when the server began to end are over: their Answers are in the queue
    /// (see [`crate::answers`]), or have been sent.
    pub answered: AtomicBool,
    /// The threads of requests that take long.
    pub requests: Mutex<Vec<JoinHandle<()>>>,
}

impl Shared {
    /// What the threads of the server of this hand share.
    #[must_use]
    pub fn new(hand: Arc<Hand>, settings: Settings) -> Self {
        Self {
            keys: HandKeys::new(settings.name.clone()),
            desk: Mutex::new(Desk::new(hand.clone(), settings.limits, now())),
            hand,
            settings,
            busy: AtomicBool::new(false),
            ending: AtomicBool::new(false),
            answered: AtomicBool::new(false),
            requests: Mutex::default(),
        }
    }
}
