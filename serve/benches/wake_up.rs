//! Whether clients delay the servos: the wake-up of the servo threads with two writers and ten readers, against the
//! server alone, in alternating turns. One writer owns the hand. The other one sends with an epoch that is not in
//! force. The clients are processes of their own. Prints Markdown.
//!
//! On the hand's machine, real clients take no processor time, and its servos have a core of their own. With two cores:
//! `taskset --cpu-list 0 cargo bench -p sun2xp-serve --bench wake_up -- --servo-core 1`.

mod common;

use clap::Parser;
use common::{Offer, configuration, percentile, pose_of};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use sun2xp::model::Fingers;
use sun2xp::realtime::CycleStage;
use sun2xp_remote_client::RemoteHand;
use sun2xp_remote_protocol::{HandKeys, Part, Place, Target};
use zenoh::Wait;

/// Time after clients have started or ended that is not measured.
const SETTLING: Duration = Duration::from_secs(2);

/// Largest ratio of the latency with clients to that without.
const GOAL: f64 = 1.1;

#[derive(Parser)]
struct Arguments {
    /// Number of turns of each side.
    #[arg(long, default_value_t = 6)]
    turns: usize,
    /// Duration of a turn, s.
    #[arg(long, default_value_t = 10.0)]
    seconds: f64,
    /// Number of readers.
    #[arg(long, default_value_t = 10)]
    readers: usize,
    /// Core of the servos. With none, the kernel selects it.
    #[arg(long)]
    servo_core: Option<usize>,
    /// Without TLS.
    #[arg(long)]
    plain: bool,
    /// The role of a client. The benchmark starts itself with it.
    #[arg(long, hide = true)]
    role: Option<String>,
    #[arg(long, hide = true)]
    endpoint: Option<String>,
    #[arg(long, hide = true)]
    folder: Option<String>,
    /// Given by `cargo bench`.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() {
    let arguments = Arguments::parse();
    if let (Some(role), Some(endpoint)) = (&arguments.role, &arguments.endpoint) {
        return client(role, endpoint, arguments.folder.as_deref());
    }
    let offer = Offer::new(!arguments.plain, 1000.0, Fingers::ALL, arguments.servo_core);
    let (mut alone, mut watched) = (Vec::new(), Vec::new());
    for _ in 0..arguments.turns {
        alone.push(measure(&offer, arguments.seconds));
        let clients = Clients::start(&offer, arguments.readers);
        watched.push(measure(&offer, arguments.seconds));
        drop(clients);
    }
    println!("| wake-up of the servos, {} turns of {} s | 50 % | 99.9 % |", arguments.turns, arguments.seconds);
    println!("|---|---|---|");
    let row = |name: &str, side: &[[f64; 2]]| {
        let [median, p999] = [0, 1].map(|which| middle(side.iter().map(|turn| turn[which])));
        println!("| {name} | {median:.1} us | {p999:.1} us |");
    };
    row("server alone", &alone);
    row(&format!("two writers and {} readers", arguments.readers), &watched);
    let ratio = middle(alone.iter().zip(&watched).map(|(alone, watched)| watched[1] / alone[1]));
    println!("\nMedian ratio of neighbouring turns, 99.9 %: {ratio:.2} (goal: at most {GOAL})");
    offer.end();
}

fn middle(values: impl Iterator<Item = f64>) -> f64 {
    percentile(&values.collect::<Vec<_>>(), 0.5)
}

/// Median and 99.9 % of the wake-ups of all fingers in one turn, us.
fn measure(offer: &Offer, seconds: f64) -> [f64; 2] {
    sleep(SETTLING);
    (1..=3).for_each(|finger| offer.hand().reset_timing(finger).expect("reset"));
    sleep(Duration::from_secs_f64(seconds));
    let wake = [1, 2, 3].map(|finger| offer.hand().timing(finger, CycleStage::WakeUp).expect("times"));
    [middle(wake.iter().map(|wake| wake.median)), middle(wake.iter().map(|wake| wake.p999))]
}

/// The processes of the clients. Dropping them ends them.
struct Clients(Vec<Child>);

impl Clients {
    fn start(offer: &Offer, readers: usize) -> Self {
        let roles = ["owner", "late"].into_iter().chain(std::iter::repeat_n("reader", readers));
        let children = roles.map(|role| {
            let mut command = Command::new(std::env::current_exe().expect("this program"));
            command.args(["--role", role, "--endpoint", &offer.endpoint]).stdin(Stdio::null());
            if let Some(folder) = offer.folder() {
                command.arg("--folder").arg(folder);
            }
            command.spawn().expect("a client")
        });
        Self(children.collect())
    }
}

impl Drop for Clients {
    fn drop(&mut self) {
        for child in &mut self.0 {
            // A client that has ended already has printed why.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// Runs a client until it is killed.
fn client(role: &str, endpoint: &str, folder: Option<&str>) {
    match role {
        "owner" => {
            let hand = common::remote(endpoint, folder);
            let begun = Instant::now();
            for number in 0.. {
                if let Err(error) = hand.send_position(1, pose_of(number)) {
                    eprintln!("after {:.1} s: {error}", begun.elapsed().as_secs_f64());
                    return;
                }
                sleep(Duration::from_millis(10));
            }
        }
        "late" => late(endpoint, folder),
        _ => {
            let hand = RemoteHand::watch(&configuration(endpoint, "carol", folder)).expect("a hand");
            loop {
                sleep(Duration::from_millis(100));
                hand.position(1).expect("a position");
            }
        }
    }
}

/// Sends Targets with an epoch that is not in force, 100 times a second.
fn late(endpoint: &str, folder: Option<&str>) {
    let mut config = zenoh::Config::default();
    let mut set = |key: &str, value: String| config.insert_json5(key, &value).expect("a key of zenoh");
    set("mode", "\"client\"".into());
    set("connect/endpoints", format!("[\"{endpoint}\"]"));
    set("scouting/multicast/enabled", "false".into());
    if let Some(folder) = folder {
        let tls = format!(
            r#"{{"root_ca_certificate":"{folder}/ca.pem","enable_mtls":true,
                "connect_certificate":"{folder}/bob.pem","connect_private_key":"{folder}/bob.key"}}"#
        );
        set("transport/link/tls", tls);
    }
    let session = zenoh::open(config).wait().expect("connected");
    let key = HandKeys::new("hand".parse().expect("a name")).target(&"bob".parse().expect("a name"));
    let finger = sun2xp_remote_protocol::Finger::new(1).expect("a finger");
    for sequence in 1.. {
        let place = Place::Joints(pose_of(0));
        let part = Part { finger, command: 1, place, stiffness: None, damping: None };
        let target = Target { validity_ms: 100, epoch: 7, sequence, sent: sequence, seen: 1, parts: vec![part] };
        session.put(&key, target.encode().expect("a Target")).wait().expect("published");
        sleep(Duration::from_millis(10));
    }
}
