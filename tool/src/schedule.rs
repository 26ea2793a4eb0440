//! `sun2xp schedule`: computes whether every cycle of a configured hand meets its deadline, the highest possible rate,
//! and the cost of another sensor.

mod off_line;

use crate::failure::Failure;
use off_line::{Costs, RateLimit, Scheduled, Sensor, fastest_rate, off_line_schedule, touches};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;
use sun2xp::files::read_regular_file;
use sun2xp::hand::{self, Hand};
use sun2xp::model::FingerNumber;
use sun2xp::model::ShownPath;
use sun2xp::model::configuration::{Configuration, RATES};
use sun2xp::realtime::{CycleStage, Distribution};
use sun2xp::reflexes::{Condition, MOST_RULES, Reaction, Reflex};

/// Maximum size of the file that --costs names, bytes. The file contains four numbers.
const LARGEST_COSTS: u64 = 1 << 16;

/// Computes whether every cycle of the hand meets its deadline, from worst-case times, line times and the allocation of
/// the fingers.
///
/// The worst cases of this machine are measured on the simulated hand, with the rate, threads, cores and priorities of
/// the configuration. With --costs they are read from a TOML file with the keys `wake_up`, `write` (the commands of one
/// port), `read` (receive and decode one reply) and `compute` (one finger), all in us. The measured computing time
/// includes 16 reflexes of each finger, of which one reacts in every cycle. Lines are as configured; a simulated port
/// counts as a serial line of its baud rate. The results hold for any phases of the threads. The exit status is 1 if a
/// deadline may be missed.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration file. The default is the file that OpenHand would use.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Read the worst cases from a file instead of measuring them.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["measure", "p999"])]
    costs: Option<PathBuf>,
    /// Duration of the measurement, s.
    #[arg(
        long,
        value_name = "SECONDS",
        default_value_t = 10,
        value_parser = clap::value_parser!(u64).range(1..=86_400)
    )]
    measure: u64,
    /// Use the 99.9 % value of each cost instead of its maximum. On a virtual machine every maximum includes a pause of
    /// the whole machine.
    #[arg(long)]
    p999: bool,
    /// Another sensor: additional bytes in each reply.
    #[arg(long, value_name = "N", default_value_t = 16)]
    sensor_bytes: usize,
    /// Another sensor: additional computing time per finger, us.
    #[arg(long, value_name = "US", default_value_t = 20.0, value_parser = not_negative)]
    sensor_compute: f64,
}

fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if f64::is_finite(number) && number >= 0.0 => Ok(number),
        _ => Err("not a number of 0 or more".into()),
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let configuration = match &arguments.config {
        Some(file) => hand::read_configuration(file)?,
        None => hand::find_configuration()?.configuration,
    };
    let costs = match &arguments.costs {
        Some(file) => read(file)?,
        None => measure(&configuration, arguments)?,
    };
    let none = Sensor::default();
    let sensor = Sensor { bytes: arguments.sensor_bytes, compute: arguments.sensor_compute };
    let rate = configuration.hand.rate;
    let schedule = off_line_schedule(&configuration, rate, &costs, &none);
    let more = off_line_schedule(&configuration, rate, &costs, &sensor);

    let mut out = io::stdout().lock();
    let Costs { wake_up, write, read, compute } = costs;
    writeln!(out, "Worst cases, us: wake-up {wake_up:.1}, write {write:.1}, read {read:.1}, compute {compute:.1}\n")?;
    table(&mut out, &schedule, &format!("{rate:.0} Hz"))?;
    let title = format!("{rate:.0} Hz with {} more bytes and {:.0} us more per finger", sensor.bytes, sensor.compute);
    table(&mut out, &more, &title)?;
    for thread in &schedule {
        let touches = touches(&configuration, &thread.fingers, rate);
        if touches > 0 {
            writeln!(out, "Thread {} fetches up to {touches} tactile events in every period.", thread.thread)?;
        }
    }
    let [fastest, with_sensor] =
        [&none, &sensor].map(|sensor| fastest_rate(&configuration, &costs, sensor, *RATES.end() as u32));
    let limited = |rate: u32, sensor| limits(&off_line_schedule(&configuration, f64::from(rate + 1), &costs, sensor));
    writeln!(out, "Every deadline is met up to {fastest} Hz: {}.", limited(fastest, &none))?;
    writeln!(out, "With the sensor, every deadline is met up to {with_sensor} Hz: {}.", limited(with_sensor, &sensor))?;
    out.flush()?;
    if schedule.iter().any(|thread| thread.limit.is_some()) {
        return Err(format!(
            "at {rate:.0} Hz a deadline may be missed: lower hand.rate, raise finger.baud or spread the fingers over \
             cores"
        )
        .into());
    }
    Ok(())
}

