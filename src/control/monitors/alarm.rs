//! Results of the monitors.

use crate::model::Part;

/// What a monitor detects. The value of each alarm is given in parentheses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symptom {
    /// The tension of a tendon stays far below t_min (mean tension, N).
    SlackTendon,
    /// A tendon has lost its tension (mean tension, N).
    BrokenTendon,
    /// The tension of a tendon stays far above t_max (tension, N).
    OverTension,
    /// A gauge shows a constant count (count).
    GaugeStuck,
    /// A gauge is at the end of its range, or shows a tension far below zero (count).
    GaugeOutOfRange,
    /// Gauges and encoders disagree (difference, N).
    GaugeDisagrees,
    /// An encoder moves farther than its motor can (unexpected motion, counts).
    EncoderJump,
    /// A motor does not turn although pull and tension are not balanced (pull minus tension, N).
    StalledMotor,
    /// The heat of a motor has been above 95 % of its continuous heat for longer than its thermal time constant (heat,
    /// per cent of the continuous heat). The heat is the filtered mean square of the torque. The continuous heat is the
    /// square of the torque that the motor may give permanently.
    OverheatedMotor,
    /// A joint is at its mechanical stop (angle, degrees).
    JointAtStop,
    /// A tendon has no tension for a moment (tension, N).
    SlackInMotion,
    /// A motor is warm, and its torque is limited (heat, per cent of the continuous heat).
    WarmMotor,
    /// The tension bounds reduce the joint torque (remaining torque, per cent).
    TorqueNotAdmitted,
}

/// A symptom with its location and value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alarm {
    /// The symptom.
    pub symptom: Symptom,
    /// The part that has the symptom.
    pub part: Part,
    /// The value, in the unit of the symptom.
    pub value: f64,
}

/// The alarms of a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Alarms {
    /// An alarm that stops the finger.
    pub fault: Option<Alarm>,
    /// An alarm with which the finger continues.
    pub warning: Option<Alarm>,
}

/// Returns an alarm for the first of four parts for which `found` returns a value.
pub(super) fn first_of(
    symptom: Symptom,
    part: impl Fn(usize) -> Part,
    found: impl Fn(usize) -> Option<f64>,
) -> Option<Alarm> {
    (0..4).find_map(|index| found(index).map(|value| Alarm { symptom, part: part(index), value }))
}
