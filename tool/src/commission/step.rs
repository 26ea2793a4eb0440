//! The steps of a commissioning, in their order.

use serde::{Deserialize, Serialize};

/// A step.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Step {
    Board,
    Computer,
    Encoders,
    Gauges,
    Motors,
    Zeros,
    Tendons,
    Bound,
    Spring,
}

impl Step {
    /// Every step.
    pub const ALL: [Self; 9] = [
        Self::Board,
        Self::Computer,
        Self::Encoders,
        Self::Gauges,
        Self::Motors,
        Self::Zeros,
        Self::Tendons,
        Self::Bound,
        Self::Spring,
    ];

    /// Number of the step in a whole commissioning, from 1.
    pub fn number(self) -> usize {
        self as usize + 1
    }

    /// Whether the step always moves the finger by its motors.
    pub fn moves(self) -> bool {
        matches!(self, Self::Motors | Self::Zeros | Self::Tendons | Self::Spring)
    }

    /// The name for the command line and the files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Board => "board",
            Self::Encoders => "encoders",
            Self::Gauges => "gauges",
            Self::Motors => "motors",
            Self::Zeros => "zeros",
            Self::Tendons => "tendons",
            Self::Bound => "bound",
            Self::Computer => "computer",
            Self::Spring => "spring",
        }
    }

    /// What the tool does in this step.
    pub fn does(self) -> &'static str {
        match self {
            Self::Board => "Queries the identity of the board, and tests its emergency stop. The motors are off.",
            Self::Encoders => {
                "Reads the encoders while you turn each motor by hand. The motors are off, unless encoders are \
                 swapped. In that case the tool asks you to hold the finger still, and then turns each motor a little."
            }
            Self::Gauges => {
                "Reads the gauges without load, and while you hang known weights on each tendon. The motors are off."
            }
            Self::Motors => {
                "Turns each motor a little, then pulls each tendon with up to twice finger.tendon.minimum. Takes 15 s."
            }
            Self::Zeros => {
                "Zeros gauges and encoders, then makes the finger a spring with stiffness.initial. Takes up to a \
                 minute."
            }
            Self::Tendons => {
                "Moves every joint between its stops and presses against the lower stops, with up to 0.6 of \
                 finger.tendon.maximum. This measures the stretch of the tendons. Then zeros gauges and encoders \
                 again, and takes this stretch into account. Takes two minutes."
            }
            Self::Bound => "Computes the largest stiffness at which the finger is stable. Takes one to two minutes.",
            Self::Computer => "Checks whether this computer runs the finger in time. The motors are off.",
            Self::Spring => "Makes the finger a spring, and measures its stiffness while you push.",
        }
    }

    /// What the person should see.
    pub fn expect(self) -> &'static str {
        match self {
            Self::Board => "The number of the board, and that the board sees the emergency stop.",
            Self::Encoders => "The encoder of the motor counts one turn, and no other encoder counts.",
            Self::Gauges => "The gauge of the tendon shows the weight, and no other gauge changes.",
            Self::Motors => "Each motor turns back and forth by less than 10 mm of tendon. The finger hardly moves.",
            Self::Zeros => "The tendons come loose and tight again. Then the finger holds its pose.",
            Self::Tendons => "Slow motions of all joints, then each joint from stop to stop.",
            Self::Bound => {
                "Nothing moves. The bound can be far below the stiffness that `sun2xp size` computes. The tool says \
                 what limits the bound."
            }
            Self::Computer => "Nothing moves.",
            Self::Spring => "The tip gives way under your hand, and returns.",
        }
    }
}

impl std::fmt::Display for Step {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(self.name())
    }
}

impl std::str::FromStr for Step {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let names = || Self::ALL.map(Self::name).join(", ");
        Self::ALL.into_iter().find(|step| step.name() == text).ok_or_else(|| format!("the steps are {}", names()))
    }
}
