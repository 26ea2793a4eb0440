//! A model of a bad line, on the clock of the caller. The line loses some packets, delays the others, and may let a
//! later packet overtake an earlier one.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::time::{Duration, Instant};

/// The state of one direction of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Conditions {
    /// Probability that a packet is lost, 0 to 1. 1 is a cut.
    pub loss: f64,
    /// Smallest delay of a packet.
    pub delay: Duration,
    /// Largest further delay. The further delay is uniformly distributed from 0 to this value.
    pub jitter: Duration,
    /// Whether a packet may overtake an earlier one with a longer delay.
    pub reorders: bool,
}

impl Conditions {
    /// A direction in which nothing arrives.
    pub const CUT: Self = Self { loss: 1.0, delay: Duration::ZERO, jitter: Duration::ZERO, reorders: false };

    /// A direction that loses a fraction of the packets, 0 to 1.
    pub fn losing(loss: f64) -> Self {
        Self { loss, ..Self::default() }
    }

    /// A direction that delays packets by up to `jitter`.
    pub fn jittering(jitter: Duration, reorders: bool) -> Self {
        Self { jitter, reorders, ..Self::default() }
    }
}

/// The packets of one direction that are under way.
pub struct Shaper {
    pub conditions: Conditions,
    random: Random,
    under_way: BinaryHeap<Reverse<(Instant, u64, Vec<u8>)>>,
    offered: u64,
    lost: u64,
    newest_arrival: Option<Instant>,
}

impl Shaper {
    /// Returns a perfect line. Equal seeds give equal losses and delays.
    pub fn new(seed: u64) -> Self {
        let (conditions, random) = (Conditions::default(), Random(seed));
        Self { conditions, random, under_way: BinaryHeap::new(), offered: 0, lost: 0, newest_arrival: None }
    }

    /// Takes a packet that was sent now.
    pub fn offer(&mut self, now: Instant, packet: Vec<u8>) {
        self.offered += 1;
        if self.random.fraction() < self.conditions.loss {
            self.lost += 1;
            return;
        }
        let mut arrival = now + self.conditions.delay + self.conditions.jitter.mul_f64(self.random.fraction());
        if !self.conditions.reorders {
            arrival = self.newest_arrival.map_or(arrival, |newest| newest.max(arrival));
            self.newest_arrival = Some(arrival);
        }
        self.under_way.push(Reverse((arrival, self.offered, packet)));
    }

    /// Returns the next packet that has arrived by now.
    pub fn arrived(&mut self, now: Instant) -> Option<Vec<u8>> {
        if self.next_arrival()? > now {
            return None;
        }
        self.under_way.pop().map(|Reverse((_, _, packet))| packet)
    }

    /// Returns the time at which the next packet arrives.
    pub fn next_arrival(&self) -> Option<Instant> {
        self.under_way.peek().map(|Reverse((arrival, ..))| *arrival)
    }

    /// Loses every packet that is under way, as a cable does when it is unplugged.
    pub fn clear(&mut self) {
        self.lost += self.under_way.len() as u64;
        self.under_way.clear();
    }

    /// Returns how many packets were offered, and how many of them were lost.
    pub fn counts(&self) -> (u64, u64) {
        (self.offered, self.lost)
    }
}

/// The generator SplitMix64: enough for losses and noise, and the same on every machine.
pub struct Random(pub u64);

impl Random {
    /// Returns a number from 0 to 1, without 1.
    pub fn fraction(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns a number from 0 to `count` - 1.
    pub fn below(&mut self, count: usize) -> usize {
        (self.fraction() * count as f64) as usize
    }

    /// Returns 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }
}
