//! Measures whether the commands of a group take effect in the same period of all its fingers, with one servo thread
//! for each finger.

use crate::Failure;
use crate::attempts::Attempts;
use crate::percentiles::Percentiles;
use crate::under_control::under_control;
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

/// The groups that took effect so far.
#[derive(Default)]
pub struct Measured {
    /// For each group, the time until the planner saw it in effect in all fingers, ns.
    pub delays: Vec<u64>,
    /// Number of groups that took effect in the same period of all fingers.
    same: u32,
    /// Number of the other groups during which a servo skipped a period.
    skipping: u32,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (mut measured, mut attempts) = (Measured::default(), Attempts::default());
    attempts.measure("groups", || measured.send(&Hand::open(Configuration::default())?, arguments.groups));
    measured.print(arguments.groups, &attempts);
    Ok(attempts.check([("groups", measured.delays.len())])?)
}

impl Measured {
    /// Sends groups to the hand until `wanted` groups have taken effect, including those of earlier hands.
    ///
    /// # Errors
    /// Says why a group has not taken effect. The results of the earlier groups are kept.
    pub fn send(&mut self, hand: &Hand, wanted: u32) -> Result<(), Failure> {
        while self.delays.len() < wanted as usize {
            self.send_next(hand)?;
        }
        Ok(())
    }

    fn send_next(&mut self, hand: &Hand) -> Result<(), Failure> {
        let skipped = reports(hand)?.map(|report| report.losses.skipped_periods);
        // Every group has its own pose.
        let pose = [0.0, 0.5, 0.8 + 1e-6 * self.delays.len() as f64];
        let sent = Instant::now();
        hand.send_group(&[1, 2, 3].map(|finger| FingerCommand::new(finger).joints(pose)))?;
        let taken = loop {
            let taken = reports(hand)?;
            if taken.iter().all(|report| report.set_point.joints.as_slice() == pose) {
                break taken;
            }
            (1..).zip(&taken).try_for_each(|(finger, report)| under_control(finger, &report.stage))?;
            if sent.elapsed().as_secs_f64() > LONGEST {
                return Err(format!("a group has not taken effect within {LONGEST} s").into());
            }
            yield_now();
        };
        self.delays.push(sent.elapsed().as_nanos() as u64);
        let together = taken.iter().all(|report| report.set_point_period == taken[0].set_point_period);
        self.same += u32::from(together);
        let late = taken.iter().zip(skipped).any(|(report, skipped)| report.losses.skipped_periods > skipped);
        self.skipping += u32::from(!together && late);
        Ok(())
    }

    fn print(&self, wanted: u32, attempts: &Attempts) {
        let (same, skipping, taken) = (self.same, self.skipping, self.delays.len());
        print!("Groups of {FINGERS} fingers in {FINGERS} servo threads: ");
        if self.delays.is_empty() {
            println!("not measured, because every measurement failed or was skipped. {attempts}.\n");
            return;
        }
        let Percentiles { median, p99, .. } = Percentiles::of(self.delays.clone());
        println!(
            "{same} of {taken} took effect in the same period of all fingers (goal: all). In {skipping} of the others \
             a late servo had skipped the period. The planner saw the group in effect in all fingers after {:.1} ms \
             (median), {:.1} ms (99 %). {wanted} groups were to be measured. {attempts}.\n",
            median * 1e-3,
            p99 * 1e-3
        );
    }
}

fn reports(hand: &Hand) -> Result<[FingerReport; FINGERS], Failure> {
    Ok([hand.report(1)?, hand.report(2)?, hand.report(3)?])
}
