//! The cables and tendons between a simulated board and its finger, which may be mixed up.

/// Largest count of the converter behind each gauge.
const GAUGE_FULL_SCALE: u16 = 4095;

/// For each connector of the board: the motor, encoder or gauge that is connected to it, and the defects of this
/// connection. Indices run from 0 to 3.
#[derive(Clone, Debug)]
pub struct Wiring {
    motor_at: [usize; 4],
    encoder_at: [usize; 4],
    gauge_at: [usize; 4],
    /// Factor of the torque at each motor's connector: 1, -1, or 0 if the motor is not connected.
    torque: [f64; 4],
    /// Whether each encoder counts backwards.
    backwards: [bool; 4],
    /// The count of an encoder that no longer counts.
    stuck: [Option<i32>; 4],
    /// Whether the signal wires of each gauge are swapped.
    reversed: [bool; 4],
}

impl Default for Wiring {
    fn default() -> Self {
        let own = [0, 1, 2, 3];
        Self {
            motor_at: own,
            encoder_at: own,
            gauge_at: own,
            torque: [1.0; 4],
            backwards: [false; 4],
            stuck: [None; 4],
            reversed: [false; 4],
        }
    }
}

impl Wiring {
    /// Swaps the cables of two motors.
    pub fn swap_motors(&mut self, one: usize, other: usize) {
        self.motor_at.swap(one, other);
    }

    /// Swaps the cables of two encoders.
    pub fn swap_encoders(&mut self, one: usize, other: usize) {
        self.encoder_at.swap(one, other);
    }

    /// Connects each of two tendons to the motor of the other one. A motor and its encoder turn together. To the board,
    /// it therefore looks as if the cables of both motors and of both encoders were swapped.
    pub fn swap_tendons(&mut self, one: usize, other: usize) {
        self.swap_motors(one, other);
        self.swap_encoders(one, other);
    }

    /// Swaps the cables of two gauges.
    pub fn swap_gauges(&mut self, one: usize, other: usize) {
        self.gauge_at.swap(one, other);
    }

    /// Swaps the two wires of a motor.
    pub fn reverse_motor(&mut self, motor: usize) {
        self.torque[motor] = -self.torque[motor];
    }

    /// Disconnects a motor.
    pub fn disconnect_motor(&mut self, motor: usize) {
        self.torque[motor] = 0.0;
    }

    /// Swaps the two channels of an encoder.
    pub fn reverse_encoder(&mut self, encoder: usize) {
        self.backwards[encoder] = !self.backwards[encoder];
    }

    /// Stops an encoder at a count.
    pub fn stop_encoder(&mut self, encoder: usize, count: i32) {
        self.stuck[encoder] = Some(count);
    }

    /// Swaps the signal wires of a gauge. Its counts are then mirrored about the middle of the converter's range.
    pub fn reverse_gauge(&mut self, gauge: usize) {
        self.reversed[gauge] = !self.reversed[gauge];
    }

    /// Returns the torques of the finger's motors if the board commands the torques `commanded`.
    #[must_use]
    pub fn torques(&self, commanded: [f64; 4]) -> [f64; 4] {
        let mut torques = [0.0; 4];
        for connector in 0..4 {
            torques[self.motor_at[connector]] = self.torque[connector] * commanded[connector];
        }
        torques
    }

    /// Converts the counts of the finger's encoders and gauges to the counts that the board reads.
    #[must_use]
    pub fn counts(&self, (encoders, gauges): ([i32; 4], [u16; 4])) -> ([i32; 4], [u16; 4]) {
        let encoder = |connector: usize| {
            let count = self.stuck[connector].unwrap_or(encoders[self.encoder_at[connector]]);
            if self.backwards[connector] { count.wrapping_neg() } else { count }
        };
        let gauge = |connector: usize| {
            let count = gauges[self.gauge_at[connector]];
            if self.reversed[connector] { GAUGE_FULL_SCALE.saturating_sub(count) } else { count }
        };
        (std::array::from_fn(encoder), std::array::from_fn(gauge))
    }
}
