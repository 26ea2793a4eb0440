//! The program under test, and a simulated hand for it.

use std::io::{BufRead, BufReader};
use std::net::SocketAddr;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use sun2xp::{Configuration, Hand, RealTime};

/// A running program that serves the page. It is killed when this value is dropped.
pub struct Program {
    child: Child,
    /// The printed address of the page.
    pub url: String,
}

impl Program {
    /// Starts the program with these arguments, and reads the address of the page.
    pub fn start(arguments: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
        let mut child = command.args(arguments).stdout(Stdio::piped()).spawn().expect("the program starts");
        let lines = BufReader::new(child.stdout.take().expect("a pipe")).lines().map_while(Result::ok);
        let url = lines.filter_map(|line| line.find("http://").map(|at| line[at..].trim().to_owned())).next();
        Self { child, url: url.expect("the program prints the address of the page") }
    }

    /// Starts `sun2xp monitor --web` for a hand.
    pub fn monitor(name: &str) -> Self {
        Self::start(&["monitor", name, "--web"])
    }

    /// Returns the loopback address with the port of the page.
    pub fn address(&self) -> SocketAddr {
        let after = self.url.rsplit_once(':').map(|(_, after)| after).expect("a port");
        let port = after.split('/').next().and_then(|port| port.parse().ok()).expect("a port");
        SocketAddr::from(([127, 0, 0, 1], port))
    }

    /// Returns the token in the address of the page.
    pub fn token(&self) -> Option<&str> {
        self.url.split_once("#token=").map(|(_, token)| token)
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // The program may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Opens a simulated hand with a name that no other test uses. Returns it with its name.
pub fn hand(change: impl FnOnce(&mut Configuration)) -> (Hand, String) {
    static HANDS: AtomicUsize = AtomicUsize::new(0);
    let mut configuration = Configuration::default();
    let name = format!("web-{}-{}", std::process::id(), HANDS.fetch_add(1, Ordering::Relaxed));
    configuration.hand.real_time = RealTime::Ignore;
    // A browser and the other tests may delay the servos for a long time.
    configuration.hand.watchdog_ms = 1000;
    configuration.hand.open_timeout_ms = 60_000;
    configuration.telemetry.enabled = true;
    configuration.telemetry.name.clone_from(&name);
    change(&mut configuration);
    (Hand::open(configuration).expect("the hand opens"), name)
}
