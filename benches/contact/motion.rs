//! Random motions of the set point.

use nalgebra::Vector3;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// A sequence of straight lines in joint space, with rests between some of them. Angles are in rad.
pub struct Motion {
    random: Pcg64,
    low: Vector3<f64>,
    high: Vector3<f64>,
    pub joints: Vector3<f64>,
    target: Vector3<f64>,
    /// Rate of the fastest joint on the present line, rad/s.
    rate: f64,
    /// Whether there are rests between lines.
    rests: bool,
    /// Cycles that are left of the present rest.
    rest: u32,
}

impl Motion {
    pub fn new(seed: u64, (low, high): (Vector3<f64>, Vector3<f64>), start: Vector3<f64>) -> Self {
        let random = Pcg64::seed_from_u64(seed);
        Self { random, low, high, joints: start, target: start, rate: 1.0, rests: true, rest: 500 }
    }

    /// Moves without rests between the lines.
    pub fn without_rests(self) -> Self {
        Self { rests: false, rest: 0, ..self }
    }

    /// Returns a random number between 0 and 1.
    pub fn uniform(&mut self) -> f64 {
        self.random.next_u32() as f64 / f64::from(u32::MAX)
    }

    /// Returns the joint angles of the next cycle, rad. The joint rates of new lines are at most `speed`, rad/s.
    /// `period` is the length of a cycle, s.
    pub fn set_point(&mut self, speed: f64, period: f64) -> Vector3<f64> {
        if self.rest > 0 {
            self.rest -= 1;
        } else if self.joints == self.target {
            self.target = Vector3::from_fn(|joint, _| {
                let part = self.uniform();
                self.low[joint] + (self.high[joint] - self.low[joint]) * (0.03 + 0.94 * part)
            });
            self.rate = speed * (0.2 + 0.8 * self.uniform());
            self.rest = if self.rests && self.uniform() < 0.5 { (self.uniform() * 1500.0) as u32 } else { 0 };
        } else {
            let way = self.target - self.joints;
            let longest = way.amax();
            let step = self.rate * period;
            self.joints = if step >= longest { self.target } else { self.joints + way * (step / longest) };
        }
        self.joints
    }
}
