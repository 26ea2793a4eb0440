//! The command line of `sun2xp-serve`, and what it does.

use crate::ServeError;
use crate::certificates::{self, Wanted};
use crate::output::say;
use crate::router::Router;
use crate::server::{Server, prepare};
use crate::settings::{Overrides, Permission, Settings, check_client, client_name};
use clap::Parser;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::path::PathBuf;
use sun2xp::hand::find_configuration;
use sun2xp::realtime::is_ignored;
use sun2xp::{Configured, Hand};
use sun2xp_remote_protocol::{ClientName, NameError};

/// Offers the hand to planners on other machines. The table [serve] of the configuration file says where the server
/// listens and who may command the hand. The server ends at SIGINT, SIGTERM or SIGHUP: the fingers go to their
/// end state. With nohup it ignores SIGHUP.
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
    /// The configuration file. The default is the file that OpenHand would use.
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
    /// Make certificates in this folder, and exit. They are signed by the authority in the folder, or by a new one if
    /// the folder has none.
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["config", "listen", "name", "router"])]
    make_certificates: Option<PathBuf>,
    /// Make the certificate of the server of a hand, or of a router. Clients reach the server or router by this name,
    /// by an --address, or at loopback. Can be repeated.
    #[arg(long, value_name = "NAME", requires = "make_certificates")]
    server: Vec<String>,
    /// Another name or address by which clients reach the servers. Can be repeated.
    #[arg(long, value_name = "HOST", requires = "make_certificates")]
    address: Vec<String>,
    /// Make the certificate of a client with this name. Can be repeated.
    #[arg(long, value_name = "NAME", requires = "make_certificates")]
    client: Vec<String>,
}

/// Does what the arguments say. Returns when it is done, or after a signal.
///
/// # Errors
/// Returns the first error.
pub fn run(arguments: Arguments) -> Result<(), ServeError> {
    if let Some(folder) = arguments.make_certificates {
        let servers = names("--server", &arguments.server, server_name)?;
        let clients = names("--client", &arguments.client, client_name)?;
        for file in certificates::make(&folder, &Wanted { servers, addresses: arguments.address, clients })? {
            say(&file.display().to_string());
        }
        return Ok(());
    }
    // Signals are held from here on, so that a server that is just starting ends in an orderly way too.
    let signals = Signals::new(ending()).map_err(|error| ServeError::refused("wait for signals", &error))?;
    let mut configured = match &arguments.config {
        Some(file) => Configured::read(file)?,
        None => find_configuration()?,
    };
    let overrides = Overrides { name: arguments.name, listen: arguments.listen };
    let settings = Settings::read(configured.file.as_deref(), &overrides)?;
    if arguments.router {
        let router = Router::start(&settings)?;
        say(&format!("router at {}", listed(&settings)));
        wait(signals);
        router.end();
        return Ok(());
    }
    prepare(&mut configured.configuration, &settings.limits);
    let hand = Hand::open_as(configured.of_this_machine())?;
    announce(&settings);
    let server = Server::start(hand, settings)?;
    say("ready");
    wait(signals);
    server.end();
    Ok(())
}

/// The signals that end the server.
fn ending() -> Vec<i32> {
    // A terminal that closes sends SIGHUP. A person who starts the program with nohup wants it to stay.
    [SIGINT, SIGTERM].into_iter().chain((!is_ignored(SIGHUP)).then_some(SIGHUP)).collect()
}

/// Reads the names that were given with an option. clap does not read them itself, because its messages would show
/// control characters unescaped.
fn names(
    option: &'static str,
    texts: &[String],
    read: impl Fn(&str) -> Result<ClientName, String>,
) -> Result<Vec<ClientName>, ServeError> {
    let name = |text: &String| read(text).map_err(|reason| ServeError::argument(option, text, reason));
    texts.iter().map(name).collect()
}

/// Reads the name of a server. It may have the same characters as the name of a client.
///
/// # Errors
/// Returns the reason if this is not a name, or if [`check_client`] refuses it.
fn server_name(text: &str) -> Result<ClientName, String> {
    let name = text.parse::<ClientName>().map_err(|error| {
        let error = match error {
            NameError::Length { length, most, .. } => NameError::Length { what: "server", length, most },
            NameError::Character { character, allowed, .. } => {
                NameError::Character { what: "server", character, allowed }
            }
        };
        format!("{error}. Choose another name; host names and addresses with other characters are given with --address")
    })?;
    check_client(&name).map(|()| name)
}

fn wait(mut signals: Signals) {
    // The iterator does not end by itself, so `next` returns only when a signal has arrived.
    let _ = signals.forever().next();
}

fn listed(settings: &Settings) -> String {
    let endpoints: Vec<String> = settings.listen.iter().chain(&settings.connect).map(ToString::to_string).collect();
    endpoints.join(", ")
}

/// Says what is offered, and what is unsafe or useless about it.
fn announce(settings: &Settings) {
    say(&format!("hand `{}` at {}", settings.name, listed(settings)));
    let commanders = settings.clients.values().filter(|&&permission| permission == Permission::Command).count();
    if commanders == 0 {
        say("nobody may command the hand: list clients in [serve.clients], such as planner = \"command\"");
    }
    if settings.tls.is_none() {
        say("without TLS: every program on this machine can read the hand, and can take the name of any client: make \
             certificates with `sun2xp serve --make-certificates FOLDER --server NAME --client NAME`, name them in \
             [serve.tls], and use tls/HOST:PORT");
    }
}
