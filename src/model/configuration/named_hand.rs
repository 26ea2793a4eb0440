//! The names of simulated hands.

use serde::{Deserialize, Serialize};

/// A named set of defaults for the keys of `[finger.simulation]` other than `hand`, which contains the name. The values
/// that the controller assumes do not change, so a finger with a set other than `Nominal` differs from its
/// configuration. Calibration measures some of the differences.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum NamedHand {
    /// The finger that the default configuration describes.
    #[default]
    Nominal,
    /// A hand after years of use. It has stiction, twice the friction of `Nominal`, soft and unequal tendons that
    /// creep, and inexact gauges and moment arms.
    Worn,
    /// A hand whose tendons run through sheaths: friction between motor and gauge, tendons that harden and creep.
    Sheathed,
    /// A hand of inexpensive parts: noisy and slow gauges, slow amplifiers, heavy and uneven motors.
    Cheap,
}

impl NamedHand {
    /// Every named hand.
    pub const ALL: [Self; 4] = [Self::Nominal, Self::Worn, Self::Sheathed, Self::Cheap];

    /// Returns the name, as in the configuration file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nominal => "nominal",
            Self::Worn => "worn",
            Self::Sheathed => "sheathed",
            Self::Cheap => "cheap",
        }
    }
}
