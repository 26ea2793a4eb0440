//! Several hands behind one router, and several readers of one hand.

use super::planner::{Motion, Planner};
use super::raw::Raw;
use super::security::{clients_of, loopback, simulated};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use sun2xp_remote_client::{FingerCommand, RemoteConfiguration, RemoteHand, discover, send_together};
use sun2xp_remote_protocol::{HandName, Target};
use sun2xp_serve::router::Router;
use sun2xp_serve::server::Server;
use sun2xp_serve::settings::{Overrides, Settings};
use zenoh::Wait;

/// Longest wait for a change that normally takes effect at once. The machine may be busy.
const HAPPENS: Duration = Duration::from_secs(20);

fn eventually(what: &str, mut holds: impl FnMut() -> bool) {
    let deadline = Instant::now() + HAPPENS;
    while !holds() {
        assert!(Instant::now() < deadline, "{what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// A hand that is a client of the router.
fn behind(router: &str, name: &str) -> Server {
    let text =
        format!("[serve]\nname = \"{name}\"\nconnect = [\"{router}\"]\n[serve.clients]\nplanner = \"command\"\n");
    let settings = Settings::from_text(&text, "sun2xp.toml".as_ref(), &Overrides::default());
    let (hand, _) = simulated(name, "", &loopback(), None);
    Server::start(hand, settings.expect("good settings")).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn two_hands_behind_a_router_get_targets_with_one_time_stamp() {
    let endpoint = loopback();
    let (names, text) = (["left", "right"], format!("[serve]\nlisten = [\"{endpoint}\"]\n"));
    let settings = Settings::from_text(&text, "router.toml".as_ref(), &Overrides::default()).expect("good settings");
    let router = Router::start(&settings).unwrap_or_else(|error| panic!("{error}"));
    let servers = names.map(|name| behind(&endpoint, name));
    let configuration =
        |name: &HandName| RemoteConfiguration::new(&endpoint, name.clone(), "planner".parse().expect("a name"));
    let names = names.map(|name| name.parse::<HandName>().expect("a name"));
    eventually("both hands are discovered", || {
        let found = discover(&configuration(&names[0])).expect("the router answers");
        names.iter().all(|name| found.iter().any(|hand| hand.name == *name))
    });

    // For each key, the time stamp of the first Target that contains a command and has passed the router.
    let seen: Arc<Mutex<BTreeMap<String, u64>>> = Arc::default();
    let mut config = zenoh::Config::default();
    config.insert_json5("mode", "\"client\"").expect("a key");
    config.insert_json5("connect/endpoints", &format!("[\"{endpoint}\"]")).expect("a key");
    config.insert_json5("scouting/multicast/enabled", "false").expect("a key");
    let spy = zenoh::open(config).wait().expect("connected");
    let notes = Arc::clone(&seen);
    let declared = spy.declare_subscriber("sun2xp/*/target/planner").callback(move |sample| {
        let target = Target::decode(&sample.payload().to_bytes()).expect("a good Target");
        if !target.parts.is_empty() {
            notes.lock().expect("a lock").entry(sample.key_expr().to_string()).or_insert(target.sent);
        }
    });
    declared.background().wait().expect("declared");

    let hands = names.each_ref().map(|name| RemoteHand::open(&configuration(name)).unwrap_or_else(|e| panic!("{e}")));
    let home = [1, 2, 3].map(|finger| FingerCommand::new(finger).joints([0.1, 0.7, 0.8]));
    send_together(&[(&hands[0], &home), (&hands[1], &home)]).unwrap_or_else(|error| panic!("{error}"));
    for server in &servers {
        eventually("the hand reaches the commanded pose", || {
            (1..=3).all(|finger| {
                let joints = server.hand().position(finger).expect("a finger");
                (0..3).all(|joint| (joints[joint] - [0.1, 0.7, 0.8][joint]).abs() < 0.05)
            })
        });
    }
    let sent: Vec<u64> = seen.lock().expect("a lock").values().copied().collect();
    assert!(sent.len() == 2 && sent[0] == sent[1], "{sent:?}");
    drop(hands);
    spy.close().wait().expect("closed");
    servers.into_iter().for_each(Server::end);
    router.end();
}

#[test]
fn a_reader_that_reads_nothing_slows_no_other() {
    let endpoint = loopback();
    let (hand, settings) = simulated("slow", &clients_of(&["planner"]), &endpoint, None);
    let server = Server::start(hand, settings).unwrap_or_else(|error| panic!("{error}"));
    let reader = Raw::connect(&endpoint, "hand", "reader", None).expect("connected");
    eventually("States arrive", || reader.states() > 10);
    // The slow planner connects and subscribes, and is then stopped. The buffers between it and the server fill up.
    let slow = Planner::start_here(
        &format!("[remote]\nendpoint = \"{endpoint}\"\nhand = \"hand\"\nclient = \"slow\"\n"),
        Motion::Watch,
    );
    slow.signal(libc::SIGSTOP);
    let stopped = Instant::now();
    let mut longest = Duration::ZERO;
    let (mut count, mut last) = (reader.states(), Instant::now());
    let begin = count;
    while stopped.elapsed() < Duration::from_secs(5) {
        std::thread::sleep(Duration::from_millis(1));
        if reader.states() > count {
            longest = longest.max(last.elapsed());
            (count, last) = (reader.states(), Instant::now());
        }
    }
    // The server sends a State at least every 10 ms, which makes 500 in 5 s.
    assert!(count - begin > 400, "{} States in 5 s", count - begin);
    assert!(longest < Duration::from_millis(200), "no State for {longest:?}");
    drop(slow);
    server.end();
}
