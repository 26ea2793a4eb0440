//! Mathematics of timed paths: polynomial pieces, the spline through timed places, and the bounds of a piece.

mod bounds;
mod hermite;
mod piece;
mod spline;

pub use piece::{Piece, PieceMotion};
pub use spline::{Knot, Start, spline};
