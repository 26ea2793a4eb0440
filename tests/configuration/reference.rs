//! Compares `docs/sun2xp.toml` with the configuration types: it must be complete, correct and current.

use crate::reading::{REFERENCE, keys, read, usable, with_numbers, with_optional_keys};
use std::collections::BTreeSet;
use sun2xp::control::Controller;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, ConfiguredObject};
use toml_edit::{DocumentMut, Item, Table};

/// The keys that a table can have, taken from the error for an unknown key.
fn expected_keys(table: &str) -> BTreeSet<String> {
    let (_, reason) = read(&format!("[{table}]\nno_such_key = 1\n")).expect_err("an unknown key");
    let (_, list) = reason.split_once("expected").unwrap_or_else(|| panic!("{reason}"));
    list.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

fn table<'a>(document: &'a DocumentMut, path: &str) -> &'a Table {
    let item = path.split('.').fold(document.as_item(), |item, part| item.get(part).unwrap_or(&Item::None));
    item.as_table().unwrap_or_else(|| panic!("[{path}] is not in the reference"))
}

#[test]
fn the_reference_is_the_default_hand() {
    assert_eq!(usable(REFERENCE), Configuration::default());
}

#[test]
fn every_key_of_every_table_is_in_the_reference() {
    let document: DocumentMut = with_optional_keys().parse().expect("TOML");
    let named = |path: &str| table(&document, path).iter().map(|(key, _)| key.to_owned()).collect::<BTreeSet<_>>();
    let fingers: BTreeSet<String> = ["1", "2", "3"].map(String::from).into();

    let in_file: BTreeSet<String> = document.iter().map(|(key, _)| key.to_owned()).collect();
    assert_eq!(in_file, ["finger", "hand", "telemetry"].map(String::from).into());
    assert_eq!(named("hand"), expected_keys("hand"));
    assert_eq!(named("telemetry"), expected_keys("telemetry"));
    assert_eq!(named("hand.simulated_object"), expected_keys("hand.simulated_object"));
    // Keys with different defaults for each finger are in the tables of the fingers.
    let of_fingers: BTreeSet<String> = &named("finger") | &named("finger.1");
    assert_eq!(&of_fingers - &fingers, expected_keys("finger"));
    assert_eq!(named("finger.1"), named("finger.2"));
    assert_eq!(named("finger.1"), named("finger.3"));
    let tables: Vec<String> = table(&document, "finger")
        .iter()
        .filter(|(key, item)| item.is_table() && !fingers.contains(*key))
        .map(|(key, _)| format!("finger.{key}"))
        .collect();
    assert_eq!(tables.len(), 17, "{tables:?}");
    for path in tables {
        assert_eq!(named(&path), expected_keys(&path), "[{path}]");
    }
}

#[test]
fn the_optional_keys_name_their_defaults() {
    let (shown, default) = (usable(&with_optional_keys()), Configuration::default());
    for (number, finger) in FingerNumber::ALL.into_iter().zip(&shown.fingers) {
        let reference = &default.fingers[number.index()];
        assert!(finger.base.is_some() && finger.turn_degrees.is_some() && finger.core.is_some());
        assert_eq!(shown.finger_to_palm(number), default.finger_to_palm(number));
        assert!(finger.stiffness.bound.is_some());
        assert_eq!(finger.stiffness_bound(1000.0), reference.stiffness_bound(1000.0));
        assert!(finger.geometry.ghost_row.is_some());
        let (q, default_q) = (finger.tendons().expect("tendons").q, reference.tendons().expect("tendons").q);
        assert!((q - default_q).amax() < 1e-6, "{q}{default_q}");
        // Compares the controllers number by number, without the ghost row, because the reference gives a rounded one.
        let mut unshown = finger.clone();
        unshown.geometry.ghost_row = None;
        let gains = &finger.controller;
        let given = [gains.tension_gain, gains.tension_integral, gains.motor_damping, gains.rate_time];
        let filters = [gains.speed_filter, gains.stretch_filter, gains.set_point_speed];
        let of_states = [gains.inertia_gain, gains.damping_ratio, gains.set_point_time, gains.dither];
        let of_friction = [gains.tension_dither, gains.friction_share];
        assert!(given.iter().chain(&filters).chain(&of_states).chain(&of_friction).all(Option::is_some), "{gains:?}");
        assert!(gains.scheme.is_some());
        let controller = |finger| format!("{:?}", Controller::new(finger, default.hand.rate).expect("a controller"));
        assert_eq!(controller(&unshown), controller(reference));
        assert!(finger.simulation.surface.is_some());
    }
    let object = shown.hand.simulated_object.expect("an object");
    assert_eq!(object, ConfiguredObject { table: object.table, ..Default::default() });
}

#[test]
fn the_examples_in_the_comments_are_usable() {
    let example: String =
        REFERENCE.lines().filter_map(|line| line.strip_prefix("#     ")).flat_map(|line| [line, "\n"]).collect();
    let hand = usable(&example);
    assert_eq!(hand.fingers.each_ref().map(|finger| finger.tendon.minimum), [5.0, 6.0, 5.0]);
    assert_eq!(hand.fingers.each_ref().map(|finger| finger.tendon.maximum), [50.0; 3]);
    assert_eq!(hand.fingers.each_ref().map(|finger| finger.simulation.surface.is_some()), [false, false, true]);
}

