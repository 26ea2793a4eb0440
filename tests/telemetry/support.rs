//! Hands and readers for the tests, and child processes that open a hand or a reader.

use crate::pauses;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use sun2xp::hand::Hand;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::telemetry::{Message, Reader};

/// Environment variables of a child process: what it opens, and the name of the hand.
const ROLE: &str = "SUN2XP_TEST_TELEMETRY_ROLE";
const NAME: &str = "SUN2XP_TEST_TELEMETRY_NAME";

/// Returns a name that no other test and no other test program uses.
pub fn name(test: &str) -> String {
    format!("test-{}-{test}", std::process::id())
}

/// The configuration of a simulated hand with this name.
pub fn configuration(name: &str) -> Configuration {
    let mut configuration = Configuration::default();
    configuration.telemetry.name = name.into();
    configuration
}

/// Opens a simulated hand with this name.
pub fn open(name: &str) -> Hand {
    pauses::name_pauses();
    Hand::open(configuration(name)).unwrap_or_else(|error| panic!("open: {error}"))
}

/// Attaches to the hand with this name.
pub fn reader(name: &str) -> Reader {
    Reader::attach(Some(name)).unwrap_or_else(|error| panic!("attach: {error}"))
}

/// Reads for some time.
pub fn read_for(reader: &mut Reader, time: Duration, messages: &mut Vec<Message>) {
    let end = Instant::now() + time;
    while Instant::now() < end {
        reader.read(Duration::from_millis(100), messages).unwrap_or_else(|ended| panic!("{ended}"));
    }
}

/// Reads until `find` returns something for a message, for at most 10 s.
pub fn read_until<T>(reader: &mut Reader, mut find: impl FnMut(&Message) -> Option<T>) -> T {
    let end = Instant::now() + Duration::from_secs(10);
    let mut messages = Vec::new();
    loop {
        reader.read(Duration::from_millis(100), &mut messages).unwrap_or_else(|ended| panic!("{ended}"));
        if let Some(found) = messages.drain(..).find_map(|message| find(&message)) {
            return found;
        }
        assert!(Instant::now() < end, "the message does not arrive");
    }
}

/// The numbers of a finger's cycles.
pub fn cycles(messages: &[Message], finger: FingerNumber) -> Vec<u64> {
    let number = |message: &Message| match message {
        Message::Cycle { finger: of, record } if *of == finger => Some(record.cycle),
        _ => None,
    };
    messages.iter().filter_map(number).collect()
}

/// A process that has a hand or a reader. The process is killed when this value is dropped.
pub struct OtherProcess {
    pub child: Child,
    lines: BufReader<std::process::ChildStdout>,
    /// Process number of the process's forked child; 0 if there is none.
    copy: i32,
}

impl OtherProcess {
    /// Starts a process with a hand of this name, and waits until the hand is open.
    pub fn with_hand(name: &str) -> Self {
        Self::start("hand", name)
    }

    /// Starts a process with a hand of this name, and with a forked child that keeps copies of the hand's descriptors.
    pub fn with_forked_hand(name: &str) -> Self {
        Self::start("forked", name)
    }

    /// Starts a process that attaches to the hand of this name, and then never reads.
    pub fn with_reader(name: &str) -> Self {
        Self::start("reader", name)
    }

    fn start(role: &str, name: &str) -> Self {
        let mut command = Command::new(std::env::current_exe().expect("the test's own program"));
        command.args(["--exact", "a_child_process", "--nocapture", "--test-threads=1"]);
        command.env(ROLE, role).env(NAME, name).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().expect("the process starts");
        let lines = BufReader::new(child.stdout.take().expect("a pipe"));
        let mut process = Self { child, lines, copy: 0 };
        process.copy = process.line_with("ready").parse().unwrap_or(0);
        process
    }

    /// Waits for a line of the process that contains a word, and returns the text after the word.
    pub fn line_with(&mut self, word: &str) -> String {
        let mut line = String::new();
        while !line.contains(word) {
            line.clear();
            assert!(self.lines.read_line(&mut line).expect("a line") > 0, "the process has ended without {word:?}");
        }
        line.split_once(word).expect("the word").1.trim().to_owned()
    }

    /// Kills the process with SIGKILL, and waits until it has ended.
    pub fn kill(&mut self) {
        self.child.kill().expect("killed");
        self.child.wait().expect("ended");
    }

    /// Ends the process in an orderly way.
    pub fn end(mut self) {
        self.child.stdin.take().expect("a pipe").write_all(b"\n").expect("written");
        self.child.wait().expect("ended");
    }
}

impl Drop for OtherProcess {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
        if self.copy > 0 {
            // SAFETY: the call takes numbers only. The process is one that this test has started.
            unsafe { libc::kill(self.copy, libc::SIGKILL) };
        }
    }
}

/// Does what the environment variables say, until a line arrives at standard input. Does nothing in the test program
/// itself, which does not have these variables.
pub fn child_is_told_what_to_do() {
    let (Ok(role), Ok(name)) = (std::env::var(ROLE), std::env::var(NAME)) else { return };
    let wait = || std::io::stdin().read(&mut [0]).expect("a byte or the end");
    match role.as_str() {
        "hand" | "forked" => {
            let hand = open(&name);
            let copy = if role == "forked" { fork() } else { 0 };
            println!("ready {copy}");
            wait();
            drop(hand);
        }
        "reader" => {
            let reader = reader(&name);
            println!("ready");
            wait();
            drop(reader);
        }
        other => panic!("unknown role {other}"),
    }
}

/// Forks a child that keeps all descriptors and does nothing until it is killed. Returns its process number.
fn fork() -> i32 {
    // SAFETY: the child only calls `pause`, which is permitted after a fork of a process with threads.
    unsafe {
        match libc::fork() {
            0 => loop {
                libc::pause();
            },
            child => child,
        }
    }
}
