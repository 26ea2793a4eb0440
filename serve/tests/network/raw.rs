//! A client that sends what it likes: good messages, repeated ones and damaged ones. It uses the codec and Zenoh, and
//! none of the checks of the real clients.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use sun2xp_remote_protocol::{
    Action, Answer, ClientName, Finger, HandKeys, Part, Place, Request, State, Status, Target,
};
use zenoh::qos::CongestionControl;
use zenoh::{Config, Session, Wait};

/// Longest time in which a server answers.
const ANSWERS: Duration = Duration::from_secs(5);

/// The files of a client's certificate: authority, certificate and key.
pub type Files<'a> = [&'a Path; 3];

/// A connected client.
pub struct Raw {
    session: Session,
    keys: HandKeys,
    client: ClientName,
    seen: Arc<AtomicU64>,
    states: Arc<AtomicU64>,
    pub epoch: u64,
    pub sequence: u64,
    /// Number of good Targets that were sent.
    pub good: u64,
}

impl Raw {
    /// Connects to an endpoint.
    ///
    /// # Errors
    /// Returns an error if there is no connection, for example because the server refuses the certificate.
    pub fn connect(endpoint: &str, hand: &str, client: &str, files: Option<Files<'_>>) -> zenoh::Result<Self> {
        let mut config = Config::default();
        config.insert_json5("mode", "\"client\"")?;
        config.insert_json5("connect/endpoints", &format!("[\"{endpoint}\"]"))?;
        config.insert_json5("transport/unicast/open_timeout", "2000")?;
        for key in ["scouting/multicast/enabled", "scouting/gossip/enabled"] {
            config.insert_json5(key, "false")?;
        }
        if let Some([authority, certificate, key]) = files {
            let names = [
                ("root_ca_certificate", authority),
                ("connect_certificate", certificate),
                ("connect_private_key", key),
            ];
            for (name, path) in names {
                config.insert_json5(&format!("transport/link/tls/{name}"), &format!("\"{}\"", path.display()))?;
            }
            config.insert_json5("transport/link/tls/enable_mtls", "true")?;
        }
        let session = zenoh::open(config).wait()?;
        let keys = HandKeys::new(hand.parse().expect("a name"));
        let (seen, states) = (Arc::new(AtomicU64::new(0)), Arc::new(AtomicU64::new(0)));
        let (note, count) = (Arc::clone(&seen), Arc::clone(&states));
        let declared = session.declare_subscriber(keys.state()).callback(move |sample| {
            if let Ok(state) = State::decode(&sample.payload().to_bytes()) {
                note.fetch_max(state.time, Ordering::AcqRel);
                count.fetch_add(1, Ordering::AcqRel);
            }
        });
        declared.background().wait()?;
        Ok(Self {
            session,
            keys,
            client: client.parse().expect("a name"),
            seen,
            states,
            epoch: 0,
            sequence: 0,
            good: 0,
        })
    }

    /// Returns the number of States that have arrived.
    pub fn states(&self) -> u64 {
        self.states.load(Ordering::Acquire)
    }

    /// Sends a Request under the key of `client`. Returns none if nobody answers.
    pub fn ask_as(&self, client: &ClientName, request: Request) -> Option<Answer> {
        let payload = request.encode().expect("a good Request");
        let get = self.session.get(self.keys.request(request.action, client)).payload(payload).timeout(ANSWERS);
        let reply = get.wait().expect("the session is open").recv().ok()?;
        let answer = Answer::decode(&reply.result().ok()?.payload().to_bytes()).expect("a good Answer");
        self.seen.fetch_max(answer.time, Ordering::AcqRel);
        Some(answer)
    }

    /// Sends a Request with the epoch of this client, under its own key. Returns none if nobody answers.
    pub fn ask(&self, action: Action, finger: Option<Finger>) -> Option<Answer> {
        let request = Request { action, finger, take_over: false, recover: false, epoch: self.epoch };
        self.ask_as(&self.client, request)
    }

    /// Acquires the hand, and recovers its fingers.
    pub fn acquire(&mut self, take_over: bool) -> Option<Answer> {
        let request = Request { action: Action::Acquire, finger: None, take_over, recover: true, epoch: 0 };
        let answer = self.ask_as(&self.client, request)?;
        (self.epoch, self.sequence) = (answer.epoch, 0);
        Some(answer)
    }

    /// Returns the next good Target.
    pub fn target(&mut self, parts: Vec<Part>) -> Target {
        self.sequence += 1;
        Target {
            validity_ms: 100,
            epoch: self.epoch,
            sequence: self.sequence,
            sent: sun2xp::realtime::now(),
            seen: self.seen.load(Ordering::Acquire),
            parts,
        }
    }

    /// Sends bytes as a Target under the key of a client. Waits if the line is slow, so that nothing is dropped here.
    pub fn put_as(&self, client: &ClientName, payload: Vec<u8>) {
        let put = self.session.put(self.keys.target(client), payload);
        put.congestion_control(CongestionControl::Block).wait().expect("the session is open");
    }

    /// Sends bytes as a Target.
    pub fn put(&self, payload: Vec<u8>) {
        self.put_as(&self.client, payload);
    }

    /// Sends the next good Target.
    pub fn send(&mut self, parts: Vec<Part>) {
        let target = self.target(parts);
        self.put(target.encode().expect("a good Target"));
        self.good += 1;
    }

    /// Asks for the Status. Returns none if nobody answers.
    pub fn status(&self) -> Option<Status> {
        let get = self.session.get(self.keys.status()).timeout(ANSWERS);
        let reply = get.wait().expect("the session is open").recv().ok()?;
        Some(Status::decode(&reply.result().ok()?.payload().to_bytes()).expect("a good Status"))
    }

    /// Asks for the Status until `holds` returns true for it. If this client has acquired the hand, it sends a Target
    /// without parts before each question, so that its ownership does not end.
    pub fn until(&mut self, mut holds: impl FnMut(&Status) -> bool) -> Status {
        let deadline = Instant::now() + 2 * ANSWERS;
        loop {
            if self.epoch != 0 {
                self.send(Vec::new());
            }
            let status = self.status().expect("the server answers");
            if holds(&status) {
                return status;
            }
            assert!(Instant::now() < deadline, "{status:?}");
        }
    }
}

/// The part that brings a finger to joint angles, rad.
pub fn joints(finger: i32, command: u32, joints: [f64; 3]) -> Part {
    let finger = Finger::new(finger).expect("a finger");
    Part { finger, command, place: Place::Joints(joints), stiffness: None, damping: None }
}
