//! Measures whether clients delay the servos. In alternating turns, it measures the wake-up latency of the servo
//! threads with the server alone, and with two writers and ten readers as clients. One writer owns the hand. The other
//! one sends with an epoch that is not in force. The clients are processes of their own, and take processor time of
//! this machine. In a third kind of turn, the same clients are therefore connected to another server, which is a
//! process of its own. Prints Markdown.
//!
//! Real clients are on other machines, and the servos have a core of their own. On a machine with two cores, this
//! command gives the servos core 1, and everything else core 0:
//! `taskset --cpu-list 0 cargo bench -p sun2xp-serve --bench wake_up -- --servo-core 1`.

mod common;

use clap::Parser;
use common::attempts::Attempts;
use common::{Failure, Offer, configuration, hand, percentile, pose_of};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use sun2xp::RealTime;
use sun2xp::model::Fingers;
use sun2xp::realtime::CycleStage;
use sun2xp_remote_client::RemoteHand;
use sun2xp_remote_protocol::{HandKeys, Part, Place, Target};
use zenoh::Wait;

/// Pause before the measurement of a turn, after clients have started or ended.
const SETTLING: Duration = Duration::from_secs(2);

/// Largest permitted ratio of the 99.9 % latency with clients to the 99.9 % latency without clients.
const GOAL: f64 = 1.1;

#[derive(Parser)]
struct Arguments {
    /// Number of turns of each arrangement: no clients, clients at another server, and clients at the server.
    #[arg(long, default_value_t = 6)]
    turns: usize,
    /// Duration of a turn, s.
    #[arg(long, default_value_t = 10.0)]
    seconds: f64,
    /// Number of readers.
    #[arg(long, default_value_t = 10)]
    readers: usize,
    /// Core of the servos. Without this option, the kernel selects it.
    #[arg(long)]
    servo_core: Option<usize>,
    /// Without TLS.
    #[arg(long)]
    plain: bool,
    /// The role of a client or of the other server. The benchmark starts itself with this option.
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

/// Median and 99.9th percentile of the wake-up latency, us. Each is the median of the figures of the three fingers.
type WakeUp = [f64; 2];

fn main() -> Result<(), Failure> {
    let arguments = Arguments::parse();
    if let (Some(role), Some(endpoint)) = (&arguments.role, &arguments.endpoint) {
        return client(role, endpoint, arguments.folder.as_deref());
    }
    if arguments.role.is_some() {
        return offer_until_input_ends(!arguments.plain);
    }
    let (mut measured, mut attempts) = (Vec::new(), Attempts::default());
    for _ in 0..arguments.turns {
        measured.extend(attempts.measure("a turn of each arrangement", || neighbours(&arguments)));
    }
    print(&arguments, &measured, &attempts);
    Ok(attempts.check([("the clients", measured.len())])?)
}

/// Starts two servers, and measures three neighbouring turns: without clients, with clients at another server, and with
/// clients at the server. These turns are repeated together, so that a ratio compares turns at nearly the same time.
fn neighbours(arguments: &Arguments) -> Result<[WakeUp; 3], Failure> {
    let other = Other::start(arguments.plain)?;
    let mut configuration = hand(1000.0, Fingers::ALL);
    configuration.fingers.iter_mut().for_each(|finger| finger.core = arguments.servo_core);
    let offer = Offer::new(!arguments.plain, configuration)?;
    let alone = measure(&offer, arguments.seconds)?;
    let with_clients = |endpoint: &str, folder: Option<&str>| {
        let mut clients = Clients::start(endpoint, folder, arguments.readers)?;
        let measured = measure(&offer, arguments.seconds)?;
        clients.check()?;
        Ok::<_, Failure>(measured)
    };
    let elsewhere = with_clients(&other.endpoint, other.folder.as_deref())?;
    let watched = with_clients(&offer.endpoint, offer.folder().and_then(Path::to_str))?;
    Ok([alone, elsewhere, watched])
}

fn print(arguments: &Arguments, measured: &[[WakeUp; 3]], attempts: &Attempts) {
    let turns = measured.len();
    println!("| wake-up of the servos, {turns} turns of {} s | 50 % | 99.9 % |", arguments.seconds);
    println!("|---|---|---|");
    let clients = format!("two writers and {} readers", arguments.readers);
    let names = ["server alone".to_owned(), format!("{clients}, at another server"), clients];
    for (side, name) in names.iter().enumerate() {
        if measured.is_empty() {
            println!("| {name} | not measured, because every measurement failed or was skipped | |");
            continue;
        }
        let [median, p999] = [0, 1].map(|which| middle(measured.iter().map(|turn| turn[side][which])));
        println!("| {name} | {median:.1} us | {p999:.1} us |");
    }
    println!("\n{attempts}.");
    if !measured.is_empty() {
        let [alone, elsewhere] = [0, 1].map(|side| middle(measured.iter().map(|turn| turn[2][1] / turn[side][1])));
        println!("Ratio of the 99.9 % with the clients to the 99.9 % of a neighbouring turn, median of all turns:");
        println!("{alone:.2} relative to the server alone (goal: at most {GOAL}),");
        println!("{elsewhere:.2} relative to clients at another server");
    }
}

fn middle(values: impl Iterator<Item = f64>) -> f64 {
    percentile(&values.collect::<Vec<_>>(), 0.5)
}

/// Measures the wake-ups in one turn. The servo of a finger that has stopped does less work, so a turn in which a
/// finger has stopped is an error.
fn measure(offer: &Offer, seconds: f64) -> Result<WakeUp, Failure> {
    sleep(SETTLING);
    let fingers = 1..=3;
    fingers.clone().try_for_each(|finger| offer.hand().reset_timing(finger))?;
    sleep(Duration::from_secs_f64(seconds));
    let wake = fingers.map(|finger| offer.hand().timing(finger, CycleStage::WakeUp)).collect::<Result<Vec<_>, _>>()?;
    offer.check()?;
    Ok([middle(wake.iter().map(|wake| wake.median)), middle(wake.iter().map(|wake| wake.p999))])
}

/// A server in a process of its own, whose servos are not real-time. Dropping this value ends the server.
struct Other {
    child: Child,
    endpoint: String,
    /// The folder with the certificates.
    folder: Option<String>,
}

impl Other {
    fn start(plain: bool) -> Result<Self, Failure> {
        let mut command = Command::new(std::env::current_exe()?);
        command.args(["--role", "server"]).args(plain.then_some("--plain")).stdin(Stdio::piped());
        let mut child = command.stdout(Stdio::piped()).spawn()?;
        let mut lines = BufReader::new(child.stdout.take().expect("its standard output is a pipe")).lines();
        let mut other = Self { child, endpoint: String::new(), folder: None };
        let mut line = || lines.next().ok_or("the other server did not start: standard error has its message");
        other.endpoint = line()??;
        other.folder = if plain { None } else { Some(line()??) };
        Ok(other)
    }
}

impl Drop for Other {
    fn drop(&mut self) {
        // The server ends at the end of its input. If it has ended already, it has printed why.
        drop(self.child.stdin.take());
        let _ = self.child.wait();
    }
}

/// The server of [`Other`]. Prints its endpoint, and the folder with its certificates.
fn offer_until_input_ends(tls: bool) -> Result<(), Failure> {
    let mut configuration = hand(1000.0, Fingers::ALL);
    configuration.hand.real_time = RealTime::Ignore;
    let offer = Offer::new(tls, configuration)?;
    println!("{}", offer.endpoint);
    if let Some(folder) = offer.folder() {
        println!("{}", folder.display());
    }
    // The input has no lines, so this call returns when the input ends.
    let _ = std::io::stdin().read_line(&mut String::new());
    Ok(())
}

/// The processes of the clients. Dropping this value ends them.
struct Clients(Vec<Child>);

impl Clients {
    fn start(endpoint: &str, folder: Option<&str>, readers: usize) -> Result<Self, Failure> {
        let mut clients = Self(Vec::new());
        for role in ["owner", "old-epoch"].into_iter().chain(std::iter::repeat_n("reader", readers)) {
            let mut command = Command::new(std::env::current_exe()?);
            command.args(["--role", role, "--endpoint", endpoint]).stdin(Stdio::null());
            if let Some(folder) = folder {
                command.arg("--folder").arg(folder);
            }
            clients.0.push(command.spawn()?);
        }
        Ok(clients)
    }

