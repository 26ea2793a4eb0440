//! The measured cases. The poses of a case, its random springs and its directions follow from the seed of the case.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use rand_distr::{Distribution, UnitSphere};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use serde::Serialize;
use sun2xp::control::{Law, Numbers};
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};
use toml_edit::ser::ValueSerializer;

/// One column of the table of measurements (`table.rs`): a controller at a rate, and how it is measured.
#[derive(Clone, Copy)]
pub struct Case {
    pub scheme: Scheme,
    pub rate: f64,
    pub poses: usize,
    pub seed: u64,
    pub law: Law,
    /// The parameters of state feedback. `None` selects those of the library.
    pub numbers: Option<Numbers>,
}

/// The friction of a finger.
#[derive(Clone, Copy, PartialEq)]
pub enum Friction {
    None,
    Default,
    Harsh,
}

/// The poses to which the goals of the table of measurements apply, degrees: lower and upper limit of each joint.
pub const USUAL: [[f64; 2]; 3] = [[-30.0, 30.0], [-10.0, 70.0], [30.0, 100.0]];

impl Case {
    pub fn name(&self) -> String {
        format!("{}, {} Hz", self.controller(), self.rate)
    }

    /// Returns the controller's name, as in a configuration.
    pub fn controller(&self) -> String {
        let value = self.scheme.serialize(ValueSerializer::new()).expect("a name");
        value.as_str().unwrap_or_default().to_owned()
    }

    /// Returns the default bound on the largest eigenvalue of Kx, N/cm.
    pub fn bound(&self) -> f64 {
        ConfiguredFinger::default().stiffness_bound(self.rate)
    }

    /// Returns a finger with this controller at `pose`. Its configuration contains the friction that identification
    /// finds. The speed of set points is practically unlimited, so that a step does not become a ramp.
    pub fn finger(&self, pose: &Vector3<f64>, friction: Friction) -> ConfiguredFinger {
        let mut finger = ConfiguredFinger::default();
        finger.controller.scheme = Some(self.scheme);
        finger.controller.set_point_speed = Some(1000.0);
        finger.simulation.start_degrees = pose.map(f64::to_degrees).into();
        finger.simulation.seed = self.seed;
        match friction {
            Friction::None => {
                finger.simulation.joint_coulomb_friction = [0.0; 3];
                finger.simulation.motor_coulomb_friction = [0.0; 4];
                finger.simulation.shaft_friction = 0.0;
                finger.friction.motor_coulomb = [0.0; 4];
                finger.friction.conduit = [0.0; 4];
                finger.friction.joint_coulomb = [0.0; 3];
            }
            Friction::Default => {}
            Friction::Harsh => {
                finger.simulation.joint_coulomb_friction = [2e-3; 3];
                finger.friction.joint_coulomb = [0.2; 3];
            }
        }
        finger
    }

    /// Returns random poses within [`USUAL`], rad.
    pub fn poses(&self) -> Vec<Vector3<f64>> {
        let mut random = Pcg64::seed_from_u64(self.seed);
        (0..self.poses).map(|_| pose(&mut random, &USUAL)).collect()
    }

    /// Returns values of Kx, N/cm: isotropic ones, one whose stiffness differs from axis to axis, and four with random
    /// axes. None is stiffer than the bound.
    pub fn springs(&self) -> Vec<Matrix3<f64>> {
        let mut random = Pcg64::seed_from_u64(self.seed + 1);
        let isotropic = [1.0, 3.0, self.bound()].map(|stiffness| Matrix3::identity() * stiffness);
        let mut springs: Vec<_> = isotropic.into();
        springs.push(Matrix3::from_diagonal(&Vector3::new(1.0, 5.0, 2.0)));
        springs.extend((0..4).map(|_| spring(&mut random, 1.0, self.bound())));
        springs
    }

    /// Returns every combination of pose and spring.
    pub fn poses_and_springs(&self) -> Vec<(Vector3<f64>, Matrix3<f64>)> {
        let springs = self.springs();
        self.poses()
            .into_iter()
            .flat_map(|pose| springs.iter().map(move |kx| (pose, *kx)).collect::<Vec<_>>())
            .collect()
    }

