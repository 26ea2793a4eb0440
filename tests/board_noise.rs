//! The link over a cable that changes, loses and adds bytes.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use sun2xp::board::protocol::*;
use sun2xp::board::*;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger, ConfiguredHand};
use sun2xp::simulated::*;

const MS: u64 = 1_000_000;

struct NoisyCable {
    cable: SimulatedCable,
    random: Pcg64,
    /// One byte in this many is disturbed, in each direction. 0 means practically none.
    one_in: u64,
    /// Whether a byte was disturbed since this flag was last cleared.
    hit: bool,
}

impl NoisyCable {
    fn after_noise(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut arriving = Vec::new();
        for &byte in bytes {
            let dice = self.random.next_u64();
            if !dice.is_multiple_of(self.one_in) {
                arriving.push(byte);
                continue;
            }
            self.hit = true;
            let other = (dice >> 32) as u8;
            match (dice >> 40) % 4 {
                0 => {}
                1 => arriving.extend([byte, other]),
                2 => arriving.push(byte ^ 1 << (other % 8)),
                _ => arriving.push(other),
            }
        }
        arriving
    }
}

impl Transport for NoisyCable {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        let arriving = self.after_noise(bytes);
        self.cable.write(&arriving)?;
        Ok(bytes.len())
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        // Leaves room for the bytes that the noise adds.
        let room = buffer.len() / 2;
        let taken = self.cable.read_until(&mut buffer[..room], deadline)?;
        let arriving = self.after_noise(&buffer[..taken]);
        buffer[..arriving.len()].copy_from_slice(&arriving);
        Ok(arriving.len())
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        self.cable.discard_input()
    }

    fn now(&self) -> u64 {
        self.cable.now()
    }
}

#[test]
fn noise_costs_the_periods_that_it_hits_and_no_wrong_value_passes() {
    let finger = ConfiguredFinger::default();
    let board = SimulatedBoard::new(&Configuration::default(), &[FingerNumber::ONE]).unwrap();
    let cable =
        NoisyCable { cable: SimulatedCable::new(board), random: Pcg64::seed_from_u64(7), one_in: 0, hit: false };
    let mut link = Link::new(cable);
    let terms = Terms::new(&ConfiguredHand { watchdog_ms: 1000, ..Default::default() }, &finger);
    let (_, configured) = link.shake_hands(1, &terms, 500 * MS).unwrap();

    // A cycle has 45 bytes, and one byte in 450 is disturbed, so about every tenth cycle is disturbed.
    link.transport().one_in = 450;
    let (mut hit_before, mut unanswered, mut hit_cycles) = (false, 0, 0);
    for cycle in 0..50_000u64 {
        let sequence = cycle as u8;
        let command = Command { toggle: cycle % 2 == 0, enable: false, torques: [0; 4] };
        link.send(&[OutgoingCommand { address: 1, sequence, command }]).unwrap();
        let mut answered = false;
        let deadline = link.transport().now() + MS;
        while let Some(received) = link.receive(deadline).unwrap() {
            assert_eq!((received.address, received.sequence), (1, sequence));
            // The motors are never enabled, so every reply that passes must equal the board's constant answer.
            assert_eq!(
                Status(received.reply.status.0 & !Status::DAMAGED_INPUT.0),
                Status::CONFIGURED | Status::ZERO_VALID
            );
            assert_eq!(received.reply.encoders, configured.encoders.map(|count| count as u16));
            answered = true;
        }
        let hit = std::mem::take(&mut link.transport().hit);
        assert!(answered || hit || hit_before, "cycle {cycle} went unanswered though nothing was hit");
        unanswered += u32::from(!answered);
        hit_cycles += u32::from(hit);
        hit_before = hit;
    }
    // A disturbed delimiter also costs the next frame. Any other disturbance costs only its own period.
    assert!((4000..6000).contains(&hit_cycles), "{hit_cycles}");
    assert!(unanswered > 4000 && f64::from(unanswered) < 1.1 * f64::from(hit_cycles), "{unanswered} of {hit_cycles}");
    assert!(link.counters().damaged > 1000);
}
