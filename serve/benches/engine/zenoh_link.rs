//! Messages over Zenoh: the client puts a message under one key, and the server puts it back under another.

use crate::Failure;
use crate::certificates::Files;
use crate::link::{ABSORB, ANSWER, Link, Sending};
use std::path::Path;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};
use zenoh::pubsub::Publisher;
use zenoh::qos::{CongestionControl, Priority};
use zenoh::{Config, Session, Wait};

/// The keys under which the client and the server publish.
const THERE: &str = "engine/there";
const BACK: &str = "engine/back";

/// Longest wait for an answer.
const PATIENCE: Duration = Duration::from_secs(60);

/// The server's session, which answers as long as it lives.
pub struct Server {
    _session: Session,
}

/// Listens at a port of this machine. With `certificates`, the connection is encrypted, and both sides have
/// certificates.
pub fn serve(port: u16, certificates: Option<&Path>) -> Result<Server, Failure> {
    let session = zenoh::open(configuration("router", "listen", port, certificates)?).wait()?;
    let back = publisher(&session, BACK, true)?;
    session
        .declare_subscriber(THERE)
        .callback(move |sample| {
            if sample.payload().to_bytes().first() == Some(&ANSWER) {
                // The put fails only while the session is closing. Nobody waits for the answer then.
                let _ = back.put(sample.payload().clone()).wait();
            }
        })
        .background()
        .wait()?;
    Ok(Server { _session: session })
}

/// Connects to the server at a port of this machine.
pub fn connect(port: u16, certificates: Option<&Path>) -> Result<Client, Failure> {
    let session = zenoh::open(configuration("client", "connect", port, certificates)?).wait()?;
    let (sender, answers) = channel();
    session
        .declare_subscriber(BACK)
        .callback(move |_| {
            // Nobody waits for an answer after the client has gone.
            let _ = sender.send(());
        })
        .background()
        .wait()?;
    let [at_once, together] = [true, false].map(|express| publisher(&session, THERE, express));
    let mut client = Client { at_once: at_once?, together: together?, answers, _session: session };
    client.wait_for_route()?;
    Ok(client)
}

/// Returns a publisher that drops no message. With `express`, it sends each message at once.
fn publisher(session: &Session, key: &'static str, express: bool) -> Result<Publisher<'static>, Failure> {
    session
        .declare_publisher(key)
        .priority(Priority::RealTime)
        .congestion_control(CongestionControl::Block)
        .express(express)
        .wait()
}

/// Returns the configuration of a session without discovery.
fn configuration(mode: &str, side: &str, port: u16, certificates: Option<&Path>) -> Result<Config, Failure> {
    let protocol = if certificates.is_some() { "tls" } else { "tcp" };
    let mut configuration = Config::from_json5(&format!(
        r#"{{
            mode: "{mode}",
            {side}: {{ endpoints: ["{protocol}/127.0.0.1:{port}"] }},
            scouting: {{ multicast: {{ enabled: false }}, gossip: {{ enabled: false }} }},
        }}"#
    ))?;
    if let Some(folder) = certificates {
        let files = Files::of(folder, if side == "listen" { "server" } else { "client" });
        let mut set = |key: &str, value: &Path| {
            configuration
                .insert_json5(&format!("transport/link/tls/{key}"), &format!("{:?}", value.display().to_string()))
        };
        set("root_ca_certificate", &files.authority)?;
        set(&format!("{side}_certificate"), &files.certificate)?;
        set(&format!("{side}_private_key"), &files.key)?;
        configuration.insert_json5("transport/link/tls/enable_mtls", "true")?;
    }
    Ok(configuration)
}

/// The client's session.
pub struct Client {
    at_once: Publisher<'static>,
    together: Publisher<'static>,
    answers: Receiver<()>,
    _session: Session,
}

impl Client {
    /// Sends messages until one comes back. Before the sides know of each other's subscribers, messages go nowhere.
    fn wait_for_route(&mut self) -> Result<(), Failure> {
        let begin = Instant::now();
        while begin.elapsed() < PATIENCE {
            self.at_once.put(vec![ANSWER]).wait()?;
            if self.answers.recv_timeout(Duration::from_millis(100)).is_ok() {
                // A late answer to one of these messages must not be taken for the answer to a later message.
                while self.answers.recv_timeout(Duration::from_millis(300)).is_ok() {}
                return Ok(());
            }
        }
        Err("the server does not answer".into())
    }

    fn wait(&self) -> Result<(), Failure> {
        self.answers.recv_timeout(PATIENCE).map_err(|_| "an answer is missing".into())
    }
}

impl Link for Client {
    fn round_trip(&mut self, message: &[u8]) -> Result<(), Failure> {
        self.at_once.put(message).wait()?;
        self.wait()
    }

    fn flood(&mut self, message: &[u8], count: u64, sending: Sending) -> Result<(), Failure> {
        let mut absorbed = message.to_vec();
        absorbed[0] = ABSORB;
        let publisher = if sending == Sending::AtOnce { &self.at_once } else { &self.together };
        for _ in 1..count {
            publisher.put(absorbed.as_slice()).wait()?;
        }
        publisher.put(message).wait()?;
        self.wait()
    }
}
