//! Ports of the loopback interface for the servers of tests.

use std::net::{TcpListener, TcpStream};

/// Returns a port at which nobody listens, and which for a minute goes only to a server that asks for it by its number.
///
/// If a port was only found to be free, the system may give it to another test, or to an outgoing connection, a moment
/// later. Therefore a connection to the port is made here, and its server closes it first. This leaves the port in the
/// state TIME_WAIT. The system does not choose a port in this state. Servers bind with SO_REUSEADDR, so they can use
/// it.
pub fn free_port() -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = listener.local_addr().expect("an address");
    let client = TcpStream::connect(address).expect("a connection");
    let (served, _) = listener.accept().expect("the connection");
    drop(served);
    drop(client);
    address.port()
}
