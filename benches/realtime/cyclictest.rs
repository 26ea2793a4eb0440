//! Runs cyclictest, an independent measurement of what the machine can do.

use crate::Failure;
use crate::percentiles::Percentiles;
use std::process::{Child, Command, Stdio};

/// In the percentiles, latencies above this value count as this value, ns.
const LONGEST: u64 = 1_000_000;

/// cyclictest with three threads, staggered over the period like servo threads.
pub struct Cyclictest(Option<Child>);

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
        Ok(Self(Some(child)))
    }

    /// Waits for the end of the run.
    pub fn finish(mut self) -> Result<Vec<Measured>, Failure> {
        let output = self.0.take().expect("it runs until this call").wait_with_output()?;
        if !output.status.success() {
            return Err("cyclictest failed: it needs the permission for SCHED_FIFO (root, or an rtprio limit)".into());
        }
        let text = String::from_utf8(output.stdout)?;
        let mut latencies: Vec<Vec<u64>> = vec![Vec::new(); 3];
        // Each line has a latency, and for each thread the number of wake-ups with this latency.
        for line in text.lines().filter(|line| line.starts_with(|first: char| first.is_ascii_digit())) {
            let numbers: Vec<u64> = line.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
            let [latency, counts @ ..] = &numbers[..] else { continue };
            for (thread, &count) in latencies.iter_mut().zip(counts) {
                thread.extend(std::iter::repeat_n(*latency, count as usize));
            }
        }
        let listed = |name: &str| -> Result<Vec<u64>, Failure> {
            let line = text.lines().find_map(|line| line.strip_prefix(name)).ok_or("unknown output of cyclictest")?;
            Ok(line.split_whitespace().map(str::parse).collect::<Result<_, _>>()?)
        };
        let (overflows, maxima) = (listed("# Histogram Overflows:")?, listed("# Max Latencies:")?);
        let measured = latencies.into_iter().zip(overflows).zip(maxima).map(|((mut latencies, late), maximum)| {
            latencies.extend(std::iter::repeat_n(LONGEST, late as usize));
            let count = latencies.len();
            Measured {
                latency: Percentiles { maximum: maximum as f64 * 1e-3, ..Percentiles::of(latencies) },
                count,
                late,
            }
        });
        Ok(measured.collect())
    }
}

/// A run that fails must not leave cyclictest behind: its real-time threads would disturb other measurements.
impl Drop for Cyclictest {
    fn drop(&mut self) {
        if let Some(mut child) = self.0.take() {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}
