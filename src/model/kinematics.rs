//! The finger as a chain of three links: position and rotation of the tip, and their Jacobians, eqs. 7-12.

use nalgebra::{Matrix3, Matrix6x3, UnitQuaternion, Vector3};

/// Sines and cosines of the joint angles of a pose. A servo cycle computes them once for everything that needs them.
#[derive(Clone, Copy, Debug)]
pub struct JointSines {
    /// sin theta.
    pub sin: [f64; 3],
    /// cos theta.
    pub cos: [f64; 3],
}

impl JointSines {
    /// Computes the sines and cosines of joint angles, rad.
    #[inline]
    pub fn of(theta: &Vector3<f64>) -> Self {
        let [(s0, c0), (s1, c1), (s2, c2)] = [theta[0].sin_cos(), theta[1].sin_cos(), theta[2].sin_cos()];
        Self { sin: [s0, s1, s2], cos: [c0, c1, c2] }
    }
}

/// The link lengths l0, l1, l2 of a finger, cm (section 5.5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Links(pub [f64; 3]);

impl Links {
    /// Returns the tip position in the finger's frame (Figure 8), cm, at joint angles `theta`, rad.
    ///
    /// x = (l0 + l1 C1 + l2 C12) S0, y = -l1 S1 - l2 S12, z = (l0 + l1 C1 + l2 C12) C0. Here S1 = sin(theta_1), C12 =
    /// cos(theta_1 + theta_2), and so on. Eq. 8 is the derivative of these equations.
    pub fn tip(&self, theta: &Vector3<f64>) -> Vector3<f64> {
        let [_, l1, l2] = self.0;
        let (s0, c0) = theta[0].sin_cos();
        let (s1, _) = theta[1].sin_cos();
        let (s12, _) = (theta[1] + theta[2]).sin_cos();
        let reach = self.reach(theta);
        Vector3::new(reach * s0, -l1 * s1 - l2 * s12, reach * c0)
    }

    /// Returns the Jacobian of [`Links::tip`], eq. 8, cm/rad. Rows are x, y, z, and columns are joints.
    pub fn jacobian(&self, theta: &Vector3<f64>) -> Matrix3<f64> {
        self.jacobian_at(&JointSines::of(theta))
    }

    /// Returns [`Links::jacobian`] at a pose whose sines the caller has.
    #[inline]
    fn jacobian_at(&self, pose: &JointSines) -> Matrix3<f64> {
        let [l0, l1, l2] = self.0;
        let JointSines { sin: [s0, s1, s2], cos: [c0, c1, c2] } = *pose;
        let s12 = c1 * s2 + s1 * c2; // eq. 11
        let c12 = c1 * c2 - s1 * s2; // eq. 12
        let reach = l0 + l1 * c1 + l2 * c12;
        let fall = -l1 * s1 - l2 * s12;
        Matrix3::new(
            reach * c0,
            fall * s0,
            -l2 * s12 * s0,
            0.0,
            -l1 * c1 - l2 * c12,
            -l2 * c12,
            -reach * s0,
            fall * c0,
            -l2 * s12 * c0,
        )
    }

    /// Returns the rotation of the last link in the finger's frame. The link's own z axis points from joint 2 to the
    /// tip. Joint 0 turns about y. Joints 1 and 2 turn about the x axis as rotated by joint 0. The result is a
    /// quaternion and not a matrix: the angle of a matrix is computed from its trace, in which rounding loses a small
    /// angle.
    pub fn tip_rotation(&self, theta: &Vector3<f64>) -> UnitQuaternion<f64> {
        UnitQuaternion::from_axis_angle(&Vector3::y_axis(), theta[0])
            * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), theta[1] + theta[2])
    }

    /// Returns the rotation vector, rad, that turns the last link from its rotation at `from` to its rotation at `to`.
    /// This vector is continuous in the joint angles. If the link turns by more than half a revolution, the vector is
    /// longer than pi. A shorter rotation has the same result, but its vector has the opposite direction.
    pub fn rotation_between(&self, from: &Vector3<f64>, to: &Vector3<f64>) -> Vector3<f64> {
        // A quaternion contains half of the angle, so its real part is negative beyond half a turn. `scaled_axis` would
        // return the shorter rotation.
        let turned = self.tip_rotation(to) * self.tip_rotation(from).inverse();
        let length = turned.imag().norm();
        if length == 0.0 {
            return Vector3::zeros();
        }
        turned.imag() * (2.0 * length.atan2(turned.w) / length)
    }

    /// Returns the Jacobian of the tip's complete motion in the finger's frame. Rows 0 to 2 are those of
    /// [`Links::jacobian`], cm/rad. Rows 3 to 5 belong to the rotation of [`Links::tip_rotation`], rad/rad, and their
    /// columns are the axes of the joints.
    pub fn spatial_jacobian(&self, theta: &Vector3<f64>) -> Matrix6x3<f64> {
        self.spatial_jacobian_at(&JointSines::of(theta))
    }

    /// Returns [`Links::spatial_jacobian`] at a pose whose sines the caller has.
    #[inline]
    pub fn spatial_jacobian_at(&self, pose: &JointSines) -> Matrix6x3<f64> {
        let (s0, c0) = (pose.sin[0], pose.cos[0]);
        let mut jacobian = Matrix6x3::zeros();
        jacobian.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.jacobian_at(pose));
        #[rustfmt::skip]
        let axes = Matrix3::new(
            0.0, c0, c0,
            1.0, 0.0, 0.0,
            0.0, -s0, -s0,
        );
        jacobian.fixed_view_mut::<3, 3>(3, 0).copy_from(&axes);
        jacobian
    }

    /// Returns the signed distance of the tip from the axis of joint 0, cm: l0 + l1 C1 + l2 C12. A pose with distance
    /// zero is singular.
    pub fn reach(&self, theta: &Vector3<f64>) -> f64 {
        let [l0, l1, l2] = self.0;
        l0 + l1 * theta[1].cos() + l2 * (theta[1] + theta[2]).cos()
    }
}
