//! Measures how long a call of `send_position` takes, and how long it takes until the server has the Target. Both ends
//! are in this process, so they have one clock.

use crate::server::{FakeServer, configuration, free_port};
use std::time::{Duration, Instant};
use sun2xp_remote_client::RemoteHand;
use sun2xp_remote_protocol::Place;

fn show(what: &str, mut times: Vec<Duration>) {
    times.sort();
    let at = |part: f64| times[((times.len() - 1) as f64 * part) as usize];
    let (half, most, nearly_all) = (at(0.5), at(0.99), at(0.999));
    println!("{what}: 50 % {half:?}, 99 % {most:?}, 99.9 % {nearly_all:?}, longest {:?}", at(1.0));
}

#[test]
#[ignore = "it measures: cargo test -p sun2xp-remote-client --test over_zenoh latency -- --ignored --nocapture"]
fn time_of_a_call_and_time_until_the_server_has_the_target() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let hand = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
    let (mut calls, mut arrivals) = (Vec::new(), Vec::new());
    for step in 0..5000 {
        let joints = [f64::from(step) * 1e-4, 0.5, 0.5];
        let begin = Instant::now();
        hand.send_position(1, joints).expect("sent");
        calls.push(begin.elapsed());
        server.hand().wait_until("the Target", |hand| {
            let newest = hand.targets.last().and_then(|target| target.parts.first());
            newest.is_some_and(|part| part.place == Place::Joints(joints))
        });
        arrivals.push(begin.elapsed());
        std::thread::sleep(Duration::from_millis(1));
    }
    show("call of send_position", calls);
    let (sent, received) = (hand.statistics().targets, server.hand().lock().targets.len());
    println!("{sent} Targets sent, {received} received");
    show("until the server has decoded the Target", arrivals);
}
