//! The text of each [`Wrong`], for the user.

use super::Wrong;
use std::fmt::{self, Display, Formatter};

/// Lists the parts that are swapped, for example "2 and 3".
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

/// Lists what was seen at each part. The list is used if it is not certain that an exchange of cables explains what was
/// seen.
fn listed(order: &[usize; 4], text: fn(usize, usize) -> String) -> String {
    (1..).zip(order).map(|(place, &found)| text(place, found)).collect::<Vec<_>>().join(", ")
}

fn turned(motor: usize, encoder: usize) -> String {
    match encoder {
        0 => format!("motor {motor} turned no encoder"),
        _ => format!("motor {motor} turned encoder {encoder}"),
    }
}

fn showed(tendon: usize, gauge: usize) -> String {
    match gauge {
        0 => format!("no gauge showed the weight on tendon {tendon}"),
        _ => format!("gauge {gauge} showed the weight on tendon {tendon}"),
    }
}

impl Display for Wrong {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::EmergencyStop => write!(f, "the emergency stop is pressed, or its contact is open"),
            Self::EmergencyStopUnseen => write!(f, "the board does not see the emergency stop"),
            Self::Supply => write!(f, "the motors have no supply"),
            Self::Board(text) | Self::Computer(text) | Self::PoseRefused(text) => write!(f, "{text}"),
            Self::Refused(text) | Self::Stopped(text) => write!(f, "{text}"),
            Self::EncodersExchanged(order) => write!(f, "encoders {} are swapped", parts(order)),
            Self::MotorsAndEncodersExchanged(order) => {
                write!(f, "motors {} are swapped together with their encoders", parts(order))
            }
            Self::MotorsExchanged(one, other) => write!(f, "motors {one} and {other} are swapped"),
            Self::TendonsExchanged(one, other) => write!(f, "tendons {one} and {other} are swapped"),
            Self::GaugesExchanged(order) => write!(f, "gauges {} are swapped", parts(order)),
            Self::EncoderReversed(encoder) => write!(f, "encoder {encoder} counts backwards"),
            Self::EncoderDead(encoder) => write!(f, "encoder {encoder} does not count"),
            Self::EncoderScale(encoder, found, configured) => {
                write!(f, "encoder {encoder} counts {found} per turn, and {configured} are configured")
            }
            Self::EncodersUnclear(order) => write!(f, "{}", listed(order, turned)),
            Self::TurnedWrongWay => write!(f, "the motors were turned so that their tendons came tight"),
            Self::EncoderUnclear(motor, turns) => {
                write!(f, "the encoder of motor {motor} shows {turns:.2} turns instead of one")
            }
            Self::MotorReversed(motor) => write!(f, "motor {motor} turns backwards"),
            Self::MotorBlocked(motor) => write!(f, "motor {motor} is blocked"),
            Self::MotorDead(motor) => write!(f, "motor {motor} has no torque"),
            Self::MotorTorque(motor, ratio) => {
                write!(f, "motor {motor} makes {:.0} % of its commanded torque", ratio * 100.0)
            }
            _ => self.of_gauges_and_tendons(f),
        }
    }
}

impl Wrong {
    fn of_gauges_and_tendons(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::GaugeReversed(gauge) => write!(f, "the count of gauge {gauge} falls when the tension rises"),
            Self::GaugeDead(gauge) => write!(f, "gauge {gauge} does not show the weight"),
            Self::GaugeScale(gauge, ratio) => {
                let (percent, way) = ((ratio - 1.0) * 100.0, if *ratio < 1.0 { "low" } else { "high" });
                write!(f, "gauge {gauge} reads {:.0} % {way} with the configured scale", percent.abs())
            }
            Self::GaugeZero(gauge, newton) => write!(f, "gauge {gauge} is {newton:+.1} N from its configured zero"),
            Self::GaugeNoise(gauge, newton) => write!(f, "gauge {gauge} has a noise of {newton:.2} N rms"),
            Self::GaugeNotLinear(gauge, newton) => {
                write!(
                    f,
                    "the readings of gauge {gauge} deviate by {newton:.2} N rms from a straight line over the weights"
                )
            }
            Self::GaugeAtEnd(gauge, count, zero) => write!(
                f,
                "gauge {gauge} shows {count:.0} counts without load, which is the end of its converter's range. The \
                 readings with weights show that its zero is at {zero:.0} counts"
            ),
            Self::GaugesUnclear(order) => write!(f, "{}", listed(order, showed)),
            Self::InitialLowered(initial, bound) => {
                write!(f, "stiffness.initial was {initial:.2} N/cm, and the bound is {bound:.2} N/cm")
            }
            Self::TendonLoose(tendon) => write!(f, "motor {tendon} turns, but tendon {tendon} does not become tight"),
            Self::TendonTension(tendon, part) => {
                write!(f, "tendon {tendon} has {:.0} % of the tension that it should have at rest", part * 100.0)
            }
            Self::SpringStiffness(found, sent) => {
                write!(f, "the measured stiffness is {found:.1} N/cm, and {sent:.1} N/cm were sent")
            }
            Self::SpringReturn(millimetres) => {
                write!(f, "the tip came to rest {millimetres:.1} mm from its position before the push")
            }
            Self::NotWeighed(tendon) => write!(f, "no weight hung on tendon {tendon}, so its gauge was not tested"),
            Self::NotPrepared => write!(f, "the step was not done, because you could not do what it asked for"),
            // Only `NotPushed` is left, because the caller handles all other cases.
            _ => write!(f, "the tip did not move"),
        }
    }
}
