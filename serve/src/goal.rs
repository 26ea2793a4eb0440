//! What the owner wants of one finger, and what the server has sent to it.

use sun2xp::finger::FingerReport;
use sun2xp::nalgebra::{Matrix3, Vector3};
use sun2xp_remote_protocol::{Part, Place};

/// Where the owner wants a finger.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Destination {
    /// Nowhere: the owner has not commanded a place for the finger.
    #[default]
    None,
    /// At these joint angles, rad.
    Joints(Vector3<f64>),
    /// With the tip at its position for these joint angles, rad.
    Tip(Vector3<f64>),
    /// On a path.
    Path {
        /// The joint angles at the end of the path, rad.
        end: Vector3<f64>,
        /// The time at which the path ends, ns. If the servo skips periods, the path ends later.
        until: u64,
    },
}

/// What the owner of the hand wants of one finger.
#[derive(Clone, Copy, Debug, Default)]
pub struct Goal {
    /// The command number that was taken last; 0 if none in this epoch.
    pub command: u32,
    /// The command number before `command`, and the time at which `command` was taken, ns.
    before: (u32, u64),
    pub destination: Destination,
    /// Kx, N/cm, and relative damping that are in force for the owner.
    pub spring: Option<(Matrix3<f64>, f64)>,
    /// Kx, N/cm, and relative damping that the previous owner has left.
    inherited: Option<(Matrix3<f64>, f64)>,
    /// The joint angles of the set point that the owner keeps because it has not commanded a place, rad. A finger that
    /// was caught (see [`crate::silence`]) returns to them.
    pub kept: Option<Vector3<f64>>,
    /// Whether the whole way to the destination has been sent, and not only the part that the lead (see
    /// [`crate::lead`]) admits.
    pub whole: bool,
    /// Numbers of the finger's recoveries and orders (see [`FingerReport`]) when this goal was set. A later recovery or
    /// order cancels the goal.
    phase: (u32, u32),
    /// `FingerReport::springs` when the goal was sent last. This number rises when a new spring phase begins, for
    /// example when the finger is caught.
    springs: u32,
}

impl Goal {
    /// Returns the command number that was in force at `time`, ns.
    #[must_use]
    pub fn command_at(&self, time: u64) -> u32 {
        if time >= self.before.1 { self.command } else { self.before.0 }
    }

    /// Forgets the command number, which belongs to the previous owner.
    pub fn forget_command(&mut self) {
        (self.command, self.before) = (0, (0, 0));
    }

    /// Begins the epoch of another owner, who has not commanded the finger yet. If a place was sent to the finger in
    /// full, it is kept: a finger that is caught before its next command returns to this place.
    pub fn begin_epoch(&mut self) {
        let kept = match self.destination {
            Destination::None => self.kept,
            Destination::Joints(end) | Destination::Tip(end) if self.whole => Some(end),
            _ => None,
        };
        *self = Self { inherited: self.spring.or(self.inherited), kept, ..Self::default() };
    }

    /// Returns whether the owner has commanded the finger, and it was neither recovered nor calibrated since.
    #[must_use]
    pub fn is_commanded(&self) -> bool {
        self.spring.is_some()
    }

    /// Forgets what the owner wants if the finger was recovered or calibrated since the goal was set. Such a finger
    /// holds its pose.
    pub fn notice(&mut self, report: &FingerReport) {
        if self.is_commanded() && self.phase != (report.recoveries, report.orders) {
            *self = Self { command: self.command, before: self.before, ..Self::default() };
        }
    }

    /// Returns whether the finger was caught, and nothing was sent since.
    #[must_use]
    pub fn is_interrupted(&self, report: &FingerReport) -> bool {
        self.is_commanded() && report.expired && self.springs != report.springs
    }

    /// Returns whether a finger at `joints`, rad, is where the owner wants it, within `tolerance`, rad. Returns true
    /// if the owner has not commanded a place for the finger.
    #[must_use]
    pub fn is_reached(&self, joints: &Vector3<f64>, tolerance: f64) -> bool {
        match self.destination {
            Destination::None => true,
            Destination::Joints(end) | Destination::Tip(end) | Destination::Path { end, .. } => {
                (joints - end).amax() <= tolerance
            }
        }
    }

    /// Notes that a set point was sent to the finger. `report` is the report on which the set point was based.
    pub fn note_sent(&mut self, report: &FingerReport, whole: bool) {
        (self.springs, self.whole) = (report.springs, whole);
    }

    /// Returns the goal after a part with a new command number, taken at `now`, ns. `destination` is the destination
    /// of the part. If it is none, the goal keeps its destination. If neither the part nor an earlier one has a Kx, the
    /// goal takes the spring in `report`, or the spring from before the catch if the finger was caught.
    #[must_use]
    pub fn with(&self, part: &Part, destination: Option<Destination>, report: &FingerReport, now: u64) -> Self {
        let inherited = self.inherited.filter(|_| report.expired);
        let (kx, damping) = self.spring.or(inherited).unwrap_or_else(|| in_force(report));
        let kx = part.stiffness.map_or(kx, |rows| matrix(&rows));
        Self {
            command: part.command,
            before: (self.command, now),
            destination: destination.unwrap_or(self.destination),
            spring: Some((kx, part.damping.unwrap_or(damping))),
            inherited: None,
            kept: self.kept.filter(|_| destination.is_none()),
            whole: false,
            phase: (report.recoveries, report.orders),
            springs: report.springs,
        }
    }

    /// Returns whether the part has a command number that was not taken yet.
    #[must_use]
    pub fn is_new(&self, part: &Part) -> bool {
        part.command != self.command
    }
}

/// Whether a part moves the finger along a path.
#[must_use]
pub fn is_path(part: &Part) -> bool {
    matches!(part.place, Place::Path(_))
}

/// Kx, N/cm, and relative damping of the set point in force.
fn in_force(report: &FingerReport) -> (Matrix3<f64>, f64) {
    let kx = report.set_point.stiffness.fixed_view::<3, 3>(0, 0).into_owned();
    (kx, report.set_point.damping)
}

/// The matrix with these rows.
#[must_use]
pub fn matrix(rows: &[[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|row, column| rows[row][column])
}

/// The rows of a matrix.
#[must_use]
pub fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    matrix.transpose().into()
}
