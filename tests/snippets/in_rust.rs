//! The Rust snippets of README and docs. Each snippet, except that of docs/remote.md, is part of a function here, which
//! a test runs.

use crate::pages::{in_language, pages};
use std::error::Error;
use std::time::Duration;
use sun2xp::events::EventKind;
use sun2xp::{FingerNumber, Hand};

const THIS_FILE: &str = include_str!("in_rust.rs");

/// Contains the snippet of README.md.
#[test]
fn the_hand_is_a_spring() -> Result<(), Box<dyn Error>> {
    let hand = sun2xp::Hand::open(sun2xp::Configuration::default())?;
    hand.send_stiffness(1, [[3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]])?;
    hand.send_position(1, [0.0, 0.5, 0.9])?;
    println!("{:?}", hand.position(1)?);
    Ok(())
}

/// Contains the snippet of docs/events.md.
fn wait_until_settled(hand: &Hand) -> Result<(), Box<dyn Error>> {
    let queue = hand.events();
    hand.send_position(1, [0.0, 0.5, 0.8])?;
    while let Some(event) = queue.wait(Some(Duration::from_secs(5))) {
        if event.finger == FingerNumber::ONE && event.kind == EventKind::Settled {
            break;
        }
    }
    Ok(())
}

#[test]
fn the_finger_settles() -> Result<(), Box<dyn Error>> {
    let hand = Hand::open(sun2xp::Configuration::default())?;
    wait_until_settled(&hand)?;
    assert!((hand.position(1)?[2] - 0.8).abs() < 0.05);
    Ok(())
}

#[test]
fn every_snippet_in_rust_is_in_this_file() {
    let pages = pages();
    let blocks = in_language(&pages, "rust");
    assert!(blocks.len() >= 2, "{} snippets were found", blocks.len());
    // serve/tests/network has the snippet of docs/remote.md, because this package does not depend on the remote client.
    for block in blocks.iter().filter(|block| block.page != "docs/remote.md") {
        let indented: String = block.text.lines().map(|line| format!("    {line}\n").replace("    \n", "\n")).collect();
        assert!(
            THIS_FILE.contains(&indented),
            "{}: copy this snippet into tests/snippets/in_rust.rs:\n{indented}",
            block.page
        );
    }
}
