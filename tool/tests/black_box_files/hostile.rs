//! Recordings that once made `sun2xp replay` hang or panic are refused in one line with the place and the reason.

use crate::recorded::{recorded, varied};
use std::fs;
use std::process::Command;
use sun2xp::finger::{Fading, Recording};

/// The tool's error text for a recording that it refuses.
fn refusal(recording: &Recording) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("altered.jsonl");
    recording.save(&file).expect("written");
    refusal_of(&fs::read(&file).expect("read"))
}

fn refusal_of(text: &[u8]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("altered.jsonl");
    fs::write(&file, text).expect("written");
    let run = Command::new(env!("CARGO_BIN_EXE_sun2xp")).arg("replay").arg(&file).output().expect("the tool runs");
    let reported = String::from_utf8(run.stderr).expect("text");
    assert_eq!(run.status.code(), Some(1), "{reported}");
    assert!(reported.lines().count() == 1 && reported.len() < 600, "one short line: {reported}");
    assert!(reported.contains("altered.jsonl"), "{reported}");
    reported
}

fn altered(alter: impl FnOnce(&mut Recording)) -> Recording {
    let mut recording = varied(&recorded().opening);
    alter(&mut recording);
    recording
}

#[test]
fn skipped_periods_without_end_are_refused() {
    let skipped = |index: usize, skipped: u64| {
        move |recording: &mut Recording| {
            recording.cycles[index].control.as_mut().expect("computed").input.skipped = skipped;
        }
    };
    let reported = refusal(&altered(skipped(7, 1_000_000_000_000)));
    assert!(reported.contains(", line 9: control.input.skipped: is 1000000000000:"), "{reported}");
    // The number of skipped periods is limited by the watchdog.
    assert!(altered(skipped(7, 12)).replay().is_ok());
    let reported = refusal(&altered(skipped(7, 13)));
    assert!(reported.contains("with the hand.watchdog_ms of this file it is at most 12"), "{reported}");
    // The total of skipped periods is limited too.
    let slow = altered(|recording| {
        recording.origin.hand.watchdog_ms = 1000;
        let cycle = recording.cycles[11].clone();
        recording.cycles.extend((0..2000).map(|later| {
            let mut cycle = cycle.clone();
            cycle.cycle += later + 1;
            cycle.control.as_mut().expect("computed").input.skipped = 700;
            cycle
        }));
    });
    let reported = refusal(&slow);
    assert!(reported.contains("together are more than 1000000"), "{reported}");
}

#[test]
fn invalid_configurations_make_no_controller() {
    type Alter = fn(&mut Recording);
    let weak =
        "friction.joint_coulomb: because of this value, the key motor.continuous_torque is refused. The file was";
    let sign = "motor.sign: [1, 0, 1, 1] has an entry other than 1 and -1. The file was altered";
    let alterations: [(Alter, &str); 10] = [
        (|recording| recording.origin.controllers[0].finger.geometry.r[1][2] = 1e308, "geometry.r"),
        (|recording| recording.origin.controllers[0].finger.motor.torque_limit[0] = 1e308, "motor.torque_limit"),
        (|recording| recording.origin.controllers[1].finger.motor.continuous_torque[3] = 5e-324, "continuous_torque"),
        (|recording| recording.origin.controllers[0].finger.motor.sign = [1, 0, 1, 1], sign),
        (|recording| recording.origin.controllers[1].gravity[2] = 1e308, "gravity: is 1e308 m/s^2, outside "),
        (|recording| recording.origin.hand.rate = 1e308, "origin.hand.rate"),
        (|recording| recording.origin.hand.watchdog_ms = 0, "origin.hand.watchdog_ms"),
        (|recording| recording.origin.finger = -1, "origin.finger"),
        (|recording| recording.origin.controllers.reverse(), "origin.controllers"),
        (
            |recording| {
                let controllers = &mut recording.origin.controllers;
                controllers.iter_mut().for_each(|source| source.finger.friction.joint_coulomb = [20.0; 3]);
            },
            weak,
        ),
    ];
    for (alter, key) in alterations {
        let reported = refusal(&altered(alter));
        assert!(reported.contains("line 1: ") && reported.contains(key), "{reported}");
        // The remedies for a configuration are no remedies for an altered file.
        assert!(!["aise ", "heck ", "Correct "].iter().any(|remedy| reported.contains(remedy)), "{reported}");
    }
}

#[test]
fn a_fade_with_impossible_numbers_is_refused() {
    for (left, rest) in [(0.4, -1.0), (0.4, 1.1), (-0.1, 0.5), (1.1, 0.5)] {
        let reported = refusal(&altered(|recording| {
            recording.cycles[8].control.as_mut().expect("computed").input.fading = Some(Fading { left, rest });
        }));
        assert!(reported.contains(", line 10: control.input.fading: "), "{reported}");
    }
}

#[test]
fn a_gravity_that_no_hand_has_is_refused() {
    let reported = refusal(&altered(|recording| {
        let input = &mut recording.cycles[8].control.as_mut().expect("computed").input;
        input.gravity = Some([0.0, 0.0, 1e3].into());
    }));
    assert!(reported.contains(", line 10: control.input.gravity: is "), "{reported}");
}

#[test]
fn files_that_no_black_box_writes_are_refused() {
    let text = {
        let mut text = Vec::new();
        varied(&recorded().opening).write(&mut text).expect("written");
        String::from_utf8(text).expect("text")
    };
    let (header, cycles) = text.split_once('\n').expect("a header");
    let (first, rest) = cycles.split_once('\n').expect("a cycle");
    let endless = format!("{header}\n{first}{}\n{rest}", " ".repeat(100_000));
    assert!(refusal_of(endless.as_bytes()).contains("a line of more than 65536 bytes"));
    let more = format!("{text}{first}\n");
    assert!(refusal_of(more.as_bytes()).contains("more than 12 cycles"));
    let many = text.replacen("\"cycles\":12", "\"cycles\":1000000000000", 1);
    assert!(refusal_of(many.as_bytes()).contains("more than 50000 cycles"));
    let number = cycles.split_once(',').expect("a number").0;
    let last = text.replacen(number, "{\"cycle\":18446744073709551615", 1);
    assert!(refusal_of(last.as_bytes()).contains("line 3: its cycle number does not follow"));
    let controller = "{\"number\":0,\"gravity\":[0,0,0],\"finger\":{}},".repeat(5000);
    let crowded = text.replacen("\"controllers\":[", &format!("\"controllers\":[{controller}"), 1);
    assert!(refusal_of(crowded.as_bytes()).contains("line 1: more than 4096 controllers"));
    let rude = text.replacen("\"exact\"", &format!("\"{}\\u001b[31m\\n\"", "x".repeat(1000)), 1);
    let reported = refusal_of(rude.as_bytes());
    assert!(reported.contains("line 1: unknown variant `xxx"), "{reported}");
    let library = text.replacen("\"library\":\"", "\"library\":\"\\n\\n", 1).replacen("\"rate\"", "\"rat\"", 1);
    assert!(refusal_of(library.as_bytes()).contains("Library \\n\\n0.1.0 wrote it"));
}
