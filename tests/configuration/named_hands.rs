//! `simulation.hand`: names that stand for the values of other keys, and their table in docs/real-tendons.md.

use crate::reading::{read, usable};
use sun2xp::model::configuration::{ConfiguredFinger, ConfiguredSimulation, NamedHand};

const PAGE: &str = include_str!("../../docs/real-tendons.md");

fn simulations(text: &str) -> [ConfiguredSimulation; 3] {
    usable(text).fingers.map(|finger| finger.simulation)
}

#[test]
fn a_name_stands_for_the_values_of_its_hand() {
    for hand in NamedHand::ALL {
        let name = hand.name();
        for text in [
            format!("[finger.simulation]\nhand = '{name}'\n"),
            format!("[finger]\nsimulation = {{ hand = '{name}' }}\n"),
            format!("[finger]\nsimulation.hand = '{name}'\n"),
        ] {
            assert_eq!(simulations(&text), [(); 3].map(|()| hand.simulation()), "{text}");
        }
        assert_eq!(hand.simulation().hand, hand);
        assert_eq!(ConfiguredSimulation::named(name), Some(hand.simulation()));
    }
    assert_eq!(ConfiguredSimulation::named("Worn"), None);
    assert_eq!(NamedHand::default().simulation(), ConfiguredSimulation::default());
}

#[test]
fn what_the_controller_assumes_stays_the_default() {
    let finger = usable("[finger]\nsimulation.hand = 'sheathed'\n").fingers[0].clone();
    assert_eq!(ConfiguredFinger { simulation: ConfiguredSimulation::default(), ..finger }, ConfiguredFinger::default());
}

#[test]
fn keys_beside_the_name_override_its_values() {
    let [one, two, three] = simulations(
        "[finger.simulation]\npulley_friction = 0.07\nhand = 'worn'\n\
         [finger.2.simulation]\nhand = 'cheap'\nseed = 7\n\
         [finger.3.simulation]\nstiction_ratio = 1.0\n\
         surface.ball = { centre = [0, 0, 12], radius = 2, stiffness = 20 }\n",
    );
    let with_friction = |hand: NamedHand| ConfiguredSimulation { pulley_friction: 0.07, ..hand.simulation() };
    assert_eq!(one, with_friction(NamedHand::Worn));
    assert_eq!(two, ConfiguredSimulation { seed: 7, ..with_friction(NamedHand::Cheap) });
    let surface = three.surface;
    assert!(surface.is_some());
    assert_eq!(three, ConfiguredSimulation { stiction_ratio: 1.0, surface, ..with_friction(NamedHand::Worn) });
}

#[test]
fn an_unknown_name_is_refused_with_the_names() {
    for (text, line) in [
        ("[finger.simulation]\nseed = 3\nhand = 'wornout'\n", 3),
        ("[finger.2]\nsimulation = { hand = 'Worn' }\n", 2),
        ("[finger.simulation]\nhand = 'worn'\n[finger.3.simulation]\nhand = ''\n", 4),
    ] {
        let (found, reason) = read(text).expect_err(text);
        assert_eq!(found, Some(line), "{text}: {reason}");
        assert!(reason.contains("simulation.hand: must be"), "{reason}");
        for hand in NamedHand::ALL {
            assert!(reason.contains(&format!("`{}`", hand.name())), "{reason}");
        }
    }
    let (line, reason) = read("[finger.simulation]\nhand = 3\n").expect_err("a number");
    assert_eq!(line, Some(2), "{reason}");
}

#[test]
fn other_errors_name_their_line_beside_a_named_hand() {
    for (text, line, words) in [
        ("[finger.simulation]\nhand = 'worn'\n\nstictions = 3\n", 4, "`stictions`"),
        ("[finger.simulation]\nhand = 'worn'\n\nseed = 'x'\n", 4, "must be"),
        ("[finger.simulation]\nhand = 'worn'\nstiction_ratio = 0.5\n", 3, "outside 1 to 10"),
        ("[finger]\n\nsimulation = { hand = 'worn', creep = 2 }\n", 3, "outside 0 to 1"),
    ] {
        let (found, reason) = read(text).expect_err(text);
        assert_eq!(found, Some(line), "{text}: {reason}");
        assert!(reason.contains(words), "{text}: {reason}");
    }
}

#[test]
fn the_examples_of_the_page_are_usable() {
    let examples: Vec<&str> =
        PAGE.split("```toml\n").skip(1).map(|block| block.split_once("```").expect("an end").0).collect();
    let [name, overridden] = examples[..] else { panic!("{examples:?}") };
    assert_eq!(name.lines().count(), 3);
    assert_eq!(simulations(name)[2], NamedHand::Worn.simulation());
    let sheathed = NamedHand::Sheathed.simulation();
    assert_eq!(simulations(overridden)[0], ConfiguredSimulation { conduit_friction: 0.2, ..sheathed });
}

/// The cells of a row of a table, without the empty text outside the first and the last `|`.
fn cells(row: &str) -> Vec<&str> {
    row.trim_matches('|').split('|').map(str::trim).collect()
}

#[test]
fn the_table_of_the_page_has_every_value_of_every_named_hand() {
    let (_, section) = PAGE.split_once("\n## The named hands\n").expect("the section");
    let section = section.split("\n## ").next().unwrap_or_default();
    let rows: Vec<Vec<&str>> = section.lines().filter(|line| line.starts_with('|')).map(cells).collect();
    let names = NamedHand::ALL.map(NamedHand::name);
    assert_eq!(rows[0][1..=names.len()], names.map(|name| format!("`{name}`")));
    for (column, hand) in NamedHand::ALL.into_iter().enumerate() {
        let mut text = "[finger.simulation]\n".to_owned();
        for row in &rows[2..] {
            // An empty cell stands for the value of the nominal hand.
            let value = [row[column + 1], row[1]].into_iter().find(|value| !value.is_empty()).expect("a value");
            text += &format!("{} = {value}\n", row[0].trim_matches('`'));
        }
        let [shown, ..] = simulations(&text);
        assert_eq!(ConfiguredSimulation { hand, ..shown }, hand.simulation(), "{}", hand.name());
    }
    // Each row is a key whose value differs between the nominal hand and another named hand.
    for row in &rows[2..] {
        assert!(row[2..=names.len()].iter().any(|value| !value.is_empty() && *value != row[1]), "{row:?}");
    }
}
