//! Measures the cycles per second without a rate limit. The system's terminals, the codec of the board protocol and the
//! controller then set the rate. A cycle whose reply was lost does not count.

use crate::Failure;
use crate::fingers::reach;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};
use std::time::{Duration, Instant};
use sun2xp::board::capacity;
use sun2xp::board::protocol::Kind;
use sun2xp::finger::{Losses, Mailbox, Servo, Stage};
use sun2xp::model::configuration::{Configuration, FINGERS, Scheme};
use sun2xp::realtime::{Clock, MonotonicClock, Priority, now, spawn};

/// Measures the cycles per second of three fingers on three pseudo-terminals without a rate limit.
#[derive(clap::Args)]
pub struct Arguments {
    /// Duration, s.
    #[arg(long, default_value_t = 5)]
    pub seconds: u64,
    /// SCHED_FIFO priority of the servo threads; 0: not real-time.
    #[arg(long, default_value_t = 80)]
    pub priority: u8,
}

impl Default for Arguments {
    fn default() -> Self {
        Self { seconds: 5, priority: 80 }
    }
}

/// Goal for the sum of the cycles per second of all fingers. Cycles that lost their replies do not count.
const GOAL: f64 = 30_000.0;

/// The rate for which the controllers are designed, Hz. It is near the measured rate, so that the fingers stay under
/// control.
const CONTROLLER_RATE: f64 = 10_000.0;

/// Period of the servos before the fingers are under control, ns. Afterwards a servo has no fixed period, but still
/// waits for replies for at most 85 % of this time.
const PERIOD: u64 = 1_000_000;

/// Priority of the simulated boards, below the servos.
const BOARD_PRIORITY: u8 = 20;

const BAUD: u32 = 1_000_000;

/// Phases of the measurement.
pub const OPEN: u8 = 0;
pub const MEASURE: u8 = 1;
const END: u8 = 2;

/// A clock that sleeps as usual until the fingers are under control. Afterwards it does not sleep. The servos begin at
/// an ordinary rate because, on a machine with other work, a servo that never sleeps would prevent the system from
/// transporting the bytes of the servo's pseudo-terminal.
#[derive(Clone)]
pub struct UnlimitedClock {
    pub phase: Arc<AtomicU8>,
}

impl Clock for UnlimitedClock {
    fn now(&self) -> u64 {
        now()
    }

    fn sleep_until(&self, deadline: u64) {
        if self.phase.load(Relaxed) == OPEN {
            MonotonicClock.sleep_until(deadline);
        }
    }
}

/// Time limit for the fingers to come under control. Other work on the machine slows them down.
const OPENING: Duration = Duration::from_secs(30);

/// Largest number of attempts. The measurement is repeated if a finger was not measured.
const ATTEMPTS: u32 = 3;

/// A finger counts as not measured if it stayed under control for less than this time.
const SHORTEST: Duration = Duration::from_millis(500);

/// The phase of the measurement. Dropping this value ends the servo threads, even if the measurement fails.
struct Phase(Arc<AtomicU8>);

impl Drop for Phase {
    fn drop(&mut self) {
        self.0.store(END, Relaxed);
    }
}

/// The result of one finger: the number of cycles per second, without those that lost their replies; the number of lost
/// replies; and what ended the measurement early, if anything. The error says why nothing was measured.
pub type Row = Result<(f64, u64, Option<String>), String>;

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut rows: Vec<Row> = Vec::new();
    for attempt in 1..=ATTEMPTS {
        rows = measure(arguments).unwrap_or_else(|failure| vec![Err(failure.to_string()); FINGERS]);
        match rows.iter().find_map(|row| row.as_ref().err()) {
            Some(reason) => {
                eprintln!("attempt {attempt} of {ATTEMPTS}: {reason}. Other work on the machine can cause this.")
            }
            None => break,
        }
    }
    println!("| finger | cycles per second | lost replies |\n|---|---|---|");
    for (finger, row) in (1..).zip(&rows) {
        match row {
            Ok((rate, lost, None)) => println!("| {finger} | {rate:.0} | {lost} |"),
            Ok((rate, lost, Some(reason))) => println!("| {finger} | {rate:.0}, {reason} | {lost} |"),
            Err(reason) => println!("| {finger} | not measured: {reason} | |"),
        }
    }
    let rates: Result<Vec<f64>, &String> = rows.iter().map(|row| row.as_ref().map(|(rate, ..)| *rate)).collect();
    let Ok(rates) = rates else {
        println!("| all | not measured (goal {GOAL:.0}) | |\n");
        return Err("a finger was not measured: measure again when the machine has no other work".into());
    };
    let all: f64 = rates.iter().sum();
    println!("| all | {all:.0} (goal {GOAL:.0}) | |\n");
    let bytes = Kind::Command.wire_length() + Kind::Reply.wire_length();
    let share = capacity(BAUD, 1, 1000.0)?;
    println!(
        "Bytes per cycle: {bytes}. At {BAUD} baud, one finger at 1000 Hz uses {:.0} % of the line's capacity. The \
         limit is {:.0} Hz. A pseudo-terminal has no such limit, and here runs at {:.1} times that rate.\n",
        100.0 * share,
        1000.0 / share,
        all / 3.0 * share / 1000.0
    );
    Ok(())
}

