//! `sun2xp bound` finds the bound of Kx. `tool/src/bound/tests.rs` tests that it stores the bound.

use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

/// If a search omits plants, walls or samples of the whole set, or if its controller or rate is not the configured one,
/// the bound that it finds must not be stored.
#[test]
fn only_the_bound_of_the_whole_set_can_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hand.toml");
    let text = "[finger.stiffness]\nbound = 5.5 # by hand\n";
    std::fs::write(&path, text).unwrap();
    let run = |arguments: &[&str]| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
        program.args(["bound", "--config", path.to_str().unwrap()]).args(arguments).output().unwrap()
    };
    let others: [&[&str]; 5] =
        [&["--nominal"], &["--free"], &["--samples", "40"], &["--rate", "500"], &["--scheme", "figure 9"]];
    for other in others {
        let refused = run(&[&["--write"][..], other].concat());
        assert_eq!(refused.status.code(), Some(2), "{other:?}: {refused:?}");
    }
    let looked = run(&["--samples", "40", "--nominal"]);
    assert!(looked.status.success(), "{looked:?}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
}

#[test]
fn a_useless_number_of_samples_is_refused() {
    for samples in ["0", "1", "9", "100000000", "18446744073709551615"] {
        let mut program = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
        let refused = program.args(["bound", "--samples", samples]).output().unwrap();
        assert_eq!(refused.status.code(), Some(2), "{samples}: {refused:?}");
        assert!(String::from_utf8_lossy(&refused.stderr).contains("--samples"), "{refused:?}");
    }
}

/// Runs `sun2xp bound` for one finger with the default configuration, and returns its output.
fn output(arguments: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hand.toml");
    std::fs::write(&path, "").unwrap();
    let mut program = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
    let run = program.args(["bound", "--finger", "1", "--config", path.to_str().unwrap()]).args(arguments).output();
    let run = run.unwrap();
    assert!(run.status.success(), "{run:?}");
    String::from_utf8(run.stdout).unwrap()
}

#[test]
fn the_tool_prints_the_bound_of_every_plant_and_takes_the_least() {
    let reported: Value = serde_json::from_str(&output(&["--samples", "10", "--json"])).expect("JSON");
    let finger = &reported["fingers"][0];
    let plants = finger["set"]["plants"].as_array().expect("an array");
    let places = |walls: bool| plants.iter().filter(move |plant| plant["walls"] == walls);
    let names: Vec<&str> = places(false).filter_map(|plant| plant["plant"].as_str()).collect();
    assert_eq!(names, sun2xp::stability::Variant::SET.map(|variant| variant.name));
    assert_eq!(places(true).count(), names.len());
    let bound = |plant: &Value| plant["bound"].as_f64().expect("a bound");
    let covered = plants.iter().filter(|plant| plant["uncovered"] == 0).map(bound);
    let least = covered.fold(f64::INFINITY, f64::min);
    assert_eq!(finger["stiffness"], least);
    let limiting = &plants[finger["set"]["limited_by"].as_u64().expect("an index") as usize];
    assert_eq!(bound(limiting), least);

    // The table that people read has the same bounds. Its columns are: plant, bound without walls, (uncovered samples),
    // bound against walls, (uncovered samples). An uncovered sample is unstable even at the smallest bound.
    let printed = output(&["--samples", "10"]);
    for (free, against) in places(false).zip(places(true)) {
        let name = free["plant"].as_str().expect("a name");
        let row = printed.lines().find_map(|line| line.strip_prefix(name)).unwrap_or_else(|| panic!("{printed}"));
        let numbers: Vec<&str> = row.split_whitespace().filter(|word| word.parse::<f64>().is_ok()).collect();
        let uncovered = row.matches(" of ").count();
        assert_eq!(numbers, [free, against].map(|plant| format!("{:.1}", bound(plant))), "{row}");
        let expected = [free, against].iter().filter(|plant| plant["uncovered"] != 0).count();
        assert_eq!(uncovered, expected, "{row}");
    }
    assert!(printed.contains(&format!("finger 1: {least:.1} N/cm at 1000 Hz, limited by: ")), "{printed}");
    assert!(!printed.contains('\u{1b}') && !printed.contains("of more"), "{printed}");
}

/// The search takes longer than a second, so a pipe receives at least one line with the part that is done.
#[test]
fn the_tool_shows_its_progress() {
    let mut program = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
    program.args(["bound", "--finger", "1", "--samples", "400"]).current_dir(env!("CARGO_TARGET_TMPDIR"));
    let mut program = program.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the tool runs");
    let lines = BufReader::new(program.stderr.take().expect("a pipe")).lines().map_while(Result::ok);
    let line = lines.into_iter().find(|line| line.starts_with("bound: ")).expect("a line");
    program.kill().expect("a child");
    program.wait().expect("its end");
    let (percent, plant) = line["bound: ".len()..].split_once(" %, finger 1, ").unwrap_or_else(|| panic!("{line}"));
    assert!(percent.parse::<u32>().is_ok_and(|percent| percent < 100), "{line}");
    assert!(sun2xp::stability::Variant::SET.iter().any(|variant| plant.starts_with(variant.name)), "{line}");
}

#[test]
fn the_tool_prints_the_passivity_of_the_tip() {
    let least = |scheme: &str| {
        let printed = output(&["--passivity", "--samples", "1", "--scheme", scheme]);
        let line = printed.lines().find(|line| line.contains("least passivity")).unwrap_or_else(|| panic!("{printed}"));
        line.split_whitespace().skip_while(|word| *word != "passivity").nth(1).unwrap().parse::<f64>().unwrap()
    };
    assert!(least("state feedback") > -0.02 && least("figure 10") < -0.02);
}
