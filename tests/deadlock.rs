//! The models of `models/promela/` under the model checker spin: which of them deadlock, and which do not.
//! `docs/deadlock.md` explains them.

#[allow(dead_code)]
#[path = "common/tools.rs"]
mod tools;

use std::path::Path;
use std::process::Command;
use std::{fs, thread};

/// Options of the compiler: a check for invalid end states and assertions, with compressed states.
const CHECKER: [&str; 4] = ["-O2", "-DSAFETY", "-DCOLLAPSE", "-DVECTORSZ=2048"];

/// The options that select a scene of `hand.pml`.
const SHUTDOWN: &str = "-DSHUTDOWN -DPORTS=1";
const RECOVERY: &str = "-DRECOVERY -DOPENED -DPORTS=1";
const TWO_RECOVERIES: &str = "-DTWO_RECOVERIES -DOPENED -DPORTS=1";
const PANIC: &str = "-DPANIC -DOPENED -DPORTS=2";
const CALIBRATION: &str = "-DCALIBRATION -DOPENED -DNO_RECONNECT -DPORTS=1";
const AGAIN: &str = "-DAGAIN -DOPENED -DPORTS=1";
const CALLS: &str = "-DCALLS -DOPENED -DPORTS=1";
const EXIT: &str = "-DEXIT -DOPENED -DNO_RECONNECT -DPORTS=1";

/// What spin finds.
#[derive(Debug, PartialEq)]
enum Found {
    /// No run of the model ends before every process is at its end, and no assertion fails.
    Nothing,
    /// A process waits, and no other process can continue.
    Deadlock,
}

/// Checks every run of a model. `options` are those of spin, separated by spaces.
fn check(model: &str, options: &str) -> Found {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/promela");
    for file in fs::read_dir(models).expect("the models") {
        let file = file.expect("a file").path();
        fs::copy(&file, folder.path().join(file.file_name().expect("a name"))).expect("a copy");
    }
    let run = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).args(arguments).current_dir(folder.path()).output();
        let output = output.unwrap_or_else(|error| panic!("{program}: {error}"));
        let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{program} {arguments:?}, {model} {options}: {text}");
        text
    };
    let options: Vec<&str> = options.split_whitespace().collect();
    run("spin", &[&options[..], &["-a", model]].concat());
    run("gcc", &[&CHECKER[..], &["-o", "pan", "pan.c"]].concat());
    let checker = folder.path().join("pan");
    let text = run(checker.to_str().expect("the path is text"), &["-m200000", "-w22"]);
    assert!(!text.contains("max search depth too small"), "{text}");
    match (text.contains("errors: 0"), text.contains("invalid end state (at depth")) {
        (true, false) => Found::Nothing,
        (false, true) => Found::Deadlock,
        _ => panic!("{model} {options:?}: {text}"),
    }
}

fn spin() -> bool {
    tools::available("spin", "model checking")
}

#[test]
fn the_example_of_the_report_deadlocks_but_not_with_the_exchange_of_this_library() {
    if spin() {
        assert_eq!(check("occam.pml", ""), Found::Deadlock);
        assert_eq!(check("occam.pml", "-DBUFFERED"), Found::Nothing);
    }
}

#[test]
fn a_planner_that_waits_for_a_slow_call_is_woken() {
    if spin() {
        assert_eq!(check("delegated_call.pml", ""), Found::Nothing);
        assert_eq!(check("delegated_call.pml", "-DWAKE_FIRST"), Found::Deadlock);
    }
}

#[test]
fn the_hand_does_not_deadlock() {
    if !spin() {
        return;
    }
    let scenes = [SHUTDOWN, RECOVERY, TWO_RECOVERIES, PANIC, CALIBRATION, AGAIN, CALLS, EXIT];
    let checks = scenes.map(|scene| (scene, thread::spawn(move || check("hand.pml", scene))));
    for (scene, check) in checks {
        assert_eq!(check.join().expect("the check ends"), Found::Nothing, "{scene}");
    }
}

/// A model that cannot show a deadlock would prove nothing.
#[test]
fn defects_of_the_hand_are_found() {
    if !spin() {
        return;
    }
    let mutants = [
        ("SERVO_WAITS_FOR_PLANNER", SHUTDOWN),
        ("FAULTED_IS_NOT_FINISHED", SHUTDOWN),
        ("BEGIN_STAYS_OPEN", SHUTDOWN),
        ("COLLECTOR_IS_NOT_STOPPED", SHUTDOWN),
        ("RECOVERY_JOINS_UNDER_LOCK", RECOVERY),
        ("CALIBRATION_IGNORES_RECOVERY", CALIBRATION),
        ("LOCKS_IN_ANY_ORDER", CALLS),
        ("GROUPS_IN_ANY_ORDER", CALLS),
        ("EXIT_WAITS_WITHOUT_LIMIT", EXIT),
    ];
    for (mutant, scene) in mutants {
        assert_eq!(check("hand.pml", &format!("-DMUTANT_{mutant} {scene}")), Found::Deadlock, "{mutant}");
    }
}
