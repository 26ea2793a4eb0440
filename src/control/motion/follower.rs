//! Follows a path: evaluates it in every cycle.

use crate::control::motion::Motion;
use crate::control::signals::{SetPoint, spatial};
use crate::model::path::Piece;
use nalgebra::{Matrix3, Matrix6};

/// The Kx that a path reaches at a given time. Between two such times Kx changes linearly.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimedStiffness {
    /// Time since the beginning of the path, s.
    pub time: f64,
    /// Kx in the finger's frame, N/cm, symmetric.
    pub kx: Matrix3<f64>,
}

/// A path in joint angles, rad. Its pieces and its stiffnesses are in the order of time.
#[derive(Clone, Copy, Debug)]
pub struct PathTable<'a> {
    /// The pieces. There is at least one.
    pub pieces: &'a [Piece],
    /// The stiffness along the path. Without entries the path does not change the stiffness.
    pub stiffness: &'a [TimedStiffness],
}

/// The place of a servo on a path.
#[derive(Clone, Copy, Debug)]
pub struct Follower {
    piece: usize,
    stiffness: usize,
    /// The stiffness before the path, as in [`SetPoint::stiffness`].
    initial: Matrix6<f64>,
}

impl Follower {
    /// Constructs a follower at the beginning of a path. `initial` is the stiffness with which the path begins.
    pub fn new(initial: Matrix6<f64>) -> Self {
        Self { piece: 0, stiffness: 0, initial }
    }

    /// Moves `set_point` to the place that the path has reached at `time`, s since its beginning. The time never goes
    /// back. Returns whether the path has ended. After the end of the path, the set point rests there.
    pub fn advance(&mut self, path: &PathTable, time: f64, set_point: &mut SetPoint) -> bool {
        if let Some(stiffness) = self.stiffness_at(path.stiffness, time) {
            set_point.stiffness = stiffness;
        }
        while self.piece + 1 < path.pieces.len() && time >= path.pieces[self.piece].end() {
            self.piece += 1;
        }
        let Some(piece) = path.pieces.get(self.piece) else { return true };
        let ended = time >= piece.end();
        let now = piece.at(time.min(piece.end()));
        set_point.joints = now.place;
        set_point.motion = (!ended).then_some(Motion {
            rates: now.rates,
            accelerations: now.accelerations,
            jerk: now.jerk,
            snap: now.snap,
        });
        ended
    }

    fn stiffness_at(&mut self, stiffness: &[TimedStiffness], time: f64) -> Option<Matrix6<f64>> {
        while self.stiffness + 1 < stiffness.len() && time >= stiffness[self.stiffness].time {
            self.stiffness += 1;
        }
        let next = stiffness.get(self.stiffness)?;
        let (begin, from) = match self.stiffness.checked_sub(1) {
            Some(last) => (stiffness[last].time, spatial(&stiffness[last].kx)),
            None => (0.0, self.initial),
        };
        let part = ((time - begin) / (next.time - begin)).clamp(0.0, 1.0);
        Some(from + (spatial(&next.kx) - from) * part)
    }
}
