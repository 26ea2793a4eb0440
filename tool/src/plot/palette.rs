//! Colours that people with any kind of colour vision can distinguish (M. Okabe and K. Ito, 2008), and a dark purple.
//! Most curves also differ in their dashes or their labels.

/// A colour as SVG writes it.
pub type Colour = &'static str;

pub const BLUE: Colour = "#0072b2";
pub const VERMILION: Colour = "#d55e00";
pub const GREEN: Colour = "#009e73";
pub const ORANGE: Colour = "#e69f00";
pub const SKY: Colour = "#56b4e9";
pub const PURPLE: Colour = "#a6518a";

/// Text and set points.
pub const INK: Colour = "#1f2430";
/// Numbers and units.
pub const SOFT_INK: Colour = "#5a6270";
/// The frames of panels.
pub const FRAME: Colour = "#9aa3af";
pub const GRID: Colour = "#e7eaee";
/// The background of a permitted range.
pub const PERMITTED: Colour = "#eaf3f8";
pub const PAPER: Colour = "#ffffff";
