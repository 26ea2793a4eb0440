//! A client in a process of its own, which the tests can stop and kill.

use super::Client;
use super::client::part;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// The environment variable that gives the endpoint to the process of the client.
const ENDPOINT: &str = "SUN2XP_TEST_CLIENT";

/// The joint angles that the client commands for finger 1, rad.
pub const WANTED: [f64; 3] = [0.1, 0.7, 0.9];

/// If this is the process of a client, owns the hand and repeats a Target until the process is killed. Otherwise
/// returns at once. The test whose name is passed to [`start`] must call this function.
pub fn run_if_child() {
    let Ok(endpoint) = std::env::var(ENDPOINT) else { return };
    let mut client = Client::connect(&endpoint, "alice", None).expect("connected");
    assert_eq!(client.acquire().text, "");
    for sent in 0u64.. {
        client.send(vec![part(1, WANTED)]);
        if sent == 20 {
            println!("commanding");
            std::io::stdout().flush().expect("a parent");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Starts the client in a process, and waits until it commands. `test` is the name of a test that calls
/// [`run_if_child`].
pub fn start(test: &str, endpoint: &str) -> Child {
    let mut command = Command::new(std::env::current_exe().expect("this program"));
    let command = command.args([test, "--exact", "--nocapture", "--test-threads=1"]).env(ENDPOINT, endpoint);
    let mut child = command.stdout(Stdio::piped()).spawn().expect("a client");
    let lines = BufReader::new(child.stdout.take().expect("its output")).lines();
    let commanding = lines.map_while(Result::ok).any(|line| line.contains("commanding"));
    assert!(commanding, "the client has failed");
    child
}
