//! The snippets in Rust of docs/remote.md: this file contains each of them as part of a function, which a test runs.

use super::security::{clients_of, loopback, simulated};
use std::error::Error;
use std::thread::sleep;
use std::time::Duration;
use sun2xp_remote_client::{RemoteConfiguration, RemoteHand};
use sun2xp_serve::server::Server;

const THIS_FILE: &str = include_str!("snippets.rs");

const PAGE: &str = include_str!("../../../docs/remote.md");

fn planner(endpoint: &str) -> Result<(), Box<dyn Error>> {
    let configuration = RemoteConfiguration::new(endpoint, "hand".parse()?, "planner".parse()?);
    let hand = RemoteHand::open(&configuration)?;
    hand.send_stiffness(1, [[3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]])?;
    hand.send_position(1, [0.0, 0.5, 0.9])?;
    while !hand.progress(1)?.arrived {
        sleep(Duration::from_millis(5));
    }
    println!("{:?}", hand.position(1)?);
    Ok(())
}

#[test]
fn the_snippet_of_the_page_runs() {
    let endpoint = loopback();
    let (hand, settings) = simulated("snippet", &clients_of(&["planner"]), &endpoint, None);
    let server = Server::start(hand, settings).expect("the server starts");
    planner(&endpoint).unwrap_or_else(|error| panic!("{error}"));
    server.end();
}

#[test]
fn every_snippet_in_rust_of_the_page_is_in_this_file() {
    let blocks: Vec<&str> = PAGE.split("```rust\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(!blocks.is_empty(), "docs/remote.md has no snippet in Rust: correct how this test searches for them");
    for block in blocks {
        let indented: String = block.lines().map(|line| format!("    {line}\n")).collect();
        assert!(THIS_FILE.contains(&indented), "copy this snippet into a function here that a test runs:\n{indented}");
    }
}
