//! `sun2xp record --from-black-box`.

use super::contents::contents;
use super::{name, open, record};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

/// Writes a black box into a folder.
fn write_black_box(test: &str, folder: &Path) {
    let hand = open(&name(test));
    let limit = Instant::now() + Duration::from_secs(20);
    while hand.losses(2).expect("losses").cycles < 300 {
        assert!(Instant::now() < limit, "finger 2 does not run");
        std::thread::sleep(Duration::from_millis(5));
    }
    hand.write_black_box(2, &folder.join("box.jsonl")).expect("written");
}

fn convert(folder: &Path, options: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
    command.args(["record", "--from-black-box"]).args(options).current_dir(folder).output().expect("the tool runs")
}

#[test]
fn a_black_box_is_converted() {
    let folder = tempfile::tempdir().expect("a folder");
    write_black_box("box", folder.path());
    let run = convert(folder.path(), &["box.jsonl"]);
    assert!(run.status.success(), "{run:?}");
    let contents = contents(&fs::read(folder.path().join("box.mcap")).expect("the file"));
    let black_box = sun2xp::Recording::open(&folder.path().join("box.jsonl")).expect("a black box");
    let expected: Vec<u64> = black_box.cycles.iter().map(|record| record.cycle).collect();
    assert!(expected.len() > 100, "a black box with hardly any cycle: {expected:?}");
    assert_eq!(contents.cycles, [vec![], expected, vec![]]);
}

/// A copy of a recording would not have the marks of its lost cycles.
#[test]
fn a_recording_is_not_converted_again() {
    let (name, folder) = (name("again"), tempfile::tempdir().expect("a folder"));
    let hand = open(&name);
    let run = record(&name, folder.path(), &["-o", "hand.mcap", "--seconds", "0.5"]).output().expect("the tool runs");
    assert!(run.status.success(), "{run:?}");
    drop(hand);
    let run = convert(folder.path(), &["hand.mcap", "-o", "copy.mcap"]);
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.code() == Some(2) && said.contains("hand.mcap is a recording already"), "{said}");
    assert!(!folder.path().join("copy.mcap").exists());
}

/// A limit on the size of files acts like a full disk. It takes effect at the beginning of the file, or later.
#[test]
fn a_conversion_that_fails_leaves_no_file() {
    let folder = tempfile::tempdir().expect("a folder");
    write_black_box("full", folder.path());
    for blocks in [0, 16] {
        let limited = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" record --from-black-box box.jsonl");
        let mut shell = Command::new("sh");
        shell.args(["-c", &limited, env!("CARGO_BIN_EXE_sun2xp")]).current_dir(folder.path());
        let run = shell.output().expect("the shell runs");
        let said = String::from_utf8_lossy(&run.stderr);
        assert!(run.status.code() == Some(1) && said.contains("cannot write box.mcap: "), "{blocks}: {said}");
        assert!(!folder.path().join("box.mcap").exists(), "{blocks}");
    }
    assert!(convert(folder.path(), &["box.jsonl"]).status.success());
}
