//! Paths of the tip: a spline through the tip positions, approximated by a spline in joint angles.

use crate::finger::MOST_PIECES;
use crate::hand::admission::Admission;
use crate::hand::{PathError, SetPointError};
use crate::model::path::{Knot, Piece, Start, spline};
use nalgebra::Vector3;

/// The tip may always deviate this far from its path, cm. If it deviates further, the path is divided into more pieces,
/// up to [`MOST_PIECES`].
const ACCURATE: f64 = 0.001;

/// Largest deviation of the tip from its path, cm. A path with a larger deviation is refused.
const ACCEPTED: f64 = 0.01;

/// Numbers of pieces per pose that are tried one after the other.
const PIECES_PER_POSE: [usize; 7] = [4, 8, 16, 32, 64, 128, 256];

/// Time step for the derivatives of the tip's motion at the beginning of a path, s.
const STEP: f64 = 2e-3;

impl Admission {
    /// Computes the pieces of a path on which the tip passes through `tips`, and the number of pieces for each pose.
    pub(super) fn tip_pieces(&self, start: &Start, tips: &[Knot]) -> Result<(Vec<Piece>, usize), PathError> {
        let path = spline(&self.start_of_tip(start), tips);
        let most = MOST_PIECES / tips.len();
        let few = PIECES_PER_POSE.into_iter().take_while(|&pieces| pieces <= most);
        let mut best: Option<(Vec<Piece>, usize, (f64, usize))> = None;
        for per_pose in few.chain((most < PIECES_PER_POSE[0]).then_some(most)) {
            let knots = self.joint_knots(start, &path, per_pose)?;
            let pieces = spline(start, &knots);
            let deviation = self.deviation(&pieces, &path, per_pose);
            let accurate = deviation.0 <= ACCURATE;
            best = Some((pieces, per_pose, deviation));
            if accurate {
                break;
            }
        }
        match best {
            Some((pieces, per_pose, (deviation, _))) if deviation <= ACCEPTED => Ok((pieces, per_pose)),
            best => {
                let (deviation, pose) = best.map_or((f64::INFINITY, 0), |(.., deviation)| deviation);
                Err(PathError::Coarse { finger: self.finger, pose, deviation, pieces: MOST_PIECES })
            }
        }
    }

    /// Returns the position of the tip and its derivatives at the beginning of the path.
    fn start_of_tip(&self, start: &Start) -> Start {
        let tip = |time: f64| {
            let quadratic = start.accelerations * (0.5 * time * time) + start.jerk * (time.powi(3) / 6.0);
            self.links.tip(&(start.place + start.rates * time + quadratic))
        };
        let place = tip(0.0);
        let (one, other, far, opposite) = (tip(STEP), tip(-STEP), tip(2.0 * STEP), tip(-2.0 * STEP));
        Start {
            place,
            rates: ((one - other) * 8.0 - (far - opposite)) / (12.0 * STEP),
            accelerations: ((one + other) * 16.0 - (far + opposite) - place * 30.0) / (12.0 * STEP * STEP),
            jerk: ((far - opposite) - (one - other) * 2.0) / (2.0 * STEP.powi(3)),
        }
    }

    /// Returns joint angles at equal intervals of time on each piece of the tip's path. If there are several solutions,
    /// the one nearest to the previous joint angles is used.
    fn joint_knots(&self, start: &Start, path: &[Piece], per_pose: usize) -> Result<Vec<Knot>, PathError> {
        let mut knots: Vec<Knot> = Vec::with_capacity(path.len() * per_pose);
        let mut present = start.place;
        for (pose, piece) in path.iter().enumerate() {
            for part in 1..=per_pose {
                let time = piece.begin + piece.length * (part as f64 / per_pose as f64);
                let tip = piece.at(time).place;
                let joints = self.inverse_kinematics.joints(&tip, &present);
                present = joints.map_err(|source| PathError::Pose {
                    pose,
                    on_the_way: part < per_pose,
                    source: SetPointError::OutOfReach { finger: self.finger, tip: tip.into(), source },
                })?;
                knots.push(Knot { time, place: present });
            }
        }
        Ok(knots)
    }

    /// Returns the largest distance of the tip from its path between the knots, cm, and the number of the pose to which
    /// the finger moves at that time.
    fn deviation(&self, pieces: &[Piece], path: &[Piece], per_pose: usize) -> (f64, usize) {
        let mut worst = (0.0, 0);
        for (index, piece) in pieces.iter().enumerate() {
            for part in [0.25, 0.5, 0.75] {
                let time = piece.begin + piece.length * part;
                let expected: Vector3<f64> = path[index / per_pose].at(time).place;
                let deviation = (self.links.tip(&piece.at(time).place) - expected).norm();
                if deviation > worst.0 {
                    worst = (deviation, index / per_pose);
                }
            }
        }
        worst
    }
}
