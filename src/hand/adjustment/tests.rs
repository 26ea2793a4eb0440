//! Tests adjustments without a running finger.

use super::*;

fn changed(keys: &str) -> ConfiguredFinger {
    adjusted(FingerNumber::ONE, &ConfiguredFinger::default(), keys, 1000.0).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn other_keys_keep_their_values() {
    assert_eq!(changed(""), ConfiguredFinger::default());
    let mut expected = ConfiguredFinger::default();
    expected.tendon.minimum = 6.0;
    expected.controller.tension_gain = Some(3.0);
    assert_eq!(changed("tendon.minimum = 6\ncontroller.tension_gain = 3"), expected);
    assert_eq!(changed("tendon = { minimum = 6 }\n[controller]\ntension_gain = 3.0\n"), expected);
    // The change also works on top of an earlier change, and with an optional table that is set.
    expected.geometry.ghost_row = Some([1.0; 4]);
    expected.simulation.surface =
        Some(crate::model::configuration::Surface::Ball { centre: [0.0, 1.0, 9.0], radius: 2.0, stiffness: 30.0 });
    let mut again = adjusted(FingerNumber::ONE, &expected, "tendon.maximum = 50", 1000.0).expect("usable");
    assert_eq!(again.tendon.maximum, 50.0);
    again.tendon.maximum = 60.0;
    assert_eq!(again, expected);
}

#[test]
fn another_controller_does_not_inherit_a_bound_that_is_too_large_for_it() {
    let mut finger = ConfiguredFinger::default();
    for (configured, rate, keys, expected) in [
        (Some(11.2), 1000.0, "controller.scheme = 'figure 11'", Some(6.0)),
        (Some(8.2), 500.0, "controller.scheme = 'figure 9'", Some(5.0)),
        (Some(4.0), 1000.0, "controller.scheme = 'figure 11'", Some(4.0)),
        (None, 1000.0, "controller.scheme = 'figure 11'", None),
        (Some(11.2), 1000.0, "controller.scheme = 'figure 9'\nstiffness.bound = 11", Some(11.0)),
        (Some(11.2), 1000.0, "controller.scheme = 'state feedback'", Some(11.2)),
        (Some(11.2), 1000.0, "tendon.maximum = 50", Some(11.2)),
    ] {
        finger.stiffness.bound = configured;
        let changed = adjusted(FingerNumber::ONE, &finger, keys, rate).expect("usable");
        assert_eq!(changed.stiffness.bound, expected, "{keys}");
    }
}

#[test]
fn keys_that_take_effect_only_at_open_are_refused_by_name() {
    for keys in [
        "port = 'x'",
        "encoder.zero = [0, 0, 0, 0]",
        "motor = { sign = [1, 1, 1, 1] }",
        "core = 1",
        "touch.elements = []",
        "tendon.minimum = 6\nsimulation.seed = 3",
        "[stiffness]\nbound = 5\ninitial = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
    ] {
        let refusal = adjusted(FingerNumber::ONE, &ConfiguredFinger::default(), keys, 1000.0).expect_err("refused");
        assert!(matches!(refusal, ConfigurationError::Permanent { .. }), "{refusal}");
        assert_eq!(refusal.errno(), libc::EBUSY);
    }
    let refusal =
        adjusted(FingerNumber::ONE, &ConfiguredFinger::default(), "simulation.seed = 3", 1000.0).expect_err("refused");
    assert!(refusal.to_string().starts_with("`simulation` cannot change"), "{refusal}");
}

#[test]
fn an_unreadable_key_is_reported_with_its_line() {
    for (keys, place, word) in [
        ("tendon.minimum = 6\ntendon.minimun = 5", 2, "minimun"),
        ("\n\ntendon.minimum = ", 3, ""),
        ("controller.tension_gain = 'much'", 1, "controller.tension_gain: must be a number, not the text \"much\""),
        ("\"tendon\\n\" = 1", 1, "unknown key `tendon\\n`"),
        ("\ntendon.stiffness = [300, 300, 300, 300, 300]", 2, "tendon.stiffness: has 5 entries, and must have 4"),
    ] {
        match adjusted(FingerNumber::TWO, &ConfiguredFinger::default(), keys, 1000.0).expect_err("refused") {
            ConfigurationError::Adjustment { finger: FingerNumber::TWO, line, reason } => {
                assert_eq!(line, place, "{keys}: {reason}");
                assert!(reason.contains(word), "{reason}");
            }
            other => panic!("{other}"),
        }
    }
}
