//! A pushed fingertip has the stiffness that the controller reports. This also holds near the straight pose, beyond a
//! joint limit, and for soft fingers.

use super::rig::{Loop, SCHEMES, smooth};
use nalgebra::{Matrix3, Matrix4, Matrix6, Vector3, Vector4};
use sun2xp::control::{Activity, JointSprings, Law, SetPoint, spatial};
use sun2xp::model::Contact;
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};

/// A stiffness, N/cm, that no planner can send, and that the finger does not support in the poses in which it is used.
const TWICE_THE_BOUND: f64 = 12.0;

const LAWS: [Law; 2] = [Law::Exact, Law::Report];

/// A finger that holds its pose with a stiffness, against a force on its tip, N.
struct Held {
    finger: ConfiguredFinger,
    set_point: SetPoint,
    load: Vector3<f64>,
    servo: Loop,
}

impl Held {
    fn new(finger: &ConfiguredFinger, law: Law, stiffness: Matrix6<f64>, load: Vector3<f64>) -> Self {
        let servo = Loop::new(finger, 1000.0);
        let hard_finger = SetPoint::hard_finger(servo.plant.joints(), Matrix3::zeros());
        let set_point = SetPoint { law, stiffness, ..hard_finger };
        let mut held = Self { finger: finger.clone(), set_point, load, servo };
        held.tip(Vector3::zeros());
        held
    }

    /// Returns the position of the tip at rest, cm, under the load and the additional force `push`, which are in N.
    fn tip(&mut self, push: Vector3<f64>) -> Vector3<f64> {
        self.servo.plant.set_external_force(self.load + push);
        let follow = Activity::Follow(self.set_point);
        self.servo.run(0.8, &follow);
        let joints = self.servo.mean_joints(0.2, &follow);
        self.finger.links().tip(&joints)
    }

    /// The stiffness that is measured with pushes of +-`push` N along the axes, N/cm.
    fn measured(&mut self, push: f64) -> Matrix3<f64> {
        let mut compliance = Matrix3::zeros();
        for axis in 0..3 {
            let along = Vector3::ith(axis, push);
            let moved = self.tip(along) - self.tip(-along);
            compliance.set_column(axis, &(moved / (2.0 * push)));
        }
        self.tip(Vector3::zeros());
        compliance.try_inverse().expect("a spring in every direction")
    }

    /// The stiffness that the controller reports, N/cm.
    fn reported(&self) -> Matrix3<f64> {
        let joints = self.servo.report.joints;
        let springs = JointSprings::new(&self.finger, 1000.0).expect("the default tendons");
        let inverse = self.finger.links().jacobian(&joints).try_inverse().expect("a regular pose");
        inverse.tr_mul(&(springs.stiffness(&self.set_point, self.servo.report.stiffness_scale, &joints) * inverse))
    }
}

fn isotropic(stiffness: f64) -> Matrix6<f64> {
    spatial(&(Matrix3::identity() * stiffness))
}

/// The largest difference, relative to the largest entry.
fn off(measured: &Matrix3<f64>, reported: &Matrix3<f64>) -> f64 {
    (measured - reported).amax() / reported.amax()
}

/// Near the straight pose the tendons do not provide 12 N/cm. All controllers and both laws provide the same part,
/// except for Figure 11, whose loop is stable only with a smaller part.
#[test]
fn a_stretched_finger_has_the_reported_part_of_its_stiffness() {
    for scheme in SCHEMES {
        for law in LAWS {
            let finger = smooth(scheme, [-10.0, 20.0, 20.0]);
            let mut held = Held::new(&finger, law, isotropic(TWICE_THE_BOUND), Vector3::zeros());
            let (measured, reported) = (held.measured(0.1), held.reported());
            let scale = held.servo.report.stiffness_scale;
            println!("{scheme:?}, {law:?}: {scale:.3}, off by {:.4}", off(&measured, &reported));
            let expected = if scheme == Scheme::Figure11 { 0.38..0.48 } else { 0.53..0.63 };
            assert!(expected.contains(&scale), "{scheme:?}, {law:?}: {scale}");
            assert!((reported - Matrix3::identity() * TWICE_THE_BOUND * scale).amax() < 1e-6, "{reported}");
            // Figure 11 does not feed the tension error back, neither by a gain nor by an integral. The finger is
            // therefore slow to settle.
            let most = if scheme == Scheme::Figure11 { 0.06 } else { 0.02 };
            assert!(off(&measured, &reported) < most, "{scheme:?}, {law:?}: {measured} instead of {reported}");
        }
    }
}

