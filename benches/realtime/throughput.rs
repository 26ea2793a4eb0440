//! Cycles a second without a rate limit: what is left is the system's terminals, the codec and the core. A cycle whose reply was lost is
//! not counted.

use crate::Failure;
use crate::fingers::reach;
use sun2xp::board::capacity;
use sun2xp::board::protocol::Kind;
use sun2xp::finger::{Mailbox, Servo, Stage};
use sun2xp::model::configuration::{Configuration, Scheme};
use sun2xp::realtime::{Clock, Priority, now, spawn};

/// Cycles a second with the rate limit off, three fingers on three pseudo-terminals.
#[derive(clap::Args)]
pub struct Arguments {
    /// How long, s.
    #[arg(long, default_value_t = 5)]
    seconds: u64,
    /// SCHED_FIFO priority of the servo threads; 0: not real-time.
    #[arg(long, default_value_t = 80)]
    priority: u8,
}

impl Default for Arguments {
    fn default() -> Self {
        Self { seconds: 5, priority: 80 }
    }
}

/// Cycles a second of all fingers, with their replies.
const GOAL: f64 = 30_000.0;

/// What the controllers are told, Hz: near what comes of it, so that the fingers are under control.
const TOLD: f64 = 10_000.0;

/// Replies are awaited for most of this, ns.
const LONGEST_CYCLE: u64 = 1_000_000;

/// Of the simulated boards, below the servos.
const BOARD_PRIORITY: u8 = 20;

const BAUD: u32 = 1_000_000;

/// A clock that never waits.
#[derive(Clone, Copy)]
struct Impatient;

impl Clock for Impatient {
    fn now(&self) -> u64 {
        now()
    }

    fn sleep_until(&self, _: u64) {}
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut configuration = Configuration::default();
    configuration.hand.rate = TOLD;
    for finger in &mut configuration.fingers {
        // State feedback reckons with equal periods, and without a rate limit none is like the other.
        finger.controller.scheme = Some(Scheme::Figure10);
    }
    let (mut mailboxes, mut boards, mut threads) = (Vec::new(), Vec::new(), Vec::new());
    let fingers = reach(&configuration, LONGEST_CYCLE, BOARD_PRIORITY)?;
    let begun = now();
    let measured = begun + 1_000_000_000;
    let end = measured + arguments.seconds * 1_000_000_000;
    for finger in fingers {
        let (port, schedule, uncollected) = (finger.port, finger.schedule, finger.uncollected);
        mailboxes.push(finger.mailbox);
        boards.push(finger.board);
        threads.push(spawn("servo", Priority { fifo: arguments.priority, core: None }, move |_| {
            let mut servo = Servo::new(Impatient, schedule, vec![port]);
            // The fingers come under tension first.
            while now() < measured {
                servo.cycle();
            }
            let mut cycles = 0u64;
            while now() < end {
                servo.cycle();
                cycles += 1;
            }
            drop(uncollected);
            cycles
        })?);
    }
    while now() < measured {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let lost_before: Vec<u64> =
        mailboxes.iter().map(|mailbox: &Mailbox| mailbox.report().losses.lost_replies).collect();
    let mut all = 0.0;
    println!("| finger | cycles a second | replies lost |\n|---|---|---|");
    for (index, thread) in threads.into_iter().enumerate() {
        let cycles = thread.join().map_err(|_| "a servo panicked")?;
        let report = mailboxes[index].report();
        if report.stage != Stage::Running {
            return Err(
                format!("finger {} is {:?}, not under control: nothing measured", index + 1, report.stage).into()
            );
        }
        let lost = report.losses.lost_replies - lost_before[index];
        let rate = cycles.saturating_sub(lost) as f64 / arguments.seconds as f64;
        println!("| {} | {rate:.0} | {lost} |", index + 1);
        all += rate;
    }
    println!("| all | {all:.0} (goal {GOAL:.0}) | |\n");
    let bytes = Kind::Command.wire_length() + Kind::Reply.wire_length();
    let share = capacity(BAUD, 1, 1000.0)?;
    println!(
        "Bytes a cycle: {bytes}. At {BAUD} baud one finger at 1000 Hz takes {:.0} % of what the line can do, {:.0} Hz is the limit; \
         a pseudo-terminal has none, and here does {:.1} times that.\n",
        100.0 * share,
        1000.0 / share,
        all / 3.0 * share / 1000.0
    );
    Ok(())
}
