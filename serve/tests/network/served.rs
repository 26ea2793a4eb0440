//! The program `sun2xp-serve` with a simulated hand and its certificates. It runs at the left end of a [`Line`], which
//! connects two network namespaces.

use super::line::Line;
use super::observer::Observer;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use sun2xp_remote_client::RemoteConfiguration;
use tempfile::TempDir;

/// The program.
pub const PROGRAM: &str = env!("CARGO_BIN_EXE_sun2xp-serve");

/// `soft_stiffness` of the server: the Kx with which it holds a caught finger, N/cm.
pub const SOFT: f64 = 1.0;

/// A running server and its hand. Dropping this value ends the server.
pub struct Served {
    process: Child,
    folder: TempDir,
    name: String,
}

impl Served {
    /// Starts the server in the left namespace, and waits until it listens there. `catch_ms` is the longest validity of
    /// a Target, ms: when it ends without a new Target, the server catches the fingers (holds them softly).
    pub fn start(line: &Line, name: &str, catch_ms: u32) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let mut make = Command::new(PROGRAM);
        make.arg("--make-certificates").arg(folder.path()).args(["--server", "cell", "--address", Line::LEFT]);
        let made = make.args(["--client", "planner", "--client", "screen"]).output().expect("the program");
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        let name = format!("net-{}-{name}", std::process::id());
        let file = folder.path().join("sun2xp.toml");
        fs::write(&file, configuration(&name, catch_ms)).expect("a file");
        let process = line.left.run(|| started(&file));
        Self { process, folder, name }
    }

    /// The number of the process.
    pub fn process(&self) -> u32 {
        self.process.id()
    }

    /// Attaches to the hand's telemetry.
    pub fn observer(&self, line: &Line) -> Observer {
        line.left.run(|| Observer::attach(&self.name))
    }

    /// The configuration of a client at the right end of the line, as text.
    pub fn remote(&self, client: &str) -> String {
        let file = |name: String| self.folder.path().join(name).display().to_string();
        format!(
            "[remote]\nendpoint = \"tls/{}:7447\"\nhand = \"hand\"\ntake_over = true\n\
             [remote.tls]\nauthority = \"{}\"\ncertificate = \"{}\"\nkey = \"{}\"\n",
            Line::LEFT,
            file("ca.pem".into()),
            file(format!("{client}.pem")),
            file(format!("{client}.key")),
        )
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn configuration(name: &str, catch_ms: u32) -> String {
    format!(
        "[finger]\nport = \"simulated\"\n[telemetry]\nname = \"{name}\"\n\
         [serve]\nlisten = [\"tls/{}:7447\"]\nsoft_stiffness = {SOFT:.1}\ncatch_ms = {catch_ms}\n\
         [serve.clients]\nplanner = \"command\"\nscreen = \"read\"\n\
         [serve.tls]\nauthority = \"ca.pem\"\ncertificate = \"cell.pem\"\nkey = \"cell.key\"\n",
        Line::LEFT
    )
}

/// Starts a server with this file, and returns when it says that it is ready.
fn started(file: &Path) -> Child {
    let mut server = Command::new(PROGRAM);
    server.arg("--config").arg(file).stdin(Stdio::null()).stdout(Stdio::piped());
    let mut process = server.spawn().expect("the program");
    let output = process.stdout.take().expect("a pipe");
    let mut lines = BufReader::new(output).lines();
    let ready = lines.by_ref().map_while(Result::ok).any(|line| line == "ready");
    assert!(ready, "the server has ended: {:?}", process.wait());
    // A thread reads what the server prints later, so that the server never waits at a full pipe.
    std::thread::spawn(move || lines.for_each(drop));
    process
}

/// Reads a configuration that [`Served::remote`] has made.
pub fn remote(text: &str) -> RemoteConfiguration {
    let read = RemoteConfiguration::from_text(text, &PathBuf::new());
    read.unwrap_or_else(|error| panic!("{error}")).expect("the table [remote]")
}
