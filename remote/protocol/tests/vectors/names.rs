//! Names of hands and clients, good and bad, and the Zenoh keys of one hand and one client.

use crate::json::{object, text};
use sun2xp_remote_protocol::{Action, ClientName, EVERY_STATUS, HandKeys, HandName};

pub fn listed() -> Vec<String> {
    let names = [
        "hand",
        "left-2",
        "-",
        "",
        "Hand",
        "a_b",
        "a.b",
        "a/b",
        "a*",
        "a b",
        "\u{e4}",
        &"h".repeat(32),
        &"h".repeat(33),
        &"c".repeat(64),
        &"c".repeat(65),
        "Planner_1.lab",
        "a$b",
        "a#b",
        "a?b",
    ];
    let line = |name: &&str| {
        let (hand, client) = (name.parse::<HandName>().is_ok(), name.parse::<ClientName>().is_ok());
        object(&[("name", text(name)), ("of_a_hand", hand.to_string()), ("of_a_client", client.to_string())])
    };
    names.iter().map(line).collect()
}

pub fn keys() -> Vec<String> {
    let client: ClientName = "planner".parse().expect("a name");
    let keys = HandKeys::new("left-2".parse().expect("a name"));
    let mut pairs = vec![
        ("hand", text("left-2")),
        ("client", text("planner")),
        ("every_status", text(EVERY_STATUS)),
        ("state", text(&keys.state())),
        ("events", text(&keys.events())),
        ("status", text(&keys.status())),
        ("refused", text(&keys.refused(&client))),
        ("target", text(&keys.target(&client))),
    ];
    pairs.extend(Action::ALL.iter().map(|&action| (action.name(), text(&keys.request(action, &client)))));
    vec![object(&pairs)]
}

#[test]
fn a_key_of_a_client_gives_the_client_and_any_other_key_gives_none() {
    let client: ClientName = "planner".parse().expect("a name");
    let keys = HandKeys::new("left-2".parse().expect("a name"));
    assert_eq!(keys.client_of_target(&keys.target(&client)), Some(client.clone()));
    for action in Action::ALL {
        assert_eq!(keys.client_of_request(action, &keys.request(action, &client)), Some(client.clone()));
        assert_eq!(keys.client_of_target(&keys.request(action, &client)), None);
    }
    let foreign = [
        "sun2xp/left-2/target/",
        "sun2xp/left-2/target/a/b",
        "sun2xp/left-2/target/*",
        "sun2xp/left/target/a",
        "sun2xp/left-22/target/a",
        "other/left-2/target/a",
        "sun2xp/left-2/targets/a",
        "",
    ];
    foreign.iter().for_each(|key| assert_eq!(keys.client_of_target(key), None, "{key}"));
}

#[test]
fn a_key_of_a_status_gives_its_hand() {
    let hand: HandName = "left-2".parse().expect("a name");
    let key = HandKeys::new(hand.clone()).status();
    assert_eq!(sun2xp_remote_protocol::hand_of_status(&key), Some(hand));
    for key in ["sun2xp/a/b/status", "sun2xp//status", "sun2xp/status", EVERY_STATUS, "sun2xp/a/state"] {
        assert_eq!(sun2xp_remote_protocol::hand_of_status(key), None, "{key}");
    }
}
