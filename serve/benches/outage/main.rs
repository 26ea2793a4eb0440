//! Makes the planner or the line fail many times. Prints the time from a failure until the fingers were caught (held
//! softly), and the time until they went to their end states. Both times come from the telemetry of the hand. Also
//! prints the threads, descriptors and memory of the server before and after the failures. Needs root, because it makes
//! network namespaces.

#[path = "../../tests/network/line.rs"]
mod line;
#[path = "../../tests/network/namespace.rs"]
mod namespace;
#[path = "../../tests/network/observer.rs"]
mod observer;
#[path = "../../tests/network/outage.rs"]
mod outage;
#[path = "../../tests/network/planner.rs"]
#[allow(dead_code, reason = "the tests use the rest")]
mod planner;
#[path = "../../tests/network/process.rs"]
mod process;
#[path = "../../tests/network/served.rs"]
mod served;
#[path = "../../tests/network/shaper.rs"]
#[allow(dead_code, reason = "the tests use the rest")]
mod shaper;
#[path = "../../tests/network/tun.rs"]
mod tun;

use clap::Parser;
use line::Line;
use outage::{CATCH_GOAL, CATCH_MS, END_GOAL, Failure, Outcome, Rig};
use process::Resources;
use std::process::ExitCode;
use std::thread;
use std::time::{Duration, Instant};

/// Time in which the connections of the first planners end.
const LEASE: Duration = Duration::from_secs(20);

/// Longest time in which the connections of all lost clients end. After a cut of the line, TCP retransmits for a long
/// time before it closes a connection.
const LAST: Duration = Duration::from_secs(120);

/// Arguments of the benchmark.
#[derive(Parser)]
struct Arguments {
    /// Repetitions of each failure.
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..))]
    repetitions: u32,
    /// Only this failure, for example Unplugged.
    #[arg(long)]
    failure: Option<Failure>,
    /// Cargo passes this argument.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    if planner::ran() {
        return ExitCode::SUCCESS;
    }
    let Arguments { repetitions, failure: only, .. } = Arguments::parse();
    let wanted = |failure: &Failure| only.is_none_or(|only| only == *failure);
    let begin = Instant::now();
    // One failure is measured after the other: several hands at the same time need more processors than a small machine
    // has.
    let failures = Failure::ALL.into_iter().filter(wanted);
    let measured: Vec<_> = failures.map(|failure| repeated(failure, repetitions)).collect();
    println!(
        "| failure | caught, median | longest | end state, median | longest | distance of the held set point, largest \
         | observed pause, longest, and cycles missing | within the goals |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for one in &measured {
        println!("{}", one.row());
    }
    println!("\nWhat the server used before and after the failures ({} s in all):", begin.elapsed().as_secs());
    for Measured { failure, before, after, freed, .. } in &measured {
        println!("{failure:?}: before {before:?}, after {after:?} ({} s after the last failure)", freed.as_secs());
    }
    if measured.iter().all(Measured::is_good) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The repetitions of one failure, and what its server used before and after them.
struct Measured {
    failure: Failure,
    outcomes: Vec<Outcome>,
    before: Resources,
    after: Resources,
    /// Time until threads and descriptors of the lost clients were free again.
    freed: Duration,
}

/// Measures one failure: lets it happen `repetitions` times.
fn repeated(failure: Failure, repetitions: u32) -> Measured {
    let line = Line::new(1)
        .unwrap_or_else(|error| panic!("namespaces and tun interfaces need root and the device /dev/net/tun: {error}"));
    let mut rig = Rig::new(line, &format!("{failure:?}"), CATCH_MS);
    // The server creates threads and buffers when the first planners connect.
    for _ in 0..3 {
        rig.fail(failure);
    }
    thread::sleep(LEASE);
    let before = Resources::of(rig.served.process());
    let outcomes = (0..repetitions).map(|_| rig.fail(failure)).collect();
    let begin = Instant::now();
    let mut after = Resources::of(rig.served.process());
    while left_over(&before, &after) && begin.elapsed() < LAST {
        thread::sleep(Duration::from_secs(1));
        after = Resources::of(rig.served.process());
    }
    Measured { failure, outcomes, before, after, freed: begin.elapsed() }
}

fn left_over(before: &Resources, after: &Resources) -> bool {
    after.threads > before.threads || after.descriptors > before.descriptors
}

impl Measured {
    fn is_good(&self) -> bool {
        self.within() == self.outcomes.len() && !left_over(&self.before, &self.after)
    }

    fn within(&self) -> usize {
        self.outcomes.iter().filter(|one| one.caught <= CATCH_GOAL && one.ended <= END_GOAL).count()
    }

    fn row(&self) -> String {
        let (caught, ended) = (self.sorted(|one| one.caught), self.sorted(|one| one.ended));
        let distance = self.sorted(|one| one.distance);
        let (middle, last) = (caught.len() / 2, caught.len() - 1);
        format!(
            "| {:?} | {:.0} ms | {:.0} ms | {:.0} ms | {:.0} ms | {:.4} rad | {:.0} ms, {} | {} of {} |",
            self.failure,
            caught[middle],
            caught[last],
            ended[middle],
            ended[last],
            distance[last],
            self.sorted(|one| one.pause)[last],
            self.outcomes.iter().map(|one| one.lost).sum::<u64>(),
            self.within(),
            self.outcomes.len()
        )
    }

    fn sorted(&self, pick: fn(&Outcome) -> f64) -> Vec<f64> {
        let mut values: Vec<f64> = self.outcomes.iter().map(pick).collect();
        values.sort_by(f64::total_cmp);
        values
    }
}
