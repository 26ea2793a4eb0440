//! A page that does not keep up loses batches. Other pages get every batch.

use super::control;
use super::messages::{batch, message};
use super::program::{Program, hand};
use super::socket::Socket;
use serde_json::Value;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Largest number of batches that the server sends to a page beyond those that the page has acknowledged.
const AHEAD: usize = 20;

#[test]
fn a_page_that_does_not_acknowledge_gets_the_batches_of_one_second_and_then_waits() {
    let (hand, name) = hand(|_| {});
    let program = Program::monitor(&name);
    let open = || Socket::open(program.address(), "/stream", &[]).expect("a socket");
    let (mut slow, mut quick) = (open(), open());
    let first = (0..AHEAD).map(|_| batch(&mut slow, false)).last().expect("a batch");
    // The quick page reads more batches than the server keeps for a page that is behind.
    let mut numbers = Vec::new();
    while numbers.len() < 100 {
        numbers.push(batch(&mut quick, true)["number"].as_u64().expect("a number"));
    }
    assert!(numbers.windows(2).all(|pair| pair[1] == pair[0] + 1), "the quick page gets every batch: {numbers:?}");
    slow.send(r#"{"received":1}"#);
    let next = batch(&mut slow, false);
    let number = |batch: &Value| batch["number"].as_u64().expect("a number");
    assert!(number(&next) > number(&first) + 50, "batches are left out: {first} {next}");
    let cycles = |batch: &Value, place: usize| batch["cycles"][place].as_u64().expect("a count");
    let skipped = cycles(&next, 1) - cycles(&next, 0) - cycles(&first, 1);
    assert!(skipped > 3000, "the page can count the cycles that it has not got: {skipped}");
    hand.close();
    while message(&mut quick)["type"] != "gone" {}
}

/// The page acknowledges batches and reads none, until the server cannot write any more. A server that reads only after
/// it has written would disconnect the page ten seconds later, without having read the stop.
#[test]
fn a_stop_is_carried_out_while_the_page_takes_no_message() {
    let (program, _folder) = control::jog(&["--control"]);
    let mut full = control::open(&program);
    batch(&mut full, true);
    full.narrow();
    let (mut unread, mut since) = (0, Instant::now());
    while since.elapsed() < Duration::from_secs(1) {
        full.send(r#"{"received":1}"#);
        sleep(Duration::from_millis(10));
        let now = full.unread();
        if now != unread {
            (unread, since) = (now, Instant::now());
        }
    }
    full.send(r#"{"command":"stop"}"#);
    let mut page = control::open(&program);
    let begun = Instant::now();
    loop {
        assert!(begun.elapsed() < Duration::from_secs(60), "no stop");
        let message = message(&mut page);
        match message["type"].as_str() {
            Some("state") if message["finger"] == 1 && !message["fault"].is_null() => break,
            Some("batch") => page.send(r#"{"received":1}"#),
            _ => {}
        }
    }
}

#[test]
fn a_page_that_opens_later_gets_the_hand_its_state_and_its_events() {
    let (_hand, name) = hand(|_| {});
    let program = Program::monitor(&name);
    let mut first = Socket::open(program.address(), "/stream", &[]).expect("a socket");
    for _ in 0..3 {
        batch(&mut first, true);
    }
    let mut second = Socket::open(program.address(), "/stream", &[]).expect("a socket");
    let hand = message(&mut second);
    assert_eq!((&hand["type"], &hand["name"]), (&"hand".into(), &name.into()));
    assert_eq!(hand["geometry"]["fingers"].as_array().map(Vec::len), Some(3));
    let columns = hand["columns"].as_array().expect("columns").len();
    let state = message(&mut second);
    assert_eq!((&state["type"], &state["finger"]), (&"state".into(), &1.into()));
    let rows = batch(&mut second, true)["fingers"][0]["rows"].clone();
    assert_eq!(rows[0].as_array().map(Vec::len), Some(columns));
}
