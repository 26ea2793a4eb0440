//! Measures whether the commands of a group take effect in the same period of all its fingers, with one servo thread
//! for each finger.

use crate::Failure;
use crate::percentiles::Percentiles;
use clap::Args;
use std::thread::yield_now;
use std::time::Instant;
use sun2xp::finger::FingerReport;
use sun2xp::groups::FingerCommand;
use sun2xp::hand::Hand;
use sun2xp::model::configuration::{Configuration, FINGERS};

/// Measures in which period of each finger the commands of a group take effect.
#[derive(Args)]
pub struct Arguments {
    /// Number of groups.
    #[arg(long, default_value_t = 10_000)]
    groups: u32,
}

impl Default for Arguments {
    fn default() -> Self {
        Self { groups: 10_000 }
    }
}

/// Longest time until a group takes effect, s.
const LONGEST: f64 = 5.0;

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let hand = Hand::open(Configuration::default())?;
    let (mut same, mut skipping) = (0, 0);
    let mut delays = Vec::new();
    for group in 0..arguments.groups {
        let skipped = reports(&hand)?.map(|report| report.losses.skipped_periods);
        // Every group has its own pose.
        let pose = [0.0, 0.5, 0.8 + 1e-6 * f64::from(group)];
        let sent = Instant::now();
        hand.send_group(&[1, 2, 3].map(|finger| FingerCommand::new(finger).joints(pose)))?;
        let taken = loop {
            let taken = reports(&hand)?;
            if taken.iter().all(|report| report.set_point.joints.as_slice() == pose) {
                break taken;
            }
            if sent.elapsed().as_secs_f64() > LONGEST {
                return Err(format!("group {group} has not taken effect within {LONGEST} s").into());
            }
            yield_now();
        };
        delays.push(sent.elapsed().as_nanos() as u64);
        let together = taken.iter().all(|report| report.set_point_period == taken[0].set_point_period);
        same += u32::from(together);
        let late = taken.iter().zip(skipped).any(|(report, skipped)| report.losses.skipped_periods > skipped);
        skipping += u32::from(!together && late);
    }
    let Percentiles { median, p99, .. } = Percentiles::of(delays);
    println!(
        "Groups of {FINGERS} fingers in {FINGERS} servo threads: {same} of {} took effect in the same period of all \
         fingers (goal: all). In {skipping} of the others a late servo had skipped the period. The planner saw the \
         group in effect in all fingers after {:.1} ms (median), {:.1} ms (99 %).\n",
        arguments.groups,
        median * 1e-3,
        p99 * 1e-3
    );
    Ok(())
}

fn reports(hand: &Hand) -> Result<[FingerReport; FINGERS], Failure> {
    Ok([hand.report(1)?, hand.report(2)?, hand.report(3)?])
}
