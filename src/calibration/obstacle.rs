//! Why a routine gave up.

use crate::model::Part;
use thiserror::Error;

/// What stood in the way, and what to do about it. Nothing was changed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum Obstacle {
    /// A tendon does not come under tension.
    #[error(
        "tendon {tendon} does not come under tension ({newton:.2} N): it is broken or off its pulley, its gauge is \
         dead, or the sign of its motor is wrong. Check the tendon and its gauge; sun2xp calibrate finds signs"
    )]
    Slack {
        /// 1 to 4.
        tendon: u8,
        /// What its gauge says, N.
        newton: f64,
    },
    /// A motor does not turn when it is told to.
    #[error(
        "motor {motor} does not let its tendon out: it is blocked or without power, or its encoder is dead. Check the \
         motor, its supply and its encoder"
    )]
    MotorStuck {
        /// 1 to 4.
        motor: u8,
    },
    /// A gauge is not at rest with the motors off.
    #[error(
        "gauge {tendon} is not at rest with the motors off ({newton:.3} N rms): something moves the finger, or the \
         gauge is noisy. Let nothing touch the finger, and check the wiring of the gauge"
    )]
    Restless {
        /// 1 to 4.
        tendon: u8,
        /// Spread, N rms.
        newton: f64,
    },
    /// A gauge shows the same with and without tension.
    #[error(
        "gauge {tendon} changes by no more than {newton:.2} N when its tendon is let out: it is dead, or the tendon \
         does not give way. Check the gauge, and whether the tendon is stuck"
    )]
    DeadGauge {
        /// 1 to 4.
        tendon: u8,
        /// Change, N.
        newton: f64,
    },
    /// A gauge is far from its zero with the tendon slack.
    #[error(
        "gauge {tendon} is {newton:.1} N from its configured zero with the motors off: its tendon is still under \
         tension, or the gauge is damaged. If the gauge was exchanged, set gauge.zero to about what it shows at rest \
         first"
    )]
    GaugeOffset {
        /// 1 to 4.
        tendon: u8,
        /// Distance, N.
        newton: f64,
    },
    /// The board has lost its counts.
    #[error(
        "zeroing.method is \"kept\", but the board does not report that its counts are still valid: set zeroing.method \
         to \"pose\" or \"stops\""
    )]
    NotKept,
    /// The finger moved while it was to stand in its pose.
    #[error(
        "joint {joint} moved by {degrees:.2} degrees while the pose was read. Keep the finger still in \
         zeroing.pose_degrees (nothing may push it, no set point may be on its way) and zero it again, or set \
         zeroing.method = \"stops\""
    )]
    Moved {
        /// 0 to 2.
        joint: u8,
        /// How far, degrees.
        degrees: f64,
    },
    /// A limp finger that stands in no pose, because nothing holds it.
    #[error(
        "nothing holds the finger in its pose: joint {joint} gave way by {degrees:.1} degrees to a light push. Hold \
         the finger in zeroing.pose_degrees until it is zeroed, or set zeroing.method = \"stops\""
    )]
    NotHeld {
        /// 0 to 2.
        joint: u8,
        /// How far, degrees.
        degrees: f64,
    },
    /// A joint went further than its stop should be.
    #[error(
        "joint {joint} moved by {degrees:.0} degrees and met no stop: a tendon is off its pulley, or \
         zeroing.lower_stop_degrees or upper_stop_degrees is wrong. Check them"
    )]
    NoStop {
        /// 0 to 2.
        joint: u8,
        /// How far, degrees.
        degrees: f64,
    },
    /// A joint has less way between its stops than it should.
    #[error(
        "joint {joint} moves {degrees:.1} degrees between its stops, and {expected:.1} are configured: something is in \
         its way, zeroing.torque is too small for its friction, or zeroing.lower_stop_degrees or upper_stop_degrees is \
         wrong. Check them"
    )]
    EarlyStop {
        /// 0 to 2.
        joint: u8,
        /// How far it moves.
        degrees: f64,
        /// How far it should.
        expected: f64,
    },
    /// A joint does not follow where it has room.
    #[error(
        "joint {joint} does not move freely: something is in its way, or zeroing.torque is too small for its friction. \
         Check both"
    )]
    JointBlocked {
        /// 0 to 2.
        joint: u8,
    },
    /// The experiment does not determine a number, or gives an impossible one.
    #[error(
        "{part}: {what} comes out as {value:.4}, which is impossible: the finger was touched, or two gauges \
         or motors are swapped. Let nothing touch the finger, and check their cables"
    )]
    Implausible {
        /// Of which part.
        part: Part,
        /// Of what.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// Winding a motor both ways changes no tension.
    #[error(
        "motor {motor} turns but tightens no tendon either way: its tendon is broken or very slack, or the gauges are \
         dead. Check them"
    )]
    NothingTightens {
        /// 1 to 4.
        motor: u8,
    },
    /// What one motor does shows first on the gauge of another tendon.
    #[error(
        "the pull of motor {motor} shows first on gauge {gauge}: gauges {motor} and {gauge} are swapped, motors \
         {motor} and {gauge} are swapped with their encoders, or a tendon is led to the wrong motor. Check the cables \
         and the tendons"
    )]
    Swapped {
        /// 1 to 4.
        motor: u8,
        /// 1 to 4.
        gauge: u8,
    },
    /// The command of one motor turns another one, as the encoders say.
    #[error(
        "the command of motor {motor} turns encoder {encoder}: the cables of motors {motor} and {encoder} are swapped, \
         or those of their encoders. Swap them back"
    )]
    SwappedMotor {
        /// 1 to 4.
        motor: u8,
        /// 1 to 4.
        encoder: u8,
    },
    /// A gauge that contradicts itself, or never moved.
    #[error(
        "gauge {tendon} does not rise and fall with the tension: it is dead, or its cable is swapped with another one. \
         Check both"
    )]
    SenselessGauge {
        /// 1 to 4.
        tendon: u8,
    },
    /// Took too long.
    #[error(
        "it was not finished after {seconds:.0} s: check that the finger can move freely, or raise zeroing.time_limit_s"
    )]
    TimeLimit {
        /// s.
        seconds: f64,
    },
}