/// A load bends joint 2 beyond its limit. With a Kx of 6 N/cm, the stiffness of the tip is the sum of Kx and of the
/// stiffness that the spring of the limit adds.
#[test]
fn a_finger_beyond_its_limit_has_the_reported_stiffness() {
    for scheme in SCHEMES {
        for law in LAWS {
            let (mut held, beyond) = beyond_its_limit(scheme, law, 6.0, 1.2);
            let (measured, reported) = (held.measured(0.02), held.reported());
            println!("{scheme:?}, {law:?}: {beyond:.4} rad, off by {:.4}", off(&measured, &reported));
            assert!(beyond > 0.005 && held.servo.report.stiffness_scale == 1.0, "{scheme:?}, {law:?}: {beyond} rad");
            assert!((reported - Matrix3::identity() * 6.0).symmetric_eigenvalues().max() > 1.0, "{reported}");
            // Under this load the error of `Law::Report` is 3 % to 5 %.
            let most = if law == Law::Exact { 0.03 } else { 0.06 };
            assert!(off(&measured, &reported) < most, "{scheme:?}, {law:?}: {measured} instead of {reported}");
        }
    }
}

/// The spring of a joint limit uses a part of the stiffness that the tendons provide. So the farther the joint is
/// beyond its limit, the smaller is the part of Kx that the controller reports.
#[test]
fn a_finger_beyond_its_limit_has_less_of_its_stiffness() {
    for scheme in SCHEMES {
        for law in LAWS {
            let parts = [0.5, 3.0].map(|load| {
                let (held, beyond) = beyond_its_limit(scheme, law, TWICE_THE_BOUND, load);
                (beyond, held.servo.report.stiffness_scale)
            });
            println!("{scheme:?}, {law:?}: {parts:.3?}");
            let [(little, most), (far, least)] = parts;
            assert!(far > little + 0.005 && least < most - 0.05, "{scheme:?}, {law:?}: {parts:?}");
        }
    }
}

/// Returns a finger whose tip is pushed by `load`, N, so that joint 2 is beyond its limit. Also returns how far the
/// joint is beyond this limit, rad.
fn beyond_its_limit(scheme: Scheme, law: Law, stiffness: f64, load: f64) -> (Held, f64) {
    let finger = smooth(scheme, [0.0, 30.0, 120.0]);
    let held = Held::new(&finger, law, isotropic(stiffness), Vector3::new(0.0, 0.0, -load));
    let beyond = (held.servo.plant.joints() - finger.joint_limits().1)[2];
    (held, beyond)
}

/// Three joints cannot turn the tip without moving it. The rotational stiffness of a soft finger therefore also makes
/// the tip stiffer against motion in one direction. The reported stiffness contains this part.
#[test]
fn a_soft_finger_has_the_reported_stiffness() {
    let k = Matrix4::from_diagonal(&Vector4::new(3.0, 3.0, 3.0, 20.0));
    for scheme in SCHEMES {
        for law in LAWS {
            for normal in [Vector3::x(), Vector3::new(0.0, -1.0, 1.0)] {
                let finger = smooth(scheme, [20.0, 30.0, 60.0]);
                let contact = Contact::soft_finger(k, normal).expect("a spring");
                let mut held = Held::new(&finger, law, *contact.stiffness(), Vector3::zeros());
                let (measured, reported) = (held.measured(0.1), held.reported());
                let case = format!("{scheme:?}, {law:?}, {normal:?}");
                println!("{case}: off by {:.4}, {reported:.2}", off(&measured, &reported));
                assert!(off(&measured, &reported) < 0.02, "{case}: {measured} instead of {reported}");
                let added = (reported - Matrix3::identity() * 3.0).symmetric_eigenvalues();
                let (most, least) = (added.max(), added.min());
                assert!(most > 0.2 && least > -1e-9 && added.sum() - most < 1e-9, "{case}: {added}");
            }
        }
    }
}
