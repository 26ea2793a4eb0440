//! A small server of the protocol over Zenoh on loopback, with fingers that reach every commanded position at
//! once.

#[path = "../../../../tests/common/free_port.rs"]
mod free_port;

pub use free_port::free_port;

use crate::fake_hand::FakeHand;
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use sun2xp_remote_client::{HandName, RemoteConfiguration, Stage};
use sun2xp_remote_protocol::{Action, HandKeys, Target};
use zenoh::{Config, Session, Wait};

/// How long a test waits for what must happen. The machine may be busy.
pub const LIMIT: Duration = Duration::from_secs(20);

/// The configuration of a client that connects to this port. The machine may be busy, so a position counts as stale
/// only after 5 s.
pub fn configuration(port: u16, hand: &str, client: &str) -> RemoteConfiguration {
    let (hand, client) = (hand.parse().expect("a name"), client.parse().expect("a name"));
    let mut configuration = RemoteConfiguration::new(&format!("tcp/127.0.0.1:{port}"), hand, client);
    configuration.stale_ms = 5000;
    configuration
}

pub struct FakeServer {
    session: Session,
    hands: Vec<Arc<Watched>>,
    publisher: Option<JoinHandle<()>>,
}

/// A hand whose changes can be waited for.
pub struct Watched {
    hand: Mutex<FakeHand>,
    changed: Condvar,
    keys: HandKeys,
}

impl Watched {
    pub fn lock(&self) -> MutexGuard<'_, FakeHand> {
        self.hand.lock().expect("no test panics while it holds the lock")
    }

    /// Waits until `holds` is true of the hand. `what` names what is waited for.
    pub fn wait_until(&self, what: &str, mut holds: impl FnMut(&mut FakeHand) -> bool) {
        let (_hand, waited) =
            self.changed.wait_timeout_while(self.lock(), LIMIT, |hand| !holds(hand)).expect("no test panics");
        assert!(!waited.timed_out(), "not within {LIMIT:?}: {what}");
    }

    /// Waits until `holds` is true of a Target, and returns this Target.
    pub fn wait_for_target(&self, what: &str, holds: impl Fn(&Target) -> bool) -> Target {
        let mut found = None;
        self.wait_until(what, |hand| {
            found = hand.targets.iter().find(|target| holds(target)).cloned();
            found.is_some()
        });
        found.expect("it was found")
    }
}

impl FakeServer {
    /// Starts a server of hands with these names.
    pub fn start(port: u16, names: &[&str]) -> Self {
        let mut config = Config::default();
        for (key, value) in [
            ("mode", "\"router\"".to_string()),
            ("listen/endpoints", format!("[\"tcp/127.0.0.1:{port}\"]")),
            ("connect/endpoints", "[]".into()),
            ("scouting/delay", "0".into()),
            ("scouting/multicast/enabled", "false".into()),
            ("scouting/gossip/enabled", "false".into()),
        ] {
            config.insert_json5(key, &value).expect("a key of Zenoh");
        }
        let session = zenoh::open(config).wait().expect("the server listens");
        let hands: Vec<_> = names.iter().map(|name| serve(&session, name)).collect();
        let (put, published) = (session.clone(), hands.clone());
        let publisher = std::thread::spawn(move || {
            let mut number = 0;
            while published.iter().all(|hand| !hand.lock().ended) {
                number += 1;
                published.iter().for_each(|hand| publish(&put, hand, number));
                std::thread::sleep(Duration::from_millis(5));
            }
        });
        Self { session, hands, publisher: Some(publisher) }
    }

    pub fn hand(&self) -> &Arc<Watched> {
        &self.hands[0]
    }

    pub fn hands(&self) -> &[Arc<Watched>] {
        &self.hands
    }
}

impl Drop for FakeServer {
    fn drop(&mut self) {
        self.hands.iter().for_each(|hand| hand.lock().ended = true);
        if let Some(publisher) = self.publisher.take() {
            let _ = publisher.join();
        }
        let _ = self.session.close().wait();
    }
}

fn publish(session: &Session, hand: &Watched, number: u64) {
    let (state, event) = {
        let mut hand = hand.lock();
        if hand.silent {
            return;
        }
        if hand.late_states > 0 && hand.stage == Stage::Running {
            hand.late_states -= 1;
            return;
        }
        (hand.state(number).encode().expect("a good State"), hand.events.pop())
    };
    session.put(hand.keys.state(), state).wait().expect("put");
    if let Some(event) = event {
        session.put(hand.keys.events(), event.encode().expect("a good Event")).wait().expect("put");
    }
}

fn serve(session: &Session, name: &str) -> Arc<Watched> {
    let name: HandName = name.parse().expect("a name");
    let keys = HandKeys::new(name);
    let watched = Arc::new(Watched { hand: Mutex::new(FakeHand::new()), changed: Condvar::new(), keys: keys.clone() });
    let hand = watched.clone();
    let take = move |sample: zenoh::sample::Sample| {
        let target = Target::decode(&sample.payload().to_bytes()).expect("a good Target");
        let refusal = hand.lock().take(target);
        hand.changed.notify_all();
        if let Some(answer) = refusal {
            let client = hand.keys.client_of_target(sample.key_expr()).expect("a client");
            let session = hand.lock().session.clone().expect("a session");
            session.put(hand.keys.refused(&client), answer.encode().expect("a good Answer")).wait().expect("put");
        }
    };
    watched.lock().session = Some(session.clone());
    session.declare_subscriber(keys.every_target()).callback(take).background().wait().expect("subscribed");
    for action in Action::ALL {
        let hand = watched.clone();
        let answer = move |query: zenoh::query::Query| {
            let client = hand.keys.client_of_request(action, query.key_expr()).expect("a client");
            let payload = query.payload().expect("a payload").to_bytes().into_owned();
            let mut locked = hand.lock();
            if locked.unanswered > 0 {
                locked.unanswered -= 1;
                let after = locked.unanswered_after;
                // The threads of Zenoh must not wait.
                std::thread::spawn(move || {
                    std::thread::sleep(after);
                    drop(query);
                });
                return;
            }
            let answer = locked.answer(&client, &payload);
            drop(locked);
            hand.changed.notify_all();
            query.reply(query.key_expr().clone(), answer).wait().expect("a reply");
        };
        session.declare_queryable(keys.every_request(action)).callback(answer).background().wait().expect("declared");
    }
    let hand = watched.clone();
    let status = move |query: zenoh::query::Query| {
        let mut locked = hand.lock();
        if locked.unanswered_status > 0 {
            locked.unanswered_status -= 1;
            return;
        }
        let status = locked.status_payload();
        drop(locked);
        query.reply(hand.keys.status(), status).wait().expect("a reply");
    };
    session.declare_queryable(keys.status()).callback(status).background().wait().expect("declared");
    watched
}

/// Repeats `call` until `holds` is true of its result, and returns this result.
pub fn until<T>(what: &str, mut call: impl FnMut() -> T, holds: impl Fn(&T) -> bool) -> T {
    let begin = Instant::now();
    loop {
        let result = call();
        if holds(&result) {
            return result;
        }
        assert!(begin.elapsed() < LIMIT, "not within {LIMIT:?}: {what}");
        std::thread::sleep(Duration::from_millis(1));
    }
}
