//! Defects that a simulated finger can get while it runs.

use crate::board::protocol::Status;
use crate::simulated::finger::SimulatedFinger;
use crate::simulated::wiring::Wiring;

/// A cable between a board and its finger, or a tendon. Two parts of one kind can be connected in each other's place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WiredPart {
    /// The cable of a motor.
    Motor,
    /// The cable of an encoder.
    Encoder,
    /// The cable of a gauge.
    Gauge,
    /// A tendon between its motor and the joints.
    Tendon,
}

/// A defect of one finger. Tendons, motors, gauges and encoders have the numbers 1 to 4, as in the texts of faults.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Defect {
    /// A tendon is torn.
    CutTendon(u8),
    /// A tendon slips in its clamp above a certain tension.
    SlippingTendon {
        /// The tendon's number.
        tendon: u8,
        /// The largest tension that the clamp holds, N.
        grip: f64,
    },
    /// A motor is blocked.
    JammedMotor(u8),
    /// A motor is too hot, and its driver switches off. All motors lose their torque, as with any fault that the board
    /// detects.
    HotMotor(u8),
    /// The reading of a gauge no longer changes.
    DeadGauge {
        /// The gauge's number.
        gauge: u8,
        /// The constant reading. `None`: the current reading.
        count: Option<u16>,
    },
    /// The reading of a gauge drifts.
    DriftingGauge {
        /// The gauge's number.
        gauge: u8,
        /// Rate of the drift, N/s.
        speed: f64,
    },
    /// An encoder gains or loses counts.
    EncoderJump {
        /// The encoder's number.
        encoder: u8,
        /// Number of counts.
        counts: i32,
    },
    /// Two parts are connected in each other's place.
    Swapped(WiredPart, u8, u8),
    /// A part is connected backwards. A tendon cannot have this defect.
    Reversed(WiredPart, u8),
    /// The gain of a gauge has changed.
    GaugeGain {
        /// The gauge's number.
        gauge: u8,
        /// Ratio of the new gain to the gain without this defect.
        ratio: f64,
    },
    /// A motor is not connected.
    DeadMotor(u8),
    /// An encoder no longer counts.
    DeadEncoder(u8),
    /// A tactile element, counted from 0 as in the configuration, can no longer be read.
    DeadElement(u8),
    /// The board reports that its encoder counts are no longer valid.
    ZeroLost,
    /// The emergency stop input is active.
    EmergencyStop,
    /// The motor supply fails.
    Supply,
    /// The board cannot read a sensor.
    Sensor,
    /// The board loses its power for a moment.
    Reset,
}

impl SimulatedFinger {
    /// Adds this defect to the finger. Returns false, and does nothing, if the finger has no such part, or if the part
    /// cannot have this defect.
    pub fn inject(&mut self, defect: &Defect) -> bool {
        let part = match *defect {
            Defect::CutTendon(part) | Defect::JammedMotor(part) | Defect::HotMotor(part) => part,
            Defect::SlippingTendon { tendon: part, .. } | Defect::DeadGauge { gauge: part, .. } => part,
            Defect::DriftingGauge { gauge: part, .. } | Defect::EncoderJump { encoder: part, .. } => part,
            Defect::Swapped(_, part, other) if (1..=4).contains(&other) => part,
            Defect::Swapped(..) => 0,
            Defect::Reversed(_, part) | Defect::GaugeGain { gauge: part, .. } => part,
            Defect::DeadMotor(part) | Defect::DeadEncoder(part) => part,
            Defect::DeadElement(_)
            | Defect::ZeroLost
            | Defect::EmergencyStop
            | Defect::Supply
            | Defect::Sensor
            | Defect::Reset => 1,
        };
        let Some(index) = usize::from(part).checked_sub(1).filter(|&index| index < 4) else { return false };
        match *defect {
            Defect::CutTendon(_) => self.plant().cut_tendon(index),
            Defect::SlippingTendon { grip, .. } => self.plant().loosen_tendon(index, grip),
            Defect::JammedMotor(_) => self.plant().jam_motor(index),
            Defect::HotMotor(_) => self.add_faults(Status::DRIVER_FAULT),
            Defect::DeadGauge { count, .. } => self.sensors().kill_gauge(index, count),
            Defect::DriftingGauge { speed, .. } => self.sensors().let_gauge_drift(index, speed),
            Defect::EncoderJump { counts, .. } => self.sensors().jump(index, counts),
            Defect::Swapped(connection, _, other) => self.swap(connection, index, usize::from(other) - 1),
            Defect::Reversed(WiredPart::Motor, _) => self.wiring().reverse_motor(index),
            Defect::Reversed(WiredPart::Encoder, _) => self.wiring().reverse_encoder(index),
            Defect::Reversed(WiredPart::Gauge, _) => self.wiring().reverse_gauge(index),
            Defect::Reversed(WiredPart::Tendon, _) => return false,
            Defect::GaugeGain { ratio, .. } => self.sensors().rescale_gauge(index, ratio),
            Defect::DeadMotor(_) => self.wiring().disconnect_motor(index),
            Defect::DeadEncoder(_) => self.wiring().stop_encoder(index, 0),
            Defect::DeadElement(element) => return self.break_element(element.into()),
            Defect::ZeroLost => self.set_zero_valid(false),
            Defect::EmergencyStop => self.add_faults(Status::EMERGENCY_STOP),
            Defect::Supply => self.add_faults(Status::SUPPLY_FAULT),
            Defect::Sensor => self.add_faults(Status::SENSOR_FAULT),
            Defect::Reset => self.reset(),
        }
        true
    }

    fn swap(&mut self, connection: WiredPart, one: usize, other: usize) {
        match connection {
            WiredPart::Motor => self.wiring().swap_motors(one, other),
            WiredPart::Encoder => self.wiring().swap_encoders(one, other),
            WiredPart::Gauge => self.wiring().swap_gauges(one, other),
            WiredPart::Tendon => self.wiring().swap_tendons(one, other),
        }
    }

    /// Removes all defects. Faults that the board has stored remain until the next Configure.
    pub fn repair(&mut self) {
        self.plant().repair();
        self.sensors().repair();
        *self.wiring() = Wiring::default();
        self.repair_elements();
        self.set_zero_valid(true);
        self.set_faults(Status::default());
    }
}