    /// Checks that no client has ended.
    fn check(&mut self) -> Result<(), Failure> {
        for child in &mut self.0 {
            if child.try_wait()?.is_some() {
                return Err("a client has ended early: standard error has its message".into());
            }
        }
        Ok(())
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

/// Runs a client until it is killed. The owner also ends if its hand refuses a call.
fn client(role: &str, endpoint: &str, folder: Option<&str>) -> Result<(), Failure> {
    match role {
        "owner" => {
            let hand = common::remote(endpoint, folder)?;
            let begun = Instant::now();
            for number in 0.. {
                let sent = hand.send_position(1, pose_of(number));
                sent.map_err(|error| format!("after {:.1} s: {error}", begun.elapsed().as_secs_f64()))?;
                sleep(Duration::from_millis(10));
            }
            Ok(())
        }
        "old-epoch" => send_old_epoch(endpoint, folder),
        _ => {
            let hand = RemoteHand::watch(&configuration(endpoint, "carol", folder)?)?;
            loop {
                sleep(Duration::from_millis(100));
                // The call fails if other work has delayed the newest State. The reader receives every State all the
                // same.
                let _ = hand.position(1);
            }
        }
    }
}

/// Sends Targets with an epoch that is not in force, 100 times a second.
fn send_old_epoch(endpoint: &str, folder: Option<&str>) -> Result<(), Failure> {
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
    let session = zenoh::open(config).wait().map_err(|error| error.to_string())?;
    let key = HandKeys::new("hand".parse().expect("a name")).target(&"bob".parse().expect("a name"));
    let finger = sun2xp_remote_protocol::Finger::new(1).expect("a finger");
    for sequence in 1.. {
        let place = Place::Joints(pose_of(0));
        let part = Part { finger, command: 1, place, stiffness: None, damping: None };
        let target = Target { validity_ms: 100, epoch: 7, sequence, sent: sequence, seen: 1, parts: vec![part] };
        let put = session.put(&key, target.encode().expect("a Target")).wait();
        put.map_err(|error| error.to_string())?;
        sleep(Duration::from_millis(10));
    }
    Ok(())
}
