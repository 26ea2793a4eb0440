//! Conversion of the monitors' symptoms to faults.

use super::{Fault, FaultKind};
use crate::control::monitors::{Alarm, Symptom};

impl From<Alarm> for Fault {
    fn from(Alarm { symptom, part, value }: Alarm) -> Self {
        let kind = match symptom {
            Symptom::SlackTendon => FaultKind::SlackTendon,
            Symptom::BrokenTendon => FaultKind::BrokenTendon,
            Symptom::OverTension => FaultKind::OverTension,
            Symptom::GaugeStuck => FaultKind::GaugeStuck,
            Symptom::GaugeOutOfRange => FaultKind::GaugeOutOfRange,
            Symptom::GaugeDisagrees => FaultKind::GaugeDisagrees,
            Symptom::EncoderJump => FaultKind::EncoderJump,
            Symptom::StalledMotor => FaultKind::StalledMotor,
            Symptom::OverheatedMotor => FaultKind::OverheatedMotor,
            Symptom::JointAtStop => FaultKind::JointAtStop,
            Symptom::SlackInMotion => FaultKind::SlackInMotion,
            Symptom::WarmMotor => FaultKind::WarmMotor,
            Symptom::TorqueNotAdmitted => FaultKind::TorqueNotAdmitted,
        };
        Fault { kind, part, value }
    }
}
