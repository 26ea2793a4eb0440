//! The command line of `sun2xp-serve`, and what it does.

use crate::ServeError;
use crate::certificates::{self, Wanted};
use crate::router::Router;
use crate::server::{Server, prepare};
use crate::settings::{Overrides, Permission, Settings};
use clap::Parser;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::path::PathBuf;
use sun2xp::hand::find_configuration;
use sun2xp::{Configured, Hand};
use sun2xp_remote_protocol::ClientName;

/// Offers the hand to planners on other machines. The table [serve] of the configuration file says where the server
/// listens and who may command the hand. The server ends at SIGINT or SIGTERM: the fingers go to their end state.
///
/// Without [serve.clients] nobody may command the hand. The server listens at tcp/127.0.0.1:7447 if it is not
/// configured otherwise, and listens for other machines only with TLS.
#[derive(Debug, Parser)]
#[command(
    name = "sun2xp-serve",
    version,
    after_help = "Exit status: 0 if the command has done its work, 1 if it failed, 2 for wrong usage."
)]
pub struct Arguments {
    /// Configuration file. If omitted: the file that the library would use.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Listen here, in place of serve.listen: tls/HOST:PORT, or tcp/127.0.0.1:PORT. Can be repeated.
    #[arg(long, value_name = "ENDPOINT")]
    listen: Vec<String>,
    /// Name of the hand, in place of serve.name.
    #[arg(long)]
    name: Option<String>,
    /// Run a router without a hand, to which hands and clients connect.
    #[arg(long, conflicts_with = "name")]
    router: bool,
    /// Make certificates in this folder, and end. An authority that is there signs them; otherwise a new one does.
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["config", "listen", "name", "router"])]
    make_certificates: Option<PathBuf>,
    /// Make the certificate of a server, a hand or a router with this name, which is also the name of its machine.
    #[arg(long, value_name = "NAME", requires = "make_certificates")]
    server: Vec<ClientName>,
    /// Another name or address by which clients reach the servers.
    #[arg(long, value_name = "HOST", requires = "make_certificates")]
    address: Vec<String>,
    /// Make the certificate of a client with this name.
    #[arg(long, value_name = "NAME", requires = "make_certificates")]
    client: Vec<ClientName>,
}

/// Does what the arguments say. Returns when it is done, or after a signal.
///
/// # Errors
/// Returns the first error.
pub fn run(arguments: Arguments) -> Result<(), ServeError> {
    if let Some(folder) = arguments.make_certificates {
        let Arguments { server: servers, address: addresses, client: clients, .. } = arguments;
        for file in certificates::make(&folder, &Wanted { servers, addresses, clients })? {
            println!("{}", file.display());
        }
        return Ok(());
    }
    // Signals are held from here on, so that a server that is just starting ends in an orderly way too.
    let signals = Signals::new([SIGINT, SIGTERM]);
    let signals =
        signals.map_err(|error| ServeError::System { doing: "wait for signals", reason: error.to_string() })?;
    let mut configured = match &arguments.config {
        Some(file) => Configured::read(file)?,
        None => find_configuration()?,
    };
    let overrides = Overrides { name: arguments.name, listen: arguments.listen };
    let settings = Settings::read(configured.file.as_deref(), &overrides)?;
    if arguments.router {
        let router = Router::start(&settings)?;
        println!("router at {}", listed(&settings));
        wait(signals);
        router.end();
        return Ok(());
    }
    prepare(&mut configured.configuration, &settings.limits);
    let hand = Hand::open_as(configured)?;
    announce(&settings);
    let server = Server::start(hand, settings)?;
    println!("ready");
    wait(signals);
    server.end();
    Ok(())
}

fn wait(mut signals: Signals) {
    // The iterator of signals does not end by itself.
    let _ = signals.forever().next();
}

fn listed(settings: &Settings) -> String {
    let endpoints: Vec<String> = settings.listen.iter().chain(&settings.connect).map(ToString::to_string).collect();
    endpoints.join(", ")
}

/// Says what is offered, and what is unsafe or useless about it.
fn announce(settings: &Settings) {
    println!("hand `{}` at {}", settings.name, listed(settings));
    let commanders = settings.clients.values().filter(|&&permission| permission == Permission::Command).count();
    if commanders == 0 {
        println!("nobody may command the hand: list clients in [serve.clients], such as planner = \"command\"");
    }
    if settings.tls.is_none() {
        println!("without TLS: every program on this machine can read, and a client has the name that it says");
    }
}
