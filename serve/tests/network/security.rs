//! Tests what each client may do, and which Targets (the messages with set points) the server takes. The server runs in
//! this process, at a loopback address.

use super::free_port::free_port;
use super::raw::{Files, Raw, joints};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use sun2xp::{Configuration, Hand};
use sun2xp_remote_protocol::{Action, Code, Finger, Request};
use sun2xp_serve::certificates::{Wanted, make};
use sun2xp_serve::server::{Server, prepare};
use sun2xp_serve::settings::{Overrides, Settings};
use tempfile::TempDir;

/// Time within which a message arrives if nothing blocks it.
const ARRIVES: Duration = Duration::from_millis(300);

/// Returns an endpoint at loopback where nobody listens.
pub fn loopback() -> String {
    format!("tcp/127.0.0.1:{}", free_port())
}

/// Returns the lines of the table [serve.clients] for clients that may command.
pub fn clients_of(names: &[&str]) -> String {
    names.iter().map(|name| format!("{name} = \"command\"\n")).collect()
}

/// Opens a simulated hand for a server with these settings. `name` must be unique in this process. With a folder of
/// certificates, the server has TLS.
pub fn simulated(name: &str, clients: &str, endpoint: &str, certificates: Option<&Path>) -> (Hand, Settings) {
    let tls = certificates.map_or(String::new(), |folder| {
        let file = |name: &str| folder.join(name).display().to_string();
        let (authority, certificate, key) = (file("ca.pem"), file("localhost.pem"), file("localhost.key"));
        format!("[serve.tls]\nauthority = \"{authority}\"\ncertificate = \"{certificate}\"\nkey = \"{key}\"\n")
    });
    let text = format!("[serve]\nlisten = [\"{endpoint}\"]\n[serve.clients]\n{clients}{tls}");
    let settings = Settings::from_text(&text, Path::new("sun2xp.toml"), &Overrides::default());
    let settings = settings.unwrap_or_else(|error| panic!("{error}"));
    let mut configuration = Configuration::default();
    configuration.telemetry.name = format!("net-{}-{name}", std::process::id());
    prepare(&mut configuration, &settings.limits);
    (Hand::open(configuration).unwrap_or_else(|error| panic!("{error}")), settings)
}

fn server(name: &str, clients: &str, endpoint: &str, certificates: Option<&Path>) -> Server {
    let (hand, settings) = simulated(name, clients, endpoint, certificates);
    Server::start(hand, settings).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn only_fresh_targets_of_the_owner_are_taken() {
    let endpoint = loopback();
    let server = server("targets", &clients_of(&["planner", "other"]), &endpoint, None);
    let mut planner = Raw::connect(&endpoint, "hand", "planner", None).expect("connected");
    planner.acquire(false).expect("an answer");
    let good = planner.target(vec![joints(1, 1, [0.1, 0.6, 0.8])]);
    planner.put(good.encode().expect("a good Target"));
    let held = sun2xp::nalgebra::Vector3::new(0.1, 0.6, 0.8);
    let set_point = || server.hand().report(1).expect("a finger").set_point.joints;
    planner.until(|_| (set_point() - held).amax() < 1e-9);
    let start = planner.status().expect("an answer").counts;
    let elsewhere = || vec![joints(1, 2, [0.3, 0.9, 0.5])];

    // Three replays: the same bytes, a sequence number that was used already, and an earlier time.
    planner.put(good.encode().expect("a good Target"));
    let mut replayed = planner.target(elsewhere());
    replayed.sequence = good.sequence;
    planner.put(replayed.encode().expect("a good Target"));
    let mut earlier = planner.target(elsewhere());
    earlier.sent = good.sent - 1;
    planner.put(earlier.encode().expect("a good Target"));
    planner.until(|status| status.counts.replayed == start.replayed + 3);

    // A Target that is older than its validity, and one from the future.
    let mut late = planner.target(elsewhere());
    late.seen -= 150_000_000;
    planner.put(late.encode().expect("a good Target"));
    planner.until(|status| status.counts.late == start.late + 1);
    let mut future = planner.target(elsewhere());
    future.seen += 3_600_000_000_000;
    planner.put(future.encode().expect("a good Target"));
    planner.until(|status| status.counts.malformed == start.malformed + 1);

    // A Target with the right epoch under the key of another client, and one with an old epoch.
    let stolen = planner.target(elsewhere());
    planner.put_as(&"other".parse().expect("a name"), stolen.encode().expect("a good Target"));
    planner.until(|status| status.counts.old_epoch == start.old_epoch + 1);
    let old = planner.target(elsewhere());
    planner.acquire(false).expect("an answer");
    planner.put(old.encode().expect("a good Target"));
    let end = planner.until(|status| status.counts.old_epoch == start.old_epoch + 2).counts;
    assert_eq!((end.refused, end.ended), (start.refused, start.ended), "{end:?}");
    let now = set_point();
    assert!((now - held).amax() < 0.05, "{now} is not {held}");
    server.end();
}

#[test]
fn a_client_that_is_not_listed_or_may_only_read_commands_nothing() {
    let endpoint = loopback();
    let server = server("readers", "planner = \"command\"\nscreen = \"read\"\n", &endpoint, None);
    let mut planner = Raw::connect(&endpoint, "hand", "planner", None).expect("connected");
    let mut screen = Raw::connect(&endpoint, "hand", "screen", None).expect("connected");
    let stranger = Raw::connect(&endpoint, "hand", "stranger", None).expect("connected");
    planner.acquire(false).expect("an answer");
    assert_eq!(screen.acquire(false).expect("an answer").code, Code::NotOwner);
    for action in [Action::Release, Action::Recover, Action::Calibrate, Action::Identify] {
        let finger = matches!(action, Action::Calibrate | Action::Identify).then(|| Finger::ALL[0]);
        for client in [&screen, &stranger] {
            assert_eq!(client.ask(action, finger).expect("an answer").code, Code::NotOwner, "{action:?}");
        }
    }
    assert_eq!(stranger.ask(Action::Stop, None).expect("an answer").code, Code::NotOwner);
    let status = planner.until(|_| true);
    assert_eq!(status.owner.map(|owner| owner.to_string()).as_deref(), Some("planner"));
    // A client that may read may also stop fingers.
    assert_eq!(screen.ask(Action::Stop, Some(Finger::ALL[0])).expect("an answer").code, Code::Done);
    server.end();
}

#[test]
fn two_planners_do_not_command_one_hand() {
    let endpoint = loopback();
    let server = server("owners", &clients_of(&["planner", "other"]), &endpoint, None);
    let mut planner = Raw::connect(&endpoint, "hand", "planner", None).expect("connected");
    let mut other = Raw::connect(&endpoint, "hand", "other", None).expect("connected");
    planner.acquire(false).expect("an answer");
    assert_eq!(other.acquire(false).expect("an answer").code, Code::Owned);
    let taken_over = other.acquire(true).expect("an answer");
    assert_eq!(taken_over.code, Code::Done);
    let before = other.until(|_| true).counts;
    planner.send(vec![joints(1, 5, [0.3, 0.9, 0.5])]);
    let after = other.until(|status| status.counts.old_epoch > before.old_epoch);
    assert_eq!(after.owner.map(|owner| owner.to_string()).as_deref(), Some("other"));
    server.end();
}

/// An authority with the certificates of a server and of clients.
fn authority(clients: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let names = |names: &[&str]| names.iter().map(|name| name.parse().expect("a name")).collect();
    let wanted =
        Wanted { servers: names(&["localhost"]), addresses: vec!["127.0.0.1".into()], clients: names(clients) };
    make(folder.path(), &wanted).unwrap_or_else(|error| panic!("{error}"));
    folder
}

/// The files of a client.
struct Certificate([PathBuf; 3]);

impl Certificate {
    fn of(folder: &TempDir, client: &str) -> Self {
        let file = |name: &str| folder.path().join(name);
        Self([file("ca.pem"), file(&format!("{client}.pem")), file(&format!("{client}.key"))])
    }

    fn files(&self) -> Files<'_> {
        let [authority, certificate, key] = &self.0;
        [authority, certificate, key]
    }
}

