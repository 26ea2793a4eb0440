//! `sun2xp size`: the figures are those that a person computes by hand, and the exit status says whether all parts
//! suffice.

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

fn size(file: &Path, arguments: &[&str]) -> Output {
    let mut tool = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
    tool.args(["size", "--config"]).arg(file).args(arguments).output().expect("the tool starts")
}

/// Returns whether all parts of a hand suffice, and its figures.
fn figures(text: &str, arguments: &[&str]) -> (bool, Vec<Value>) {
    let file = tempfile::NamedTempFile::with_suffix(".toml").expect("a file");
    std::fs::write(file.path(), text).expect("written");
    let run = size(file.path(), &[arguments, &["--json"]].concat());
    let report: Value = serde_json::from_slice(&run.stdout).unwrap_or_else(|error| panic!("{error}: {run:?}"));
    let pass = report["pass"].as_bool().expect("a verdict");
    assert_eq!(run.status.code(), Some(i32::from(!pass)), "{run:?}");
    (pass, report["figures"].as_array().expect("figures").clone())
}

fn figure(figures: &[Value], what: &str, side: &str) -> f64 {
    let found = figures.iter().find(|figure| figure["what"].as_str().is_some_and(|name| name.starts_with(what)));
    found.and_then(|figure| figure[side].as_f64()).unwrap_or_else(|| panic!("{what}: no {side}"))
}

const SIMULATED: &str = "[finger]\nport = \"simulated\"\n";

#[test]
fn the_figures_are_those_of_a_calculation_by_hand() {
    let (pass, of) = figures(SIMULATED, &[]);
    assert!(pass, "{of:#?}");
    let near = |what, side, expected: f64| {
        let value = figure(&of, what, side);
        assert!((value / expected - 1.0).abs() < 1e-3, "{what}: {value}, not {expected}");
    };
    // The torque limit minus the Coulomb friction, divided by the radius and by one plus the conduit friction.
    near("tension that the weakest motor", "has", (4.75 - 0.07) / (0.0475 * 1.05));
    // Tendons 1 and 4 run over pulleys of 1.09 cm at joints 0 and 1. All joints move at 5 rad/s.
    near("speed of a motor", "needs", 5.0 * (1.09 + 1.09) / 0.0475 * 60.0 / std::f64::consts::TAU);
    near("voltage", "needs", 5.0 * (1.09 + 1.09) / 0.0475 * 0.0234);
    near("continuous current", "needs", 2.5 / 2.34);
    near("peak current", "needs", 4.75 / 2.34);
    near("E A", "needs", 300.0 * 50.0);
    // A tendon of 30 000 N/m and a rotor of 6e-7 kg m^2 with a radius of 0.475 mm oscillate at 16.9 Hz. The servo needs
    // 20 times this rate.
    near(
        "rate of the servo",
        "needs",
        20.0 * (30_000.0_f64 * 0.000_475_f64.powi(2) / 6e-7).sqrt() / std::f64::consts::TAU,
    );
}

/// The first run computes the force from the largest tension. The second run computes the tension from this force.
#[test]
fn force_and_tension_agree() {
    let (_, of) = figures(SIMULATED, &[]);
    let force = figure(&of, "force of the tip, for some seconds", "has").to_string();
    let (_, of) = figures(SIMULATED, &["--force", &force]);
    let tension = figure(&of, "tension of the tendons", "needs");
    assert!((tension - 60.0).abs() < 1e-6, "{tension} N, and finger.tendon.maximum is 60 N");
}

#[test]
fn a_part_that_does_not_suffice_is_named_with_a_remedy() {
    let (pass, of) = figures(&format!("{SIMULATED}[finger.encoder]\ncounts_per_revolution = [64, 64, 64, 64]\n"), &[]);
    let wanting: Vec<&Value> = of.iter().filter(|figure| figure["sufficient"] == false).collect();
    assert!(!pass && wanting.len() == 1, "{wanting:?}");
    assert!(wanting[0]["advice"].as_str().is_some_and(|advice| advice.contains("encoders with more counts")));
    let stiffer = figures(SIMULATED, &["--stiffness", "50"]);
    let wanting: Vec<&Value> = stiffer.1.iter().filter(|figure| figure["sufficient"] == false).collect();
    assert!(wanting.len() == 1 && wanting[0]["unit"] == "N/cm", "{wanting:?}");
}

#[test]
fn wrong_usage_is_refused() {
    for arguments in [["--force", "0"], ["--force", "nan"], ["--finger", "4"], ["--tendon-length", "x"]] {
        let run = size(Path::new("none.toml"), &arguments);
        assert_eq!(run.status.code(), Some(2), "{run:?}");
    }
    let run = size(Path::new("none.toml"), &["--finger", "x"]);
    assert!(String::from_utf8_lossy(&run.stderr).contains("not 1, 2 or 3"), "{run:?}");
    assert_eq!(size(Path::new("none.toml"), &[]).status.code(), Some(1));
}

/// The table in docs/building-a-hand.md is the output of the command.
#[test]
fn the_page_shows_the_table() {
    let file = tempfile::NamedTempFile::with_suffix(".toml").expect("a file");
    std::fs::write(file.path(), SIMULATED).expect("written");
    let run = size(file.path(), &[]);
    let table = String::from_utf8(run.stdout).expect("text");
    let page = include_str!("../../docs/building-a-hand.md");
    for line in table.lines() {
        assert!(page.contains(line.trim_end()), "docs/building-a-hand.md does not have this line: {line}");
    }
}
