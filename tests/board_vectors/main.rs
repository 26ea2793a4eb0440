//! protocol/vectors.json: test vectors for any board and any host. The codec generated the file and must keep agreeing
//! with it. The simulated board must pass every conversation in it, and so must the reference firmware
//! (tests/c_boards.rs).

mod conversations;
mod example_board;
mod frames;
mod json;
mod scripts;
mod steps;
mod stuffing;
mod unusable_frames;

use std::path::Path;
use std::{env, fs};

const ABOUT: &str = "Test vectors of docs/board-protocol.md, version 1; protocol/README.md says how to use them";

fn text() -> String {
    let sections = [
        ("frames", frames::good()),
        ("bad", unusable_frames::bad()),
        ("ignored", unusable_frames::ignored()),
        ("conversations", conversations::listed()),
    ];
    let sections: Vec<String> =
        sections.iter().map(|(name, lines)| format!("\"{name}\": [\n{}\n]", lines.join(",\n"))).collect();
    format!("{{\n\"about\": \"{ABOUT}\",\n\"protocol\": 1,\n{}\n}}\n", sections.join(",\n"))
}

#[test]
fn the_file_is_what_the_codec_makes() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("protocol/vectors.json");
    if env::var_os("SUN2XP_WRITE_VECTORS").is_some() {
        fs::write(&path, text()).expect("protocol/vectors.json can be written");
    }
    assert!(
        fs::read_to_string(&path).is_ok_and(|committed| committed == text()),
        "protocol/vectors.json is not what the codec makes. A protocol must not change by accident. If this change is \
         intended, run: SUN2XP_WRITE_VECTORS=1 cargo test --test board_vectors"
    );
}
