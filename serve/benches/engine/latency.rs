//! The round trip of a message, with and without load.

use crate::link::{ANSWER, Engine, Link};
use crate::percentiles::{Percentiles, median};
use crate::{Failure, LENGTH, certificates, echo, load};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Goal under load: the 99th percentile of an engine with Zenoh is at most this multiple of the 99th percentile of its
/// [`Engine::baseline`], the engine without Zenoh that protects the messages in the same way.
const GOAL: f64 = 3.0;

/// Measures the round trip of a message of 200 bytes.
#[derive(clap::Args)]
pub struct Arguments {
    /// Number of measurements of each engine.
    #[arg(long, default_value_t = Self::default().repeats)]
    repeats: usize,
    /// Duration of each measurement, s.
    #[arg(long, default_value_t = Self::default().seconds)]
    seconds: u64,
    /// Time from one message to the next, us. With 0, each message is sent as soon as the previous answer has arrived.
    #[arg(long, default_value_t = Self::default().period_us)]
    period_us: u64,
}

impl Default for Arguments {
    fn default() -> Self {
        Self { repeats: 5, seconds: 5, period_us: 1000 }
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let folder = tempfile::tempdir()?;
    certificates::write(folder.path())?;
    let mut servers = Vec::new();
    let mut links = Vec::new();
    for engine in Engine::ALL {
        let (child, port) = echo::start(engine, folder.path())?;
        links.push((engine, engine.connect(port, folder.path())?));
        servers.push(child);
    }
    println!("| load | engine | median | 99 % | 99.9 % | ratio at 99 % | goal |\n|---|---|---|---|---|---|---|");
    for (name, busy) in [("none", false), ("every core", true)] {
        let _load = if busy { Some(load::start()?) } else { None };
        let measured = measure(arguments, &mut links)?;
        print(name, busy, &measured);
    }
    println!(
        "\nRound trips of {LENGTH} bytes, one every {} us. Medians over {} repeats of {} s. The ratio is to the engine \
         without Zenoh that protects the messages in the same way.\n",
        arguments.period_us, arguments.repeats, arguments.seconds
    );
    Ok(())
}

/// Returns the percentiles of every repeat, for each engine. The engines take turns.
fn measure(
    arguments: &Arguments,
    links: &mut [(Engine, Box<dyn Link>)],
) -> Result<Vec<(Engine, Vec<Percentiles>)>, Failure> {
    let mut measured: Vec<_> = links.iter().map(|(engine, _)| (*engine, Vec::new())).collect();
    for _ in 0..arguments.repeats {
        for ((_, link), (_, turns)) in links.iter_mut().zip(&mut measured) {
            turns.push(Percentiles::of(round_trips(arguments, link.as_mut())?));
        }
    }
    Ok(measured)
}

/// Returns the times of round trips, ns.
fn round_trips(arguments: &Arguments, link: &mut dyn Link) -> Result<Vec<u64>, Failure> {
    let message = [ANSWER; LENGTH];
    let period = Duration::from_micros(arguments.period_us);
    let end = Instant::now() + Duration::from_secs(arguments.seconds);
    let mut times = Vec::new();
    let mut next = Instant::now();
    while next < end {
        sleep(next.saturating_duration_since(Instant::now()));
        let sent = Instant::now();
        link.round_trip(&message)?;
        times.push(sent.elapsed().as_nanos() as u64);
        // After a late answer, the messages that were due in the meantime are skipped.
        next = (next + period).max(Instant::now());
    }
    Ok(times)
}

fn print(load: &str, busy: bool, measured: &[(Engine, Vec<Percentiles>)]) {
    let figure = |engine: Engine, part: fn(&Percentiles) -> f64| {
        median(measured.iter().filter(|(other, _)| *other == engine).flat_map(|(_, turns)| turns.iter().map(part)))
    };
    for (engine, _) in measured {
        let p50 = figure(*engine, |turn| turn.median);
        let p99 = figure(*engine, |turn| turn.p99);
        let p999 = figure(*engine, |turn| turn.p999);
        let baseline = engine.baseline();
        let ratio = p99 / figure(baseline, |turn| turn.p99);
        let goal = if busy && *engine != baseline { format!("<= {GOAL}") } else { String::new() };
        println!("| {load} | {} | {p50:.1} us | {p99:.1} us | {p999:.1} us | {ratio:.2} | {goal} |", engine.name());
    }
}
