//! Tests that the tool refuses a path that is not a regular file of an acceptable size, and an altered black box.

use std::fs::{File, write};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use sun2xp::hand::Hand;
use sun2xp::model::configuration::Configuration;

/// Runs the tool. It must end within a time limit and use less than half a gigabyte of memory.
fn tool(arguments: &[&str], configuration: Option<&Path>) -> Output {
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -v 524288; exec \"$@\"", "sh", env!("CARGO_BIN_EXE_sun2xp")]).args(arguments);
    if let Some(path) = configuration {
        command.env("SUN2XP_CONFIG", path);
    }
    let mut process = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the tool starts");
    let limit = Instant::now() + Duration::from_secs(20);
    while process.try_wait().expect("a child").is_none() {
        if Instant::now() > limit {
            process.kill().expect("a child");
            panic!("{arguments:?} with {configuration:?} did not end");
        }
        sleep(Duration::from_millis(5));
    }
    process.wait_with_output().expect("its output")
}

fn refusal(arguments: &[&str], configuration: Option<&Path>) -> String {
    let output = tool(arguments, configuration);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{arguments:?} with {configuration:?}: {text}");
    text
}

#[test]
fn files_that_are_not_regular_or_too_large_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    assert!(Command::new("mkfifo").arg(path("fifo")).status().expect("mkfifo").success());
    // The file is sparse and takes no space.
    File::create(path("large")).and_then(|file| file.set_len(1 << 40)).expect("made");
    write(path("good"), "").expect("written");
    write(path("costs"), "wake_up = 1\nwrite = 1\nread = 1\ncompute = 1\n").expect("written");
    let text = |name: &str| path(name).to_str().expect("a name").to_owned();

    for (unsuitable, reason) in [
        (text("fifo"), "it is a FIFO (a pipe) and not a regular file"),
        ("/dev/zero".into(), "it is a device and not a regular file"),
        ("/dev/tty".into(), "it is a device and not a regular file"),
        (folder.path().display().to_string(), "it is a directory and not a regular file"),
        (text("large"), "it is larger than"),
    ] {
        let costs = text("costs");
        for (arguments, configuration, remedy) in [
            (vec!["schedule", "--costs", &costs], Some(Path::new(&unsuitable)), "It must be a text file"),
            (vec!["schedule", "--costs", &costs, "--config", &unsuitable], None, "It must be a text file"),
            (vec!["schedule", "--costs", &unsuitable], Some(&*path("good")), "Name a readable file with --costs"),
            (vec!["replay", &unsuitable], None, "Name a readable file that a hand has written"),
        ] {
            let said = refusal(&arguments, configuration);
            let expected = [reason, &unsuitable, remedy];
            assert!(expected.iter().all(|&part| said.contains(part)), "{arguments:?}: {said}");
        }
    }
}

#[test]
fn a_black_box_with_an_impossible_rate_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let hand = Hand::open(Configuration::default()).expect("the simulated hand opens");
    hand.write_black_box(1, &path("good.jsonl")).expect("written");
    drop(hand);
    let text = std::fs::read_to_string(path("good.jsonl")).expect("read");
    let (header, rest) = text.split_once('\n').expect("a header");
    let mut header: serde_json::Value = serde_json::from_str(header).expect("JSON");
    *header.pointer_mut("/origin/hand/rate").expect("a rate") = 0.into();
    write(path("altered.jsonl"), format!("{header}\n{rest}")).expect("written");
    let file = path("altered.jsonl").to_str().expect("a name").to_owned();
    let picture = path("timing.svg").to_str().expect("a name").to_owned();
    let folder = folder.path().to_str().expect("a name");
    for arguments in [
        vec!["plot", &file, "--kind", "timing", "--output", &picture],
        vec!["export", &file, "--output", folder],
        vec!["record", "--from-black-box", &file],
    ] {
        let said = refusal(&arguments, None);
        assert!(said.contains("cannot be used: rate: 0 Hz"), "{arguments:?}: {said}");
        assert!(said.contains("altered or damaged after it was written: copy it again"), "{arguments:?}: {said}");
        // The remedy for a configuration is no remedy for an altered file.
        assert!(!said.contains("raise it"), "{arguments:?}: {said}");
    }
    assert!(!path("altered.mcap").exists());
}
