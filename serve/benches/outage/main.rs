//! Lets the planner or the line fail many times, and prints when the fingers were caught and ended, at the board, and
//! what the server has left over. Needs root, because it makes network namespaces.

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

/// Time after which the connections of lost clients are over.
const LEASE: Duration = Duration::from_secs(20);

/// Arguments of the benchmark.
#[derive(Parser)]
struct Arguments {
    /// Repetitions of each failure.
    #[arg(long, default_value_t = 100)]
    repetitions: usize,
    /// Cargo passes this argument.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> ExitCode {
    if planner::ran() {
        return ExitCode::SUCCESS;
    }
    let repetitions = Arguments::parse().repetitions;
    let begin = Instant::now();
    // One after the other, because several hands at once need more processors than a small machine has.
    let measured = Failure::ALL.map(|failure| repeated(failure, repetitions));
    println!(
        "| failure | caught, median | longest | end state, median | longest | held off | pause, missing | within |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for one in &measured {
        println!("{}", one.row());
    }
    println!("\nThe server, before and after, in {} s:", begin.elapsed().as_secs());
    for Measured { failure, before, after, .. } in &measured {
        println!("{failure:?}: {before:?}, {after:?}");
    }
    if measured.iter().all(Measured::is_good) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The repetitions of one failure, and what its server used before and after them.
struct Measured {
    failure: Failure,
    outcomes: Vec<Outcome>,
    before: Resources,
    after: Resources,
}

/// Lets something fail many times.
fn repeated(failure: Failure, repetitions: usize) -> Measured {
    let line = Line::new(1).unwrap_or_else(|error| panic!("namespaces and tun interfaces need root: {error}"));
    let mut rig = Rig::new(line, &format!("{failure:?}"), CATCH_MS);
    // The first planners make the server's threads and buffers.
    for _ in 0..3 {
        rig.fail(failure);
    }
    thread::sleep(LEASE);
    let before = Resources::of(rig.served.process());
    let outcomes = (0..repetitions).map(|_| rig.fail(failure)).collect();
    thread::sleep(LEASE);
    Measured { failure, outcomes, before, after: Resources::of(rig.served.process()) }
}

impl Measured {
    fn is_good(&self) -> bool {
        let left_over = self.after.threads > self.before.threads || self.after.descriptors > self.before.descriptors;
        self.within() == self.outcomes.len() && !left_over
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
