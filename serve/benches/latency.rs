//! Time from SendPos on a client to the motor command that is computed from it, over loopback. The client is a process
//! of its own. Prints Markdown.

mod common;

use clap::Parser;
use common::{Offer, hand, percentile, pose_of};
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::time::Duration;
use sun2xp::control::Activity;
use sun2xp::finger::CycleRecord;
use sun2xp::model::Fingers;
use sun2xp::realtime::now;

#[derive(Parser)]
struct Arguments {
    /// Number of set points.
    #[arg(long, default_value_t = 2000)]
    samples: u32,
    /// Rate of the servos, Hz.
    #[arg(long, default_value_t = 1000.0)]
    rate: f64,
    /// With three fingers. Their simulated boards need processor time that real boards do not need.
    #[arg(long)]
    whole_hand: bool,
    /// Without TLS.
    #[arg(long)]
    plain: bool,
    /// The endpoint to which the client connects. The benchmark uses it when it starts itself as the client.
    #[arg(long, hide = true)]
    client: Option<String>,
    /// The folder with the certificates of the client.
    #[arg(long, hide = true)]
    folder: Option<String>,
    /// Given by `cargo bench`.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() {
    let arguments = Arguments::parse();
    if let Some(endpoint) = &arguments.client {
        return client(&arguments, endpoint);
    }
    let fingers = if arguments.whole_hand { Ok(Fingers::ALL) } else { Fingers::only(1) };
    let offer = Offer::new(!arguments.plain, hand(arguments.rate, fingers.expect("a finger")));
    let mut command = Command::new(std::env::current_exe().expect("this program"));
    command.args(["--client", &offer.endpoint, "--samples", &arguments.samples.to_string()]);
    if let Some(folder) = offer.folder() {
        command.arg("--folder").arg(folder);
    }
    let mut child = command.stdout(Stdio::piped()).spawn().expect("a client");
    let output = BufReader::new(child.stdout.take().expect("its output"));
    let reading = std::thread::spawn(move || output.lines().map_while(Result::ok).collect::<Vec<_>>());
    let mut records = Vec::new();
    let mut last = offer.hand().report(1).expect("finger 1").losses.cycles;
    while !reading.is_finished() {
        offer.hand().records_after(1, last, &mut records).expect("finger 1");
        last = records.last().map_or(last, |record: &CycleRecord| record.cycle);
        std::thread::sleep(Duration::from_millis(50));
    }
    offer.hand().records_after(1, last, &mut records).expect("finger 1");
    child.wait().expect("the client");
    let sent: Vec<u64> = reading.join().expect("read").iter().map(|line| line.parse().expect("a time")).collect();
    print(&arguments, &latencies(&sent, &records));
    offer.end();
}

/// Returns the times from each SendPos to the beginning of the exchange with its motor command, us.
fn latencies(sent: &[u64], records: &[CycleRecord]) -> Vec<f64> {
    let mut found = Vec::new();
    let mut from = 0;
    for (number, &sent) in sent.iter().enumerate() {
        let wanted = pose_of(number as u32);
        let first =
            records[from..].iter().position(|record| match record.control.map(|control| control.input.activity) {
                Some(Activity::Follow(set_point)) => <[f64; 3]>::from(set_point.joints) == wanted,
                _ => false,
            });
        // The command is computed in this cycle, and goes to the board at the beginning of the next one.
        if let Some(next) = first.map(|first| from + first + 1).filter(|&next| next < records.len()) {
            from = next;
            found.push((records[next].began as f64 - sent as f64) * 1e-3);
        }
    }
    found
}

fn print(arguments: &Arguments, latencies: &[f64]) {
    let link = if arguments.plain { "TCP" } else { "TLS" };
    let goal = 2e6 / arguments.rate + 1000.0;
    let found = latencies.len();
    println!(
        "| SendPos to the motor command, loopback {link}, {} Hz | 50 % | 99 % | 99.9 % | goal, 99 % |",
        arguments.rate
    );
    println!("|---|---|---|---|---|");
    let [median, p99, p999] = [0.5, 0.99, 0.999].map(|part| percentile(latencies, part));
    println!(
        "| {found} of {} set points | {median:.0} us | {p99:.0} us | {p999:.0} us | {goal:.0} us |",
        arguments.samples
    );
}

/// Sends set points at intervals that fall on every phase of the servo's period, and prints when it sent them.
fn client(arguments: &Arguments, endpoint: &str) {
    let hand = common::remote(endpoint, arguments.folder.as_deref());
    let mut sent = Vec::new();
    for number in 0..arguments.samples {
        std::thread::sleep(Duration::from_micros(8000 + u64::from(number * 137 % 1000)));
        sent.push(now());
        hand.send_position(1, pose_of(number)).expect("sent");
    }
    std::thread::sleep(Duration::from_millis(100));
    for time in sent {
        println!("{time}");
    }
}
