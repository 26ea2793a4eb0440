//! The server of the web page of `sun2xp monitor --web` and `sun2xp jog --web`. By default it serves only browsers on
//! this machine. Browsers need a token if other machines can reach the page, or if the page may move the hand.
//!
//! A thread reads the hand and publishes messages to the pages. The thread does not wait for the pages.

mod access;
mod control;
mod feed;
mod files;
mod hub;
mod listener;
mod message;
mod place;
mod server;
mod session;
mod translation;

pub use control::Control;

use crate::failure::Failure;
use crate::monitor::source::Wanted;
use access::Access;
use hub::Hub;
use server::Server;
use std::io::{self, Write};
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener, UdpSocket};
use std::sync::Arc;
use std::thread;
use sun2xp::realtime::with_remedy;

/// An address that is reserved for documentation, so that no host has it.
const DISTANT: (Ipv4Addr, u16) = (Ipv4Addr::new(192, 0, 2, 1), 9);

/// Where the page is served.
#[derive(clap::Args, Clone, Debug)]
pub struct Address {
    /// Port of the page. By default the system chooses a free one.
    #[arg(long, value_name = "PORT", default_value_t = 0, requires = "web")]
    port: u16,
    /// Serve the page at this address of the machine, or at 0.0.0.0 for all of them. The printed address of the page
    /// then contains a token, without which nobody gets data. The connection is not encrypted.
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST), requires = "web")]
    bind: IpAddr,
}

/// Reserves the address of the page. Browsers that connect wait for [`serve`].
///
/// # Errors
/// Returns an error if the address cannot be used.
pub fn listen(address: &Address) -> Result<TcpListener, Failure> {
    let at = SocketAddr::new(address.bind, address.port);
    TcpListener::bind(at)
        .map_err(|error| format!("cannot serve at {at}: {error}. Choose another --port or --bind").into())
}

/// Serves the page until SIGINT, SIGTERM, SIGHUP or SIGQUIT. Prints its address. With a `control`, pages may move the
/// hand, and they need the token on loopback too.
///
/// # Errors
/// Returns an error if the page cannot be served.
pub fn serve(listener: TcpListener, wanted: Wanted, control: Option<Control>) -> Result<(), Failure> {
    let bound = listener.local_addr()?;
    let secret = control.is_some() || !bound.ip().is_loopback();
    let token = if secret { Some(access::new_token().map_err(io::Error::other)?) } else { None };
    writeln!(io::stdout(), "{}", url(bound, token.as_deref()))?;
    let hub = Arc::new(Hub::new());
    let (its_hub, may_control) = (Arc::clone(&hub), control.is_some());
    let failed = |error: io::Error| format!("cannot serve the page at {bound}: {}", with_remedy(&error));
    let reading = thread::Builder::new().name("sun2xp feed".into());
    reading.spawn(move || feed::run(&wanted, may_control, &its_hub)).map_err(failed)?;
    let access = Arc::new(Access { address: bound, token, machine: access::machine() });
    let server = Server { access, hub, control: control.map(Arc::new) };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().map_err(failed)?;
    Ok(runtime.block_on(server.run(listener)).map_err(failed)?)
}

/// Returns the address of the page. Browsers do not send the part after # to a server, so the token is in no log.
fn url(bound: SocketAddr, token: Option<&str>) -> String {
    let host = match bound.ip() {
        ip if ip.is_unspecified() => own_address().or_else(access::machine).unwrap_or_else(|| "localhost".into()),
        IpAddr::V4(ip) => ip.to_string(),
        IpAddr::V6(ip) => format!("[{ip}]"),
    };
    let token = token.map(|token| format!("#token={token}")).unwrap_or_default();
    format!("http://{host}:{}/{token}", bound.port())
}

/// Returns the address at which other machines reach this machine: the source address that a datagram to a distant
/// network would have. No datagram is sent.
fn own_address() -> Option<String> {
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).ok()?;
    socket.connect(DISTANT).ok()?;
    Some(socket.local_addr().ok()?.ip().to_string())
}
