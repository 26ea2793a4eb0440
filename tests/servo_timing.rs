//! Periods of a servo on simulated time: late cycles are counted, and the periods that pass meanwhile are skipped and
//! counted. Also tests the age of the feedback and the board's clock.

#[allow(dead_code)]
#[path = "common/finger_on_a_cable.rs"]
mod finger_on_a_cable;

use finger_on_a_cable::{Hooks, ServedFinger, World};
use std::cell::Cell;
use sun2xp::board::{PortError, Transport};
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::{Clock, CycleStage, Distribution, Histograms};
use sun2xp::simulated::SimulatedCable;

const PERIOD: u64 = 1_000_000;

/// A host and a board, whose clock may be faster or slower than the host's.
#[derive(Default)]
struct Clocks {
    now: Cell<u64>,
    drift: f64,
    /// Delay of the next wake-up of the host's thread, ns.
    oversleep: u64,
    /// Beginnings of cycles on the board's clock, ns.
    beginnings: Vec<u64>,
    /// Whether replies are withheld.
    withheld: bool,
    /// Number of times that the host has read its clock since its last wake-up.
    readings: Cell<u32>,
    /// A pair (n, t): t ns pass before the host reads its clock for the n-th time after a wake-up. This happens only
    /// once, and not in later cycles.
    busy: Cell<(u32, u64)>,
}

impl Clocks {
    fn advance_to(&mut self, cable: &mut SimulatedCable, time: u64) {
        self.now.set(self.now.get().max(time));
        cable.advance_to(self.board_time());
    }

    fn board_time(&self) -> u64 {
        (self.now.get() as f64 * (1.0 + self.drift)) as u64
    }
}

impl Hooks for Clocks {
    fn read_until(&mut self, cable: &mut SimulatedCable, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        let taken = match self.withheld {
            true => 0,
            // The cable gets the present time as its deadline, so it returns only what has arrived by now. Time passes
            // in this function, not in the cable.
            false => cable.read_until(buffer, self.board_time())?,
        };
        if taken == 0 {
            self.advance_to(cable, deadline);
        }
        Ok(taken)
    }

    fn sleep_until(&mut self, cable: &mut SimulatedCable, deadline: u64) {
        let oversleep = std::mem::take(&mut self.oversleep);
        self.advance_to(cable, deadline + oversleep);
        self.beginnings.push(self.board_time());
        self.readings.set(0);
    }

    fn now(&self, _: &SimulatedCable) -> u64 {
        self.readings.set(self.readings.get() + 1);
        if self.busy.get().0 == self.readings.get() {
            self.now.set(self.now.get() + self.busy.take().1);
        }
        self.now.get()
    }
}

struct Rig {
    world: World<Clocks>,
    finger: ServedFinger<World<Clocks>>,
    /// When the first cycle is due, ns.
    first: u64,
}

impl Rig {
    fn new(drift: f64, follow: bool) -> Self {
        let mut configuration = Configuration::default();
        // The port must not be "simulated": a built-in finger stands still while replies are missing.
        configuration.fingers[0].port = "/dev/cable".into();
        let world = World::new(&configuration, Clocks { drift, ..Clocks::default() });
        let mut finger = ServedFinger::new(&world, &configuration);
        if follow {
            finger.servo = finger.servo.following_board();
        }
        let first = Clock::now(&world) + PERIOD;
        Self { world, finger, first }
    }

    fn cycles(&mut self, count: usize) {
        (0..count).for_each(|_| self.finger.servo.cycle());
    }

    /// The age of the feedback in the cycles since the last call.
    fn age(&mut self) -> Distribution {
        let mut histograms = Histograms::new();
        while let Some(timing) = self.finger.timings.pop() {
            histograms.record(&timing);
        }
        histograms.distribution(CycleStage::Age)
    }

    /// Beginnings of the cycles from number `cycle` on, us after the first was due.
    fn beginnings_from(&self, cycle: usize) -> Vec<u64> {
        self.world.place().hooks.beginnings[cycle..].iter().map(|at| (at - self.first) / 1000).collect()
    }

