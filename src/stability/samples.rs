//! Random samples of poses, springs, contacts and loads.

use super::rest::{Rest, Wall};
use crate::control::{Law, spatial};
use crate::model::configuration::ConfiguredFinger;
use crate::model::{Contact, Links};
use nalgebra::{Matrix3, Matrix4, Matrix6, Rotation3, Unit, Vector3};
use rand_distr::{Distribution, UnitSphere};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::f64::consts::PI;

/// Smallest eigenvalue of the springs, and smallest bound on the largest eigenvalue, N/cm. With a softer spring the
/// finger is nearly limp, whatever the bound is.
pub(super) const SOFTEST: f64 = 1.0;

/// Smallest and largest deflection of the tip by its load, cm. The smallest deflection is not zero, because eq. 20 has
/// a kink at zero load.
const DEFLECTIONS: [f64; 2] = [0.01, 0.2];

/// Smallest deflection of the tip by a wall, cm. It keeps the tip in contact while the motion is observed.
const LEAST_INTO_WALL: f64 = 0.05;

/// Largest change of a joint angle by the load, rad. It limits the load of poses with a short lever.
const LARGEST_TURN: f64 = 0.06;

/// Smallest and largest stiffness of a wall, N/cm.
const WALLS: [f64; 2] = [30.0, 1000.0];

/// Largest length of [`Wall::tilt`]. The wall then carries at least 0.7 of the load.
const LARGEST_TILT: f64 = 0.7;

/// A finger at rest with a spring whose stiffness is relative to a bound.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// The finger at rest. [`Sample::at`] replaces its stiffness and clamps its damping.
    rest: Rest,
    /// Kx with eigenvalues from 0 (softest spring) to 1 (spring at the bound).
    relative: Matrix3<f64>,
    contact: ContactType,
}

#[derive(Clone, Copy, Debug)]
enum ContactType {
    FrictionlessPoint(Vector3<f64>),
    HardFinger,
    /// The normal, and the stiffness about it, from 0 to 1 (the bound).
    SoftFinger(Vector3<f64>, f64),
}

impl Sample {
    pub fn joints(&self) -> Vector3<f64> {
        self.rest.joints
    }

    /// Returns the sample as a hard finger with this isotropic stiffness, N/cm. The caller passes a stiffness that no
    /// pose supports. The servo scales it down, and this scale gives the stiffness that the sample's pose supports.
    pub fn with_isotropic(&self, stiffness: f64) -> Rest {
        Rest { stiffness: spatial(&(Matrix3::identity() * stiffness)), damping: 1.0, wall: None, ..self.rest }
    }

    /// Returns the finger at rest with a spring whose largest eigenvalue is at most `stiffest`, N/cm. `range` returns
    /// the smallest and the largest admissible relative damping for an eigenvalue, N/cm.
    pub fn at(&self, stiffest: f64, links: &Links, range: impl Fn(f64) -> (f64, f64)) -> Rest {
        let softest = SOFTEST.min(stiffest);
        let kx = Matrix3::identity() * softest + self.relative * (stiffest - softest);
        let lever = links.0[2];
        let stiffness = self.contact.stiffness(&kx, stiffest * lever * lever);
        let contact = Contact::general(&stiffness, &Matrix6::identity()).expect("every sample is a spring");
        let (least, most) = range(contact.largest_eigenvalue(lever));
        Rest { stiffness, damping: self.rest.damping.clamp(least, most), ..self.rest }
    }
}

impl ContactType {
    /// Returns the stiffness of a contact that has the translational stiffness `kx`, N/cm, and a stiffness up to
    /// `about_normal`, N cm/rad, about its normal.
    fn stiffness(&self, kx: &Matrix3<f64>, about_normal: f64) -> Matrix6<f64> {
        let contact = match *self {
            Self::HardFinger => Contact::hard_finger(*kx),
            Self::FrictionlessPoint(normal) => Contact::frictionless_point(normal.dot(&(kx * normal)), normal),
            Self::SoftFinger(normal, part) => {
                let mut stiffness = Matrix4::zeros();
                stiffness.fixed_view_mut::<3, 3>(0, 0).copy_from(kx);
                stiffness[(3, 3)] = about_normal * part;
                Contact::soft_finger(stiffness, normal)
            }
        };
        *contact.expect("every sample is a spring").stiffness()
    }
}