#[test]
fn only_certificates_of_the_authority_get_in_and_a_name_opens_only_its_own_keys() {
    let (ours, theirs) = (authority(&["planner", "screen", "stranger"]), authority(&["planner"]));
    let endpoint = loopback().replace("tcp/", "tls/");
    let clients = "planner = \"command\"\nscreen = \"read\"\n";
    let server = server("tls", clients, &endpoint, Some(ours.path()));
    let connect = |client: &str, files: Option<Files<'_>>| Raw::connect(&endpoint, "hand", client, files);

    // Three clients are refused. The first trusts another authority, and has a certificate of that authority. The
    // second trusts our authority, but has a certificate of the other one. The third has no TLS.
    let foreign = Certificate::of(&theirs, "planner");
    assert!(connect("planner", Some(foreign.files())).is_err());
    let planner = Certificate::of(&ours, "planner");
    let mixed = [planner.files()[0], foreign.files()[1], foreign.files()[2]];
    assert!(connect("planner", Some(mixed)).is_err());
    assert!(Raw::connect(&endpoint.replace("tls/", "tcp/"), "hand", "planner", None).is_err());

    // A client that the server does not list gets nothing, although its certificate is of our authority.
    let stranger = Certificate::of(&ours, "stranger");
    let stranger = connect("planner", Some(stranger.files())).expect("a certificate of the authority");
    assert!(stranger.status().is_none(), "the Status is not for strangers");

    let mut planner = connect("planner", Some(planner.files())).expect("connected");
    assert_eq!(planner.acquire(false).expect("an answer").code, Code::Done);
    let begin = Instant::now();
    while begin.elapsed() < ARRIVES || planner.states() == 0 {
        planner.send(Vec::new());
        std::thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(stranger.states(), 0, "a State has reached a stranger");

    // A reader cannot use the key of the planner, even if it knows the epoch.
    let screen = Certificate::of(&ours, "screen");
    let screen = connect("screen", Some(screen.files())).expect("connected");
    let name = "planner".parse().expect("a name");
    let acquire = Request { action: Action::Acquire, finger: None, take_over: true, recover: false, epoch: 0 };
    assert_eq!(screen.ask_as(&name, acquire), None);
    let before = planner.until(|status| status.counts.taken > 0).counts;
    let stolen = planner.target(vec![joints(1, 9, [0.3, 0.9, 0.5])]);
    screen.put_as(&name, stolen.encode().expect("a good Target"));
    let begin = Instant::now();
    while begin.elapsed() < ARRIVES {
        planner.send(Vec::new());
        std::thread::sleep(Duration::from_millis(20));
    }
    let after = planner.until(|_| true);
    assert_eq!(after.owner.map(|owner| owner.to_string()).as_deref(), Some("planner"));
    assert_eq!(after.counts.replayed, before.replayed, "the Target of the screen has arrived");
    let set_point = server.hand().report(1).expect("a finger").set_point.joints;
    assert!((set_point[1] - 0.9).abs() > 0.01, "the Target of the screen was applied");
    server.end();
}
