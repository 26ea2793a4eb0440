//! A server with the simulated hand in this process, and clients that use the protocol with zenoh and the codec
//! alone.

#![allow(dead_code)]

pub mod child;
pub mod client;
#[path = "../../../tests/common/free_port.rs"]
mod free_port;

pub use client::Client;
pub use free_port::free_port;

use std::path::Path;
use std::time::{Duration, Instant};
use sun2xp::hand::parse_configuration;
use sun2xp::model::configuration::NamedHand;
use sun2xp::{Configuration, Hand};
use sun2xp_serve::server::{Server, prepare};
use sun2xp_serve::settings::{Overrides, Settings};

/// Longest time for anything that the tests wait for. The machine of the tests may be busy.
pub const PATIENCE: Duration = Duration::from_secs(20);

/// The clients of the tests. Carol may only read.
pub const CLIENTS: &str = "[serve.clients]\nalice = 'command'\nbob = 'command'\ncarol = 'read'\n";

/// A server and its endpoint.
pub struct Rig {
    pub server: Server,
    pub endpoint: String,
}

impl Rig {
    /// Starts a server on loopback, without TLS. `text` adds to the table `[serve]`.
    pub fn new(text: &str) -> Self {
        let endpoint = format!("tcp/127.0.0.1:{}", free_port());
        let text = format!("[serve]\nlisten = ['{endpoint}']\n{text}\n{CLIENTS}");
        Self::from_text(&text, Path::new("."), endpoint)
    }

    /// Starts a server with the tables in `text`. Relative paths in `text` start at `folder`.
    pub fn from_text(text: &str, folder: &Path, endpoint: String) -> Self {
        Self::with_hand(Configuration::default(), text, folder, endpoint)
    }

    /// Starts a server on loopback with the simulated hand of this name.
    pub fn named(hand: NamedHand, text: &str) -> Self {
        let endpoint = format!("tcp/127.0.0.1:{}", free_port());
        let text = format!("[serve]\nlisten = ['{endpoint}']\n{text}\n{CLIENTS}");
        let configuration = format!("[finger.simulation]\nhand = {:?}\n", hand.name());
        let configuration = parse_configuration(&configuration).unwrap_or_else(|error| panic!("{error}"));
        Self::with_hand(configuration, &text, Path::new("."), endpoint)
    }

    fn with_hand(mut configuration: Configuration, text: &str, folder: &Path, endpoint: String) -> Self {
        let settings = Settings::from_text(text, &folder.join("sun2xp.toml"), &Overrides::default());
        let settings = settings.unwrap_or_else(|error| panic!("{error}"));
        prepare(&mut configuration, &settings.limits);
        let hand = Hand::open(configuration).expect("the simulated hand");
        let server = Server::start(hand, settings).unwrap_or_else(|error| panic!("{error}"));
        Self { server, endpoint }
    }

    pub fn hand(&self) -> &Hand {
        self.server.hand()
    }

    /// The joint angles of the set point of finger 1, rad.
    pub fn set_point(&self) -> [f64; 3] {
        self.hand().report(1).expect("a report").set_point.joints.into()
    }

    pub fn connect(&self, name: &str) -> Client {
        Client::connect(&self.endpoint, name, None).expect("connected")
    }
}

/// Waits until `found` returns something.
pub fn wait_for<T>(what: &str, mut found: impl FnMut() -> Option<T>) -> T {
    let begun = Instant::now();
    loop {
        if let Some(found) = found() {
            return found;
        }
        assert!(begun.elapsed() < PATIENCE, "waited too long for: {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}
