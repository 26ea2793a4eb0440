//! `sun2xp doctor`: on the simulated hand, on unusable ports, and with output for other programs.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;
use sun2xp::board::Port;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::Priority;
use sun2xp::simulated::{Pace, SimulatedBoard, SimulatedPort};

/// Runs the doctor with a configuration and returns the findings. Checks that the exit status, `pass` and the verdicts
/// agree.
fn examined(configuration: &str) -> Vec<Value> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("named.toml");
    fs::write(&file, configuration).expect("written");
    let run = doctor(&file, &["--json"]);
    let reported: Value = serde_json::from_slice(&run.0).unwrap_or_else(|error| panic!("{error}: {run:?}"));
    let findings = reported["findings"].as_array().expect("an array").clone();
    let failed = findings.iter().any(|finding| finding["verdict"] == "failure");
    assert_eq!((reported["pass"].as_bool(), run.1), (Some(!failed), Some(i32::from(failed))), "{reported:#}");
    for finding in &findings {
        let good = finding["verdict"] == "good";
        assert_eq!(good, finding["advice"] == "", "what is not good has a remedy: {finding:#}");
    }
    findings
}

fn doctor(configuration: &Path, options: &[&str]) -> (Vec<u8>, Option<i32>) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
    let run = command.args(["doctor", "--seconds", "0.5", "--config"]).arg(configuration).args(options).output();
    let run = run.expect("the tool can be started");
    (run.stdout, run.status.code())
}

fn find<'a>(findings: &'a [Value], subject: &str) -> &'a Value {
    let of = |finding: &&Value| finding["subject"].as_str().is_some_and(|reported| reported.starts_with(subject));
    findings.iter().find(of).unwrap_or_else(|| panic!("no {subject}: {findings:#?}"))
}

#[test]
fn the_simulated_hand_is_examined_whole() {
    let findings = examined("[hand]\nrate = 500\n");
    for subject in
        ["kernel", "real-time throttling", "real-time priority", "locked memory", "cores", "frequency governor"]
    {
        find(&findings, subject);
    }
    let measured = |name: &'static str| {
        findings
            .iter()
            .filter(move |finding| finding["subject"].as_str().is_some_and(|reported| reported.starts_with(name)))
    };
    assert_eq!((measured("wake-up").count(), measured("port").count(), measured("round trip").count()), (3, 3, 3));
    for finding in measured("round trip") {
        // Three ports share 0.25 s at 500 Hz, so each port has 41 cycles.
        let found = finding["found"].as_str().expect("a text");
        assert!(found.starts_with("median ") && found.contains("of 41 lost"), "{found}");
        assert_ne!(finding["verdict"], "failure", "a simulated board has no port that could fail: {finding:#}");
    }
    let simulated =
        |finding: &Value| finding["found"].as_str().is_some_and(|reported| reported.contains("simulated board"));
    assert!(measured("port").all(simulated), "{findings:#?}");
    let cores = find(&findings, "cores")["found"].as_str().expect("a text");
    assert!(cores.starts_with("configured: none") && !cores.contains('['), "{cores}");
}

#[test]
fn an_unusable_port_fails_with_its_remedy() {
    let findings = examined("[finger]\nport = 'simulated'\n[finger.2]\nport = '/dev/there-is-no-such-port'\n");
    let missing = find(&findings, "port /dev/there-is-no-such-port");
    assert_eq!(missing["verdict"], "failure");
    assert!(missing["advice"].as_str().is_some_and(|advice| advice.contains("/dev/serial/by-id")), "{missing}");

    let board = SimulatedBoard::new(&Configuration::default(), &[FingerNumber::THREE]).expect("a board");
    let board = SimulatedPort::start(board, Pace::patient(500.0), Priority::default()).expect("a pseudo-terminal");
    let taken = Port::open(&board.path(), 1_000_000).expect("the port");
    let configuration = format!("[finger]\nport = 'simulated'\n[finger.3]\nport = '{}'\n", board.path().display());
    let findings = examined(&configuration);
    let busy = find(&findings, &format!("port {}", board.path().display()));
    assert!(busy["advice"].as_str().is_some_and(|advice| advice.contains("in use")), "{busy}");

    // A board with another address answers. It does not belong to the finger.
    drop(taken);
    let findings = examined(&configuration.replace("port", "address = 9\nport"));
    let foreign = find(&findings, &format!("round trip on {}", board.path().display()));
    assert_eq!(foreign["verdict"], "failure");
    assert!(foreign["advice"].as_str().is_some_and(|advice| advice.contains("finger.address")), "{foreign}");
}

#[test]
fn the_report_is_readable_and_an_invalid_configuration_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("named.toml");
    fs::write(&file, "").expect("written");
    let (reported, _) = doctor(&file, &[]);
    let reported = String::from_utf8(reported).expect("text");
    // A pipe receives one line of aligned text for each finding, and its advice in a line of its own.
    let subjects = ["kernel", "cores", "locked memory"];
    let columns = subjects.map(|subject| reported.lines().find_map(|line| line.find(&format!("  {subject}  "))));
    assert_eq!(columns, [Some("warning".len()); 3], "{reported}");
    assert!(!reported.contains('\u{1b}'), "{reported}");
    assert!(reported.ends_with("pass\n") || reported.ends_with("fail\n"), "{reported}");

    // No controller can run with the values of the second configuration.
    for text in ["[hand]\nrat = 1\n", "[finger.tendon]\nmaximum = 10\n"] {
        fs::write(&file, text).expect("written");
        assert_eq!(doctor(&file, &["--json"]), (Vec::new(), Some(1)), "{text}");
    }
}

#[test]
fn values_that_open_hand_would_refuse_are_reported_with_file_and_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("named.toml");
    fs::write(&file, "[hand]\nrate = 1000\n[finger.2.motor]\nviscous_friction = [1, 1, 1, 1]\n").expect("written");
    let mut command = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
    let run = command.args(["doctor", "--seconds", "0.5", "--config"]).arg(&file).output().expect("it starts");
    let reported = String::from_utf8(run.stderr).expect("text");
    assert_eq!(run.status.code(), Some(1), "{reported}");
    assert!(reported.contains("named.toml:4: finger.2.motor.viscous_friction: "), "{reported}");
}
