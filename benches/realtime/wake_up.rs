//! Compares the wake-up latency of three servo-like threads with cyclictest at the same priority and interval. The
//! threads and cyclictest run alternately.

use crate::Failure;
use crate::cyclictest::Cyclictest;
use crate::percentiles::{Percentiles, median};
use crate::turns::Turns;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::process::{Child, Command, Stdio};
use sun2xp::realtime::{Clock, MonotonicClock, Priority, Schedule, now, spawn};

const PRIORITY: u8 = 80;
const PERIOD_US: u64 = 1000;

/// Largest permitted ratio of the threads' latency to cyclictest's.
const GOAL: f64 = 1.1;

pub fn run(turns: &Turns) -> Result<(), Failure> {
    let _awake = keep_awake();
    println!("| load | figure | this library | cyclictest | ratio | goal |\n|---|---|---|---|---|---|");
    for (load, busy) in [("none", false), ("stress-ng", true)] {
        if let Err(reason) = measure(turns, load, busy) {
            println!("| {load} | not measured: {reason} | | | | |");
        }
    }
    println!("\nMedians over three threads and {} repeats of {} s.\n", turns.repeats, turns.seconds);
    Ok(())
}

fn measure(turns: &Turns, load: &str, busy: bool) -> Result<(), Failure> {
    let _stress = if busy { Some(Stress::start()?) } else { None };
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for _ in 0..turns.repeats {
        ours.extend(servo_threads(turns.seconds)?);
        let measured = Cyclictest::start(PRIORITY, PERIOD_US, turns.seconds)?.finish()?;
        theirs.extend(measured.into_iter().map(|thread| thread.latency));
    }
    let row = |name: &str, part: fn(&Percentiles) -> f64, goal: &str| {
        let [ours, theirs] = [&ours, &theirs].map(|all| median(all.iter().map(part)));
        println!("| {load} | {name} | {ours:.1} us | {theirs:.1} us | {:.2} | {goal} |", ours / theirs);
    };
    row("median", |latency| latency.median, &format!("<= {GOAL}"));
    row("99 %", |latency| latency.p99, &format!("<= {GOAL}"));
    row("worst", |latency| latency.maximum, "");
    Ok(())
}

/// Keeps the processor out of deep sleep. cyclictest does this while it runs, so the same must hold while the library
/// is measured.
fn keep_awake() -> Option<File> {
    let mut latency = OpenOptions::new().write(true).open("/dev/cpu_dma_latency").ok()?;
    latency.write_all(&0i32.to_ne_bytes()).ok()?;
    Some(latency)
}

/// Returns the latencies of three threads that only wake up, with phases staggered over the period.
fn servo_threads(seconds: u64) -> Result<Vec<Percentiles>, Failure> {
    let first = now() + 10_000_000;
    let cycles = (seconds * 1_000_000 / PERIOD_US) as usize;
    let threads = (0..3).map(|place| {
        let mut schedule = Schedule::new(first + place * PERIOD_US * 1000 / 3, PERIOD_US * 1000);
        spawn("servo", Priority { fifo: PRIORITY, core: None }, move |had| {
            let mut latencies = Vec::with_capacity(cycles);
            for _ in 0..cycles {
                let beginning = schedule.next();
                MonotonicClock.sleep_until(beginning);
                let woken = MonotonicClock.now();
                latencies.push(woken.saturating_sub(beginning));
                schedule.advance(woken);
            }
            had.scheduling.map_or(Ok(latencies), Err)
        })
    });
    let threads: Vec<_> = threads.collect::<Result<_, _>>()?;
    let mut all = Vec::new();
    for thread in threads {
        all.push(Percentiles::of(thread.join().map_err(|_| "a thread panicked: standard error has its message")??));
    }
    Ok(all)
}

/// Load for every core, the memory and the caches.
struct Stress(Child);

impl Stress {
    fn start() -> Result<Self, Failure> {
        let child = Command::new("stress-ng")
            .args(["--cpu=0", "--vm=1", "--vm-bytes=64M", "--switch=1", "--quiet"])
            .stdout(Stdio::null())
            .spawn()
            .map_err(|error| format!("cannot run stress-ng ({error}): install it"))?;
        std::thread::sleep(std::time::Duration::from_secs(1));
        Ok(Self(child))
    }
}

impl Drop for Stress {
    fn drop(&mut self) {
        // stress-ng passes the signal on to its workers.
        // SAFETY: this process has started the process with this number, and has not yet waited for it.
        unsafe { libc::kill(self.0.id() as libc::pid_t, libc::SIGINT) };
        let _ = self.0.wait();
    }
}
