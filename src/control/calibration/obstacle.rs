//! Why a routine gave up.

use thiserror::Error;

/// What stood in the way, and what to do about it. Nothing was changed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum Obstacle {
    /// A tendon does not come under tension.
    #[error(
        "tendon {tendon} does not come under tension ({newton:.2} N): is it broken or off its pulley, is its gauge dead, is \
         the sign of its motor wrong?"
    )]
    Slack {
        /// 1 to 4.
        tendon: u8,
        /// What its gauge says, N.
        newton: f64,
    },
    /// A motor does not turn when it is told to.
    #[error("motor {motor} does not let its tendon out: is it blocked, without power, or is its encoder dead?")]
    MotorStuck {
        /// 1 to 4.
        motor: u8,
    },
    /// A gauge is not at rest with the motors off.
    #[error("gauge {tendon} is not at rest with the motors off ({newton:.3} N rms): does something move the finger?")]
    Restless {
        /// 1 to 4.
        tendon: u8,
        /// Spread, N rms.
        newton: f64,
    },
    /// A gauge shows the same with and without tension.
    #[error(
        "gauge {tendon} changes by {newton:.2} N only when its tendon is let out: dead, or the tendon does not give way"
    )]
    DeadGauge {
        /// 1 to 4.
        tendon: u8,
        /// Change, N.
        newton: f64,
    },
    /// A gauge is far from its zero with the tendon slack.
    #[error(
        "gauge {tendon} is {newton:.1} N from its configured zero with the motors off: its tendon is still pulled, or the \
         gauge is damaged. If it was exchanged, configure gauge.zero roughly first"
    )]
    GaugeOffset {
        /// 1 to 4.
        tendon: u8,
        /// Distance, N.
        newton: f64,
    },
    /// The board has lost its counts.
    #[error(
        "zeroing.method is \"kept\", but the board does not say that its counts are still good: zero by \"pose\" or \"stops\""
    )]
    NotKept,
    /// The finger moved while it was to stand in its pose.
    #[error(
        "joint {joint} moved by {degrees:.2} degrees while the pose was read. Keep the finger still in zeroing.pose_degrees (nothing \
         may push it, no set point may be on its way) and zero it again, or set zeroing.method = \"stops\""
    )]
    Moved {
        /// 0 to 2.
        joint: u8,
        /// How far, degrees.
        degrees: f64,
    },
    /// A limp finger that stands in no pose, because nothing holds it.
    #[error(
        "nothing holds the finger in its pose: joint {joint} gave way by {degrees:.1} degrees to a light push. Hold the finger in \
         zeroing.pose_degrees until it is zeroed, or set zeroing.method = \"stops\""
    )]
    NotHeld {
        /// 0 to 2.
        joint: u8,
        /// How far, degrees.
        degrees: f64,
    },
    /// A joint went further than its stop should be.
    #[error(
        "joint {joint} went {degrees:.0} degrees and met no stop: is a tendon off, are zeroing's stop angles right?"
    )]
    NoStop {
        /// 0 to 2.
        joint: u8,
        /// How far, degrees.
        degrees: f64,
    },
    /// A joint has less way between its stops than it should.
    #[error(
        "joint {joint} moves {degrees:.1} degrees between its stops, {expected:.1} are configured: is something in its way, \
         is zeroing.torque too small for its friction, are zeroing's stop angles right?"
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
        "joint {joint} does not move freely: is something in its way, is zeroing.torque too small for its friction?"
    )]
    JointBlocked {
        /// 0 to 2.
        joint: u8,
    },
    /// The experiment does not determine a number, or gives an impossible one.
    #[error(
        "tendon {tendon}: {what} comes out as {value:.4}, which cannot be: was the finger touched, are two gauges or motors \
         swapped?"
    )]
    Implausible {
        /// 1 to 4; of a joint's friction the joint's number and one more.
        tendon: u8,
        /// Of what.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// Winding a motor both ways changes no tension.
    #[error(
        "motor {motor} turns but tightens nothing either way: is its tendon broken or very slack, are the gauges dead?"
    )]
    NothingTightens {
        /// 1 to 4.
        motor: u8,
    },
    /// What one motor does shows first on the gauge of another tendon.
    #[error(
        "what motor {motor} pulls shows first on gauge {gauge}: are gauges {motor} and {gauge} swapped, or motors {motor} and {gauge} with their \
         encoders, or is a tendon led to the wrong motor?"
    )]
    Swapped {
        /// 1 to 4.
        motor: u8,
        /// 1 to 4.
        gauge: u8,
    },
    /// The command of one motor turns another one, as the encoders say.
    #[error(
        "the command of motor {motor} turns encoder {encoder}: are the cables of motors {motor} and {encoder} swapped, or those of their encoders?"
    )]
    SwappedMotor {
        /// 1 to 4.
        motor: u8,
        /// 1 to 4.
        encoder: u8,
    },
    /// A gauge that contradicts itself, or never moved.
    #[error("gauge {tendon} does not rise and fall with the tension: dead, or its cable is swapped with another")]
    SenselessGauge {
        /// 1 to 4.
        tendon: u8,
    },
    /// Took too long.
    #[error("not finished after {seconds:.0} s (zeroing.time_limit_s)")]
    TimeLimit {
        /// s.
        seconds: f64,
    },
}
