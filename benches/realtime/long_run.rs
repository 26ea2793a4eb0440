//! Runs three fingers for a long time with cyclictest in parallel, and checks whether the library's own computation
//! ever makes a cycle late.

use crate::Failure;
use crate::cyclictest::{Cyclictest, Measured};
use crate::explain::{Cause, LateCycle, NotingClock, Pauses, Watchers, cause};
use crate::fingers::reach;
use crate::under_control::under_control;
use sun2xp::finger::{Mailbox, Servo};
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::{Priority, now, spawn};

/// Runs three fingers at 1000 Hz for a long time and classifies every late cycle by its cause. Exit status 1: a cycle
/// was late because of the library's own computation, or because of a pause of a core that was too short to be
/// detected.
#[derive(clap::Args)]
pub struct Arguments {
    /// Duration, minutes.
    #[arg(long, default_value_t = 30.0)]
    minutes: f64,
}

/// Priority of the watch threads: above every servo.
const ABOVE: u8 = 90;

/// Priority of the simulated boards: below every servo.
const BELOW: u8 = 20;

/// The results of a run: for each finger its number of cycles and its late cycles, and the planner's end of its
/// mailbox.
struct Ran {
    cycles: Vec<(u64, Vec<LateCycle>)>,
    planners: Vec<Mailbox>,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut configuration = Configuration::default();
    // The run measures delays, so it must not end with a fault if the machine delays bytes of the pseudo-terminals.
    configuration.hand.watchdog_ms = 1000;
    let period = (1e9 / configuration.hand.rate) as u64;
    let seconds = (arguments.minutes * 60.0).ceil() as u64;
    let priority = configuration.fingers[0].priority;
    let cyclictest = Cyclictest::start(priority, period / 1000, seconds);
    let watchers = Watchers::start(ABOVE)?;
    let ran = serve(&configuration, period, now() + seconds * 1_000_000_000)?;
    let pauses = watchers.finish();
    let machine = cyclictest.and_then(Cyclictest::finish);

    let own = print_fingers(&ran, period, &pauses);
    print_machine(&machine);
    println!(
        "\n{:.1} minutes at {:.0} Hz; {} pauses of a core longer than 50 us.\n",
        arguments.minutes,
        configuration.hand.rate,
        pauses.count()
    );
    if own > 0 {
        return Err(format!(
            "{own} cycles were late because of the library's own computation, or because of pauses of a core that are \
             too short to be detected. Measure again when the machine has no other work. If cycles are late again, \
             standard error shows how they spent their time"
        )
        .into());
    }
    Ok(())
}

/// Serves all fingers until `end`, each on its own thread.
fn serve(configuration: &Configuration, period: u64, end: u64) -> Result<Ran, Failure> {
    let (mut threads, mut planners, mut others) = (Vec::new(), Vec::new(), Vec::new());
    for finger in reach(configuration, period, BELOW)? {
        let (port, schedule) = (finger.port, finger.schedule);
        let priority = Priority { fifo: configuration.fingers[0].priority, core: None };
        threads.push(spawn("servo", priority, move |had| {
            let clock = NotingClock::new(period);
            let mut servo = Servo::new(&clock, schedule, vec![port]);
            while now() < end {
                servo.cycle();
            }
            drop(servo);
            had.scheduling.map_or_else(|| Ok(clock.finish()), Err)
        })?);
        planners.push(finger.mailbox);
        // The boards and the receivers of timings and records must outlive the threads.
        others.push((finger.board, finger.uncollected));
    }
    let mut cycles = Vec::new();
    for thread in threads {
        cycles.push(thread.join().map_err(|_| "a servo panicked: standard error has its message")??);
    }
    Ok(Ran { cycles, planners })
}

/// Prints a row for each finger. Returns the number of cycles that the library's own computation made late.
fn print_fingers(ran: &Ran, period: u64, pauses: &Pauses) -> usize {
    println!(
        "| finger | cycles | lost replies | late cycles | late wake-up | pause of a core | kept from the core | \
         system calls of the exchange | computation |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let mut own = 0;
    for (index, ((cycles, late), mailbox)) in ran.cycles.iter().zip(&ran.planners).enumerate() {
        let report = mailbox.report();
        if let Err(reason) = under_control(index + 1, &report.stage) {
            // The servo has continued, so its cycles count.
            eprintln!(
                "{reason}. Other work on the machine can cause this. To measure a finger that stays under control, \
                 measure again when the machine has no other work."
            );
        }
        let causes: Vec<(Cause, LateCycle)> = late.iter().map(|cycle| (cause(cycle, period, pauses), *cycle)).collect();
        let count = |cause| causes.iter().filter(|(found, _)| *found == cause).count();
        let library = count(Cause::Library);
        println!(
            "| {} | {cycles} | {} | {} | {} | {} | {} | {} | {library} |",
            index + 1,
            report.losses.lost_replies,
            late.len(),
            count(Cause::WakeUp),
            count(Cause::Pause),
            count(Cause::KeptFromCore),
            count(Cause::Exchange)
        );
        let by_library = causes.iter().filter(|(cause, _)| *cause == Cause::Library);
        by_library.take(10).for_each(|(_, cycle)| explain(index, cycle));
        own += library;
    }
    own
}

/// Prints how a late cycle spent its time.
fn explain(index: usize, cycle: &LateCycle) {
    let &LateCycle { beginning, woken, done, ran, computed } = cycle;
    let [woken, done, ran, computed] =
        [woken - beginning, done - beginning, ran, computed].map(|time| time as f64 * 1e-3);
    eprintln!(
        "finger {}: woken after {woken:.0}, done after {done:.0} us; ran for {ran:.0} us, \
         computed for {computed:.0} us",
        index + 1
    );
}

/// Prints the measurements of cyclictest.
fn print_machine(machine: &Result<Vec<Measured>, Failure>) {
    println!("\n| cyclictest in parallel | wake-ups | median | 99 % | worst | over 1 ms |\n|---|---|---|---|---|---|");
    if let Err(reason) = machine {
        println!("| not measured: {reason} | | | | | |");
    }
    for (index, thread) in machine.iter().flatten().enumerate() {
        let latency = &thread.latency;
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
}
