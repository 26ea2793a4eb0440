//! Messages of one length over a stream: plain TCP, and TCP with rustls. The caller itself waits on the socket, so no
//! time is lost between threads.

use crate::certificates::Files;
use crate::link::{ABSORB, ANSWER, Link, Sending};
use crate::{Failure, LENGTH};
use rustls::pki_types::pem::PemObject;
use rustls::pki_types::{CertificateDer, PrivateKeyDer, ServerName};
use rustls::server::WebPkiClientVerifier;
use rustls::{ClientConfig, ClientConnection, RootCertStore, ServerConfig, ServerConnection, StreamOwned};
use std::io::{BufReader, ErrorKind, Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::Path;
use std::sync::Arc;

/// Bytes that are collected before they are sent together: as many as in a batch of Zenoh.
const BATCH: usize = 65_535;

/// Connects without encryption.
pub fn connect_plain(port: u16) -> Result<Stream<TcpStream>, Failure> {
    Ok(Stream(BufReader::new(connect(port)?)))
}

/// Connects with TLS 1.3, and with certificates on both sides.
pub fn connect_encrypted(
    port: u16,
    certificates: &Path,
) -> Result<Stream<StreamOwned<ClientConnection, TcpStream>>, Failure> {
    let files = Files::of(certificates, "client");
    let configuration = ClientConfig::builder_with_protocol_versions(&[&rustls::version::TLS13])
        .with_root_certificates(authority(&files)?)
        .with_client_auth_cert(chain(&files)?, PrivateKeyDer::from_pem_file(&files.key)?)?;
    let name = ServerName::from(std::net::IpAddr::from(Ipv4Addr::LOCALHOST));
    let connection = ClientConnection::new(Arc::new(configuration), name)?;
    Ok(Stream(BufReader::new(StreamOwned::new(connection, connect(port)?))))
}

/// Accepts one connection without encryption and answers its messages.
pub fn serve_plain(listener: &TcpListener) -> Result<(), Failure> {
    let (socket, _) = listener.accept()?;
    socket.set_nodelay(true)?;
    answer(BufReader::new(socket))
}

/// Accepts one encrypted connection and answers its messages.
pub fn serve_encrypted(listener: &TcpListener, certificates: &Path) -> Result<(), Failure> {
    let files = Files::of(certificates, "server");
    let verifier = WebPkiClientVerifier::builder(Arc::new(authority(&files)?)).build()?;
    let configuration = ServerConfig::builder_with_protocol_versions(&[&rustls::version::TLS13])
        .with_client_cert_verifier(verifier)
        .with_single_cert(chain(&files)?, PrivateKeyDer::from_pem_file(&files.key)?)?;
    let connection = ServerConnection::new(Arc::new(configuration))?;
    let (socket, _) = listener.accept()?;
    socket.set_nodelay(true)?;
    answer(BufReader::new(StreamOwned::new(connection, socket)))
}

fn connect(port: u16) -> Result<TcpStream, Failure> {
    let socket = TcpStream::connect((Ipv4Addr::LOCALHOST, port))?;
    // Without this, the kernel holds a message back until the one before it is acknowledged.
    socket.set_nodelay(true)?;
    Ok(socket)
}

fn authority(files: &Files) -> Result<RootCertStore, Failure> {
    let mut authorities = RootCertStore::empty();
    authorities.add(CertificateDer::from_pem_file(&files.authority)?)?;
    Ok(authorities)
}

fn chain(files: &Files) -> Result<Vec<CertificateDer<'static>>, Failure> {
    Ok(vec![CertificateDer::from_pem_file(&files.certificate)?])
}

/// Sends back every message that asks for an answer, until the client closes the connection.
fn answer(mut stream: BufReader<impl Read + Write>) -> Result<(), Failure> {
    let mut message = [0; LENGTH];
    loop {
        match stream.read_exact(&mut message) {
            Ok(()) if message[0] == ANSWER => {
                stream.get_mut().write_all(&message)?;
                stream.get_mut().flush()?;
            }
            Ok(()) => {}
            Err(error) if [ErrorKind::UnexpectedEof, ErrorKind::ConnectionReset].contains(&error.kind()) => {
                return Ok(());
            }
            Err(error) => return Err(error.into()),
        }
    }
}

/// The client's end of a stream.
pub struct Stream<S>(BufReader<S>);

impl<S: Read + Write> Link for Stream<S> {
    fn round_trip(&mut self, message: &[u8]) -> Result<(), Failure> {
        self.0.get_mut().write_all(message)?;
        self.0.get_mut().flush()?;
        let mut answer = [0; LENGTH];
        self.0.read_exact(&mut answer)?;
        Ok(())
    }

    fn flood(&mut self, message: &[u8], count: u64, sending: Sending) -> Result<(), Failure> {
        let mut absorbed = message.to_vec();
        absorbed[0] = ABSORB;
        let batch = absorbed.repeat(if sending == Sending::AtOnce { 1 } else { BATCH / LENGTH });
        let mut left = (count.saturating_sub(1)) as usize * LENGTH;
        while left > 0 {
            let part = left.min(batch.len());
            self.0.get_mut().write_all(&batch[..part])?;
            left -= part;
        }
        self.round_trip(message)
    }
}