/// Returns `number` samples of the finger at rest, anywhere within the joint limits. If `walls` is true, every finger
/// presses against a wall. A quarter of the samples are isotropic with eigenvalues of 1, half have random eigenvalues
/// of which the largest is 1, and a quarter have three random eigenvalues. A quarter are soft fingers, and with walls a
/// quarter are frictionless points. The others are hard fingers. Half of the samples have the report's law. The
/// relative damping is 1, or the smallest or largest admissible one.
pub(super) fn samples(finger: &ConfiguredFinger, number: usize, seed: u64, walls: bool) -> Vec<Sample> {
    let mut random = Pcg64::seed_from_u64(seed);
    let (low, high) = finger.joint_limits();
    let links = finger.links();
    (0..number)
        .map(|number| {
            let joints = low.zip_map(&high, |low, high| uniform(&mut random, low, high));
            let relative = relative_stiffness(&mut random, number);
            let way = direction(&mut random);
            let tip_way = links.jacobian(&joints) * way;
            let normal = direction(&mut random);
            let (contact, most_tilt) = match number / 2 % 4 {
                // The spring of a frictionless point acts only along its normal. Without a wall such a point is not
                // sampled: under a constant force, nothing would keep the tip from moving away perpendicular to the
                // normal. The wall of such a point is not tilted: a tilted wall would add stiffness perpendicular to
                // the normal, where the spring has none.
                0 if walls => (ContactType::FrictionlessPoint(Unit::new_normalize(tip_way).into_inner()), 0.0),
                1 => (ContactType::SoftFinger(normal, uniform(&mut random, 0.0, 1.0)), LARGEST_TILT),
                _ => (ContactType::HardFinger, LARGEST_TILT),
            };
            let wall = walls.then(|| wall(&mut random, most_tilt));
            let least = wall.map_or(DEFLECTIONS[0], |_| LEAST_INTO_WALL);
            let size = (uniform(&mut random, least, DEFLECTIONS[1]) / tip_way.norm()).min(LARGEST_TURN);
            let law = [Law::Exact, Law::Report][number % 2];
            // Infinity is clamped to the largest admissible damping.
            let damping = [1.0, 0.0, f64::INFINITY][number % 3];
            let rest = Rest { joints, deflection: way * size, stiffness: Matrix6::zeros(), law, damping, wall };
            Sample { rest, relative, contact }
        })
        .collect()
}

/// Returns Kx with random axes and eigenvalues from 0 to 1.
fn relative_stiffness(random: &mut Pcg64, number: usize) -> Matrix3<f64> {
    let axis = Unit::new_normalize(direction(random));
    let turn = Rotation3::from_axis_angle(&axis, uniform(random, 0.0, PI));
    let mut principal = Vector3::from_fn(|_, _| uniform(random, 0.0, 1.0));
    match (number / 8 + number) % 4 {
        0 => {}
        1 => principal = Vector3::repeat(1.0),
        _ => principal /= principal.max(),
    }
    turn * Matrix3::from_diagonal(&principal) * turn.inverse()
}

/// Returns a wall of random stiffness and direction. The logarithm of the stiffness is uniformly distributed.
fn wall(random: &mut Pcg64, most_tilt: f64) -> Wall {
    let [softest, stiffest] = WALLS;
    let stiffness = softest * (stiffest / softest).powf(uniform(random, 0.0, 1.0));
    Wall { stiffness, tilt: direction(random) * uniform(random, 0.0, most_tilt) }
}

/// Returns a random unit vector.
fn direction(random: &mut Pcg64) -> Vector3<f64> {
    Vector3::from(<UnitSphere as Distribution<[f64; 3]>>::sample(&UnitSphere, random))
}

fn uniform(random: &mut Pcg64, low: f64, high: f64) -> f64 {
    low + (high - low) * f64::from(random.next_u32()) / 4294967296.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// A bound that is found only with a damping of 1 says nothing about the other dampings that a planner may request.
    #[test]
    fn every_law_and_contact_is_tried_with_the_least_damping_with_one_and_with_the_most() {
        let finger = ConfiguredFinger::default();
        for (walls, dimensions) in [(false, &[3, 4][..]), (true, &[1, 3, 4])] {
            let tried: BTreeSet<(bool, usize, String)> = samples(&finger, 24, 5, walls)
                .iter()
                .map(|sample| sample.at(3.0, &finger.links(), |_| (0.5, 1.5)))
                .map(|rest| (matches!(rest.law, Law::Exact), rest.dimensions(), rest.damping.to_string()))
                .collect();
            for law in [true, false] {
                for &dimensions in dimensions {
                    for damping in ["0.5", "1", "1.5"] {
                        let combination = (law, dimensions, damping.to_string());
                        assert!(tried.contains(&combination), "{combination:?} is not among {tried:?}");
                    }
                }
            }
            assert_eq!(tried.len(), 2 * dimensions.len() * 3, "{tried:?}");
        }
    }
}
