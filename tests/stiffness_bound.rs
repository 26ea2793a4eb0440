//! The bound of Kx: what the search finds, that it can fail, and that the tool stores it.

use std::process::Command;
use sun2xp::hand;
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};
use sun2xp::stability::{Limit, Search};

const SEARCH: Search = Search { samples: 80, seed: 5 };

fn finger(scheme: Scheme) -> ConfiguredFinger {
    let mut finger = ConfiguredFinger::default();
    finger.controller.scheme = scheme;
    finger
}

#[test]
fn the_default_finger_carries_what_it_is_said_to() {
    for scheme in [Scheme::Figure10, Scheme::StateFeedback] {
        for (rate, least) in [(500.0, 5.0), (1000.0, 6.0)] {
            let found = SEARCH.bound(&finger(scheme), rate).unwrap();
            assert!(found.stiffness >= least, "{scheme:?} at {rate} Hz: {found:?}");
            assert!(found.least_scale >= 0.5 && found.samples > 40);
        }
    }
}

#[test]
fn a_loop_with_too_much_gain_or_no_damper_is_found_out() {
    let whole = SEARCH.bound(&finger(Scheme::Figure10), 1000.0).unwrap().stiffness;
    let mut less_damped = finger(Scheme::Figure10);
    less_damped.controller.rate_time = Some(0.002);
    match SEARCH.bound(&less_damped, 1000.0) {
        Ok(found) => assert!(found.stiffness < whole && matches!(found.limit, Limit::Unstable(_)), "{found:?}"),
        Err(unusable) => assert_eq!(unusable.key, "controller"),
    }
    let mut undamped = finger(Scheme::Figure10);
    undamped.controller.motor_damping = Some(0.0);
    undamped.controller.rate_time = Some(0.0);
    assert_eq!(SEARCH.bound(&undamped, 1000.0).unwrap_err().key, "controller");
}

#[test]
fn the_tool_stores_the_bound_and_keeps_the_rest_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hand.toml");
    let text = "# Mine.\n[finger.stiffness]\nbound = 5.5 # by hand\n[finger.controller]\nscheme = \"state feedback\"\n";
    std::fs::write(&path, text).unwrap();
    let run = |arguments: &[&str]| {
        let config = path.to_str().unwrap();
        let mut program = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
        program.args(["bound", "--config", config, "--samples", "40"]).args(arguments).output().unwrap()
    };
    let looked = run(&[]);
    assert!(looked.status.success(), "{looked:?}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
    let written = run(&["--write"]);
    assert!(written.status.success(), "{written:?}");
    let after = std::fs::read_to_string(&path).unwrap();
    assert!(after.starts_with(text), "{after}");
    let hand = hand::read(&path).unwrap();
    let bound = hand.fingers[2].stiffness_bound(1000.0);
    assert!(bound >= 6.0, "{bound}");
    assert!(String::from_utf8(written.stdout).unwrap().contains(&format!("finger 3: {bound:.1} N/cm")));
    assert!(!run(&["--write", "--rate", "500"]).status.success(), "a bound for another rate must not be stored");
}
