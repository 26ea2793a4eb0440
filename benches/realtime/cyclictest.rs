//! Runs cyclictest, an independent measurement of what the machine can do.

use crate::Failure;
use crate::percentiles::Percentiles;
use std::process::{Child, Command, Stdio};

/// In the percentiles, latencies above this value count as this value, ns.
const LONGEST: u64 = 1_000_000;

/// cyclictest with three threads, staggered over the period like servo threads.
pub struct Cyclictest {
    child: Option<Child>,
    priority: u8,
}

/// The measurements of one thread.
pub struct Measured {
    pub latency: Percentiles,
    /// Number of wake-ups.
    pub count: usize,
    /// Number of wake-ups that were later than [`LONGEST`].
    pub late: u64,
}

impl Cyclictest {
    pub fn start(priority: u8, period_us: u64, seconds: u64) -> Result<Self, Failure> {
        let child = Command::new("cyclictest")
            .args(["--quiet", "--mlockall", "--threads=3", "--nsecs"])
            .arg(format!("--priority={priority}"))
            .arg(format!("--interval={period_us}"))
            .arg(format!("--aligned={}", period_us / 3))
            .arg(format!("--duration={seconds}"))
            .arg(format!("--histogram={LONGEST}"))
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| format!("cannot run cyclictest ({error}): install rt-tests"))?;
        Ok(Self { child: Some(child), priority })
    }

    /// Waits for the end of the run.
    pub fn finish(mut self) -> Result<Vec<Measured>, Failure> {
        let child = self.child.take().expect("it runs until this call");
        let output = child
            .wait_with_output()
            .map_err(|error| format!("cannot read the output of cyclictest ({error}): start the measurement again"))?;
        if !output.status.success() {
            return Err(format!(
                "cyclictest failed ({}): standard error has its message. If cyclictest lacks the permission for \
                 SCHED_FIFO, run this benchmark as root, or raise the rtprio limit (ulimit -r) to {} or more",
                output.status, self.priority
            )
            .into());
        }
        Ok(measurements(&String::from_utf8_lossy(&output.stdout))?)
    }
}

/// Reads the measurements of the three threads from the output of cyclictest.
///
/// # Errors
/// Returns what is missing or cannot be understood, with the remedy.
pub fn measurements(text: &str) -> Result<Vec<Measured>, String> {
    let mut latencies: Vec<Vec<u64>> = vec![Vec::new(); 3];
    // Each line has a latency, and for each thread the number of wake-ups with this latency.
    for line in text.lines().filter(|line| line.starts_with(|first: char| first.is_ascii_digit())) {
        let numbers = numbers_in(line)?;
        let [latency, counts @ ..] = &numbers[..] else { continue };
        for (thread, &count) in latencies.iter_mut().zip(counts) {
            thread.extend(std::iter::repeat_n(*latency, count as usize));
        }
    }
    let listed = |name: &str| -> Result<Vec<u64>, String> {
        let line = text.lines().find_map(|line| line.strip_prefix(name));
        numbers_in(
            line.ok_or_else(|| format!("cyclictest printed no line \"{name}\": install another version of rt-tests"))?,
        )
    };
    let (overflows, maxima) = (listed("# Histogram Overflows:")?, listed("# Max Latencies:")?);
    let measured = latencies.into_iter().zip(overflows).zip(maxima).map(|((mut latencies, late), maximum)| {
        latencies.extend(std::iter::repeat_n(LONGEST, late as usize));
        let count = latencies.len();
        Measured { latency: Percentiles { maximum: maximum as f64 * 1e-3, ..Percentiles::of(latencies) }, count, late }
    });
    Ok(measured.collect())
}

/// Reads the numbers of a line that cyclictest has printed.
fn numbers_in(line: &str) -> Result<Vec<u64>, String> {
    let number = |word: &str| {
        word.parse::<u64>().map_err(|error| {
            format!("cyclictest printed \"{word}\" in place of a number ({error}): install another version of rt-tests")
        })
    };
    line.split_whitespace().map(number).collect()
}

/// A run that fails must not leave cyclictest behind: its real-time threads would disturb other measurements.
impl Drop for Cyclictest {
    fn drop(&mut self) {
        if let Some(mut child) = self.child.take() {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}
