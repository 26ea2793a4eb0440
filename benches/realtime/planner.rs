//! Measures whether the servos are delayed by planners that call the library as fast as they can.

use crate::Failure;
use crate::attempts::Attempts;
use crate::percentiles::{median, ratio};
use crate::turns::Turns;
use std::hint::{black_box, spin_loop};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::thread::sleep;
use std::time::Duration;
use sun2xp::hand::{Hand, HandError};
use sun2xp::model::configuration::{Configuration, FINGERS};
use sun2xp::realtime::CycleStage;

/// What the two planner threads do during a measurement.
#[derive(Clone, Copy, PartialEq)]
enum Planners {
    Quiet,
    /// The threads use the cores, but do not call the library. This shows the effect of the load alone.
    Spinning,
    Calling,
}

const KINDS: [(Planners, &str); 3] = [
    (Planners::Quiet, "no planner"),
    (Planners::Spinning, "two threads that spin"),
    (Planners::Calling, "two threads that call"),
];

/// Median and 99th percentile of the wake-up latency of a finger, us.
type WakeUp = (f64, f64);

/// The wake-up latencies of each of [`KINDS`].
type WakeUps = [Vec<WakeUp>; KINDS.len()];

pub fn run(turns: &Turns) -> Result<(), Failure> {
    let mut wake_ups = WakeUps::default();
    let (calls, mut attempts) = (AtomicU64::new(0), Attempts::default());
    for _ in 0..turns.repeats {
        for ((kind, name), wake_ups) in KINDS.into_iter().zip(&mut wake_ups) {
            let measured = attempts.measure(name, || turn(turns.seconds, kind, &calls));
            wake_ups.extend(measured.into_iter().flatten());
        }
    }
    print_table(&wake_ups);
    let made = wake_ups.map(|wake_ups| wake_ups.len() / FINGERS);
    let [quiet, spinning, calling] = made;
    println!(
        "\nMedians over three fingers and all measurements of {} s: {quiet} measurements for the first row, {spinning} \
         for the second and {calling} for the third. {attempts}. The two threads that call made {:.1} million calls \
         per second together.\n",
        turns.seconds,
        calls.load(Relaxed) as f64 / (calling as u64 * turns.seconds).max(1) as f64 * 1e-6
    );
    Ok(attempts.check(KINDS.map(|(_, name)| name).into_iter().zip(made))?)
}

fn print_table(wake_ups: &WakeUps) {
    println!(
        "| | median | 99 % | median relative to spinning (goal for threads that call: at most 1.1) | 99 % relative to \
         spinning |\n|---|---|---|---|---|"
    );
    let of = |kind: usize, part: fn(&WakeUp) -> f64| median(wake_ups[kind].iter().map(part));
    let (spinning, spinning_p99) = (of(1, |wake| wake.0), of(1, |wake| wake.1));
    for (kind, (_, name)) in KINDS.iter().enumerate() {
        if wake_ups[kind].is_empty() {
            println!("| {name} | not measured, because every measurement failed or was skipped | | | |");
            continue;
        }
        let (middle, p99) = (of(kind, |wake| wake.0), of(kind, |wake| wake.1));
        let [relative, relative_p99] = [ratio(middle, spinning), ratio(p99, spinning_p99)];
        println!("| {name} | {middle:.1} us | {p99:.1} us | {relative} | {relative_p99} |");
    }
}

/// Makes one measurement on a hand of its own.
fn turn(seconds: u64, kind: Planners, calls: &AtomicU64) -> Result<Vec<WakeUp>, Failure> {
    let hand = Hand::open(Configuration::default())?;
    let (ended, made) = (AtomicBool::new(false), AtomicU64::new(0));
    std::thread::scope(|scope| {
        let planners = [1, 2].map(|finger| {
            let (hand, ended, made) = (&hand, &ended, &made);
            scope.spawn(move || plan(hand, finger, kind, ended, made))
        });
        let measured = measure(&hand, seconds, &made);
        ended.store(true, Relaxed);
        for planner in planners {
            planner.join().map_err(|_| "a planner panicked: standard error has its message")??;
        }
        let (wake_ups, counted) = measured?;
        calls.fetch_add(counted, Relaxed);
        Ok(wake_ups)
    })
}

/// Runs one planner until `ended` is set.
fn plan(hand: &Hand, finger: i32, kind: Planners, ended: &AtomicBool, calls: &AtomicU64) -> Result<(), HandError> {
    let start = hand.position(finger)?;
    while !ended.load(Relaxed) {
        match kind {
            Planners::Quiet => sleep(Duration::from_millis(10)),
            Planners::Spinning => spin_loop(),
            Planners::Calling => {
                for _ in 0..100 {
                    hand.send_position(finger, start)?;
                    black_box(hand.position(finger)?);
                }
                calls.fetch_add(200, Relaxed);
            }
        }
    }
    Ok(())
}

/// Returns the wake-up latency of each finger, and by how much `calls` rose during the measurement.
fn measure(hand: &Hand, seconds: u64, calls: &AtomicU64) -> Result<(Vec<WakeUp>, u64), Failure> {
    let fingers = 1..=FINGERS as i32;
    // The start of the hand is not measured.
    sleep(Duration::from_millis(200));
    fingers.clone().try_for_each(|finger| hand.reset_timing(finger))?;
    let before = calls.load(Relaxed);
    sleep(Duration::from_secs(seconds));
    let counted = calls.load(Relaxed) - before;
    let timings = fingers.map(|finger| hand.timing(finger, CycleStage::WakeUp).map(|wake| (wake.median, wake.p99)));
    Ok((timings.collect::<Result<_, _>>()?, counted))
}
