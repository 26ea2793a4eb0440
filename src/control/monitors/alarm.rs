//! What the monitors find.

use crate::model::Part;

/// What a monitor finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symptom {
    /// Tension of a tendon, N, stays far under t_min.
    SlackTendon,
    /// Tension of a tendon, N, is gone.
    BrokenTendon,
    /// Tension of a tendon, N.
    OverTension,
    /// Count of a gauge.
    GaugeStuck,
    /// Count of a gauge.
    GaugeOutOfRange,
    /// Tension, N, that gauges and encoders differ by.
    GaugeDisagrees,
    /// Counts that an encoder moved.
    EncoderJump,
    /// Pull without balance, N.
    StalledMotor,
    /// Heat, per cent of what a motor can bear for ever.
    OverheatedMotor,
    /// Angle of a joint, degrees.
    JointAtStop,
    /// Tension of a tendon, N, gone for a moment.
    SlackInMotion,
    /// Heat, per cent.
    WarmMotor,
    /// Per cent of the wanted torque that the tension limits let through.
    TorqueNotAdmitted,
}

/// A symptom, where, and how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alarm {
    /// What.
    pub symptom: Symptom,
    /// Where.
    pub part: Part,
    /// In the unit of the symptom.
    pub value: f64,
}

/// What a cycle gives rise to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Alarms {
    /// The finger has to stop.
    pub fault: Option<Alarm>,
    /// The finger goes on.
    pub warning: Option<Alarm>,
}

/// The first of four for which this holds, as an alarm.
pub(super) fn first_of(
    symptom: Symptom,
    part: impl Fn(usize) -> Part,
    found: impl Fn(usize) -> Option<f64>,
) -> Option<Alarm> {
    (0..4).find_map(|index| found(index).map(|value| Alarm { symptom, part: part(index), value }))
}
