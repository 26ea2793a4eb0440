//! Measures whether processes that read telemetry delay the servos.

use crate::Failure;
use crate::attempts::Attempts;
use crate::percentiles::{median, ratio};
use crate::turns::Turns;
use crate::under_control::under_control;
use std::fs::File;
use std::hint::black_box;
use std::io::{self, BufWriter, Read, Write};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::Duration;
use sun2xp::hand::Hand;
use sun2xp::model::configuration::{Configuration, FINGERS};
use sun2xp::realtime::{CycleStage, Distribution, with_remedy};
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
    /// Whether to write every message into a file.
    #[arg(long)]
    write: bool,
}

/// One side of the comparison: with readers, or without. Each entry is the distribution of the wake-up latencies of one
/// finger in one measurement, us.
#[derive(Default)]
struct Side(Vec<Distribution>);

impl Side {
    fn median_of(&self, part: fn(&Distribution) -> f64) -> f64 {
        median(self.0.iter().map(part))
    }

    /// Prints the row of this side.
    fn print(&self, name: &str) {
        if self.0.is_empty() {
            println!("| {name} | not measured, because every measurement failed or was skipped | | | |");
            return;
        }
        let largest = self.0.iter().map(|wake| wake.maximum).fold(0.0, f64::max);
        println!(
            "| {name} | {:.1} us | {:.1} us | {:.1} us | {largest:.0} us |",
            self.median_of(|wake| wake.median),
            self.median_of(|wake| wake.p99),
            self.median_of(|wake| wake.p999),
        );
    }
}

pub fn run(turns: &Turns) -> Result<(), Failure> {
    let (mut without, mut with, mut ratios) = (Side::default(), Side::default(), Vec::new());
    let mut attempts = Attempts::default();
    for _ in 0..turns.repeats {
        let measured =
            attempts.measure("a measurement without readers and one with them", || measure_both(turns.seconds));
        let Some([alone, with_readers]) = measured else { continue };
        ratios.push(median(with_readers.iter().map(|wake| wake.p999)) / median(alone.iter().map(|wake| wake.p999)));
        without.0.extend(alone);
        with.0.extend(with_readers);
    }
    println!("| wake-up | median | 99 % | 99.9 % | largest |\n|---|---|---|---|---|");
    without.print("no reader");
    with.print("three readers");
    let (made, Attempts { failed, skipped }) = (ratios.len(), &attempts);
    println!(
        "\nMedians over three fingers, and over {made} pairs of measurements. A pair is one measurement of {} s \
         without readers, and then one with them. {failed} pairs failed, and {skipped} were skipped because too many \
         had failed. The last column has the largest value of all measurements. Ratio of the 99.9 % latency with \
         readers to that without (goal: 0.9 to 1.1): {}. Each pair has such a ratio too. The median of these ratios is \
         {}.\n",
        turns.seconds,
        ratio(with.median_of(|wake| wake.p999), without.median_of(|wake| wake.p999)),
        ratio(median(ratios), 1.0),
    );
    Ok(attempts.check([("three readers", made)])?)
}

/// Opens a hand, and measures it once without readers and then once with them. If one of the two measurements fails,
/// both are repeated, so that a ratio compares measurements at nearly the same time.
fn measure_both(seconds: u64) -> Result<[Vec<Distribution>; 2], Failure> {
    let mut configuration = Configuration::default();
    configuration.telemetry.name = format!("bench-{}", std::process::id());
    let name = configuration.telemetry.name.clone();
    let hand = Hand::open(configuration)?;
    let alone = measure(&hand, seconds)?;
    let readers = READERS.map(|write| Process::start(&name, write));
    let readers = readers.into_iter().collect::<Result<Vec<_>, _>>()?;
    let with_readers = measure(&hand, seconds)?;
    readers.into_iter().try_for_each(Process::end)?;
    Ok([alone, with_readers])
}

