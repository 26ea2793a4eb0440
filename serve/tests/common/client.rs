//! A client that uses only zenoh and the codec.

use super::{PATIENCE, wait_for};
use std::path::Path;
use std::sync::{Arc, Mutex};
use sun2xp_remote_protocol::{
    Action, Answer, ClientName, Code, Event, Finger, HandKeys, Part, Place, Request, State, Status, Target,
};
use zenoh::{Session, Wait};

/// The TLS files of a client, in `folder`: the authority's certificate is the file `authority`. The client's
/// certificate and key are `name`.pem and `name`.key.
#[derive(Clone, Copy)]
pub struct Certificate<'a> {
    pub folder: &'a Path,
    pub authority: &'a str,
    pub name: &'a str,
}

#[derive(Default)]
struct Received {
    seen: u64,
    states: Vec<State>,
    refusals: Vec<Answer>,
    events: Vec<Event>,
}

/// A client.
pub struct Client {
    pub session: Session,
    pub keys: HandKeys,
    pub name: ClientName,
    pub epoch: u64,
    pub sequence: u64,
    received: Arc<Mutex<Received>>,
}

/// A request for every finger.
pub fn request(action: Action) -> Request {
    Request { action, finger: None, take_over: false, recover: false, epoch: 0 }
}

/// A part that moves finger 1 to these joint angles, rad.
pub fn part(command: u32, joints: [f64; 3]) -> Part {
    Part { finger: finger(1), command, place: Place::Joints(joints), stiffness: None, damping: None }
}

pub fn finger(number: i32) -> Finger {
    Finger::new(number).expect("a finger")
}

impl Client {
    /// Connects to the hand `hand`, with TLS if there is a certificate.
    pub fn connect(endpoint: &str, name: &str, tls: Option<Certificate>) -> Result<Self, String> {
        Self::connect_to(endpoint, "hand", name, tls)
    }

    /// Connects to a hand.
    pub fn connect_to(endpoint: &str, hand: &str, name: &str, tls: Option<Certificate>) -> Result<Self, String> {
        let mut config = zenoh::Config::default();
        let mut set = |key: &str, value: String| config.insert_json5(key, &value).unwrap_or_else(|e| panic!("{e}"));
        set("mode", "\"client\"".into());
        set("connect/endpoints", format!("[\"{endpoint}\"]"));
        set("connect/timeout_ms", "2000".into());
        set("scouting/multicast/enabled", "false".into());
        if let Some(Certificate { folder, authority, name }) = tls {
            let file = |name: &str| format!("{:?}", folder.join(name).display().to_string());
            set(
                "transport/link/tls",
                format!(
                    r#"{{"root_ca_certificate":{},"enable_mtls":true,
                        "connect_certificate":{},"connect_private_key":{}}}"#,
                    file(authority),
                    file(&format!("{name}.pem")),
                    file(&format!("{name}.key"))
                ),
            );
        }
        let session = zenoh::open(config).wait().map_err(|error| error.to_string())?;
        let keys = HandKeys::new(hand.parse().expect("a name"));
        let name: ClientName = name.parse().expect("a name");
        let received = Arc::<Mutex<Received>>::default();
        let of_states = received.clone();
        let on_state = move |sample: zenoh::sample::Sample| {
            let state = State::decode(&sample.payload().to_bytes()).expect("a State");
            let received = &mut *of_states.lock().expect("received");
            received.seen = received.seen.max(state.time);
            received.states.push(state);
        };
        session.declare_subscriber(keys.state()).callback(on_state).background().wait().expect("subscribed");
        let of_events = received.clone();
        let on_event = move |sample: zenoh::sample::Sample| {
            let event = Event::decode(&sample.payload().to_bytes()).expect("an Event");
            of_events.lock().expect("received").events.push(event);
        };
        session.declare_subscriber(keys.events()).callback(on_event).background().wait().expect("subscribed");
        let of_refusals = received.clone();
        let on_refusal = move |sample: zenoh::sample::Sample| {
            let answer = Answer::decode(&sample.payload().to_bytes()).expect("an Answer");
            of_refusals.lock().expect("received").refusals.push(answer);
        };
        session.declare_subscriber(keys.refused(&name)).callback(on_refusal).background().wait().expect("subscribed");
        Ok(Self { session, keys, name, epoch: 0, sequence: 0, received })
    }

    /// The newest State.
    pub fn state(&self) -> Option<State> {
        self.received.lock().expect("received").states.last().cloned()
    }

    /// All States so far.
    pub fn states(&self) -> Vec<State> {
        self.received.lock().expect("received").states.clone()
    }

    /// All Events so far.
    pub fn events(&self) -> Vec<Event> {
        self.received.lock().expect("received").events.clone()
    }

    /// The newest refusal of a Target.
    pub fn refusal(&self) -> Option<Answer> {
        self.received.lock().expect("received").refusals.last().cloned()
    }

    pub fn seen(&self) -> u64 {
        self.received.lock().expect("received").seen
    }

    /// Sends a Request under this key. Returns none if there is no answer.
    pub fn ask(&self, key: &str, payload: Vec<u8>) -> Option<Answer> {
        let replies = self.session.get(key).payload(payload).timeout(PATIENCE).wait().expect("asked");
        let reply = replies.recv().ok()?;
        let answer = Answer::decode(&reply.result().ok()?.payload().to_bytes()).expect("an Answer");
        let received = &mut *self.received.lock().expect("received");
        received.seen = received.seen.max(answer.time);
        Some(answer)
    }

    /// Sends a Request, and expects an answer.
    pub fn request(&self, request: Request) -> Answer {
        let key = self.keys.request(request.action, &self.name);
        self.ask(&key, request.encode().expect("a Request")).expect("an answer")
    }

    /// Acquires the hand, and recovers it.
    pub fn acquire(&mut self) -> Answer {
        self.acquire_with(Request { recover: true, ..request(Action::Acquire) })
    }

    pub fn acquire_with(&mut self, request: Request) -> Answer {
        let answer = self.request(request);
        if answer.code == Code::Done {
            self.epoch = answer.epoch;
        }
        answer
    }

    /// A Target with the next sequence number.
    pub fn target(&mut self, parts: Vec<Part>) -> Target {
        self.sequence += 1;
        let (epoch, sequence, seen) = (self.epoch, self.sequence, self.seen());
        Target { validity_ms: 100, epoch, sequence, sent: sequence, seen, parts }
    }

    /// Publishes a Target.
    pub fn publish(&self, target: &Target) {
        self.publish_under(&self.keys.target(&self.name), target.encode().expect("a Target"));
    }

    pub fn publish_under(&self, key: &str, payload: Vec<u8>) {
        self.session.put(key, payload).wait().expect("published");
    }

    /// Publishes a Target with these parts.
    pub fn send(&mut self, parts: Vec<Part>) {
        let target = self.target(parts);
        self.publish(&target);
    }

    /// Repeats a Target with these parts until `found` returns something.
    pub fn repeat_until<T>(&mut self, parts: &[Part], what: &str, mut found: impl FnMut(&Self) -> Option<T>) -> T {
        wait_for(what, || {
            self.send(parts.to_vec());
            std::thread::sleep(std::time::Duration::from_millis(8));
            found(self)
        })
    }

    /// Asks for the Status.
    pub fn status(&self) -> Option<Status> {
        let replies = self.session.get(self.keys.status()).timeout(PATIENCE).wait().expect("asked");
        let reply = replies.recv().ok()?;
        Some(Status::decode(&reply.result().ok()?.payload().to_bytes()).expect("a Status"))
    }
}
