//! Access control with mutual TLS: the name of a client is the common name of its certificate.

mod common;

use common::client::{Certificate, part, request};
use common::{CLIENTS, Client, Rig, free_port, wait_for};
use std::path::Path;
use sun2xp_remote_client::{RemoteConfiguration, RemoteHand};
use sun2xp_remote_protocol::{Action, Code};
use sun2xp_serve::certificates::{Wanted, make};

fn certificates(folder: &Path, clients: &[&str]) {
    let clients = clients.iter().map(|name| name.parse().expect("a name")).collect();
    let servers = vec!["server".parse().expect("a name")];
    make(folder, &Wanted { servers, addresses: Vec::new(), clients }).expect("made");
}

fn rig(folder: &Path) -> Rig {
    let endpoint = format!("tls/127.0.0.1:{}", free_port());
    let files = "authority = 'ca.pem'\ncertificate = 'server.pem'\nkey = 'server.key'\n";
    let text = format!("[serve]\nlisten = ['{endpoint}']\nend_ms = 20000\n[serve.tls]\n{files}{CLIENTS}");
    Rig::from_text(&text, folder, endpoint)
}

fn connect(rig: &Rig, name: &str, folder: &Path, certificate: &str) -> Result<Client, String> {
    let certificate = Certificate { folder, authority: "ca.pem", name: certificate };
    Client::connect(&rig.endpoint, name, Some(certificate))
}

#[test]
fn a_client_may_use_only_the_zenoh_keys_of_the_name_in_its_certificate() {
    let folder = tempfile::tempdir().expect("a folder");
    certificates(folder.path(), &["alice", "bob", "carol", "mallory"]);
    let rig = rig(folder.path());
    let connected = |name: &str, certificate: &str| connect(&rig, name, folder.path(), certificate).expect("connected");
    let mut alice = connected("alice", "alice");
    assert_eq!(alice.acquire_with(request(Action::Acquire)).text, "");
    let goal = [0.1, 0.5, 0.9];
    let in_force = || (rig.set_point() == goal).then_some(());
    alice.repeat_until(&[part(1, goal)], "set point", |_| in_force());

    // Bob connects with his own certificate, and uses alice's name and epoch. None of his messages reaches the server.
    let bob = connected("alice", "bob");
    let key = bob.keys.request(Action::Stop, &alice.name);
    assert!(bob.ask(&key, request(Action::Stop).encode().expect("a Request")).is_none());
    let mut forged = alice.target(vec![part(2, [0.4, 0.4, 0.4])]);
    forged.sequence += 1_000_000;
    for key in [bob.keys.target(&alice.name), "sun2xp/hand/target/*".into()] {
        bob.publish_under(&key, forged.encode().expect("a Target"));
    }
    // Mallory has a certificate of the same authority, but the server's configuration does not list mallory.
    let mallory = connected("mallory", "mallory");
    let stop = mallory.keys.request(Action::Stop, &mallory.name);
    assert!(mallory.ask(&stop, request(Action::Stop).encode().expect("a Request")).is_none());
    assert!(mallory.status().is_none());
    // Carol may read and stop, but not acquire.
    let carol = connected("carol", "carol");
    let acquire = carol.keys.request(Action::Acquire, &carol.name);
    assert!(carol.ask(&acquire, request(Action::Acquire).encode().expect("a Request")).is_none());
    wait_for("a State", || carol.state());
    assert!(mallory.state().is_none(), "mallory reads nothing, although carol does");
    // None of these messages has changed a set point, and alice still commands.
    let next = [0.15, 0.5, 0.9];
    alice.repeat_until(&[part(2, next)], "set point", |_| (rig.set_point() == next).then_some(()));
    assert_eq!(carol.request(request(Action::Stop)).code, Code::Done);
    rig.server.end();
}

#[test]
fn the_client_of_the_project_commands_with_its_certificate() {
    let folder = tempfile::tempdir().expect("a folder");
    certificates(folder.path(), &["alice"]);
    let rig = rig(folder.path());
    let text = format!(
        "[remote]\nendpoint = '{}'\nhand = 'hand'\n[remote.tls]\nauthority = 'ca.pem'\ncertificate = 'alice.pem'\n\
         key = 'alice.key'\n",
        rig.endpoint
    );
    let configuration = RemoteConfiguration::from_text(&text, folder.path()).expect("usable").expect("a table");
    let hand = RemoteHand::open(&configuration).unwrap_or_else(|error| panic!("{error}"));
    hand.send_position(1, [0.1, 0.5, 0.9]).expect("sent");
    wait_for("set point", || (rig.set_point() == [0.1, 0.5, 0.9]).then_some(()));
    hand.close().expect("released");
    rig.server.end();
}

#[test]
fn a_certificate_of_another_authority_does_not_connect() {
    let (folder, other) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    certificates(folder.path(), &["alice"]);
    certificates(other.path(), &["alice"]);
    let rig = rig(folder.path());
    // The client with the certificate "foreign" trusts the server. The certificate has alice's name, but another
    // authority has signed it.
    for file in ["alice.pem", "alice.key"] {
        let own = other.path().join(file);
        std::fs::copy(own, folder.path().join(format!("foreign{}", &file[5..]))).expect("copied");
    }
    assert!(connect(&rig, "alice", folder.path(), "foreign").is_err());
    // A client does not trust a server of another authority.
    assert!(connect(&rig, "alice", other.path(), "alice").is_err());
    let plain = rig.endpoint.replace("tls/", "tcp/");
    assert!(Client::connect(&plain, "alice", None).is_err(), "without TLS");
    assert!(connect(&rig, "alice", folder.path(), "alice").is_ok());
    rig.server.end();
}
