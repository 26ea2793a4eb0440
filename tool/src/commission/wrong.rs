//! What can be wrong with a finger that was just built: cause and remedy.

use serde::Serialize;
use std::fmt::{self, Display, Formatter};

/// Something that is wrong or unexpected. Parts have the numbers 1 to 4.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Wrong {
    EmergencyStop,
    EmergencyStopUnseen,
    Supply,
    Board(String),
    /// `order[n]` is the encoder that counts when motor n + 1 turns.
    EncodersExchanged([usize; 4]),
    /// `order[n]` is the motor, with its encoder, that has the cables of motor n + 1.
    MotorsAndEncodersExchanged([usize; 4]),
    MotorsExchanged(usize, usize),
    TendonsExchanged(usize, usize),
    /// `order[n]` is the gauge that shows the weight on tendon n + 1.
    GaugesExchanged([usize; 4]),
    EncoderReversed(usize),
    EncoderDead(usize),
    /// The encoder counts this number of times in a revolution, and the configuration expects another number.
    EncoderScale(usize, u32, u32),
    EncoderUnclear(usize, f64),
    MotorReversed(usize),
    MotorBlocked(usize),
    MotorDead(usize),
    /// True torque divided by the commanded torque.
    MotorTorque(usize, f64),
    GaugeReversed(usize),
    GaugeDead(usize),
    /// Shown divided by true tension with the previous scale.
    GaugeScale(usize, f64),
    /// Difference to the configured zero, N.
    GaugeZero(usize, f64),
    /// N rms.
    GaugeNoise(usize, f64),
    /// The weights are not on a line: residual, N.
    GaugeNotLinear(usize, f64),
    TendonLoose(usize),
    /// Tension at rest divided by the intended one.
    TendonTension(usize, f64),
    /// Measured and sent stiffness, N/cm.
    SpringStiffness(f64, f64),
    /// Distance from the pose after a push, mm.
    SpringReturn(f64),
    /// The person did not push.
    NotPushed,
    Computer(String),
    /// A routine has stopped, with its own text.
    Refused(String),
}

impl Wrong {
    /// Whether the configuration compensates it, or the hand works with it, so that nothing must be repaired.
    pub fn compensated(&self) -> bool {
        matches!(
            self,
            Self::EncoderReversed(_)
                | Self::EncoderScale(..)
                | Self::MotorReversed(_)
                | Self::MotorTorque(..)
                | Self::GaugeReversed(_)
                | Self::GaugeScale(..)
                | Self::GaugeZero(..)
                | Self::TendonTension(..)
                | Self::SpringStiffness(..)
                | Self::SpringReturn(_)
                | Self::EmergencyStopUnseen
                | Self::Computer(_)
        )
    }

    /// What to do, or what the tool has done.
    pub fn remedy(&self) -> String {
        match self {
            Self::EmergencyStop => "Release it, and reset the safety relay".into(),
            Self::EmergencyStopUnseen => {
                "The contact of the stop is not wired to the board, or its input is inverted. Without it the library \
                 does not know that the motors have no power"
                    .into()
            }
            Self::Supply => "Switch the supply on, and check the wire of its DC-OK output".into(),
            Self::EncodersExchanged(order) => format!("Exchange the encoder cables: {}", moves("encoder", order)),
            Self::MotorsAndEncodersExchanged(order) => {
                format!("Exchange motor and encoder cables together: {}", moves("motor", order))
            }
            Self::MotorsExchanged(one, other) => {
                format!("Exchange the cables of motors {one} and {other} at their drivers. The encoders are right")
            }
            Self::TendonsExchanged(one, other) => format!(
                "Put tendon {one} on the drum of motor {one}, and tendon {other} on the drum of motor {other}. Cables \
                 of motors, encoders and gauges are right"
            ),
            Self::GaugesExchanged(order) => format!("Exchange the gauge cables: {}", moves("gauge", order)),
            Self::EncoderReversed(encoder) => {
                format!("Nothing: encoder.sign compensates it. Or exchange the channels A and B of encoder {encoder}")
            }
            Self::EncoderDead(encoder) => format!(
                "Check the cable and the supply of encoder {encoder}, and that its disc turns with the shaft. One \
                 missing channel looks the same"
            ),
            Self::EncoderScale(..) => "Nothing: encoder.counts_per_revolution is corrected".into(),
            Self::EncoderUnclear(motor, _) => {
                format!("Turn motor {motor} by exactly one turn; a mark on its shaft helps")
            }
            Self::MotorReversed(motor) => {
                format!("Nothing: motor.sign compensates it. Or exchange the two wires of motor {motor}")
            }
            Self::MotorBlocked(motor) => format!("Free motor {motor}: its drum, brake, bearing or tendon blocks it"),
            Self::MotorDead(motor) => format!(
                "Check the wires of motor {motor}, and that its driver is enabled, has its supply and shows no fault"
            ),
            Self::MotorTorque(motor, _) => format!(
                "The hand works. Check motor.torque_constant of motor {motor}, and the scale of its driver's reference"
            ),
            _ => self.remedy_of_gauges_and_tendons(),
        }
    }

