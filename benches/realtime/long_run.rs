//! Three fingers for a long time, with cyclictest beside them: whether a cycle is ever late by the library's own computation.

use crate::Failure;
use crate::cyclictest::Cyclictest;
use crate::explain::{Cause, LateCycle, NotingClock, Watchers, cause};
use crate::fingers::reach;
use sun2xp::finger::{Servo, Stage};
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::{Priority, now, spawn};

/// Three fingers at 1000 Hz for a long time; every late cycle is sorted by its cause. Exit status 1: one was late
/// by the library's own computation.
#[derive(clap::Args)]
pub struct Arguments {
    /// How long.
    #[arg(long, default_value_t = 30.0)]
    minutes: f64,
}

/// Of the watchers: above every servo.
const ABOVE: u8 = 90;

/// Of the simulated boards: below every servo.
const BELOW: u8 = 20;

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut configuration = Configuration::default();
    // What is measured is time: a machine that starves the terminals' bytes must not end it with a fault.
    configuration.hand.watchdog_ms = 1000;
    let period = (1e9 / configuration.hand.rate) as u64;
    let seconds = (arguments.minutes * 60.0).ceil() as u64;
    let priority = configuration.fingers[0].priority;
    let cyclictest = Cyclictest::start(priority, period / 1000, seconds);
    let watchers = Watchers::start(ABOVE)?;

    let end = now() + seconds * 1_000_000_000;
    let (mut threads, mut planners, mut boards) = (Vec::new(), Vec::new(), Vec::new());
    for finger in reach(&configuration, period, BELOW)? {
        let (port, schedule) = (finger.port, finger.schedule);
        threads.push(spawn("servo", Priority { fifo: priority, core: None }, move |had| {
            let clock = NotingClock::new(period);
            let mut servo = Servo::new(&clock, schedule, vec![port]);
            while now() < end {
                servo.cycle();
            }
            drop(servo);
            had.scheduling.map_or_else(|| Ok(clock.finish()), Err)
        })?);
        planners.push((finger.mailbox, finger.uncollected));
        boards.push(finger.board);
    }
    let mut found = Vec::new();
    for thread in threads {
        found.push(thread.join().map_err(|_| "a servo panicked")??);
    }
    let pauses = watchers.finish();
    let machine = cyclictest.and_then(Cyclictest::finish);

    println!(
        "| finger | cycles | replies lost | late | by their wake-up | by a pause of a core | kept from its core | by system calls of the exchange | by its computation |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let mut own = 0;
    for (index, ((cycles, late), (mailbox, _))) in found.iter().zip(&planners).enumerate() {
        let report = mailbox.report();
        if report.stage != Stage::Running {
            // Its servo has gone on, so its cycles count.
            eprintln!("finger {} is {:?} in the end. Other work on the machine disturbs it.", index + 1, report.stage);
        }
        let causes: Vec<(Cause, LateCycle)> =
            late.iter().map(|cycle| (cause(cycle, period, &pauses), *cycle)).collect();
        let count = |cause| causes.iter().filter(|(found, _)| *found == cause).count();
        let library = count(Cause::Library);
        println!(
            "| {} | {cycles} | {} | {} | {} | {} | {} | {} | {library} |",
            index + 1,
            report.losses.lost_replies,
            late.len(),
            count(Cause::WakeUp),
            count(Cause::Pause),
            count(Cause::Kept),
            count(Cause::Exchange)
        );
        for (_, LateCycle { beginning, woken, done, ran, computed }) in
            causes.iter().filter(|(cause, _)| *cause == Cause::Library).take(10)
        {
            let [woken, done, ran, computed] =
                [woken - beginning, done - beginning, *ran, *computed].map(|time| time as f64 * 1e-3);
            eprintln!(
                "finger {}: woken after {woken:.0}, done after {done:.0} us; ran for {ran:.0} us, computed for {computed:.0} us",
                index + 1
            );
        }
        own += library;
    }
    println!("\n| cyclictest beside it | wake-ups | median | 99 % | worst | over 1 ms |\n|---|---|---|---|---|---|");
    if let Err(reason) = &machine {
        println!("| not measured: {reason} | | | | | |");
    }
    for (index, thread) in machine.iter().flatten().enumerate() {
        let latency = thread.latency;
        println!(
            "| thread {} | {} | {:.1} us | {:.1} us | {:.0} us | {} |",
            index + 1,
            thread.count,
            latency.median,
            latency.p99,
            latency.maximum,
            thread.late
        );
    }
    println!(
        "\n{:.1} minutes at {:.0} Hz; {} pauses of a core above 50 us.\n",
        arguments.minutes,
        configuration.hand.rate,
        pauses.count()
    );
    if own > 0 {
        return Err(format!("{own} cycles were late by the library's own computation").into());
    }
    Ok(())
}
