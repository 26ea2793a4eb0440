//! Inertia, Coriolis and gravity torques of the three links, which are uniform cylinders, and of the tip, which is a
//! point mass.
//!
//! The angular velocity of links 1 and 2 is the rate of joint 0 about its axis plus a rate about the normal of the
//! finger's plane. The normal is a principal axis of every link, and the centres of mass are in the plane, so the
//! inertia matrix does not couple joint 0 with the other joints.

use crate::model::{JointSines, LinkMomentum, LinkWeight, Links};
use nalgebra::{Matrix3, Vector3};

/// A link as a rigid body.
#[derive(Clone, Copy, Debug)]
struct Cylinder {
    /// Mass, kg.
    mass: f64,
    /// Moment of inertia about the axis of the cylinder, kg m^2.
    axial: f64,
    /// Moment of inertia about a transverse axis through the centre, kg m^2.
    transverse: f64,
}

impl Cylinder {
    fn new(mass: f64, radius: f64, length: f64) -> Self {
        let axial = mass * radius * radius / 2.0;
        Self { mass, axial, transverse: axial / 2.0 + mass * length * length / 12.0 }
    }
}

/// The rigid bodies of a finger, and the gravity that acts on them.
#[derive(Clone, Debug)]
pub struct LinkDynamics {
    length: [f64; 3],
    link: [Cylinder; 3],
    tip_mass: f64,
    /// The two parts of the inertia about joint 1 that do not depend on theta_2, kg m^2. The first part is the inertia
    /// of link 1 with link 2 and the tip as point masses at its end. The second part is the inertia of link 2 and the
    /// tip about joint 2.
    bent: [f64; 2],
    /// Coefficient of cos(theta_2) in the inertia that couples joints 1 and 2, kg m^2.
    coupling: f64,
    /// Gravity in the finger's frame, m/s^2.
    gravity: Vector3<f64>,
    weight: LinkWeight,
}

impl LinkDynamics {
    /// Constructs the dynamics from the masses of the links and of the tip, kg, the radii of the links, m, and gravity
    /// in the finger's frame, m/s^2.
    pub fn new(links: Links, mass: [f64; 4], radii: [f64; 3], gravity: Vector3<f64>) -> Self {
        let length = links.0.map(|cm| cm * 0.01);
        let link: [Cylinder; 3] = std::array::from_fn(|i| Cylinder::new(mass[i], radii[i], length[i]));
        let ([_, l1, l2], [_, link1, link2], tip_mass) = (length, link, mass[3]);
        let proximal = link1.transverse + link1.mass * l1 * l1 / 4.0 + (link2.mass + tip_mass) * l1 * l1;
        let distal = link2.transverse + link2.mass * l2 * l2 / 4.0 + tip_mass * l2 * l2;
        let coupling = (link2.mass / 2.0 + tip_mass) * l1 * l2;
        let weight = LinkWeight::new(links, mass);
        Self { length, link, tip_mass, bent: [proximal, distal], coupling, gravity, weight }
    }

    /// Sets gravity in the finger's frame, m/s^2.
    pub fn set_gravity(&mut self, gravity: Vector3<f64>) {
        self.gravity = gravity;
    }

    /// Returns the inertia matrix H(theta), kg m^2.
    pub fn inertia(&self, theta: &Vector3<f64>) -> Matrix3<f64> {
        self.inertia_at(theta, &JointSines::of(theta))
    }

    /// Returns the inertia matrix H(theta), kg m^2, at a pose whose sines the caller has.
    #[inline]
    pub fn inertia_at(&self, theta: &Vector3<f64>, sines: &JointSines) -> Matrix3<f64> {
        self.coupled_inertia(&Pose::new(self, theta, sines), self.coupling * sines.cos[2])
    }

    /// Returns the inertia matrix H(theta), kg m^2. `coupled` is the coupling times cos(theta_2).
    fn coupled_inertia(&self, pose: &Pose, coupled: f64) -> Matrix3<f64> {
        let [proximal, distal] = self.bent;
        let (h11, h12) = (proximal + distal + 2.0 * coupled, distal + coupled);
        Matrix3::new(self.about_joint_0(pose), 0.0, 0.0, 0.0, h11, h12, 0.0, h12, distal)
    }

    /// Returns c(theta, theta_dot), the Coriolis and centrifugal torques, N m. Their sign is such that the joint
    /// torques equal H theta_dd + c.
    pub fn coriolis(&self, theta: &Vector3<f64>, rate: &Vector3<f64>) -> Vector3<f64> {
        self.coriolis_at(theta, &JointSines::of(theta), rate)
    }