#[test]
fn every_key_is_read_and_a_misspelt_one_is_refused_with_its_line() {
    let text = with_optional_keys();
    for key in keys(&text) {
        let misspelt: String = text
            .lines()
            .enumerate()
            .map(
                |(index, line)| {
                    if index + 1 == key.line { format!("{}s = 1\n", key.name) } else { format!("{line}\n") }
                },
            )
            .collect();
        let (line, reason) = read(&misspelt).expect_err("misspelt");
        assert!(reason.contains(&format!("`{}s`", key.name)), "{}.{}: {reason}", key.table, key.name);
        assert_eq!(line, Some(key.line), "{}.{}: {reason}", key.table, key.name);
    }
}

/// Returns whether a comment contains this range, and not only as a part of another range.
fn mentions(comment: &str, range: &str) -> bool {
    let numeric = |c: char| c.is_ascii_alphanumeric() || c == '-';
    comment.match_indices(range).any(|(start, _)| {
        let (before, after) = (&comment[..start], &comment[start + range.len()..]);
        !before.ends_with(|c| numeric(c) || c == '.') && !after.starts_with(numeric)
    })
}

#[test]
fn every_range_is_documented() {
    // Values beyond every range, for floating-point numbers and for integers of 8, 16 and 32 bits.
    let beyond = ["1e300", "-1e300", "255", "0", "65535", "4294967295"];
    let mut documented = 0;
    for key in keys(&with_optional_keys()) {
        // Skips texts, booleans, and the keys of [finger.2] and [finger.3], whose ranges [finger.1] gives. Skips inline
        // tables too, because one comment gives the ranges of all their keys.
        if key.value.starts_with(['"', '{', 't', 'f']) || matches!(key.table.as_str(), "finger.2" | "finger.3") {
            continue;
        }
        let refusals = beyond.iter().filter_map(|number| {
            let text = format!("[{}]\n{} = {}\n", key.table, key.name, with_numbers(&key.value, number));
            read(&text).err()
        });
        let ranges: BTreeSet<String> = refusals
            .filter_map(|(_, reason)| reason.split_once(" is outside ").map(|(_, range)| range.to_owned()))
            .collect();
        for range in ranges {
            assert!(
                mentions(&key.comment, &range),
                "{}.{}: {range:?} is not in {:?}",
                key.table,
                key.name,
                key.comment
            );
            documented += 1;
        }
    }
    assert!(documented > 40, "only {documented} ranges found");
}

/// With numbers above these ranges a finger oscillates, or presses on its stop until the time limit of its zeroing.
#[test]
fn numbers_with_which_a_finger_fails_are_refused() {
    usable("[finger]\ncontroller.damping_ratio = 0.45\nzeroing.torque = 95\n");
    for (key, range) in [("controller.damping_ratio = 0.5", "0.05 to 0.45"), ("zeroing.torque = 100", "0.001 to 95")] {
        let (_, reason) = read(&format!("[finger]\n{key}\n")).expect_err("too large");
        assert!(reason.contains(range), "{reason}");
    }
}

#[test]
fn a_gain_that_a_controller_does_not_have_is_refused_and_its_comment_says_so() {
    let mut refused = 0;
    for key in keys(&with_optional_keys()) {
        if key.table != "finger.controller" || key.name == "scheme" {
            continue;
        }
        let refuses = |figure: &&str| {
            let text = format!("[finger.controller]\nscheme = \"figure {figure}\"\n{} = {}\n", key.name, key.value);
            read(&text).is_err()
        };
        let figures: Vec<&str> = ["9", "10", "11"].into_iter().filter(refuses).collect();
        let reported = match figures[..] {
            [] => continue,
            [figure] => format!("Refused with figure {figure}"),
            _ => format!("Refused with figures {}", figures.join(" and ")),
        };
        assert!(key.comment.contains(&reported), "{}: {reported:?} is not in {:?}", key.name, key.comment);
        refused += 1;
    }
    assert_eq!(refused, 2);
}

#[test]
fn an_initial_stiffness_above_the_bound_is_clamped_like_a_command_and_its_comment_says_so() {
    let stiff = "[finger.stiffness]\ninitial = [[9, 0, 0], [0, 9, 0], [0, 0, 9]]\n";
    let (line, reason) = read(stiff).expect_err("above the bound");
    assert!(line == Some(2) && reason.contains("stiffness.initial"), "{reason}");
    assert!(reason.contains("above the bound") && !reason.contains("send"), "a remedy for the file: {reason}");
    usable(&format!("[hand]\nout_of_range = \"clamp\"\n{stiff}"));
    let all = keys(REFERENCE);
    let key = all.iter().find(|key| key.table == "finger.stiffness" && key.name == "initial").expect("the key");
    assert!(key.comment.contains("hand.out_of_range is \"clamp\""), "{}", key.comment);
}

/// Step 8 of the order of bring-up in docs/building-a-hand.md sets an eighth of the torque limit.
#[test]
fn an_eighth_of_the_torque_limit_suffices_for_the_signs() {
    let limit = Configuration::default().fingers[0].motor.torque_limit.map(|limit| limit / 8.0);
    usable(&format!("[finger.motor]\ntorque_limit = {limit:?}\n"));
}