/// Measures all fingers once.
pub fn measure(arguments: &Arguments) -> Result<Vec<Row>, Failure> {
    let mut configuration = Configuration::default();
    configuration.hand.rate = CONTROLLER_RATE;
    // A machine with other work may delay the terminals' bytes. This must not cause a fault.
    (configuration.hand.watchdog_ms, configuration.hand.open_timeout_ms) = (1000, 60_000);
    for finger in &mut configuration.fingers {
        // State feedback assumes equal periods. Without a rate limit the periods differ.
        finger.controller.scheme = Some(Scheme::Figure10);
    }
    let phase = Phase(Arc::new(AtomicU8::new(OPEN)));
    let (mut mailboxes, mut boards, mut threads) = (Vec::new(), Vec::new(), Vec::new());
    for finger in reach(&configuration, PERIOD, BOARD_PRIORITY)? {
        let (port, schedule, uncollected) = (finger.port, finger.schedule, finger.uncollected);
        let clock = UnlimitedClock { phase: phase.0.clone() };
        mailboxes.push(finger.mailbox);
        boards.push(finger.board);
        threads.push(spawn("servo", Priority { fifo: arguments.priority, core: None }, move |_| {
            let phase = clock.phase.clone();
            let mut servo = Servo::new(clock, schedule, vec![port]);
            while phase.load(Relaxed) != END {
                servo.cycle();
            }
            drop(uncollected);
        })?);
    }
    let rows = observe(&mailboxes, &phase, Duration::from_secs(arguments.seconds));
    drop(phase);
    threads
        .into_iter()
        .try_for_each(|thread| thread.join().map_err(|_| "a servo panicked: standard error has its message"))?;
    Ok(rows)
}

/// Lets the servos run without a rate limit once all fingers are under control, and measures them.
fn observe(mailboxes: &[Mailbox], phase: &Phase, length: Duration) -> Vec<Row> {
    let begun = Instant::now();
    let opening = |mailbox: &Mailbox| mailbox.report().stage == Stage::Opening;
    while mailboxes.iter().any(opening) && begun.elapsed() < OPENING {
        std::thread::sleep(Duration::from_millis(10));
    }
    let running = |mailbox: &Mailbox| mailbox.report().stage == Stage::Running;
    if !mailboxes.iter().all(running) {
        return mailboxes.iter().map(|mailbox| Err(state(mailbox))).collect();
    }
    phase.0.store(MEASURE, Relaxed);
    let begun = Instant::now();
    let before: Vec<_> = mailboxes.iter().map(|mailbox| mailbox.report().losses).collect();
    // The last counts that each finger reported while it was under control, and the time of that report.
    let mut last: Vec<_> = before.iter().map(|losses| (*losses, Duration::ZERO)).collect();
    while begun.elapsed() < length {
        std::thread::sleep(Duration::from_millis(50));
        for (mailbox, last) in mailboxes.iter().zip(&mut last) {
            let report = mailbox.report();
            if report.stage == Stage::Running {
                *last = (report.losses, begun.elapsed());
            }
        }
    }
    let row = |((mailbox, before), (losses, after)): ((&Mailbox, &Losses), &(Losses, Duration))| {
        if *after < SHORTEST {
            return Err(state(mailbox));
        }
        let losses = losses.since(before);
        let rate = (losses.cycles - losses.lost_replies) as f64 / after.as_secs_f64();
        let ended = (!running(mailbox)).then(|| format!("only for {:.1} s: {}", after.as_secs_f64(), state(mailbox)));
        Ok((rate, losses.lost_replies, ended))
    };
    mailboxes.iter().zip(&before).zip(&last).map(row).collect()
}

/// Returns why the measurement of a finger did not begin, or ended early.
fn state(mailbox: &Mailbox) -> String {
    let report = mailbox.report();
    let losses = report.losses;
    match report.stage {
        Stage::Running => "another finger did not come under control".into(),
        Stage::Opening => format!(
            "not under tension after {} s, {} of {} replies lost",
            OPENING.as_secs(),
            losses.lost_replies,
            losses.cycles
        ),
        Stage::Faulted(fault) => fault.to_string(),
        stage => format!("{stage:?}"),
    }
}