    /// The remedies of gauges, tendons and the spring.
    fn remedy_of_gauges_and_tendons(&self) -> String {
        match self {
            Self::GaugeReversed(gauge) => format!(
                "Nothing: the sign of gauge.newton_per_count compensates it. Or exchange the two signal wires of \
                 gauge {gauge}"
            ),
            Self::GaugeDead(gauge) => {
                format!("Check the cable, the supply and the amplifier of gauge {gauge}, and that the weight bends it")
            }
            Self::GaugeScale(..) => "Nothing: gauge.newton_per_count is corrected".into(),
            Self::GaugeZero(..) => "Nothing: gauge.zero is corrected".into(),
            Self::GaugeNoise(gauge, _) => {
                format!("Check the shield and the ground of gauge {gauge}, and keep motor wires away from its cable")
            }
            Self::GaugeNotLinear(gauge, _) => format!(
                "Check the masses of the weights, that they hang freely, and that nothing rubs on tendon {gauge}"
            ),
            Self::TendonLoose(tendon) => {
                format!("Check tendon {tendon}: it is off its drum or a pulley, broken, or looser than 10 mm")
            }
            Self::TendonTension(tendon, part) if *part < 1.0 => {
                format!("Shorten tendon {tendon}, or look for friction in its path")
            }
            Self::TendonTension(tendon, _) => format!("Look for friction in the path of tendon {tendon}"),
            Self::SpringStiffness(..) => "Do the step tendons again, and push along one direction only".into(),
            Self::SpringReturn(_) => "That is friction. docs/tuning.md says how to live with it".into(),
            Self::NotPushed => "Push the tip before you press Enter".into(),
            _ => String::new(),
        }
    }
}

/// Says which plug belongs where. `order[n]` is the part that is found at number n + 1.
fn moves(part: &str, order: &[usize; 4]) -> String {
    let wrong = order.iter().enumerate().filter(|&(place, &found)| place + 1 != found);
    let text = |(place, found): (usize, &usize)| format!("the plug at {part} {found} belongs to {part} {}", place + 1);
    wrong.map(text).collect::<Vec<_>>().join(", ")
}

/// Lists the parts that are exchanged, for example "2 and 3".
fn parts(order: &[usize; 4]) -> String {
    let wrong: Vec<String> = order
        .iter()
        .enumerate()
        .filter(|&(place, &found)| place + 1 != found)
        .map(|(place, _)| (place + 1).to_string())
        .collect();
    match wrong.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        _ => wrong.join(""),
    }
}

impl Display for Wrong {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::EmergencyStop => write!(f, "the emergency stop is pressed, or its contact is open"),
            Self::EmergencyStopUnseen => write!(f, "the board does not see the emergency stop"),
            Self::Supply => write!(f, "the motors have no supply"),
            Self::Board(text) | Self::Computer(text) | Self::Refused(text) => write!(f, "{text}"),
            Self::EncodersExchanged(order) => write!(f, "encoders {} are exchanged", parts(order)),
            Self::MotorsAndEncodersExchanged(order) => {
                write!(f, "motors {} are exchanged together with their encoders", parts(order))
            }
            Self::MotorsExchanged(one, other) => write!(f, "motors {one} and {other} are exchanged"),
            Self::TendonsExchanged(one, other) => write!(f, "tendons {one} and {other} are exchanged"),
            Self::GaugesExchanged(order) => write!(f, "gauges {} are exchanged", parts(order)),
            Self::EncoderReversed(encoder) => write!(f, "encoder {encoder} counts backwards"),
            Self::EncoderDead(encoder) => write!(f, "encoder {encoder} does not count"),
            Self::EncoderScale(encoder, found, configured) => {
                write!(f, "encoder {encoder} counts {found} per turn, and {configured} are configured")
            }
            Self::EncoderUnclear(motor, turns) => {
                write!(f, "the encoder of motor {motor} shows {turns:.2} turns instead of one")
            }
            Self::MotorReversed(motor) => write!(f, "motor {motor} turns backwards"),
            Self::MotorBlocked(motor) => write!(f, "motor {motor} is blocked"),
            Self::MotorDead(motor) => write!(f, "motor {motor} has no torque"),
            Self::MotorTorque(motor, ratio) => {
                write!(f, "motor {motor} makes {:.0} % of its commanded torque", ratio * 100.0)
            }
            Self::GaugeReversed(gauge) => write!(f, "the count of gauge {gauge} falls with the tension"),
            Self::GaugeDead(gauge) => write!(f, "gauge {gauge} does not show the weight"),
            Self::GaugeScale(gauge, ratio) => {
                let (percent, way) = ((ratio - 1.0) * 100.0, if *ratio < 1.0 { "low" } else { "high" });
                write!(f, "gauge {gauge} reads {:.0} % {way} with the configured scale", percent.abs())
            }
            Self::GaugeZero(gauge, newton) => write!(f, "gauge {gauge} is {newton:+.1} N from its configured zero"),
            Self::GaugeNoise(gauge, newton) => write!(f, "gauge {gauge} has a noise of {newton:.2} N rms"),
            Self::GaugeNotLinear(gauge, newton) => {
                write!(f, "gauge {gauge} is {newton:.2} N rms from a straight line through its weights")
            }
            Self::TendonLoose(tendon) => write!(f, "motor {tendon} turns, but tendon {tendon} does not become tight"),
            Self::TendonTension(tendon, part) => {
                write!(f, "tendon {tendon} has {:.0} % of the tension that it should have at rest", part * 100.0)
            }
            Self::SpringStiffness(found, sent) => {
                write!(f, "the tip gave way with {found:.1} N/cm, and {sent:.1} N/cm were sent")
            }
            Self::SpringReturn(millimetres) => write!(f, "the tip came to rest {millimetres:.1} mm from its pose"),
            Self::NotPushed => write!(f, "the tip did not move"),
        }
    }
}
