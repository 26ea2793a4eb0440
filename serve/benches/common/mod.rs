//! What the benchmarks share: a server with a simulated hand in this process, and the configuration of its clients.

#![allow(dead_code)]

#[path = "../../../benches/realtime/attempts.rs"]
pub mod attempts;
#[path = "../../../benches/realtime/under_control.rs"]
mod under_control;

use std::error::Error;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use sun2xp::model::Fingers;
use sun2xp::{Configuration, Hand, RealTime};
use sun2xp_remote_client::{RemoteConfiguration, RemoteHand};
use sun2xp_serve::certificates::{Wanted, make};
use sun2xp_serve::server::{Server, prepare};
use sun2xp_serve::settings::{Overrides, Settings};
use under_control::under_control;

pub type Failure = Box<dyn Error>;

/// The clients. Alice owns the hand, bob sends Targets with an epoch that is not in force, and carol only reads.
const CLIENTS: &str = "[serve.clients]\nalice = 'command'\nbob = 'command'\ncarol = 'read'\n";

/// The simulated hand with these fingers at this rate, Hz.
pub fn hand(rate: f64, fingers: Fingers) -> Configuration {
    let mut configuration = Configuration::default();
    (configuration.hand.rate, configuration.hand.fingers) = (rate, fingers);
    configuration.hand.real_time = RealTime::Try;
    configuration
}

/// A hand that is offered on loopback. Dropping this value ends the server, so that it does not disturb the next
/// measurement.
pub struct Offer {
    /// None only while this value is being dropped.
    server: Option<Server>,
    pub endpoint: String,
    certificates: Option<tempfile::TempDir>,
}

impl Offer {
    /// Offers the hand of this configuration.
    ///
    /// # Errors
    /// Returns an error if the hand cannot be opened or offered.
    pub fn new(tls: bool, mut configuration: Configuration) -> Result<Self, Failure> {
        let port = TcpListener::bind("127.0.0.1:0").and_then(|at| at.local_addr())?.port();
        let endpoint = format!("{}/127.0.0.1:{port}", if tls { "tls" } else { "tcp" });
        let certificates = if tls { Some(tempfile::tempdir()?) } else { None };
        let mut text = format!("[serve]\nlisten = ['{endpoint}']\n{CLIENTS}");
        if let Some(folder) = &certificates {
            let names = |names: &[&str]| names.iter().map(|name| name.parse().expect("a name")).collect();
            let (servers, clients) = (names(&["server"]), names(&["alice", "bob", "carol"]));
            make(folder.path(), &Wanted { servers, addresses: Vec::new(), clients })?;
            text += "[serve.tls]\nauthority = 'ca.pem'\ncertificate = 'server.pem'\nkey = 'server.key'\n";
        }
        let folder = certificates.as_ref().map_or(PathBuf::new(), |folder| folder.path().into());
        let settings = Settings::from_text(&text, &folder.join("sun2xp.toml"), &Overrides::default())?;
        prepare(&mut configuration, &settings.limits);
        let server = Some(Server::start(Hand::open(configuration)?, settings)?);
        Ok(Self { server, endpoint, certificates })
    }

    /// Checks that all fingers are under control.
    ///
    /// # Errors
    /// Returns an error that names the first finger that is not under control, with the reason.
    pub fn check(&self) -> Result<(), Failure> {
        for finger in 1..=3 {
            under_control(finger as usize, &self.hand().report(finger)?.stage)?;
        }
        Ok(())
    }

    pub fn hand(&self) -> &Hand {
        self.server.as_ref().expect("the server runs").hand()
    }

    /// The folder with the certificates.
    pub fn folder(&self) -> Option<&Path> {
        self.certificates.as_ref().map(tempfile::TempDir::path)
    }
}

impl Drop for Offer {
    fn drop(&mut self) {
        self.server.take().into_iter().for_each(Server::end);
    }
}

/// The configuration of the client with this name.
pub fn configuration(endpoint: &str, name: &str, folder: Option<&str>) -> Result<RemoteConfiguration, Failure> {
    let mut text = format!("[remote]\nendpoint = '{endpoint}'\nhand = 'hand'\n");
    match folder {
        Some(_) => {
            text += &format!("[remote.tls]\nauthority = 'ca.pem'\ncertificate = '{name}.pem'\nkey = '{name}.key'\n");
        }
        None => text += &format!("client = '{name}'\n"),
    }
    let read = RemoteConfiguration::from_text(&text, Path::new(folder.unwrap_or_default()))?;
    Ok(read.ok_or("no table [remote]")?)
}

/// Opens the hand for alice.
pub fn remote(endpoint: &str, folder: Option<&str>) -> Result<RemoteHand, Failure> {
    Ok(RemoteHand::open(&configuration(endpoint, "alice", folder)?)?)
}

/// The set point with this number, rad. The set points repeat after 100 000 numbers.
pub fn pose_of(number: u32) -> [f64; 3] {
    [0.1, 0.5, 0.9 + 1e-6 * f64::from(number % 100_000)]
}

/// Returns the percentile: the smallest element of `values` for which at least the fraction `part` of all elements is
/// less than or equal to this element.
pub fn percentile(values: &[f64], part: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let index = (part * sorted.len() as f64).ceil() as usize;
    sorted.get(index.saturating_sub(1)).copied().unwrap_or(f64::NAN)
}