    /// The mean of the last `cycles` periods, ns of the board's clock.
    fn board_period(&self, cycles: usize) -> f64 {
        let beginnings = &self.world.place().hooks.beginnings;
        let last = beginnings.len() - 1;
        (beginnings[last] - beginnings[last - cycles]) as f64 / cycles as f64
    }
}

#[test]
fn a_late_cycle_runs_late_and_skipped_periods_are_not_made_up() {
    let mut rig = Rig::new(0.0, false);
    rig.cycles(10);
    let losses = rig.finger.mailbox.report().losses;
    assert_eq!((losses.cycles, losses.overruns, losses.skipped_periods, losses.lost_replies), (10, 0, 0, 0));

    // This cycle runs 3.4 periods late. The next two periods are skipped, and the cycle of the third begins at once.
    rig.world.place().hooks.oversleep = 3 * PERIOD + 400_000;
    rig.cycles(6);
    let losses = rig.finger.mailbox.report().losses;
    assert_eq!((losses.cycles, losses.overruns, losses.skipped_periods), (16, 1, 2));
    let beginnings = rig.beginnings_from(10);
    assert_eq!(beginnings, [13_400, 13_400, 14_000, 15_000, 16_000, 17_000], "us");
}

#[test]
fn a_cycle_whose_computation_ends_late_is_an_overrun() {
    let mut rig = Rig::new(0.0, false);
    rig.cycles(10);
    // The servo reads its clock for the last time in a cycle when the computation has ended.
    let last = rig.world.place().hooks.readings.get();
    rig.world.place().hooks.busy.set((last, PERIOD + 50_000));
    rig.cycles(2);
    let losses = rig.finger.mailbox.report().losses;
    assert_eq!((losses.cycles, losses.overruns, losses.skipped_periods, losses.lost_replies), (12, 1, 0, 0));
    assert_eq!(rig.beginnings_from(10), [10_000, 11_050], "us");
}

#[test]
fn feedback_is_one_period_old_and_older_where_replies_stay_away() {
    let mut rig = Rig::new(0.0, false);
    rig.cycles(200);
    let age = rig.age();
    assert_eq!(age.count, 199, "the first command was computed from nothing");
    assert!((age.minimum - 1000.0).abs() < 10.0 && (age.maximum - 1000.0).abs() < 10.0, "{age:?}");

    rig.world.place().hooks.withheld = true;
    rig.cycles(3);
    rig.world.place().hooks.withheld = false;
    rig.cycles(1);
    let age = rig.age();
    assert!(age.count == 1 && (age.maximum - 4000.0).abs() < 40.0, "{age:?}");
    let losses = rig.finger.mailbox.report().losses;
    assert_eq!((losses.lost_replies, losses.late_replies, losses.skipped_periods), (3, 3, 0));

    // The delay exceeds the range of the board's clock. The age is not recorded, because it would be wrong.
    rig.world.place().hooks.oversleep = 70 * PERIOD;
    rig.cycles(2);
    assert!(rig.age().count <= 1);
}

/// Later cycles must not use the last reading of the board's clock from before the stop.
#[test]
fn a_stopped_finger_does_not_change_the_period() {
    let mut rig = Rig::new(0.0, true);
    rig.cycles(1000);
    rig.finger.mailbox.stop();
    rig.cycles(10_000);
    let off = rig.board_period(1000) - PERIOD as f64;
    assert!(off.abs() < 3.0, "periods off by {off} ns");
}

#[test]
fn the_period_can_follow_the_board() {
    for drift in [-200e-6, 200e-6] {
        let mut by_host = Rig::new(drift, false);
        by_host.cycles(2000);
        let off = by_host.board_period(1000) - PERIOD as f64;
        assert!((off - 1e6 * drift).abs() < 3.0, "{off}");

        let mut by_board = Rig::new(drift, true);
        by_board.cycles(20_000);
        let off = by_board.board_period(5000) - PERIOD as f64;
        assert!(off.abs() < 3.0, "{} ppm of drift: periods off by {off} ns", drift * 1e6);
    }
}
