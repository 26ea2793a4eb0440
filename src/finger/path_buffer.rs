//! The path that a planner sends to a servo. Its tables of pieces and of stiffnesses are large, so they have pages of
//! their own: only the struct moves through the stack.

use crate::control::motion::{PathTable, TimedStiffness};
use crate::model::path::Piece;
use crate::realtime::{LockedMemory, Pages};
use nalgebra::{Matrix6, Vector3};

/// Largest number of pieces of a path.
pub const MOST_PIECES: usize = 256;

/// Largest number of poses of a path.
pub const MOST_POSES: usize = 128;

/// A path with its number and its beginning.
pub(super) struct PathBuffer {
    /// Number of the path, from 1.
    pub number: u32,
    /// The period of the servo in which the path begins, as in [`Reference::period`](crate::finger::Reference::period).
    pub origin: u64,
    /// The stiffness with which the path begins, as in [`SetPoint::stiffness`](crate::control::SetPoint::stiffness);
    /// none if the path begins with the stiffness in force. The path carries the stiffness, because a planner may have
    /// sent a set point with this stiffness shortly before the path. The mailbox keeps only the newest set point, so
    /// the servo may never get the earlier one.
    pub begin: Option<Matrix6<f64>>,
    pieces: Pages<[Piece]>,
    piece_count: usize,
    stiffness: Pages<[TimedStiffness]>,
    stiffness_count: usize,
}

impl PathBuffer {
    /// Constructs a path without motion, and adds its pages to `memory`.
    pub fn new(memory: &mut LockedMemory) -> Self {
        let pieces = Pages::from_fn(MOST_PIECES, |_| Piece::at_rest(Vector3::zeros()));
        let stiffness = Pages::from_fn(MOST_POSES, |_| TimedStiffness::default());
        memory.add(&pieces);
        memory.add(&stiffness);
        Self { number: 0, origin: 0, begin: None, pieces, piece_count: 1, stiffness, stiffness_count: 0 }
    }

    /// Replaces the path. Pieces beyond [`MOST_PIECES`] and stiffnesses beyond [`MOST_POSES`] are ignored; the caller
    /// must have refused a path that has more.
    pub fn fill(&mut self, number: u32, origin: u64, begin: Option<Matrix6<f64>>, path: &PathTable) {
        (self.number, self.origin, self.begin) = (number, origin, begin);
        self.piece_count = path.pieces.len().min(MOST_PIECES);
        self.pieces[..self.piece_count].copy_from_slice(&path.pieces[..self.piece_count]);
        self.stiffness_count = path.stiffness.len().min(MOST_POSES);
        self.stiffness[..self.stiffness_count].copy_from_slice(&path.stiffness[..self.stiffness_count]);
    }

    /// Returns the path.
    pub fn table(&self) -> PathTable<'_> {
        PathTable { pieces: &self.pieces[..self.piece_count], stiffness: &self.stiffness[..self.stiffness_count] }
    }
}
