//! Clients find and command several hands behind a router. The router lets a hand offer only the keys below the name in
//! its certificate.

mod common;

use common::client::{Certificate, part, request};
use common::{Client, Rig, free_port, wait_for};
use std::path::Path;
use sun2xp_remote_protocol::{Action, EVERY_STATUS, hand_of_status};
use sun2xp_serve::certificates::{Wanted, make};
use sun2xp_serve::router::Router;
use sun2xp_serve::settings::{Overrides, Settings};
use zenoh::Wait;

const CLIENTS: &str = "[serve.clients]\nleft = 'hand'\nright = 'hand'\nalice = 'command'\ncarol = 'read'\n";

fn tls(name: &str) -> String {
    format!("[serve.tls]\nauthority = 'ca.pem'\ncertificate = '{name}.pem'\nkey = '{name}.key'\n")
}

fn router(folder: &Path) -> (Router, String) {
    let names = |names: &[&str]| names.iter().map(|name| name.parse().expect("a name")).collect();
    let (servers, clients) = (names(&["router", "left", "right"]), names(&["alice", "carol"]));
    make(folder, &Wanted { servers, addresses: Vec::new(), clients }).expect("made");
    let endpoint = format!("tls/127.0.0.1:{}", free_port());
    let text = format!("[serve]\nlisten = ['{endpoint}']\n{}{CLIENTS}", tls("router"));
    let settings = Settings::from_text(&text, &folder.join("sun2xp.toml"), &Overrides::default()).expect("settings");
    (Router::start(&settings).unwrap_or_else(|error| panic!("{error}")), endpoint)
}

fn hand(folder: &Path, endpoint: &str, name: &str, certificate: &str) -> Rig {
    let text = format!("[serve]\nname = '{name}'\nconnect = ['{endpoint}']\n{}{CLIENTS}", tls(certificate));
    Rig::from_text(&text, folder, endpoint.into())
}

fn client(folder: &Path, endpoint: &str, hand: &str, name: &str) -> Client {
    let certificate = Certificate { folder, authority: "ca.pem", name };
    Client::connect_to(endpoint, hand, name, Some(certificate)).expect("connected")
}

fn found(client: &Client) -> Vec<String> {
    let replies = client.session.get(EVERY_STATUS).wait().expect("asked");
    let names = replies.into_iter().filter_map(|reply| {
        let key = reply.result().ok()?.key_expr().as_str().to_owned();
        hand_of_status(&key).map(|name| name.as_str().to_owned())
    });
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

#[test]
fn one_client_finds_and_commands_two_hands() {
    let folder = tempfile::tempdir().expect("a folder");
    let (router, endpoint) = router(folder.path());
    let hands = ["left", "right"].map(|name| hand(folder.path(), &endpoint, name, name));
    let watcher = client(folder.path(), &endpoint, "left", "carol");
    wait_for("both hands", || (found(&watcher) == ["left", "right"]).then_some(()));
    let mut owners = ["left", "right"].map(|name| client(folder.path(), &endpoint, name, "alice"));
    for owner in &mut owners {
        assert_eq!(owner.acquire_with(request(Action::Acquire)).text, "");
    }
    let goals = [[0.1, 0.5, 0.9], [0.2, 0.4, 0.8]];
    wait_for("set points of both", || {
        for (owner, goal) in owners.iter_mut().zip(goals) {
            owner.send(vec![part(1, goal)]);
        }
        (hands[0].set_point() == goals[0] && hands[1].set_point() == goals[1]).then_some(())
    });
    // Carol may read every hand, and command none.
    wait_for("a State", || watcher.state());
    let key = watcher.keys.request(Action::Acquire, &watcher.name);
    assert!(watcher.ask(&key, request(Action::Acquire).encode().expect("a Request")).is_none());
    hands.into_iter().for_each(|hand| hand.server.end());
    router.end();
}

#[test]
fn a_hand_cannot_impersonate_another_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let (router, endpoint) = router(folder.path());
    // This server has the certificate of the right hand, and says that it is the left one.
    let impostor = hand(folder.path(), &endpoint, "left", "right");
    let honest = hand(folder.path(), &endpoint, "right", "right");
    let watcher = client(folder.path(), &endpoint, "left", "carol");
    wait_for("the honest hand", || found(&watcher).contains(&"right".to_owned()).then_some(()));
    assert_eq!(found(&watcher), ["right"]);
    assert!(watcher.state().is_none());
    impostor.server.end();
    honest.server.end();
    router.end();
}
