//! Measures whether processes that read telemetry delay the servos.

use crate::Failure;
use crate::percentiles::median;
use crate::turns::Turns;
use std::fs::File;
use std::hint::black_box;
use std::io::{BufWriter, Read, Write};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;
use sun2xp::hand::{Hand, HandError};
use sun2xp::model::configuration::{Configuration, FINGERS};
use sun2xp::realtime::{CycleStage, Distribution};
use sun2xp::telemetry::{Reader, View};

/// Whether each reader writes the messages to a file. All readers convert every cycle to a sample. The first two stand
/// for a monitor and a page, which do not write. The third stands for a recorder.
const READERS: [bool; 3] = [false, false, true];

/// Time between a change of the readers and the beginning of the next measurement.
const SETTLING: Duration = Duration::from_millis(500);

/// The arguments of a process that reads the telemetry of a hand.
#[derive(clap::Args)]
pub struct ReaderArguments {
    /// Name of the hand.
    name: String,
    /// Whether to write every cycle into a file.
    #[arg(long)]
    write: bool,
}

/// One side of the comparison: with readers, or without. Each distribution is that of the wake-up latencies, us, of one
/// finger in one measurement.
#[derive(Default)]
struct Side(Vec<Distribution>);

impl Side {
    fn median_of(&self, part: fn(&Distribution) -> f64) -> f64 {
        median(self.0.iter().map(part))
    }
}

pub fn run(turns: &Turns) -> Result<(), Failure> {
    let mut configuration = Configuration::default();
    configuration.telemetry.name = format!("bench-{}", std::process::id());
    let name = configuration.telemetry.name.clone();
    let hand = Hand::open(configuration)?;
    let (mut without, mut with, mut ratios) = (Side::default(), Side::default(), Vec::new());
    for _ in 0..turns.repeats {
        let alone = measure(&hand, turns.seconds)?;
        let readers = READERS.map(|write| Process::start(&name, write));
        let readers = readers.into_iter().collect::<Result<Vec<_>, _>>()?;
        let read = measure(&hand, turns.seconds)?;
        readers.into_iter().try_for_each(Process::end)?;
        ratios.push(median(read.iter().map(|wake| wake.p999)) / median(alone.iter().map(|wake| wake.p999)));
        without.0.extend(alone);
        with.0.extend(read);
    }
    println!("| wake-up | median | 99 % | 99.9 % | largest |\n|---|---|---|---|---|");
    for (name, side) in [("no reader", &without), ("three readers", &with)] {
        let largest = side.0.iter().map(|wake| wake.maximum).fold(0.0, f64::max);
        println!(
            "| {name} | {:.1} us | {:.1} us | {:.1} us | {largest:.0} us |",
            side.median_of(|wake| wake.median),
            side.median_of(|wake| wake.p99),
            side.median_of(|wake| wake.p999),
        );
    }
    let of_sides = with.median_of(|wake| wake.p999) / without.median_of(|wake| wake.p999);
    println!(
        "\nMedians over three fingers and {} turns of {} s for each side. The two sides alternate. Ratio of the 99.9 % \
         latency with readers to that without (goal: 0.9 to 1.1): {of_sides:.3}; median of the ratios of \
         neighbouring turns: {:.3}.\n",
        turns.repeats,
        turns.seconds,
        median(ratios),
    );
    Ok(())
}

/// Returns the wake-up latency of each finger.
fn measure(hand: &Hand, seconds: u64) -> Result<Vec<Distribution>, HandError> {
    let fingers = 1..=FINGERS as i32;
    sleep(SETTLING);
    fingers.clone().try_for_each(|finger| hand.reset_timing(finger))?;
    sleep(Duration::from_secs(seconds));
    fingers.map(|finger| hand.timing(finger, CycleStage::WakeUp)).collect()
}

/// A process that reads until its standard input ends.
struct Process(Child);

impl Process {
    fn start(name: &str, write: bool) -> Result<Self, Failure> {
        let mut command = Command::new(std::env::current_exe()?);
        command.args(["reader", name]).args(write.then_some("--write")).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn()?;
        // The reader prints one byte when it is attached.
        child.stdout.take().ok_or("no pipe")?.read_exact(&mut [0])?;
        Ok(Self(child))
    }

    fn end(mut self) -> Result<(), Failure> {
        drop(self.0.stdin.take());
        let status = self.0.wait()?;
        if status.success() { Ok(()) } else { Err("a reader lost cycles or failed".into()) }
    }
}

/// Reads until standard input ends. Fails if cycles are lost.
pub fn read(arguments: &ReaderArguments) -> Result<(), Failure> {
    let mut reader = Reader::attach(Some(&arguments.name))?;
    let mut view = View::new(&reader.description().configuration);
    let mut file = match arguments.write {
        true => Some(BufWriter::new(tempfile::tempfile()?)),
        false => None,
    };
    let ended = std::thread::spawn(|| std::io::stdin().read(&mut [0]));
    std::io::stdout().write_all(b".")?;
    std::io::stdout().flush()?;
    let mut messages = Vec::new();
    while !ended.is_finished() {
        messages.clear();
        reader.read(Duration::from_millis(100), &mut messages)?;
        for message in &messages {
            black_box(view.take(message));
            write(&mut file, || message.encode())?;
        }
    }
    if reader.lost() == [0; FINGERS] { Ok(()) } else { Err(format!("lost: {:?}", reader.lost()).into()) }
}

fn write(file: &mut Option<BufWriter<File>>, bytes: impl FnOnce() -> std::io::Result<Vec<u8>>) -> std::io::Result<()> {
    match file {
        Some(file) => file.write_all(&bytes()?),
        None => Ok(()),
    }
}
