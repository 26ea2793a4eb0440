//! A finger in step with its simulated board, on a machine that delays replies. The board's time stands still while it
//! waits for the next command, and the host's time does not.

use crate::finger_on_a_cable::{Hooks, ServedFinger, World};
use crate::rig::{MILLISECOND, TARGET};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::cell::Cell;
use sun2xp::board::{PortError, Transport};
use sun2xp::finger::Stage;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::{Clock, Schedule};
use sun2xp::simulated::SimulatedCable;

struct BusyMachine {
    /// The time of the host, ns.
    host: Cell<u64>,
    /// The board's time stands still when it has reached this time, ns, until the next command.
    limit: u64,
    /// The reply on its way arrives at this time of the host, ns.
    release: u64,
    random: Pcg64,
}

impl BusyMachine {
    fn new(seed: u64) -> Self {
        Self { host: Cell::new(0), limit: MILLISECOND, release: 0, random: Pcg64::seed_from_u64(seed) }
    }

    /// Advances the host's time to `until`, ns, and the board's time by the same span, but not beyond `limit`.
    fn pass(&mut self, cable: &mut SimulatedCable, until: u64) {
        let passed = until.saturating_sub(self.host.get());
        self.host.set(until.max(self.host.get()));
        cable.advance_to((cable.now() + passed).min(self.limit.max(cable.now())));
    }
}

impl Hooks for BusyMachine {
    fn write(&mut self, cable: &mut SimulatedCable, bytes: &[u8]) -> Result<usize, PortError> {
        if bytes.is_empty() {
            return Ok(0);
        }
        self.limit = cable.now() + MILLISECOND;
        if self.random.next_u32().is_multiple_of(100) {
            self.release = self.host.get() + u64::from(1 + self.random.next_u32() % 300) * MILLISECOND;
        }
        cable.write(bytes)
    }

    fn read_until(&mut self, cable: &mut SimulatedCable, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        if self.release >= deadline {
            self.pass(cable, deadline);
            return Ok(0);
        }
        let release = self.release;
        self.pass(cable, release);
        let taken = cable.read_until(buffer, cable.now())?;
        if taken == 0 {
            self.pass(cable, deadline);
        }
        Ok(taken)
    }

    fn sleep_until(&mut self, cable: &mut SimulatedCable, deadline: u64) {
        self.pass(cable, deadline);
    }

    fn now(&self, _: &SimulatedCable) -> u64 {
        self.host.get()
    }
}

#[test]
fn a_machine_that_delays_replies_causes_no_fault() {
    let configuration = Configuration::default();
    let hand = configuration.hand.clone();
    for seed in 1..=4 {
        let world = World::new(&configuration, BusyMachine::new(seed));
        let schedule = Schedule::new(Clock::now(&world) + MILLISECOND, MILLISECOND);
        let ServedFinger { mut servo, mailbox, .. } =
            ServedFinger::in_thread(&world, &configuration, &configuration, schedule, |finger| finger.in_step(&hand));
        let mut poses = [TARGET, TARGET / 2.0].into_iter().cycle();
        for cycle in 1..=100_000 {
            servo.cycle();
            if let Stage::Faulted(fault) = mailbox.report().stage {
                panic!("seed {seed}, cycle {cycle}: {fault}");
            }
            if cycle % 5_000 == 0 {
                let joints = poses.next().expect("endless");
                mailbox.send(|set_point| set_point.joints = joints).expect("not faulted");
            }
        }
        let losses = mailbox.report().losses;
        assert!(losses.lost_replies > 10_000, "the machine delays replies: {losses:?}");
    }
}
