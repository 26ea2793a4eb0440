//! Commands that are damaged on the way to the board: the board executes none of them, and the period of each of them
//! remains without a reply.

use crate::rig::{Bench, TARGET};
use nalgebra::Vector3;
use sun2xp::finger::Stage;
use sun2xp::simulated::LineFault;

impl Bench {
    /// Runs one period and returns whether it was answered. If so, the board must execute this period's command, else
    /// the previous one. `lost` is the number of periods before this one that were not answered.
    fn exchanges(&mut self, lost: u32) -> bool {
        // After three lost periods the command decreases, and it reaches zero after ten.
        let left = f64::from(10 - lost.max(3)) / 7.0;
        let (commanded, before) = (self.report().cycle.motor_torques * left, self.executed());
        let losses = self.report().losses.lost_replies;
        self.cycles(1);
        assert_eq!(self.stage(), Stage::Running);
        let (executed, answered) = (self.executed(), self.report().losses.lost_replies == losses);
        let expected = if answered { commanded } else { before };
        // A torque unit is 1.6e-4 N cm.
        assert!((executed - expected).amax() < 2e-4, "answered: {answered}, executed {executed}, expected {expected}");
        answered
    }
}

#[test]
fn a_damaged_command_is_not_executed_and_costs_its_own_period() {
    let mut bench = Bench::new();
    let mut next_too = 0;
    for seed in 0..1000 {
        // The finger is moving, so no two commands are equal.
        let aside = if seed % 100 < 50 { 0.3 } else { -0.3 };
        bench.mailbox.send(|set_point| set_point.joints = TARGET + Vector3::new(aside, 0.0, 0.0)).expect("not faulted");
        bench.with_cable(|cable| cable.inject_to_board(LineFault::Corrupt, 1.0, u64::MAX, seed));
        assert!(!bench.exchanges(0), "seed {seed}");
        bench.with_cable(|cable| cable.clear());
        // A damaged delimiter joins two frames, so the next one is lost too.
        if !bench.exchanges(1) {
            next_too += 1;
            assert!(bench.exchanges(2), "seed {seed}");
        }
        assert!((0..8).all(|_| bench.exchanges(0)), "seed {seed}");
    }
    // The delimiter has 8 of the 136 bits of a Command.
    assert!((20..100).contains(&next_too), "{next_too}");
}

#[test]
fn one_and_five_per_cent_of_lost_and_damaged_commands_are_no_fault() {
    for fault in [LineFault::Drop, LineFault::Corrupt] {
        for percent in [1, 5] {
            let mut bench = Bench::new();
            bench.with_cable(|cable| cable.inject_to_board(fault, f64::from(percent) / 100.0, u64::MAX, 7));
            let (mut unanswered, mut in_a_row) = (0, 0);
            let mut farthest = 0.0f64;
            for second in 0..5 {
                let target = if second % 2 == 0 { TARGET } else { TARGET - Vector3::new(0.2, 0.0, 0.2) };
                bench.mailbox.send(|set_point| set_point.joints = target).expect("not faulted");
                for _ in 0..1000 {
                    in_a_row = if bench.exchanges(in_a_row) { 0 } else { in_a_row + 1 };
                    unanswered += u32::from(in_a_row > 0);
                }
                farthest = farthest.max((bench.report().cycle.joints - target).amax());
            }
            println!("{fault:?}, {percent} %: {unanswered} of 5000 periods, off by {farthest:.4} rad");
            assert!((30 * percent..80 * percent).contains(&unanswered), "{fault:?}, {percent} %: {unanswered}");
            assert!(farthest < 0.03, "{fault:?}, {percent} %: {farthest} rad");
        }
    }
}

#[test]
fn delayed_duplicated_or_reordered_commands_are_no_fault() {
    let late = LineFault::Delay(300_000);
    for fault in [late, LineFault::Duplicate, LineFault::Reorder] {
        let mut bench = Bench::new();
        bench.with_cable(|cable| cable.inject_to_board(fault, 0.05, u64::MAX, 7));
        bench.goes(TARGET);
        assert_eq!(bench.stage(), Stage::Running, "{fault:?}");
    }
}
