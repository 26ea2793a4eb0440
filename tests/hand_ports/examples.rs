//! Every complete configuration that `docs/configuration.md` prints is opened on boards, and all fingers of the hand
//! are moved. Only the ports, the folders and `hand.watchdog_ms` differ from the printed text.

use crate::rig::{Board, PATIENT, close, settles, turn};
use std::collections::BTreeMap;
use std::path::Path;
use sun2xp::hand::{Configured, Hand, read_configuration};

const PAGE: &str = include_str!("../../docs/configuration.md");

/// A pose within the limits of every example, and clear of every surface, rad.
const POSE: [f64; 3] = [0.2, 0.5, 1.0];

/// The examples of the page with their headings.
fn examples() -> Vec<(&'static str, &'static str)> {
    PAGE.split("\n### ")
        .skip(1)
        .map(|section| {
            let (heading, rest) = section.split_once('\n').expect("a heading");
            let blocks: Vec<&str> =
                rest.split("```toml\n").skip(1).map(|block| block.split_once("```").expect("an end").0).collect();
            let [example] = blocks[..] else { panic!("{heading} has {} examples", blocks.len()) };
            (heading, example)
        })
        .collect()
}

/// Opens the configuration in the text, with boards for its ports and a folder for its black boxes, and moves every
/// finger.
fn works(what: &str, text: &str) {
    let _turn = turn();
    let folder = tempfile::tempdir().expect("a folder");
    let printed = folder.path().join("printed.toml");
    std::fs::write(&printed, text).expect("written");
    let configuration = read_configuration(&printed).unwrap_or_else(|error| panic!("{what}: {error}"));

    let mut on_ports: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for (index, finger) in configuration.fingers.iter().enumerate().filter(|(_, finger)| !finger.simulated()) {
        on_ports.entry(&finger.port).or_default().push((index + 1).to_string());
    }
    let mut text = text.to_owned();
    let mut boards = Vec::new();
    for (port, fingers) in on_ports {
        let fingers: Vec<&str> = fingers.iter().map(String::as_str).collect();
        let config = printed.to_str().expect("a name");
        let options = [&PATIENT[..], &["--config", config]].concat();
        let board = Board::start_with(&options, &fingers);
        text = replaced(&text, port, &board.port);
        boards.push(board);
    }
    if let Some(black_box) = &configuration.hand.black_box {
        text = replaced(&text, black_box, &folder.path().to_string_lossy());
    }
    moves(what, &folder.path().join("sun2xp.toml"), &text);
}

/// Replaces a path in the text.
fn replaced(text: &str, path: &str, other: &str) -> String {
    let (quoted, other) = (format!("\"{path}\""), format!("\"{other}\""));
    assert!(text.contains(&quoted), "{path} is not in {text}");
    text.replace(&quoted, &other)
}

fn moves(what: &str, file: &Path, text: &str) {
    std::fs::write(file, text).expect("written");
    let mut configured = Configured::read(file).unwrap_or_else(|error| panic!("{what}: {error}"));
    // A busy machine delays the bytes of a pseudo-terminal by several ms. A cable does not.
    configured.configuration.hand.watchdog_ms = 1000;
    let hand = Hand::open_as(configured).unwrap_or_else(|error| panic!("{what}: {error}"));
    let fingers = hand.fingers();
    for finger in fingers.numbers() {
        hand.send_position(finger, POSE).unwrap_or_else(|error| panic!("{what}: {error}"));
    }
    fingers.numbers().for_each(|finger| settles(&hand, finger, POSE));
    close(hand);
}

#[test]
fn every_example_of_the_page_works_as_printed() {
    let examples = examples();
    assert!(examples.len() >= 10, "{}", examples.len());
    for (heading, text) in examples {
        works(heading, text);
    }
}

/// The indented blocks of a section of the page, in order.
fn blocks(heading: &str) -> Vec<String> {
    let (_, section) = PAGE.split_once(&format!("\n{heading}\n")).expect("the heading");
    let section = section.split("\n#").next().unwrap_or_default();
    let code = |paragraph: &str| paragraph.lines().all(|line| line.starts_with("    "));
    let paragraphs: Vec<&str> = section.trim_matches('\n').split("\n\n").collect();
    let blocks = paragraphs.chunk_by(|one, next| code(one) == code(next)).filter(|block| code(block[0]));
    blocks.map(|block| block.join("\n\n").lines().map(|line| line.trim_start().to_owned() + "\n").collect()).collect()
}

#[test]
fn the_example_of_the_format_works_as_printed() {
    let blocks = blocks("## The format");
    let [example] = &blocks[..] else { panic!("{blocks:?}") };
    works("the format", example);
}

#[test]
fn the_recipe_for_a_board_at_a_port_works_as_printed() {
    let blocks = blocks("## A board at a port");
    let [board, example, planner] = &blocks[..] else { panic!("{blocks:?}") };
    let options = board.trim().strip_prefix("cargo run --release -- board ").expect("a board");
    let link = options.strip_prefix("--link ").expect("its link");
    assert_eq!(planner, "make -C c_examples run SUN2XP_CONFIG=$PWD/hand.toml\n");

    let _turn = turn();
    let folder = tempfile::tempdir().expect("a folder");
    let own_link = folder.path().join("board");
    let own_link = own_link.to_str().expect("a name");
    let options = options.replace(link, own_link);
    let options: Vec<&str> = PATIENT.into_iter().chain(options.split(' ')).collect();
    let _board = Board::start_with(&options, &[]);
    moves("a board at a port", &folder.path().join("hand.toml"), &replaced(example, link, own_link));
}
