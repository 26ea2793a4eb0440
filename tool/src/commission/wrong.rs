//! What can be wrong with a finger that was just built: cause and remedy.

mod remedy;
mod text;

use serde::Serialize;

/// Largest relative error of a gauge scale that the tolerances of the parts explain.
const TOLERANCE: f64 = 0.15;

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
    /// `order[n]` is the number at which the cables of motor n + 1 and of its encoder are plugged in.
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
    /// `order[n]` is the encoder that counted when motor n + 1 was turned, or 0. It is not certain that an exchange of
    /// cables explains this order.
    EncodersUnclear([usize; 4]),
    /// The person turned the motors in the direction that winds the tendons in.
    TurnedWrongWay,
    MotorReversed(usize),
    MotorBlocked(usize),
    MotorDead(usize),
    /// True torque divided by the commanded torque.
    MotorTorque(usize, f64),
    GaugeReversed(usize),
    GaugeDead(usize),
    /// Tension that the gauge shows before its scale is corrected, divided by the true tension.
    GaugeScale(usize, f64),
    /// Difference to the configured zero, N.
    GaugeZero(usize, f64),
    /// N rms.
    GaugeNoise(usize, f64),
    /// The counts are not a linear function of the weights: residual, N.
    GaugeNotLinear(usize, f64),
    /// The count without load is at the end of the converter's range. The values are this count, and the zero that
    /// follows from the weights.
    GaugeAtEnd(usize, f64, f64),
    /// `order[n]` is the gauge that showed the weight on tendon n + 1, or 0. It is not certain that an exchange of
    /// cables explains this order.
    GaugesUnclear([usize; 4]),
    TendonLoose(usize),
    /// Tension at rest divided by the intended tension.
    TendonTension(usize, f64),
    /// Measured and sent stiffness, N/cm.
    SpringStiffness(f64, f64),
    /// Distance between the position of the tip before a push and its position after the push has ended, mm.
    SpringReturn(f64),
    /// The configured initial stiffness and the bound below it, N/cm.
    InitialLowered(f64, f64),
    /// The person did not push.
    NotPushed,
    /// No weight hung on this tendon.
    NotWeighed(usize),
    /// The person could not do what the step needs.
    NotPrepared,
    Computer(String),
    /// The zeroing at a pose has stopped. The text says why.
    PoseRefused(String),
    /// A calibration routine has stopped, or has contradicted an earlier step. The text says why.
    Refused(String),
    /// The step has stopped because the finger or the system failed, with the text of this failure.
    Stopped(String),
}

impl Wrong {
    /// Whether no repair is needed, because the configuration compensates the error or the hand works in spite of it.
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
                | Self::InitialLowered(..)
                | Self::EmergencyStopUnseen
                | Self::Computer(_)
        )
    }

    /// What is wrong and what to do, without a full stop at the end.
    pub fn with_remedy(&self) -> String {
        format!("{self}. {}", self.remedy()).trim_end_matches([' ', '.']).to_owned()
    }

    /// Whether the error is [`Self::compensated`], but probably has a cause that should be removed.
    pub fn suspect(&self) -> bool {
        match self {
            Self::GaugeScale(_, ratio) => (ratio - 1.0).abs() > TOLERANCE,
            Self::EmergencyStopUnseen | Self::Computer(_) => true,
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gauge_beyond_the_tolerance_of_parts_is_suspect() {
        let harmless = Wrong::GaugeScale(1, 1.06);
        let [low, high] = [0.77, 1.3].map(|ratio| Wrong::GaugeScale(1, ratio));
        assert!(harmless.compensated() && !harmless.suspect());
        assert!(harmless.remedy().starts_with("Nothing"), "{}", harmless.remedy());
        for wrong in [low, high] {
            assert!(wrong.compensated() && wrong.suspect(), "{wrong}");
            assert!(wrong.remedy().contains("supply of its bridge"), "{}", wrong.remedy());
        }
    }

    /// A motor that is commutated electronically has more than two wires.
    #[test]
    fn the_wires_of_a_reversed_motor_are_swapped_only_if_it_is_brushed() {
        assert!(Wrong::MotorReversed(3).remedy().contains("if motor 3 is brushed"));
    }

    #[test]
    fn readings_that_no_exchange_explains_are_listed() {
        let text = Wrong::GaugesUnclear([2, 2, 0, 4]).to_string();
        let seen = "gauge 2 showed the weight on tendon 1, gauge 2 showed the weight on tendon 2, \
                    no gauge showed the weight on tendon 3, gauge 4 showed the weight on tendon 4";
        assert_eq!(text, seen);
        let text = Wrong::EncodersUnclear([2, 2, 0, 4]).to_string();
        assert!(text.starts_with("motor 1 turned encoder 2, motor 2 turned encoder 2, motor 3 turned no"), "{text}");
    }
}
