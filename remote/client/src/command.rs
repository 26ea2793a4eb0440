//! Commands of planners.

/// A desired pose of a finger.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Pose {
    /// Angles of joints 0, 1 and 2, rad.
    Joints([f64; 3]),
    /// Position of the tip in the finger's frame, cm.
    Tip([f64; 3]),
}

/// The command for one finger in a group of commands that take effect together. The finger keeps the values whose
/// fields are none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FingerCommand {
    /// Number of the finger, 1 to 3.
    pub finger: i32,
    /// Desired pose.
    pub pose: Option<Pose>,
    /// Kx in the finger's frame, N/cm: `stiffness[row][column]`.
    pub stiffness: Option<[[f64; 3]; 3]>,
    /// Damping, relative to the damping that the controller chooses.
    pub damping: Option<f64>,
}

impl FingerCommand {
    /// Returns a command that changes nothing.
    #[must_use]
    pub fn new(finger: i32) -> Self {
        Self { finger, ..Self::default() }
    }

    /// Sets the desired joint angles, rad.
    #[must_use]
    pub fn joints(self, joints: [f64; 3]) -> Self {
        Self { pose: Some(Pose::Joints(joints)), ..self }
    }

    /// Sets the desired position of the tip, cm.
    #[must_use]
    pub fn tip(self, tip: [f64; 3]) -> Self {
        Self { pose: Some(Pose::Tip(tip)), ..self }
    }

    /// Sets Kx, N/cm.
    #[must_use]
    pub fn stiffness(self, rows: [[f64; 3]; 3]) -> Self {
        Self { stiffness: Some(rows), ..self }
    }

    /// Sets the relative damping.
    #[must_use]
    pub fn damping(self, ratio: f64) -> Self {
        Self { damping: Some(ratio), ..self }
    }
}