fn read(file: &Path) -> Result<Costs, Failure> {
    let text = read_regular_file(file, LARGEST_COSTS).map_err(|error| format!("{}: {error}", ShownPath(file)))?;
    Ok(Costs::parse(&text).map_err(|reason| format!("{}:{reason}", ShownPath(file)))?)
}

fn measure(configuration: &Configuration, arguments: &Arguments) -> Result<Costs, Failure> {
    let mut simulated = configuration.clone();
    simulated.fingers.iter_mut().for_each(|finger| finger.port = "simulated".into());
    let hand = Hand::open(simulated)?;
    FingerNumber::ALL.into_iter().try_for_each(|finger| busy_with_reflexes(&hand, finger))?;
    (1..=3).try_for_each(|finger| hand.reset_timing(finger))?;
    sleep(Duration::from_secs(arguments.measure));
    let worst = |stage| -> Result<f64, Failure> {
        let part = |timing: Distribution| if arguments.p999 { timing.p999 } else { timing.maximum };
        let timings = (1..=3).map(|finger| hand.timing(finger, stage).map(part));
        Ok(timings.collect::<Result<Vec<f64>, _>>()?.into_iter().fold(0.0, f64::max))
    };
    Ok(Costs {
        wake_up: worst(CycleStage::WakeUp)?,
        write: worst(CycleStage::Write)?,
        read: worst(CycleStage::Read)? + worst(CycleStage::Decode)?,
        compute: worst(CycleStage::Compute)?,
    })
}

/// Gives a finger as many reflexes as it can have. All of them fire again and again, so one of them reacts in every
/// cycle, and the measured computing time includes the aperiodic server at its limit.
fn busy_with_reflexes(hand: &Hand, finger: FingerNumber) -> Result<(), Failure> {
    let reflex = Reflex {
        condition: Condition::ForceAbove(0.0),
        reaction: Reaction::Damp(1.0),
        priority: 0,
        // Shorter than any period.
        refractory: 1e-9,
        inhibition: 0.0,
    };
    for _ in 0..MOST_RULES {
        hand.install_reflex(finger.get(), reflex)?;
    }
    Ok(())
}

fn table(out: &mut impl Write, schedule: &[Scheduled], title: &str) -> io::Result<()> {
    writeln!(out, "{title}:\n")?;
    writeln!(out, "| thread | fingers | core | priority | computing | line busy | replies by | done by | deadlines |")?;
    writeln!(out, "|---|---|---|---|---|---|---|---|---|")?;
    for thread in schedule {
        let fingers = thread.fingers.iter().map(FingerNumber::to_string).collect::<Vec<_>>().join(", ");
        let core = thread.core.map_or("any".into(), |core| core.to_string());
        let by = |time: Option<f64>| time.map_or("-".into(), |time| format!("{time:.0} us"));
        writeln!(
            out,
            "| {} | {fingers} | {core} | {} | {:.1} % | {:.0} % | {} | {} | {} |",
            thread.thread,
            thread.priority,
            100.0 * thread.load,
            100.0 * thread.line,
            by(thread.response.map(|response| response.0)),
            by(thread.response.map(|response| response.1)),
            thread.limit.map_or("met", missed)
        )?;
    }
    writeln!(out)
}

/// Returns the reason why the rate cannot be higher.
fn limits(schedule: &[Scheduled]) -> String {
    let first = schedule.iter().find_map(|thread| {
        thread.limit.map(|limit| format!("above that, {}, thread {}", missed(limit), thread.thread))
    });
    first.unwrap_or_else(|| "the highest rate that can be configured".into())
}

fn missed(limit: RateLimit) -> &'static str {
    match limit {
        RateLimit::Line => "the line is too busy",
        RateLimit::Replies => "replies may arrive too late",
        RateLimit::Cycle => "a cycle may end too late",
    }
}