    /// Returns the directions of the steps from the pose with this number: one along each axis, with a random sign, and
    /// an oblique one.
    pub fn directions(&self, pose: usize) -> Vec<Vector3<f64>> {
        let mut random = Pcg64::seed_from_u64(self.seed + 100 + pose as u64);
        let mut directions: Vec<_> = [Vector3::x(), Vector3::y(), Vector3::z()]
            .into_iter()
            .map(|axis| if uniform(&mut random, -1.0, 1.0) < 0.0 { -axis } else { axis })
            .collect();
        directions.push(direction(&mut random));
        directions
    }

    /// Returns every combination of a pose and one of its directions in which the tip can move `distance` cm.
    pub fn poses_and_directions(&self, distance: f64) -> Vec<(Vector3<f64>, Vector3<f64>)> {
        let finger = ConfiguredFinger::default();
        let of_pose = |(number, pose): (usize, Vector3<f64>)| {
            self.directions(number).into_iter().map(move |direction| (pose, direction))
        };
        let mut all: Vec<_> = self.poses().into_iter().enumerate().flat_map(of_pose).collect();
        all.retain(|(pose, direction)| has_room(&finger, pose, direction, distance));
        all
    }
}

/// Returns +x, -x, +y, -y, +z, -z.
pub fn axes() -> impl Iterator<Item = Vector3<f64>> {
    [Vector3::x(), Vector3::y(), Vector3::z()].into_iter().flat_map(|axis| [axis, -axis])
}

/// Returns whether the tip can move `distance` cm in a straight line from `pose`. The finger must stay bent, and its
/// joints must stay within their limits.
pub fn has_room(finger: &ConfiguredFinger, pose: &Vector3<f64>, direction: &Vector3<f64>, distance: f64) -> bool {
    const STRIDE: f64 = 0.05;
    const BENT: f64 = 0.35;
    let (low, high) = finger.joint_limits();
    let mut joints = *pose;
    for _ in 0..(distance / STRIDE).ceil() as usize {
        let Some(inverse) = finger.links().jacobian(&joints).try_inverse() else { return false };
        joints += inverse * direction * STRIDE;
        if joints[2] < BENT || (0..3).any(|joint| joints[joint] < low[joint] || joints[joint] > high[joint]) {
            return false;
        }
    }
    true
}

/// Returns a random pose, rad. `limits` are the lower and upper limit of each joint, degrees.
pub fn pose(random: &mut Pcg64, limits: &[[f64; 2]; 3]) -> Vector3<f64> {
    Vector3::from(limits.map(|[low, high]| uniform(random, low, high).to_radians()))
}

/// Returns a random spring with eigenvalues between `softest` and `stiffest`, N/cm.
pub fn spring(random: &mut Pcg64, softest: f64, stiffest: f64) -> Matrix3<f64> {
    let axis = Unit::new_normalize(direction(random));
    let turn = Rotation3::from_axis_angle(&axis, uniform(random, 0.0, std::f64::consts::PI));
    let principal = Vector3::from_fn(|_, _| uniform(random, softest, stiffest));
    turn * Matrix3::from_diagonal(&principal) * turn.inverse()
}

/// Returns a random direction of unit length.
pub fn direction(random: &mut Pcg64) -> Vector3<f64> {
    Vector3::from(<UnitSphere as Distribution<[f64; 3]>>::sample(&UnitSphere, random))
}

pub fn uniform(random: &mut Pcg64, low: f64, high: f64) -> f64 {
    low + (high - low) * f64::from(random.next_u32()) / 4294967296.0
}

/// Multiplies the stiffness of the true tendons by `ratio`.
pub fn stiffen(finger: &mut ConfiguredFinger, ratio: &[f64; 4]) {
    for (stiffness, ratio) in finger.simulation.tendon_stiffness.iter_mut().zip(ratio) {
        *stiffness *= ratio;
    }
}
