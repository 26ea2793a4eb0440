//! A cycle of a finger, converted to the quantities that users read.

use crate::finger::{Fault, Stage};
use crate::model::FingerNumber;
use serde::Serialize;

/// A cycle of a finger: its pose, forces, tensions and commands. Lengths are in cm, forces in N, torques in N cm,
/// stiffnesses in N/cm, angles in rad.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sample {
    /// The finger.
    pub finger: FingerNumber,
    /// Number of the cycle since open; the first is 1.
    pub cycle: u64,
    /// Beginning of the cycle, ns of the monotonic clock.
    pub began: u64,
    /// Stage of the finger at the end of the cycle.
    pub stage: Stage,
    /// Whether the controller ran in this cycle. If it did not, for example because the finger has just faulted, most
    /// values below are those of the last cycle in which it ran. If it has not run yet, most of them are 0. The contact
    /// and the stiffness of the tip are 0 unless the finger is in the stage `Running`. The times `wake_up` and `whole`
    /// are those of this cycle.
    pub computed: bool,
    /// Measured joint angles.
    pub joints: [f64; 3],
    /// Measured joint rates, rad/s.
    pub joint_rates: [f64; 3],
    /// Joint angles of the set point in this cycle. If the set point moves, these are the angles that it has reached in
    /// this cycle. None if the finger does not follow a set point.
    pub joint_set_point: Option<[f64; 3]>,
    /// Measured position of the tip in the palm's frame.
    pub tip: [f64; 3],
    /// Position of the tip at the set point, in the palm's frame.
    pub tip_set_point: Option<[f64; 3]>,
    /// Measured force of the tip on what it touches, in the finger's frame, as planners get it.
    pub tip_force: [f64; 3],
    /// The same force in the palm's frame.
    pub tip_force_in_palm: [f64; 3],
    /// Kx of the set point in this cycle, row by row, in the finger's frame, before it is scaled down to what the pose
    /// supports.
    pub kx: Option<[[f64; 3]; 3]>,
    /// Stiffness of the tip in the present pose, in the finger's frame, as planners get it. It is zero if the finger
    /// does not follow a set point.
    pub stiffness: [[f64; 3]; 3],
    /// The same stiffness in the palm's frame.
    pub stiffness_in_palm: [[f64; 3]; 3],
    /// Desired joint torques. For a finger that follows a set point, they include the damper, the soft joint limits,
    /// the gravity compensation and the feed-forward.
    pub joint_torques: [f64; 3],
    /// Joint torques R t (eq. 13) with the measured tensions t.
    pub measured_joint_torques: [f64; 3],
    /// Commanded tensions.
    pub desired_tensions: [f64; 4],
    /// Measured tensions.
    pub tensions: [f64; 4],
    /// Configured lower bound of the tensions.
    pub t_min: f64,
    /// Configured upper bound of the tensions.
    pub t_max: f64,
    /// Commanded motor torques.
    pub motor_torques: [f64; 4],
    /// The fraction of `joint_torques` that the tension bounds permit, 0 to 1.
    pub torque_scale: f64,
    /// The fraction of the set point's stiffness that the pose supports, 0 to 1.
    pub stiffness_scale: f64,
    /// Estimated force on the touched object in the finger's frame, as planners get it. It excludes friction, weight
    /// and acceleration of the finger.
    pub contact_force: [f64; 3],
    /// Whether the finger touches something, as far as tensions and motion show it.
    pub touching: bool,
    /// Speed of the tip perpendicular to `contact_force` while it touches something, cm/s.
    pub slide: f64,
    /// Time from the scheduled beginning of the cycle to its first instruction, us.
    pub wake_up: Option<f64>,
    /// Time from the scheduled beginning of the cycle to the end of its computation, us.
    pub whole: Option<f64>,
}

impl Sample {
    /// Returns the name of the stage, without the text of a fault.
    pub fn stage_name(&self) -> String {
        match self.stage {
            Stage::Faulted(_) => "faulted".into(),
            stage => stage.to_string(),
        }
    }

    /// Returns the fault, if the finger is faulted.
    pub fn fault(&self) -> Option<Fault> {
        match self.stage {
            Stage::Faulted(fault) => Some(fault),
            _ => None,
        }
    }
}
