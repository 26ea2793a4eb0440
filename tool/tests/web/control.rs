//! `sun2xp jog --web`: a page moves the hand, if it may.

use super::messages::{batch, message};
use super::program::Program;
use super::socket::{Frame, Socket};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// A hand that may be delayed for long.
const CONFIGURATION: &str = "
    [hand]
    watchdog_ms = 1000
    open_timeout_ms = 60000
    real_time = \"ignore\"
    [telemetry]
    name = \"web-jog\"
";

/// Starts `sun2xp jog --web` with further arguments.
pub fn jog(arguments: &[&str]) -> (Program, TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("sun2xp.toml");
    fs::write(&file, CONFIGURATION).expect("a file");
    let file = file.to_str().expect("UTF-8");
    (Program::start(&[&["jog", "--web", "--config", file], arguments].concat()), folder)
}

fn open(program: &Program) -> Socket {
    let token = program.token().expect("the address has a token");
    Socket::open(program.address(), &format!("/stream?token={token}"), &[]).expect("a socket")
}

/// Sends a command, and returns the answer.
fn answer(socket: &mut Socket, command: &str) -> Value {
    socket.send(command);
    loop {
        let message = message(socket);
        match message["type"].as_str() {
            Some("answer") => return message,
            Some("batch") => socket.send(&format!(r#"{{"received":{}}}"#, message["number"])),
            _ => {}
        }
    }
}

/// Waits until joint 0 of finger 1 is where it is wanted.
fn wait_until(socket: &mut Socket, wanted: impl Fn(f64) -> bool) {
    for _ in 0..600 {
        let batch = batch(socket, true);
        let rows = batch["fingers"].as_array().expect("fingers").iter().filter(|rows| rows["finger"] == 1);
        let newest = rows.flat_map(|rows| rows["rows"].as_array().expect("rows")).last();
        if newest.is_some_and(|row| wanted(row[2].as_f64().expect("an angle"))) {
            return;
        }
    }
    panic!("the finger does not get there")
}

#[test]
fn a_page_with_the_token_moves_the_hand_and_its_push_ends_with_the_page() {
    let (program, _folder) = jog(&["--control"]);
    assert_eq!(Socket::open(program.address(), "/stream", &[]).err(), Some(403), "loopback needs the token too");
    let mut page = open(&program);
    let moved = answer(&mut page, r#"{"command":"joints","finger":1,"joints":[0.2,0.6,0.9]}"#);
    assert_eq!(moved["done"], true, "{moved}");
    wait_until(&mut page, |angle| (angle - 0.2).abs() < 0.02);
    let refused = answer(&mut page, r#"{"command":"joints","finger":1,"joints":[9.0,0.6,0.9]}"#);
    assert_eq!(refused["done"], false, "{refused}");
    let pushed = answer(&mut page, r#"{"command":"push","finger":1,"force":[2.0,0.0,0.0]}"#);
    assert_eq!(pushed["done"], true, "{pushed}");
    wait_until(&mut page, |angle| angle > 0.23);
    drop(page);
    wait_until(&mut open(&program), |angle| (angle - 0.2).abs() < 0.02);
}

#[test]
fn without_control_the_page_of_jog_only_shows() {
    let (program, _folder) = jog(&[]);
    assert!(program.token().is_none());
    let mut page = Socket::open(program.address(), "/stream", &[]).expect("a socket");
    batch(&mut page, true);
    page.send(r#"{"command":"stop"}"#);
    let end = loop {
        match page.next() {
            Frame::Text(_) => {}
            end => break end,
        }
    };
    assert!(matches!(&end, Frame::Close(1008, reason) if reason.contains("--control")), "{end:?}");
}

#[test]
fn a_stop_drops_the_recoveries_that_wait() {
    let (program, _folder) = jog(&["--control"]);
    let mut page = open(&program);
    assert_eq!(answer(&mut page, r#"{"command":"stop"}"#)["done"], true);
    // The first recovery takes some time, and the others wait for it.
    for finger in 1..=3 {
        page.send(&format!(r#"{{"command":"recover","finger":{finger}}}"#));
    }
    page.send(r#"{"command":"stop"}"#);
    let mut answers = Vec::new();
    while answers.len() < 4 {
        let message = message(&mut page);
        match message["type"].as_str() {
            Some("answer") => answers.push(message["text"].as_str().expect("a text").to_owned()),
            Some("batch") => page.send(&format!(r#"{{"received":{}}}"#, message["number"])),
            _ => {}
        }
    }
    let dropped = answers.iter().filter(|text| text.contains("dropped by the emergency stop")).count();
    assert!(dropped >= 2, "{answers:?}");
    assert!(!answers.iter().any(|text| text.contains("finger 2: holds") || text.contains("finger 3: holds")));
}
