//! A finger at rest: its spring, its load, and the wall that it may touch.

use crate::control::{Law, SetPoint, spatial};
use crate::model::Links;
use crate::model::configuration::Surface;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

/// Lever below which a joint counts as unable to exert a force at the tip, cm. A force at the tip balances the joint
/// torques of the spring, also those of its rotational stiffness. It does not balance a torque of the rotational
/// stiffness at a joint with such a short lever, so the finger rests at a pose that differs slightly from
/// [`Rest::joints`].
const LEAST_LEVER: f64 = 0.5;

/// An eigenvalue of a stiffness is zero if it is at most this fraction of the largest.
const RANK: f64 = 1e-9;

/// A finger at rest at `joints`. Forces on the tip hold the finger at `deflection` from the anchor of its spring.
#[derive(Clone, Copy, Debug)]
pub struct Rest {
    /// Joint angles, rad.
    pub joints: Vector3<f64>,
    /// Anchor of the spring minus joint angles, rad. At zero deflection, tendons 1 and 4 both have the tension t_min,
    /// and eq. 20 has a kink there.
    pub deflection: Vector3<f64>,
    /// Stiffness of the contact, with the units and axes of [`SetPoint::stiffness`].
    pub stiffness: Matrix6<f64>,
    /// The law that converts deflections to torques.
    pub law: Law,
    /// Damping relative to the damping that the controller computes from the stiffness.
    pub damping: f64,
    /// The wall that the tip presses against, if any. A constant force supplies the rest of the load.
    pub wall: Option<Wall>,
}

/// An elastic wall without friction.
#[derive(Clone, Copy, Debug)]
pub struct Wall {
    /// Stiffness, N/cm.
    pub stiffness: f64,
    /// The outward normal is parallel to tilt - d, where d is the unit vector along the pull of the spring at the tip.
    /// The length of `tilt` is below 1, so the tip presses against the wall.
    pub tilt: Vector3<f64>,
}

/// The forces of a spring on its finger at rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pull {
    /// Joint torques of the spring, N cm.
    pub torques: Vector3<f64>,
    /// Force at the tip that exerts these torques on the joints, N. [`LEAST_LEVER`] describes an exception.
    pub force: Vector3<f64>,
}

/// What holds a finger against the pull of its spring.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Support {
    pub wall: Option<Surface>,
    /// Constant force at the tip, N.
    pub load: Vector3<f64>,
}

impl Rest {
    /// Returns a finger at rest whose contact is a hard finger with friction. It has the report's law, a relative
    /// damping of 1 and no wall. `kx` is in N/cm.
    pub fn hard_finger(joints: Vector3<f64>, deflection: Vector3<f64>, kx: &Matrix3<f64>) -> Self {
        Self { joints, deflection, stiffness: spatial(kx), law: Law::Report, damping: 1.0, wall: None }
    }

    /// Returns the anchor of the spring: the desired joint angles, rad.
    pub fn anchor(&self) -> Vector3<f64> {
        self.joints + self.deflection
    }

    /// Returns the dimensions of the contact: the rank of its stiffness.
    pub fn dimensions(&self) -> usize {
        let eigenvalues = self.stiffness.symmetric_eigenvalues();
        let zero = eigenvalues.max() * RANK;
        eigenvalues.iter().filter(|&&eigenvalue| eigenvalue > zero).count()
    }

    pub(super) fn set_point(&self) -> SetPoint {
        SetPoint {
            joints: self.anchor(),
            law: self.law,
            stiffness: self.stiffness,
            damping: self.damping,
            motion: None,
            joint_spring: None,
        }
    }

    /// Returns the forces of the spring with its stiffness scaled by `scale`.
    pub(super) fn pull(&self, links: &Links, scale: f64) -> Pull {
        let jacobian = links.spatial_jacobian(&self.joints);
        let deflection = match self.law {
            Law::Report => jacobian * self.deflection,
            Law::Exact => {
                let anchor = self.anchor();
                let rotation = links.tip_rotation(&anchor) * links.tip_rotation(&self.joints).inverse();
                let mut deflection = Vector6::zeros();
                deflection.fixed_rows_mut::<3>(0).copy_from(&(links.tip(&anchor) - links.tip(&self.joints)));
                deflection.fixed_rows_mut::<3>(3).copy_from(&rotation.scaled_axis());
                deflection
            }
        };
        let wrench = self.stiffness * deflection * scale;
        let moments = jacobian.fixed_rows::<3>(3).tr_mul(&wrench.fixed_rows::<3>(3));
        let lever = jacobian.fixed_rows::<3>(0).transpose().svd(true, true);
        // Both factors of the decomposition are computed, so a solution exists.
        let balancing = lever.solve(&moments, LEAST_LEVER).unwrap_or_else(|_| Vector3::zeros());
        Pull { torques: jacobian.tr_mul(&wrench), force: wrench.fixed_rows::<3>(0) + balancing }
    }

    /// Returns the wall, and the constant force that supplies the rest of the load. `force` is the pull of the spring
    /// at the tip, N.
    pub(super) fn support(&self, links: &Links, force: &Vector3<f64>) -> Support {
        let (Some(wall), Some(direction)) = (self.wall, force.try_normalize(0.0)) else {
            return Support { wall: None, load: -force };
        };
        let normal = (wall.tilt - direction).normalize();
        let pressed = -force.dot(&normal);
        let point = links.tip(&self.joints) + normal * (pressed / wall.stiffness);
        let surface = Surface::Wall { point: point.into(), normal: normal.into(), stiffness: wall.stiffness };
        Support { wall: Some(surface), load: -force - normal * pressed }
    }
}
