//! `sun2xp bound` finds the bound of Kx and stores it.

use std::process::Command;
use sun2xp::hand;

#[test]
fn the_tool_stores_the_bound_and_keeps_the_rest_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hand.toml");
    let text = "# Mine.\n[finger.stiffness]\nbound = 5.5 # by hand\n[finger.controller]\nscheme = \"state feedback\"\n";
    std::fs::write(&path, text).unwrap();
    let run = |arguments: &[&str]| {
        let config = path.to_str().unwrap();
        let mut program = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
        program.args(["bound", "--config", config, "--samples", "40", "--nominal"]).args(arguments).output().unwrap()
    };
    let looked = run(&[]);
    assert!(looked.status.success(), "{looked:?}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
    // The search is limited to one finger.
    let one = run(&["--finger", "2", "--write"]);
    let said = String::from_utf8(one.stdout).unwrap();
    assert!(said.contains("finger 2:") && !said.contains("finger 1:") && !said.contains("finger 3:"), "{said}");
    let bounds = hand::read_configuration(&path).unwrap().fingers.map(|finger| finger.stiffness.bound.unwrap());
    assert!(bounds[0] == 5.5 && bounds[1] >= 6.0 && bounds[2] == 5.5, "{bounds:?}");
    std::fs::write(&path, text).unwrap();
    let written = run(&["--write"]);
    assert!(written.status.success(), "{written:?}");
    let after = std::fs::read_to_string(&path).unwrap();
    assert!(after.starts_with(text), "{after}");
    let hand = hand::read_configuration(&path).unwrap();
    let bound = hand.fingers[2].stiffness_bound(1000.0);
    assert!(bound >= 6.0, "{bound}");
    assert!(String::from_utf8(written.stdout).unwrap().contains(&format!("finger 3: {bound:.1} N/cm")));
    assert!(!run(&["--write", "--rate", "500"]).status.success(), "a bound for another rate must not be stored");
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
    let printed = output(&["--samples", "8"]);
    // Two bounds, each with or without a count in brackets: "11.2 (3 of 6)  9.0  nominal".
    let rows = printed.lines().skip(2).map_while(|line| {
        let mut bounds = Vec::new();
        let mut rest = line.trim();
        while let Some((number, after)) = rest.split_once(' ').filter(|(number, _)| number.parse::<f64>().is_ok()) {
            let after = after.trim_start();
            let counted = after.strip_prefix('(').and_then(|count| count.split_once(')'));
            bounds.push((number.parse::<f64>().ok()?, counted.is_none()));
            rest = counted.map_or(after, |(_, after)| after).trim();
        }
        (bounds.len() == 2).then(|| (bounds, rest.to_owned()))
    });
    let rows: Vec<_> = rows.collect();
    let plants: Vec<&str> = rows.iter().map(|(_, plant)| plant.as_str()).collect();
    assert_eq!(plants, sun2xp::stability::Variant::SET.map(|variant| variant.name));
    let covered = rows.iter().flat_map(|(bounds, _)| bounds).filter(|(_, covered)| *covered);
    let least = covered.map(|(bound, _)| *bound).fold(f64::INFINITY, f64::min);
    assert!(printed.contains(&format!("finger 1: {least:.1} N/cm at 1000 Hz, limited by: ")), "{printed}");
}

#[test]
fn the_tool_prints_the_passivity_of_the_tip() {
    let least = |scheme: &str| {
        let printed = output(&["--passivity", "--samples", "1", "--scheme", scheme]);
        let line = printed.lines().find(|line| line.contains("of |Y|")).unwrap_or_else(|| panic!("{printed}"));
        line.split_whitespace().skip_while(|word| *word != "least").nth(1).unwrap().parse::<f64>().unwrap()
    };
    assert!(least("state feedback") > -0.02 && least("figure 10") < -0.02);
}
