//! What a person does to a finger by hand.

use super::Plant;
use crate::plant::holding_hand::HoldingHand;
use nalgebra::{Vector3, Vector4};

impl Plant {
    /// Turns a motor by `angle`, rad, as a person could by hand. A negative angle unwinds its tendon.
    pub fn turn_motor(&mut self, motor: usize, angle: f64) {
        self.motor[motor] += angle;
        self.tendons.slide(&self.theta, &self.motor);
    }

    /// Takes up the slack of every tendon as far as a person can by turning its motor by hand. A torn tendon stays
    /// loose.
    pub fn take_up_by_hand(&mut self) {
        const TURN: f64 = 0.5;
        for motor in 0..4 {
            let loose = |tensions: Vector4<f64>| tensions[motor] < 0.1;
            let begin = self.motor[motor];
            let tight = (0..200).any(|_| {
                self.turn_motor(motor, TURN);
                !loose(self.tensions())
            });
            let back = if tight { -TURN } else { begin - self.motor[motor] };
            self.turn_motor(motor, back);
        }
    }

    /// Hangs a weight, N, on a tendon, 0 to 3, between its gauge and the finger, with the motor's end fixed. Only the
    /// gauge feels it.
    pub fn hang(&mut self, tendon: usize, weight: f64) {
        self.hung[tendon] = weight;
    }

    /// Holds the joints at these angles, rad, as a person's hand does.
    pub fn hold(&mut self, pose: Vector3<f64>) {
        self.held = Some(HoldingHand::new(pose));
    }

    /// Removes the holding hand.
    pub fn release(&mut self) {
        self.held = None;
    }
}
