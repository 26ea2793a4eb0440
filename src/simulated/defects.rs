//! What can be broken about a simulated finger, while it runs.

use crate::board::protocol::Status;
use crate::simulated::finger::SimulatedFinger;

/// A defect of one finger. Tendons, motors, gauges and encoders are counted from 1 to 4, as in the texts of faults.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Defect {
    /// A tendon is torn.
    CutTendon(u8),
    /// A tendon slips where it is clamped, and bears no more than so much.
    SlackTendon {
        /// Which.
        tendon: u8,
        /// What it bears, N.
        grip: f64,
    },
    /// A motor is blocked.
    JammedMotor(u8),
    /// A motor is so hot that its driver switches off: all motors lose their torque, as with any fault that the board
    /// finds.
    HotMotor(u8),
    /// A gauge shows the same for ever.
    DeadGauge {
        /// Which.
        gauge: u8,
        /// What it shows; none: what it shows now.
        count: Option<u16>,
    },
    /// A gauge drifts.
    DriftingGauge {
        /// Which.
        gauge: u8,
        /// N/s.
        speed: f64,
    },
    /// An encoder gains or loses counts.
    EncoderJump {
        /// Which.
        encoder: u8,
        /// How many.
        counts: i32,
    },
    /// The board no longer vouches for its encoder counts.
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
    /// From now on the finger has this defect too. False where there is no such part: nothing happens.
    pub fn suffer(&mut self, defect: &Defect) -> bool {
        let part = match *defect {
            Defect::CutTendon(part) | Defect::JammedMotor(part) | Defect::HotMotor(part) => part,
            Defect::SlackTendon { tendon: part, .. } | Defect::DeadGauge { gauge: part, .. } => part,
            Defect::DriftingGauge { gauge: part, .. } | Defect::EncoderJump { encoder: part, .. } => part,
            Defect::ZeroLost | Defect::EmergencyStop | Defect::Supply | Defect::Sensor | Defect::Reset => 1,
        };
        let Some(index) = usize::from(part).checked_sub(1).filter(|&index| index < 4) else { return false };
        match *defect {
            Defect::CutTendon(_) => self.plant().cut_tendon(index),
            Defect::SlackTendon { grip, .. } => self.plant().loosen_tendon(index, grip),
            Defect::JammedMotor(_) => self.plant().jam_motor(index),
            Defect::HotMotor(_) => self.add_faults(Status::DRIVER_FAULT),
            Defect::DeadGauge { count, .. } => self.sensors().kill_gauge(index, count),
            Defect::DriftingGauge { speed, .. } => self.sensors().let_gauge_drift(index, speed),
            Defect::EncoderJump { counts, .. } => self.sensors().jump(index, counts),
            Defect::ZeroLost => self.set_zero_valid(false),
            Defect::EmergencyStop => self.add_faults(Status::EMERGENCY_STOP),
            Defect::Supply => self.add_faults(Status::SUPPLY_FAULT),
            Defect::Sensor => self.add_faults(Status::SENSOR_FAULT),
            Defect::Reset => self.reset(),
        }
        true
    }

    /// No defects any more. What the board remembers of a fault it remembers until the next Configure.
    pub fn mend(&mut self) {
        self.plant().mend();
        self.sensors().mend();
        self.set_zero_valid(true);
        self.set_faults(Status::default());
    }
}
