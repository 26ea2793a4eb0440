//! Why a routine gave up.

use super::causes::{DOES_NOT_RETURN, NARROW, STAYS_BEHIND, WIDE, outcome};
use crate::model::Part;
use thiserror::Error;

/// The reason for a refusal, and its remedy. A routine that is refused changes no value of the configuration.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum Obstacle {
    /// A tendon does not become tight.
    #[error(
        "tendon {tendon} does not come under tension ({newton:.2} N): it is broken or off its pulley, its gauge is \
         dead, or the sign of its motor is wrong. Check the tendon and its gauge. Run sun2xp calibrate --signs if the \
         sign may be wrong"
    )]
    Slack {
        /// The tendon's number, 1 to 4.
        tendon: u8,
        /// Tension that its gauge shows, N.
        newton: f64,
    },
    /// A motor does not follow its command.
    #[error(
        "motor {motor} does not follow its command: it is blocked or has no power, or its encoder is dead. Check the \
         motor, its supply and its encoder"
    )]
    MotorStuck {
        /// The motor's number, 1 to 4.
        motor: u8,
    },
    /// The reading of a gauge changes although the motors are off.
    #[error(
        "gauge {tendon} is not at rest with the motors off ({newton:.3} N rms): something moves the finger, or the \
         gauge is noisy. Let nothing touch the finger, and check the wiring of the gauge"
    )]
    UnsteadyGauge {
        /// The gauge's number, 1 to 4.
        tendon: u8,
        /// Standard deviation, N rms.
        newton: f64,
    },
    /// A gauge reports the same tension with a tight and a slack tendon.
    #[error(
        "gauge {tendon} changes by no more than {newton:.2} N when its tendon is unwound: the gauge is dead, or the \
         tendon is stuck. Check both"
    )]
    DeadGauge {
        /// The gauge's number, 1 to 4.
        tendon: u8,
        /// Change, N.
        newton: f64,
    },
    /// A gauge is far from its configured zero although its tendon was let out and should be slack.
    #[error(
        "gauge {tendon} is {newton:.1} N from its configured zero with the motors off: its tendon is still under \
         tension, or the gauge is damaged. Slacken the tendon, and check the gauge. If the gauge was replaced, first \
         set gauge.zero to its approximate count at rest"
    )]
    GaugeOffset {
        /// The gauge's number, 1 to 4.
        tendon: u8,
        /// Difference, N.
        newton: f64,
    },
    /// The board has lost its counts.
    #[error(
        "zeroing.method is \"kept\", but the board does not report that its counts are still valid: set zeroing.method \
         to \"pose\" or \"stops\""
    )]
    NotKept,
    /// The finger moved although it had to stay in its pose.
    #[error(
        "joint {joint} moved by {degrees:.2} degrees while the pose was read. Zero the finger again \
         in zeroing.pose_degrees: let nothing push it, and if it moves to a set point, wait until it arrives. Or zero \
         it at its stops (zeroing.method = \"stops\", zeroing.lower_stop_degrees, zeroing.upper_stop_degrees)"
    )]
    Moved {
        /// The joint, 0 to 2.
        joint: u8,
        /// Distance, degrees.
        degrees: f64,
    },
    /// Nothing holds the limp finger in its pose.
    #[error(
        "nothing holds the finger in its pose: joint {joint} moved by {degrees:.1} degrees under a light push. Hold \
         the finger in zeroing.pose_degrees until it is zeroed, or zero it at its stops (zeroing.method = \"stops\", \
         zeroing.lower_stop_degrees, zeroing.upper_stop_degrees)"
    )]
    NotHeld {
        /// The joint, 0 to 2.
        joint: u8,
        /// Distance, degrees.
        degrees: f64,
    },
    /// A joint moved beyond the expected position of its stop.
    #[error(
        "joint {joint} moved by {degrees:.0} degrees and reached no stop: a tendon is off its pulley, or the \
         configured range of this joint from zeroing.lower_stop_degrees to upper_stop_degrees is too small. Check both"
    )]
    NoStop {
        /// The joint, 0 to 2.
        joint: u8,
        /// Distance, degrees.
        degrees: f64,
    },
    /// The range of a joint between its stops differs from the configured range.
    #[error(
        "joint {joint} moves {degrees:.1} degrees between its stops, but {expected:.1} are configured: {}, geometry.r \
         is wrong, or the range from zeroing.lower_stop_degrees to upper_stop_degrees is wrong. Check them",
        if degrees < expected { NARROW } else { WIDE }
    )]
    WrongRange {
        /// The joint, 0 to 2.
        joint: u8,
        /// Measured range, degrees.
        degrees: f64,
        /// Configured range, degrees.
        expected: f64,
    },
    /// A joint cannot be moved, although it should be away from its stops.
    #[error(
        "joint {joint} does not move freely: something blocks it, {}",
        if *returning { DOES_NOT_RETURN } else { STAYS_BEHIND }
    )]
    JointBlocked {
        /// The joint, 0 to 2.
        joint: u8,
        /// Whether the joint was on the way back to its start, with a torque that `zeroing.torque` affects. Otherwise
        /// it was moved back and forth to measure its friction, with another torque.
        returning: bool,
    },
    /// The measurements do not determine a value, or the value is impossible.
    #[error(
        "{part}: {}: the finger was touched, two gauges or motors are swapped, or a value in [finger.geometry], \
         [finger.motor] or [finger.gauge] is wrong. Let nothing touch the finger, and check the cables and the values",
        outcome(what, *value)
    )]
    Implausible {
        /// The part of the finger.
        part: Part,
        /// The quantity.
        what: &'static str,
        /// Its value; NaN if the measurements do not determine it.
        value: f64,
    },
    /// A motor turns in both directions, but changes no tension.
    #[error(
        "motor {motor} turns but tightens no tendon in either direction: its tendon is broken or very slack, or the \
         gauges are dead. Check them"
    )]
    NothingTightens {
        /// The motor's number, 1 to 4.
        motor: u8,
    },
    /// The pull of a motor appears first on the gauge of another tendon.
    #[error(
        "the pull of motor {motor} appears first on gauge {gauge}: gauges {motor} and {gauge} are swapped, motors \
         {motor} and {gauge} are swapped together with their encoders, or a tendon is routed to the wrong motor. Check \
         the cables and the tendons"
    )]
    Swapped {
        /// The motor's number, 1 to 4.
        motor: u8,
        /// The gauge's number, 1 to 4.
        gauge: u8,
    },
    /// The command of a motor turns another motor's encoder.
    #[error(
        "the command of motor {motor} turns encoder {encoder}: the cables of motors {motor} and {encoder} are swapped, \
         or those of their encoders. Swap them back"
    )]
    SwappedMotor {
        /// The motor's number, 1 to 4.
        motor: u8,
        /// The encoder's number, 1 to 4.
        encoder: u8,
    },
    /// A motor turns another motor's encoder and pulls that motor's tendon.
    #[error("motors {first} and {second} are swapped: the board drives each in place of the other. Swap their cables")]
    SwappedMotors {
        /// The motor's number, 1 to 4.
        first: u8,
        /// The other motor's number.
        second: u8,
    },
    /// A motor pulls its own tendon, but another encoder moves.
    #[error("encoders {first} and {second} are swapped: each counts the other motor. Swap their cables")]
    SwappedEncoders {
        /// The encoder's number, 1 to 4.
        first: u8,
        /// The other encoder's number.
        second: u8,
    },
    /// A motor pulls another tendon.
    #[error(
        "tendons {first} and {second} are swapped: motor {first} pulls tendon {second}, and motor {second} pulls \
         tendon {first}. Route each tendon to its motor, or swap both motors together with their encoders"
    )]
    SwappedTendons {
        /// The tendon's number, 1 to 4.
        first: u8,
        /// The other tendon's number.
        second: u8,
    },
    /// Two gauges show each other's tension.
    #[error("gauges {first} and {second} are swapped: each shows the tension of the other tendon. Swap their cables")]
    SwappedGauges {
        /// The gauge's number, 1 to 4.
        first: u8,
        /// The other gauge's number.
        second: u8,
    },
    /// A motor unwinds its tendon instead of pulling it.
    #[error(
        "motor {motor} turns backwards: it unwinds its tendon when it should pull. Change its entry in motor.sign, or, \
         if it is brushed, swap its two wires"
    )]
    ReversedMotor {
        /// The motor's number, 1 to 4.
        motor: u8,
    },
    /// An encoder counts backwards.
    #[error(
        "encoder {encoder} counts backwards while its motor pulls the tendon in. Swap its two channels, or change its \
         entry in encoder.sign"
    )]
    ReversedEncoder {
        /// The encoder's number, 1 to 4.
        encoder: u8,
    },
    /// A gauge falls while its tendon is pulled.
    #[error(
        "gauge {gauge} is reversed: its reading falls while the tension rises. Swap its two signal wires, or change \
         the sign of its entry in gauge.newton_per_count"
    )]
    ReversedGauge {
        /// The gauge's number, 1 to 4.
        gauge: u8,
    },
    /// A motor pulls, but its encoder does not count.
    #[error(
        "encoder {encoder} does not count although motor {encoder} pulls its tendon. Check the encoder and its cable"
    )]
    DeadEncoder {
        /// The encoder's number, 1 to 4.
        encoder: u8,
    },
    /// A motor neither turns nor pulls.
    #[error(
        "motor {motor} neither turns nor pulls: it is blocked, or it or its driver has no power. Check the motor, its \
         cable and its supply"
    )]
    DeadMotor {
        /// The motor's number, 1 to 4.
        motor: u8,
    },
    /// A gauge does not respond to a pull.
    #[error(
        "gauge {gauge} rises by only {newton:.2} N while all tendons are pulled: it is dead. Check the gauge, its \
         amplifier and its cable"
    )]
    SilentGauge {
        /// The gauge's number, 1 to 4.
        gauge: u8,
        /// Rise, N.
        newton: f64,
    },
    /// The scale of a gauge differs from that of the others.
    #[error(
        "gauge {gauge} reads {:.0} % too {}, compared with the other gauges: its scale is wrong, its amplifier has \
         changed, or something touches the finger. Calibrate it again (sun2xp calibrate --identify), or check its \
         amplifier and that nothing touches the finger",
        percent.abs(), if *percent > 0.0 { "high" } else { "low" }
    )]
    GaugeScale {
        /// The gauge's number, 1 to 4.
        gauge: u8,
        /// Difference, %.
        percent: f64,
    },
    /// The readings of a gauge contradict each other, or never changed.
    #[error(
        "gauge {tendon} does not rise and fall with the tension: it is dead, or its cable is swapped with that of \
         another gauge. Check the gauge and the cables"
    )]
    InconsistentGauge {
        /// The gauge's number, 1 to 4.
        tendon: u8,
    },
    /// The routine exceeded its time limit.
    #[error(
        "the routine did not finish within {seconds:.0} s: something slows the finger down, or zeroing.time_limit_s is \
         too short. Check that the finger can move freely, or raise zeroing.time_limit_s"
    )]
    TimeLimit {
        /// The limit, s.
        seconds: f64,
    },
}
