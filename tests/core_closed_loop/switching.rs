//! Switches of the set point that a planner may make, on a finger that is pushed away from its anchor: the torque must
//! not jump.

use crate::rig::{Loop, SCHEMES, quiet};
use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};
use sun2xp::control::{Activity, JointSpring, JointStiffness, Law, SetPoint, TensionDistribution};
use sun2xp::model::Contact;
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};

const ANCHOR: Vector3<f64> = Vector3::new(0.2, 0.7, 1.2);

fn isotropic(stiffness: f64) -> SetPoint {
    SetPoint::hard_finger(ANCHOR, Matrix3::identity() * stiffness)
}

/// Name, set point before and after, and whether the finger is moving.
fn switches() -> Vec<(&'static str, SetPoint, SetPoint, bool)> {
    let exact = isotropic(3.0);
    let report = SetPoint { law: Law::Report, ..exact };
    let stiff = |contact: Result<Contact, _>| SetPoint { stiffness: *contact.expect("a spring").stiffness(), ..exact };
    let soft_finger = stiff(Contact::soft_finger(
        Matrix4::from_diagonal(&Vector4::new(3.0, 2.0, 1.0, 20.0)),
        Vector3::new(0.0, 1.0, 1.0),
    ));
    let point = stiff(Contact::frictionless_point(4.0, Vector3::new(0.3, 1.0, 0.5)));
    let directed = stiff(Contact::hard_finger(Matrix3::from_diagonal(&Vector3::new(1.0, 5.0, 2.0))));
    let damped = SetPoint { damping: 3.0, ..report };
    let mut in_joints = exact;
    in_joints.stiffen_joints(Matrix3::new(60.0, 10.0, 0.0, 10.0, 60.0, 10.0, 0.0, 10.0, 40.0));
    let mut torqued = exact;
    torqued.torque_joints(Vector3::new(4.0, -5.0, 3.0));
    let steps = [
        ("joint spring", exact, in_joints),
        ("tip again", in_joints, exact),
        ("torque", exact, torqued),
        ("no torque", torqued, report),
        ("joint spring for a torque", torqued, in_joints),
        ("law", report, exact),
        ("stiffer", isotropic(1.0), isotropic(6.0)),
        ("softer", isotropic(6.0), isotropic(1.0)),
        ("limp", report, isotropic(0.0)),
        ("directed", exact, directed),
        ("soft finger", exact, soft_finger),
        ("frictionless point", soft_finger, point),
        ("damping", report, damped),
        ("everything", report, SetPoint { damping: 0.5, ..soft_finger }),
    ];
    let both = |(name, before, after)| [(name, before, after, false), (name, before, after, true)];
    steps.into_iter().flat_map(both).collect()
}

/// A pushed finger before a switch: at rest, or 30 ms after the push has changed.
fn before(finger: &ConfiguredFinger, rate: f64, set_point: SetPoint, moving: bool) -> Loop {
    let mut servo = Loop::new(finger, rate);
    let follow = Activity::Follow(set_point);
    servo.plant.set_external_force(Vector3::new(0.8, -0.6, 0.5));
    servo.run(2.5, &follow);
    if moving {
        servo.plant.set_external_force(Vector3::new(-0.2, 0.3, 0.1));
        servo.run(0.03, &follow);
    }
    servo.forget();
    servo
}

/// The change of the desired tensions if the switch were made at once, N.
fn at_once(finger: &ConfiguredFinger, servo: &Loop, before: SetPoint, after: SetPoint) -> f64 {
    let law = JointStiffness::new(finger.links(), 0.015);
    let limit = Vector4::repeat(finger.tendon.maximum);
    let distribution =
        TensionDistribution::new(&finger.tendons().expect("regular"), finger.tendon.minimum, limit).expect("bounds");
    let [before, after] = [before, after].map(|set_point| {
        let joints = servo.plant.joints();
        let mut torques = law.torques(&set_point.into(), &joints, &servo.plant.joint_rates());
        if let Some(JointSpring { k_theta, torque }) = set_point.joint_spring {
            torques += k_theta * (set_point.joints - joints) + torque;
        }
        distribution.distribute(&torques).tensions
    });
    (after - before).amax()
}

#[test]
fn no_switch_of_the_spring_jumps() {
    let mut seen: f64 = 0.0;
    for rate in [500.0, 1000.0, 2000.0] {
        for scheme in SCHEMES {
            let finger = quiet(scheme);
            let mut worst: f64 = 0.0;
            for (name, from, to, moving) in switches() {
                let mut goes_on = before(&finger, rate, from, moving);
                let mut switched = before(&finger, rate, from, moving);
                let bare = at_once(&finger, &switched, from, to);
                goes_on.cycle(&Activity::Follow(from));
                switched.cycle(&Activity::Follow(to));
                let jump = switched.largest_jump - goes_on.largest_jump;
                let case = format!("{name}, {scheme:?}, {rate} Hz, moving: {moving}");
                assert!(jump < 0.02 + 0.07 * bare, "{case}: {jump} N");
                worst = worst.max(jump);
                seen = seen.max(bare);
            }
            println!("{scheme:?}, {rate} Hz: worst {worst:.3} N");
        }
    }
    assert!(seen > 10.0, "an immediate switch must be visible: {seen} N");
}

/// The steps of a calibration: a new controller takes over and lets the tendons out, the motors rest, and the
/// controller takes up the slack. In the last step, the pulls from the cycle of the take-over must not act again.
#[test]
fn pulls_in_the_cycle_of_a_take_over_do_not_act_again_later() {
    let finger = quiet(Scheme::StateFeedback);
    let mut servo = Loop::new(&finger, 1000.0);
    servo.run(0.5, &Activity::Follow(isotropic(3.0)));
    servo.adjust(&quiet(Scheme::Figure10));
    servo.run(0.01, &Activity::Pull(Vector4::repeat(-4.0)));
    servo.run(0.5, &Activity::Turn(Vector4::zeros()));
    servo.forget();
    servo.cycle(&Activity::TakeUpSlack);
    assert!(servo.largest_jump < 1.0, "{} N", servo.largest_jump);
}