    /// Returns [`LinkDynamics::coriolis`] at a pose whose sines the caller has.
    #[inline]
    pub fn coriolis_at(&self, theta: &Vector3<f64>, sines: &JointSines, rate: &Vector3<f64>) -> Vector3<f64> {
        let pose = Pose::new(self, theta, sines);
        let (by_1, by_2) = self.about_joint_0_derivatives(&pose);
        let bend = self.coupling * sines.sin[2];
        Vector3::new(
            rate[0] * (by_1 * rate[1] + by_2 * rate[2]),
            -bend * rate[2] * (2.0 * rate[1] + rate[2]) - 0.5 * by_1 * rate[0] * rate[0],
            bend * rate[1] * rate[1] - 0.5 * by_2 * rate[0] * rate[0],
        )
    }

    /// Returns the inertia matrix at a pose and its derivatives, from which the momentum of the links follows.
    pub fn momentum(&self, theta: &Vector3<f64>) -> LinkMomentum {
        let pose = Pose::new(self, theta, &JointSines::of(theta));
        let (sin, cos) = (pose.s12 * pose.c1 - pose.c12 * pose.s1, pose.c12 * pose.c1 + pose.s12 * pose.s1);
        let (by_1, by_2) = self.about_joint_0_derivatives(&pose);
        LinkMomentum {
            inertia: self.coupled_inertia(&pose, self.coupling * cos),
            by_1: 0.5 * by_1,
            by_2: 0.5 * by_2,
            bend: self.coupling * sin,
        }
    }

    /// Returns the joint torques that gravity exerts, N m.
    pub fn gravity_torque(&self, theta: &Vector3<f64>) -> Vector3<f64> {
        self.weight.torques(&self.gravity, theta)
    }

    /// Returns the kinetic energy of the links plus their potential energy in gravity, J.
    pub fn energy(&self, theta: &Vector3<f64>, rate: &Vector3<f64>) -> f64 {
        self.kinetic_energy(theta, rate) - self.gravity.dot(&self.weight.moment(theta))
    }

    /// Returns the kinetic energy of the links, J.
    pub fn kinetic_energy(&self, theta: &Vector3<f64>, rate: &Vector3<f64>) -> f64 {
        0.5 * rate.dot(&(self.inertia(theta) * rate))
    }

    /// Returns the inertia about the axis of joint 0, kg m^2.
    fn about_joint_0(&self, pose: &Pose) -> f64 {
        let [link0, link1, link2] = self.link;
        let [centre0, centre1, centre2, tip] = pose.reach;
        let leaning = |link: Cylinder, sin: f64, cos: f64| link.transverse * cos * cos + link.axial * sin * sin;
        link0.transverse
            + link0.mass * centre0 * centre0
            + leaning(link1, pose.s1, pose.c1)
            + link1.mass * centre1 * centre1
            + leaning(link2, pose.s12, pose.c12)
            + link2.mass * centre2 * centre2
            + self.tip_mass * tip * tip
    }

    /// Returns the derivatives of [`Self::about_joint_0`] with respect to theta_1 and theta_2.
    fn about_joint_0_derivatives(&self, pose: &Pose) -> (f64, f64) {
        let [_, l1, l2] = self.length;
        let [_, link1, link2] = self.link;
        let [_, centre1, centre2, tip] = pose.reach;
        let leaning = |link: Cylinder, sin: f64, cos: f64| (link.axial - link.transverse) * sin * cos;
        let by_1_alone = leaning(link1, pose.s1, pose.c1)
            - pose.s1 * l1 * (link1.mass * centre1 / 2.0 + link2.mass * centre2 + self.tip_mass * tip);
        let by_sum =
            leaning(link2, pose.s12, pose.c12) - pose.s12 * l2 * (link2.mass * centre2 / 2.0 + self.tip_mass * tip);
        (2.0 * (by_1_alone + by_sum), 2.0 * by_sum)
    }
}

/// Sines and cosines of a pose, and the distances of the centres of links 0, 1, 2 and of the tip from the axis of joint
/// 0, m.
struct Pose {
    s1: f64,
    c1: f64,
    s12: f64,
    c12: f64,
    reach: [f64; 4],
}

impl Pose {
    fn new(finger: &LinkDynamics, theta: &Vector3<f64>, sines: &JointSines) -> Self {
        let [l0, l1, l2] = finger.length;
        let (s1, c1) = (sines.sin[1], sines.cos[1]);
        let (s12, c12) = (theta[1] + theta[2]).sin_cos();
        let elbow = l0 + l1 * c1;
        let reach = [l0 / 2.0, l0 + l1 * c1 / 2.0, elbow + l2 * c12 / 2.0, elbow + l2 * c12];
        Self { s1, c1, s12, c12, reach }
    }
}
