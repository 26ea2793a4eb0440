//! `sun2xp jog --web`: a page moves the hand if it has the permission.

use super::messages::{batch, message};
use super::program::Program;
use super::socket::{Frame, Socket};
use serde_json::Value;
use std::fs;
use std::net::TcpListener;
use std::process::Command;
use tempfile::TempDir;

/// The configuration of a hand that tolerates long delays.
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

/// Opens the page that may move the hand.
pub fn open(program: &Program) -> Socket {
    let token = program.token().expect("the address has a token");
    Socket::open(program.address(), &format!("/stream?token={token}"), &[]).expect("a socket")
}

/// Sends a command, and returns the answer.
fn answer(socket: &mut Socket, command: &str) -> Value {
    socket.send(command);
    answers(socket, 1).remove(0)
}

/// Returns the next answers, in the order in which they come.
fn answers(socket: &mut Socket, number: usize) -> Vec<Value> {
    let mut answers = Vec::new();
    while answers.len() < number {
        let message = message(socket);
        match message["type"].as_str() {
            Some("answer") => answers.push(message),
            Some("batch") => socket.send(&format!(r#"{{"received":{}}}"#, message["number"])),
            _ => {}
        }
    }
    answers
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
    assert_eq!(pushed["command"]["force"][0], 2.0, "an answer has its command: {pushed}");
    wait_until(&mut page, |angle| angle > 0.23);
    drop(page);
    wait_until(&mut open(&program), |angle| (angle - 0.2).abs() < 0.02);
}

/// A real hand tightens its tendons when it is opened. If its page cannot be served, nothing may move.
#[test]
fn a_hand_whose_page_cannot_be_served_is_not_opened() {
    let taken = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let port = taken.local_addr().expect("an address").port().to_string();
    let mut tool = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
    let run = tool.args(["jog", "--web", "--port", &port]).output().expect("the tool runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(run.status.code() == Some(1) && text(&run.stderr).contains("cannot serve at 127.0.0.1:"), "{run:?}");
    assert!(!text(&run.stdout).contains("opening the hand"), "{run:?}");
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
    let answers = answers(&mut page, 4);
    let texts: Vec<&str> = answers.iter().map(|answer| answer["text"].as_str().expect("a text")).collect();
    let dropped = texts.iter().filter(|text| text.contains("dropped by an emergency stop")).count();
    assert!(dropped >= 2, "{texts:?}");
    assert!(!texts.iter().any(|text| text.contains("finger 2: holds") || text.contains("finger 3: holds")));
}

#[test]
fn a_push_ends_although_too_many_commands_wait() {
    let (program, _folder) = jog(&["--control"]);
    let mut page = open(&program);
    assert_eq!(answer(&mut page, r#"{"command":"stop"}"#)["done"], true);
    // The first recovery takes some time, and the others wait for it.
    for finger in 1..=3 {
        page.send(&format!(r#"{{"command":"recover","finger":{finger}}}"#));
    }
    for _ in 0..40 {
        page.send(r#"{"command":"scale_stiffness","finger":1,"factor":1}"#);
    }
    page.send(r#"{"command":"push","finger":1,"force":[0,0,0]}"#);
    let answers = answers(&mut page, 44);
    assert!(
        answers.iter().any(|answer| answer["text"].as_str().is_some_and(|text| text.contains("too many commands")))
    );
    let ended = answers.iter().find(|answer| answer["text"] == "finger 1: no push");
    assert!(ended.is_some_and(|answer| answer["done"] == true), "{answers:?}");
}
