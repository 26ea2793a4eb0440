//! The server of an engine, in a process of its own.

use crate::link::Engine;
use crate::load::{Child, wait_for_end};
use crate::{Failure, stream, zenoh_link};
use std::io::{BufRead, BufReader};
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub struct Arguments {
    engine: Engine,
    /// Folder of the certificates.
    certificates: PathBuf,
}

/// Prints the port, then answers one client until standard input ends.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?;
    let port = listener.local_addr()?.port();
    let certificates = arguments.certificates.clone();
    let encrypted = arguments.engine.baseline() == Engine::Rustls;
    match arguments.engine {
        Engine::Tcp | Engine::Rustls => {
            println!("{port}");
            // When standard input ends, the new thread still waits for messages. The process does not wait for it.
            std::thread::spawn(move || {
                let served = if encrypted {
                    stream::serve_encrypted(&listener, &certificates)
                } else {
                    stream::serve_plain(&listener)
                };
                served.unwrap_or_else(|error| eprintln!("the server fails: {error}"));
            });
            wait_for_end();
        }
        Engine::ZenohTcp | Engine::ZenohTls => {
            // Zenoh does not report a port that the kernel chooses, so Zenoh gets the port that `listener` had.
            drop(listener);
            let _server = zenoh_link::serve(port, encrypted.then_some(certificates.as_path()))?;
            println!("{port}");
            wait_for_end();
        }
    }
    Ok(())
}

/// Starts the server of an engine. Returns the server's process and port. The server ends when the `Child` is dropped.
pub fn start(engine: Engine, certificates: &Path) -> Result<(Child, u16), Failure> {
    let name = clap::ValueEnum::to_possible_value(&engine).ok_or("the engine has no name")?;
    let mut child = Child::start(&[name.get_name().as_ref(), certificates.as_os_str()], "echo")?;
    let mut line = String::new();
    BufReader::new(child.output()?).read_line(&mut line)?;
    let port = line.trim().parse().map_err(|_| format!("the server of {} has not started", engine.name()))?;
    Ok((child, port))
}
