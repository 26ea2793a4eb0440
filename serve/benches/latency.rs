//! Time from SendPos on a client to the motor command that is computed from it, over loopback. The client is a process
//! of its own. Prints Markdown.

mod common;

use clap::Parser;
use common::attempts::Attempts;
use common::{Failure, Offer, hand, percentile, pose_of};
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
    /// The endpoint to which the client connects. The benchmark starts itself as the client with this option.
    #[arg(long, hide = true)]
    client: Option<String>,
    /// The folder with the certificates of the client.
    #[arg(long, hide = true)]
    folder: Option<String>,
    /// Given by `cargo bench`.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> Result<(), Failure> {
    let arguments = Arguments::parse();
    if let Some(endpoint) = &arguments.client {
        return client(&arguments, endpoint);
    }
    let (mut measured, mut attempts) = (Measured::default(), Attempts::default());
    attempts.measure("SendPos to the motor command", || measured.with_new_server(&arguments));
    print(&arguments, &measured);
    println!("\n{attempts}.");
    Ok(attempts.check([("the client", measured.latencies.len())])?)
}

/// The set points so far.
#[derive(Default)]
struct Measured {
    /// Number of set points that were sent.
    sent: u32,
    /// Times from a SendPos to its motor command, us.
    latencies: Vec<f64>,
}

impl Measured {
    /// Offers a hand, and lets a client send the set points that are left. If the client or the hand fails, the earlier
    /// set points stay measured.
    fn with_new_server(&mut self, arguments: &Arguments) -> Result<(), Failure> {
        let fingers = if arguments.whole_hand { Fingers::ALL } else { Fingers::only(1)? };
        let offer = Offer::new(!arguments.plain, hand(arguments.rate, fingers))?;
        let mut command = Command::new(std::env::current_exe()?);
        let left = arguments.samples - self.sent;
        command.args(["--client", &offer.endpoint, "--samples", &left.to_string()]);
        if let Some(folder) = offer.folder() {
            command.arg("--folder").arg(folder);
        }
        let mut child = command.stdout(Stdio::piped()).spawn()?;
        let output = BufReader::new(child.stdout.take().expect("its standard output is a pipe"));
        let reading = std::thread::spawn(move || output.lines().map_while(Result::ok).collect::<Vec<_>>());
        let records = records_until(&offer, || reading.is_finished());
        let status = child.wait()?;
        let sent = reading.join().map_err(|_| "the reading thread panicked: standard error has its message")?;
        let sent = sent.iter().map(|line| line.parse()).collect::<Result<Vec<u64>, _>>()?;
        self.sent += sent.len() as u32;
        self.latencies.extend(latencies(&sent, &records?));
        if status.success() { Ok(()) } else { Err("the client has ended early: standard error has its message".into()) }
    }
}

/// Collects the records of finger 1 until `ended` returns true.
fn records_until(offer: &Offer, ended: impl Fn() -> bool) -> Result<Vec<CycleRecord>, Failure> {
    let mut records = Vec::new();
    let mut last = offer.hand().report(1)?.losses.cycles;
    loop {
        let finished = ended();
        offer.hand().records_after(1, last, &mut records)?;
        last = records.last().map_or(last, |record: &CycleRecord| record.cycle);
        if finished {
            return Ok(records);
        }
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// Returns the time from each SendPos to the beginning of the exchange that sends its motor command to the board, us.
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

fn print(arguments: &Arguments, measured: &Measured) {
    let Measured { sent, latencies } = measured;
    let link = if arguments.plain { "TCP" } else { "TLS" };
    let goal = 2e6 / arguments.rate + 1000.0;
    let found = latencies.len();
    println!(
        "| SendPos to the motor command, loopback {link}, {} Hz | 50 % | 99 % | 99.9 % | goal, 99 % |",
        arguments.rate
    );
    println!("|---|---|---|---|---|");
    if latencies.is_empty() {
        println!("| not measured, because every measurement failed or was skipped | | | | {goal:.0} us |");
        return;
    }
    let [median, p99, p999] = [0.5, 0.99, 0.999].map(|part| percentile(latencies, part));
    println!("| {found} of {sent} set points | {median:.0} us | {p99:.0} us | {p999:.0} us | {goal:.0} us |");
}

/// Sends set points at times that are spread over the servo's period, and prints these times. If the hand refuses a set
/// point, prints the times of the earlier ones.
fn client(arguments: &Arguments, endpoint: &str) -> Result<(), Failure> {
    let hand = common::remote(endpoint, arguments.folder.as_deref())?;
    let mut sent = Vec::new();
    let all = (0..arguments.samples).try_for_each(|number| -> Result<(), Failure> {
        std::thread::sleep(Duration::from_micros(8000 + u64::from(number * 137 % 1000)));
        let time = now();
        hand.send_position(1, pose_of(number))?;
        sent.push(time);
        Ok(())
    });
    std::thread::sleep(Duration::from_millis(100));
    for time in sent {
        println!("{time}");
    }
    all
}
