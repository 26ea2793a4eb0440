//! The worst cases over poses and directions.

use crate::failure::Failure;
use sun2xp::control::TensionDistribution;
use sun2xp::model::Tendons;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

/// Number of angles of each joint, from limit to limit.
const ANGLES: usize = 5;

/// A force or a tension that no finger can give, N. The distribution scales such a force down to what the tensions
/// permit. As the largest permitted tension, it has no effect.
const TOO_MUCH: f64 = 1e5;

/// The geometry of a finger, in cm, the stiffness of its tendons, N/cm, and their lowest tension, N.
pub struct Mechanics {
    tendons: Tendons,
    stiffness: Vector4<f64>,
    minimum: f64,
    jacobians: Vec<Matrix3<f64>>,
}

impl Mechanics {
    pub fn new(finger: &ConfiguredFinger) -> Result<Self, Failure> {
        let (lower, upper) = finger.joint_limits();
        let angle = |joint: usize, step: usize| {
            lower[joint] + (upper[joint] - lower[joint]) * step as f64 / (ANGLES - 1) as f64
        };
        let links = finger.links();
        let jacobians = (0..ANGLES.pow(3)).map(|pose| {
            let steps = [pose % ANGLES, pose / ANGLES % ANGLES, pose / ANGLES / ANGLES];
            links.jacobian(&Vector3::from_fn(|joint, _| angle(joint, steps[joint])))
        });
        Ok(Self {
            tendons: finger.tendons()?,
            stiffness: Vector4::from(finger.tendon.stiffness),
            minimum: finger.tendon.minimum,
            jacobians: jacobians.collect(),
        })
    }

    /// Returns the largest force of the tip in the worst pose and direction while no tension exceeds `most`, N (eqs. 1
    /// and 18 to 20). It is 0 if `most` does not suffice for the lowest tensions.
    pub fn force(&self, most: &Vector4<f64>) -> f64 {
        let Ok(distribution) = TensionDistribution::new(&self.tendons, self.minimum, *most) else { return 0.0 };
        let forces = self.torques(TOO_MUCH).map(|torque| distribution.distribute(&torque).scale * TOO_MUCH);
        forces.fold(f64::INFINITY, f64::min)
    }

    /// Returns the largest tension of each tendon for a force of the tip in any pose and direction, N.
    pub fn tensions(&self, force: f64) -> Result<Vector4<f64>, Failure> {
        let distribution = TensionDistribution::new(&self.tendons, self.minimum, Vector4::repeat(TOO_MUCH))?;
        let tensions = self.torques(force).map(|torque| distribution.distribute(&torque).tensions);
        Ok(tensions.fold(Vector4::zeros(), |most, tensions| most.sup(&tensions)))
    }

    /// Returns the joint torques of a force in all poses and directions (eq. 1), N cm.
    fn torques(&self, force: f64) -> impl Iterator<Item = Vector3<f64>> + '_ {
        let torques = move |jacobian: &Matrix3<f64>| {
            let transposed = jacobian.transpose() * force;
            directions().map(move |direction| transposed * direction)
        };
        self.jacobians.iter().flat_map(torques)
    }

    /// Returns the speed of each tendon while all joints move at `speed` rad/s in the worst combination of directions,
    /// cm/s (eq. 26).
    pub fn tendon_speed(&self, speed: f64) -> Vector4<f64> {
        Vector4::from_fn(|tendon, _| self.tendons.r.column(tendon).abs().sum() * speed)
    }

    /// Returns the largest displacement of the tip by the travel of any one tendon, cm (eqs. 7 and 27).
    pub fn tip_by_travel(&self, travel: &Vector4<f64>) -> f64 {
        let joints = self.tendons.joints_from_travel();
        let tip = self.jacobians.iter().flat_map(|jacobian| {
            let tip = jacobian * joints;
            (0..4).map(move |tendon| tip.column(tendon).norm() * travel[tendon])
        });
        tip.fold(0.0, f64::max)
    }

    /// Returns the largest change of the force at the tip by the tension of any one tendon, N, in the poses that
    /// are not nearly singular.
    pub fn tip_force_by_tension(&self, tension: &Vector4<f64>) -> f64 {
        let force = self.regular().flat_map(|inverse| {
            let force = inverse.transpose() * self.tendons.r;
            (0..4).map(move |tendon| force.column(tendon).norm() * tension[tendon])
        });
        force.fold(0.0, f64::max)
    }

    /// Returns the smallest stiffness of the tip with locked motors, N/cm: the smallest eigenvalue of
    /// J^-T (R k R^T) J^-1 over the poses that are not nearly singular.
    pub fn locked_stiffness(&self) -> f64 {
        let joints = self.tendons.r * Matrix4::from_diagonal(&self.stiffness) * self.tendons.r.transpose();
        let stiffness = self.regular().map(|inverse| {
            let tip: Matrix3<f64> = inverse.transpose() * joints * inverse;
            tip.symmetric_eigenvalues().min()
        });
        stiffness.fold(f64::INFINITY, f64::min)
    }

    /// The inverses of the Jacobians of the poses that are not nearly singular.
    fn regular(&self) -> impl Iterator<Item = Matrix3<f64>> + '_ {
        let regular = |jacobian: &&Matrix3<f64>| {
            let singular = jacobian.singular_values();
            singular.min() > 0.2 * singular.max()
        };
        self.jacobians.iter().filter(regular).filter_map(|jacobian| jacobian.try_inverse())
    }
}

/// The directions to the faces, edges and corners of a cube.
fn directions() -> impl Iterator<Item = Vector3<f64>> {
    let coordinates = |at: usize| [at % 3, at / 3 % 3, at / 9].map(|digit| digit as f64 - 1.0);
    (0..27).map(move |at| Vector3::from(coordinates(at))).filter_map(|direction| direction.try_normalize(0.5))
}