/// Returns the wake-up latency of each finger. Returns an error if a finger has stopped, because the servo of such a
/// finger does less work.
fn measure(hand: &Hand, seconds: u64) -> Result<Vec<Distribution>, Failure> {
    let fingers = 1..=FINGERS as i32;
    sleep(SETTLING);
    fingers.clone().try_for_each(|finger| hand.reset_timing(finger))?;
    sleep(Duration::from_secs(seconds));
    let timings = fingers.clone().map(|finger| hand.timing(finger, CycleStage::WakeUp)).collect::<Result<_, _>>()?;
    for finger in fingers {
        under_control(finger as usize, &hand.report(finger)?.stage)?;
    }
    Ok(timings)
}

/// A process that reads until its standard input ends.
struct Process(Child);

impl Process {
    fn start(name: &str, write: bool) -> Result<Self, Failure> {
        let program = std::env::current_exe();
        let program = program.map_err(|error| format!("cannot find the reader's program: {error}. Mount /proc"))?;
        let mut command = Command::new(program);
        command.args(["reader", name]).args(write.then_some("--write")).stdin(Stdio::piped()).stdout(Stdio::piped());
        let child = command.spawn();
        let mut child = child.map_err(|error| format!("cannot start a reader: {}", with_remedy(&error)))?;
        let mut attached = child.stdout.take().expect("its standard output is a pipe");
        let process = Self(child);
        // The reader prints one byte when it is attached.
        let ended = "a reader ended before it was attached to the telemetry: standard error has its message";
        attached.read_exact(&mut [0]).map_err(|_| ended)?;
        Ok(process)
    }

    fn end(mut self) -> Result<(), Failure> {
        let status = self.wait()?;
        if status.success() {
            return Ok(());
        }
        Err(format!("a reader lost cycles or failed ({status}): standard error has its message").into())
    }

    fn wait(&mut self) -> io::Result<ExitStatus> {
        drop(self.0.stdin.take());
        self.0.wait()
    }
}

/// A measurement that fails must not leave its readers behind, because they would disturb the next one.
impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.wait();
    }
}

/// Reads until standard input ends. Fails if cycles are lost.
pub fn read(arguments: &ReaderArguments) -> Result<(), Failure> {
    let mut reader = Reader::attach(Some(&arguments.name))?;
    let mut view = View::new(&reader.description().configuration);
    let mut file = match arguments.write {
        true => Some(BufWriter::new(tempfile::tempfile().map_err(|error| unwritable(&error))?)),
        false => None,
    };
    let ended = std::thread::spawn(|| io::stdin().read(&mut [0]));
    io::stdout().write_all(b".")?;
    io::stdout().flush()?;
    let mut messages = Vec::new();
    while !ended.is_finished() {
        messages.clear();
        reader.read(Duration::from_millis(100), &mut messages)?;
        for message in &messages {
            black_box(view.take(message));
            write(&mut file, || message.encode())?;
        }
    }
    let lost = reader.lost();
    if lost == [0; FINGERS] {
        return Ok(());
    }
    let [first, second, third] = lost;
    Err(format!(
        "the reader was too slow: it lost {first} cycles of finger 1, {second} of finger 2 and {third} of finger 3. \
         Measure again when the machine has no other work"
    )
    .into())
}

fn write(file: &mut Option<BufWriter<File>>, bytes: impl FnOnce() -> io::Result<Vec<u8>>) -> Result<(), Failure> {
    match file {
        Some(file) => Ok(file.write_all(&bytes()?).map_err(|error| unwritable(&error))?),
        None => Ok(()),
    }
}

/// The text of an error in writing a temporary file.
fn unwritable(error: &io::Error) -> String {
    let folder = std::env::temp_dir();
    format!(
        "cannot write a temporary file in {}: {error}. Make that folder writable and free space there, or set TMPDIR \
         to another folder",
        folder.display()
    )
}
