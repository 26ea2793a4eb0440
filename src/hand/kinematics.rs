//! The kinematics of a finger for planners: Jacobian, forward and inverse kinematics, joint torques, and the pose of
//! the finger in the palm.

use crate::finger::FingerReport;
use crate::hand::admission::Admission;
use crate::hand::{Hand, HandError};
use crate::model::FingerNumber;
use nalgebra::{Isometry3, Matrix3, Vector3};

/// The torques of a finger's joints, N cm.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct JointTorques {
    /// R t (eq. 13 of the report) with the moment arms R and the measured tensions t.
    pub measured: [f64; 3],
    /// What the controller commands: the torques of spring, damper, limits, gravity compensation and feed-forward,
    /// scaled to the part that the tension bounds permit.
    pub commanded: [f64; 3],
}

/// Where a finger and its tip are in the palm's frame, cm.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PalmPose {
    /// Origin of the finger's frame: `finger.base`.
    pub base: [f64; 3],
    /// Axes of the finger's frame as columns: `rotation[row][column]`. The product of this matrix and a vector in the
    /// finger's frame is the vector in the palm's frame.
    pub rotation: [[f64; 3]; 3],
    /// Position of the tip, from the measured joint angles.
    pub tip: [f64; 3],
    /// Axes of the last link as columns. Its z axis points from joint 2 to the tip.
    pub tip_rotation: [[f64; 3]; 3],
}

impl Hand {
    /// Returns the Jacobian of the tip of finger 1, 2 or 3 (eq. 8 of the report), cm/rad, at these joint angles, rad,
    /// or at the measured ones: `jacobian[row][column]`, with x, y, z as rows and joints as columns.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if an angle is NaN or infinite. Returns an error if the measured
    /// angles are wanted and the finger is faulted.
    pub fn jacobian(&self, finger: i32, joints: Option<[f64; 3]>) -> Result<[[f64; 3]; 3], HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let admission = self.dispatcher.member(finger)?.admission.read();
        let joints = match joints {
            Some(joints) => finite(&admission, joints)?,
            None => self.dispatcher.report(finger)?.cycle.joints,
        };
        Ok(rows(&admission.links.jacobian(&joints)))
    }

    /// Returns the position of the tip of finger 1, 2 or 3 in the finger's frame, cm, at these joint angles, rad. The
    /// angles may be beyond the joint limits.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if an angle is NaN or infinite.
    pub fn tip_at(&self, finger: i32, joints: [f64; 3]) -> Result<[f64; 3], HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let admission = self.dispatcher.member(finger)?.admission.read();
        Ok(admission.links.tip(&finite(&admission, joints)?).into())
    }

    /// Returns the joint angles of finger 1, 2 or 3, rad, at which its tip is at this position in the finger's frame,
    /// cm. Of several solutions within the joint limits it returns the one nearest to the present pose, as
    /// [`Hand::send_tip`] does.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if a number is NaN or infinite, or if the tip cannot be there.
    pub fn joints_at(&self, finger: i32, tip: [f64; 3]) -> Result<[f64; 3], HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let present = self.dispatcher.last_report(finger)?.cycle.joints;
        let admission = self.dispatcher.member(finger)?.admission.read();
        Ok(admission.tip(tip, &present)?.into())
    }

    /// Returns the joint torques of finger 1, 2 or 3, from the last cycle.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger is faulted.
    pub fn joint_torques(&self, finger: i32) -> Result<JointTorques, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let FingerReport { cycle, .. } = self.dispatcher.report(finger)?;
        let measured = self.dispatcher.member(finger)?.admission.read().r * cycle.tensions;
        Ok(JointTorques { measured: measured.into(), commanded: (cycle.joint_torques * cycle.torque_scale).into() })
    }

    /// Returns the pose of finger 1, 2 or 3 and of its tip in the palm's frame. The configuration defines the pose of
    /// the finger: `finger.base` and `finger.turn_degrees`.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger is faulted.
    pub fn palm_pose(&self, finger: i32) -> Result<PalmPose, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let joints = self.dispatcher.report(finger)?.cycle.joints;
        let links = self.dispatcher.member(finger)?.admission.read().links;
        let pose: Isometry3<f64> = self.configuration.read().finger_to_palm(finger);
        let rotation = |rotation: nalgebra::UnitQuaternion<f64>| rows(rotation.to_rotation_matrix().matrix());
        Ok(PalmPose {
            base: pose.translation.vector.into(),
            rotation: rotation(pose.rotation),
            tip: (pose * nalgebra::Point3::from(links.tip(&joints))).coords.into(),
            tip_rotation: rotation(pose.rotation * links.tip_rotation(&joints)),
        })
    }
}

fn finite(admission: &Admission, joints: [f64; 3]) -> Result<Vector3<f64>, HandError> {
    admission.finite("Pos", &joints)?;
    Ok(Vector3::from(joints))
}

/// Returns the matrix as an array of its rows.
pub(super) fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    matrix.transpose().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_rows() {
        let matrix = Matrix3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0);
        assert_eq!(rows(&matrix), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]);
    }
}
