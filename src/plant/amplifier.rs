//! The amplifiers between the torques that the board commands and the torques that the rotors receive.

use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;
use std::collections::VecDeque;

/// A dead time, followed by a first-order lag.
#[derive(Clone, Debug)]
pub(super) struct Amplifier {
    /// Dead time, s.
    delay: f64,
    /// Time constant of the lag, s. Zero: no lag.
    lag: f64,
    /// Commands that wait until their dead time has passed, the oldest first.
    waiting: VecDeque<Vector4<f64>>,
    /// Torques, N m.
    torques: Vector4<f64>,
}

impl Amplifier {
    /// `shortest_step` is the shortest step of the physics, s. It determines the memory for the dead time.
    pub fn new(finger: &ConfiguredFinger, shortest_step: f64) -> Self {
        let delay = finger.simulation.command_delay_ms * 1e-3;
        Self {
            delay,
            lag: finger.simulation.amplifier_lag_ms * 1e-3,
            // The memory is reserved here, because the physics may run in a thread that must not allocate.
            waiting: VecDeque::with_capacity((delay / shortest_step).round() as usize + 2),
            torques: Vector4::zeros(),
        }
    }

    /// Returns the torques, N m, during a step of `h` seconds in which the board commands `commanded`, N m.
    pub fn torques(&mut self, commanded: Vector4<f64>, h: f64) -> Vector4<f64> {
        let arrived = self.delayed(commanded, h);
        if self.lag == 0.0 {
            self.torques = arrived;
        } else {
            self.torques += (arrived - self.torques) * -(-h / self.lag).exp_m1();
        }
        self.torques
    }

    fn delayed(&mut self, commanded: Vector4<f64>, h: f64) -> Vector4<f64> {
        let steps = (self.delay / h).round() as usize;
        self.waiting.push_back(commanded);
        if self.waiting.len() <= steps {
            // The dead time has not passed since the first command.
            return self.torques;
        }
        self.waiting.pop_front().unwrap_or(commanded)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn amplifier(delay_ms: f64, lag_ms: f64) -> Amplifier {
        let mut finger = ConfiguredFinger::default();
        finger.simulation.command_delay_ms = delay_ms;
        finger.simulation.amplifier_lag_ms = lag_ms;
        Amplifier::new(&finger, 1e-4)
    }

    #[test]
    fn an_ideal_amplifier_passes_every_command_on_at_once() {
        let mut ideal = amplifier(0.0, 0.0);
        for value in [0.01, -0.02, 0.0] {
            assert_eq!(ideal.torques(Vector4::repeat(value), 1e-4), Vector4::repeat(value));
        }
    }

    #[test]
    fn a_command_arrives_after_the_dead_time_and_with_the_lag() {
        let mut slow = amplifier(1.0, 2.0);
        let torques: Vec<f64> = (0..60).map(|_| slow.torques(Vector4::repeat(1.0), 1e-4)[0]).collect();
        assert!(torques[..10].iter().all(|&torque| torque == 0.0), "{torques:?}");
        // 20 steps of the lag are one time constant.
        assert!((torques[29] - (1.0 - (-1.0f64).exp())).abs() < 1e-12, "{torques:?}");
    }
}
