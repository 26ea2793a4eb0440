//! Fingertip set points, contacts and adjustment on a hand with simulated boards, in real time.

#[allow(dead_code)]
#[path = "common/pauses.rs"]
mod pauses;

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};
use std::time::{Duration, Instant};
use sun2xp::control::Law;
use sun2xp::hand::{FingerCommand, FingerTip, Hand, HandError, PathPose, Pose, SetPointError};
use sun2xp::model::Contact;
use sun2xp::model::configuration::{Configuration, OutOfRange};

fn open(configuration: Configuration) -> Hand {
    pauses::name_pauses();
    Hand::open(configuration).unwrap_or_else(|error| panic!("open: {error}"))
}

fn tip(hand: &Hand, finger: i32) -> FingerTip {
    hand.fingertip(finger).unwrap_or_else(|error| panic!("finger {finger}: {error}"))
}

fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let limit = Instant::now() + Duration::from_secs(10);
    while !holds() {
        assert!(Instant::now() < limit, "not within 10 s: {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Waits until a cycle that uses the last set point is over.
fn taken_in(hand: &Hand, finger: i32) {
    let cycles = hand.report(finger).expect("report").losses.cycles;
    until("some cycles pass", || hand.report(finger).expect("report").losses.cycles > cycles + 3);
}

#[test]
fn a_tip_moves_to_its_set_point_and_reports_its_force() {
    let mut configuration = Configuration::default();
    configuration.fingers[1].controller.law = Law::Report;
    let hand = open(configuration);
    let wanted = Vector3::new(1.0, -6.0, 8.0);
    hand.send_tip(2, wanted.into()).expect("sent");
    until("the tip arrives", || (Vector3::from(tip(&hand, 2).tip) - wanted).norm() < 0.1);
    let report = hand.report(2).expect("report");
    assert_eq!(report.set_point.law, Law::Exact);
    // The contact estimate learns the error of its model anew at rest. In motion the error is different.
    let learned = || Vector3::from(tip(&hand, 2).contact).norm() < 0.03;
    let mut quiet = 0;
    until("the contact estimate has come to rest", || {
        quiet = if learned() { quiet + 1 } else { 0 };
        quiet > 1000
    });
    hand.push_simulated(2, [0.0, 1.0, 0.0]).expect("pushed");
    until("the tip pushes back", || {
        let tip = tip(&hand, 2);
        (Vector3::from(tip.force) - Vector3::new(0.0, -1.0, 0.0)).amax() < 0.3 && tip.felt == 3
    });
    until("the contact is noticed", || {
        let tip = tip(&hand, 2);
        tip.touching && (Vector3::from(tip.contact) - Vector3::new(0.0, -1.0, 0.0)).amax() < 0.2 && tip.slide < 1.0
    });
    // By the spring's law, 1 N at 3 N/cm moves the tip by 1/3 cm. The friction of the joints causes a dead band.
    let given_way = || Vector3::from(tip(&hand, 2).tip) - wanted;
    until("the spring gives way", || (given_way() - Vector3::new(0.0, 1.0 / 3.0, 0.0)).amax() < 0.08);
    assert!((Matrix3::from(tip(&hand, 2).stiffness) - Matrix3::identity() * 3.0).amax() < 1e-9);
    // Joint set points use the configured law again.
    hand.send_position(2, [0.2, 0.6, 1.1]).expect("sent");
    taken_in(&hand, 2);
    assert_eq!(hand.report(2).expect("report").set_point.law, Law::Report);
}

#[test]
fn the_configured_law_is_that_of_joint_set_points() {
    let mut configuration = Configuration::default();
    configuration.fingers[0].controller.law = Law::Report;
    let hand = open(configuration);
    assert_eq!([1, 2].map(|finger| hand.report(finger).expect("report").set_point.law), [Law::Report, Law::Exact]);
    hand.adjust(2, "controller.law = 'report'").expect("adjusted");
    hand.send_position(2, [0.2, 0.6, 1.1]).expect("sent");
    taken_in(&hand, 2);
    assert_eq!(hand.report(2).expect("report").set_point.law, Law::Report);
}

#[test]
fn contacts_and_damping_arrive_at_the_servo() {
    let hand = open(Configuration::default());
    let k = Matrix4::from_diagonal(&Vector4::new(3.0, 2.0, 1.0, 20.0));
    let soft = Contact::soft_finger(k, Vector3::new(0.0, -1.0, 1.0)).expect("a spring");
    hand.send_contact(3, soft).expect("sent");
    hand.send_damping(3, 1.5).expect("sent");
    taken_in(&hand, 3);
    let set_point = hand.report(3).expect("report").set_point;
    assert_eq!((&set_point.stiffness, set_point.damping), (soft.stiffness(), 1.5));
    // Kx replaces the contact and leaves the damping as it is.
    hand.send_stiffness(3, [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]).expect("sent");
    taken_in(&hand, 3);
    let set_point = hand.report(3).expect("report").set_point;
    assert_eq!((set_point.stiffness.sum(), set_point.damping), (6.0, 1.5));
}

#[test]
fn an_adjustment_takes_effect_completely_or_not_at_all() {
    let hand = open(Configuration::default());
    hand.adjust(1, "tendon.minimum = 9\ncontroller.scheme = 'figure 9'").expect("adjusted");
    until("the tendons have the new tension", || tip(&hand, 1).tensions.iter().all(|&tension| tension > 8.0));
    let before = hand.report(1).expect("report");
    let refused = [
        // A valid key beside an invalid one.
        hand.adjust(1, "tendon.minimum = 4\ntendon.maximum = 5"),
        hand.adjust(1, "tendon.minimum = 4\ncontroller.rate_time = 7"),
        hand.adjust(1, "tendon.minimum = 4\nbaud = 9600"),
        // Invalid together with the earlier adjustment: Figure 9 has no proportional term.
        hand.adjust(1, "controller.tension_gain = 3"),
        // The last set point would be out of range.
        hand.adjust(1, "joints.maximum_degrees = [60, 20, 120]"),
    ];
    let errnos = refused.map(|result| result.expect_err("refused").errno());
    assert_eq!(errnos, [libc::EINVAL, libc::EINVAL, libc::EBUSY, libc::EINVAL, libc::ERANGE]);
    // A refusal names the key whose value is unusable. If this key is one of the keys to adjust, the refusal also names
    // its line.
    for (keys, place) in [
        ("tendon.minimum = 4\ntendon.maximum = 0.01", "finger 1, line 2 of the keys to adjust: tendon.maximum: "),
        ("tendon.minimum = 900", "finger.1.tendon.maximum: "),
    ] {
        let refused = hand.adjust(1, keys).expect_err("refused").to_string();
        assert!(refused.starts_with(place), "{refused}");
    }
    taken_in(&hand, 1);
    assert_eq!(hand.report(1).expect("report").set_point, before.set_point);
    assert!(hand.report(1).expect("report").cycle.desired_tensions.min() > 9.0 - 1e-9);
    // Softer tendons reduce the largest damping ratio that the present stiffness admits.
    hand.adjust(1, "controller.scheme = 'state feedback'").expect("adjusted");
    hand.send_damping(1, 1.3).expect("sent");
    let damped = hand.adjust(1, "tendon.stiffness = [150, 150, 150, 150]");
    assert!(matches!(damped, Err(HandError::SetPoint(SetPointError::Damping { .. }))), "{damped:?}");
    hand.send_damping(1, 1.0).expect("sent");
    // New limits are in force at once. The other fingers keep theirs.
    hand.adjust(1, "joints.maximum_degrees = [60, 40, 120]").expect("adjusted");
    assert!(matches!(
        hand.send_position(1, [0.0, 0.8, 1.0]),
        Err(HandError::SetPoint(SetPointError::BeyondJointLimit { .. }))
    ));
    hand.send_position(2, [0.0, 0.8, 1.0]).expect("sent");
}

/// Returns Kx, N/cm, with the same stiffness in all directions.
fn kx(stiffness: f64) -> [[f64; 3]; 3] {
    (Matrix3::identity() * stiffness).into()
}

/// Sends a path that holds the pose of finger 1. Its Kx is `begin` after 0.2 s, and `end` after `seconds`.
fn send_softening_path(hand: &Hand, (begin, end): (f64, f64), seconds: f64) {
    let joints = hand.report(1).expect("report").set_point.joints.into();
    let pose = |time, stiffness| PathPose { time, pose: Pose::Joints(joints), stiffness: Some(kx(stiffness)) };
    hand.send_path(1, &[pose(0.2, begin), pose(seconds, end)], None).expect("sent");
}

fn is_refused_damping(result: &Result<(), HandError>) -> bool {
    matches!(result, Err(HandError::SetPoint(SetPointError::Damping { .. })))
}

#[test]
fn damping_is_checked_against_the_stiffest_kx_of_a_path() {
    let hand = open(Configuration::default());
    // A path that lasts 40 s must begin at rest. The reference comes to rest after the finger has become a spring.
    taken_in(&hand, 1);
    until("the reference rests", || {
        let motion = hand.report(1).expect("report").reference.motion;
        [motion.rates, motion.accelerations, motion.jerk].iter().all(|derivative| derivative.amax() < 1e-7)
    });
    // A ratio of 1.5 is admitted with 1 N/cm, but not with 5 N/cm.
    send_softening_path(&hand, (5.0, 1.0), 40.0);
    let refused = hand.send_damping(1, 1.5);
    assert!(is_refused_damping(&refused), "{refused:?}");
    taken_in(&hand, 1);
    let refused = hand.send_damping(1, 1.5);
    assert!(is_refused_damping(&refused), "{refused:?}");
    let others = [FingerCommand::new(1).damping(1.5), FingerCommand::new(2).joints([0.0, 0.6, 1.0])];
    for group in [&others[..1], &others] {
        let refused = hand.send_group(group);
        assert!(is_refused_damping(&refused), "{refused:?}");
    }
    hand.send_damping(1, 1.1).expect("admitted with 5 N/cm");
    hand.send_damping(1, 1.0).expect("admitted");
    // After a Kx is sent, the Kx no longer changes along the path.
    hand.send_stiffness(1, kx(1.0)).expect("sent");
    hand.send_damping(1, 1.5).expect("admitted with 1 N/cm");
    hand.send_damping(1, 1.0).expect("admitted");
    // The Kx with which a path begins counts too.
    hand.send_stiffness(1, kx(5.0)).expect("sent");
    taken_in(&hand, 1);
    send_softening_path(&hand, (1.0, 1.0), 40.0);
    let refused = hand.send_damping(1, 1.5);
    assert!(is_refused_damping(&refused), "{refused:?}");
    // A path that has ended does not count.
    send_softening_path(&hand, (5.0, 1.0), 0.4);
    until("the path has ended", || hand.send_damping(1, 1.5).is_ok());
    taken_in(&hand, 1);
    let set_point = hand.report(1).expect("report").set_point;
    assert!((set_point.stiffness[(0, 0)] - 1.0).abs() < 1e-9 && set_point.damping == 1.5, "{set_point:?}");
}

/// Sends a path on which joint 1 goes to 1.2 rad, and then to 0.5 rad.
fn send_path_that_returns(hand: &Hand) {
    let pose = |time, angle| PathPose { time, pose: Pose::Joints([0.0, angle, 1.0]), stiffness: None };
    hand.send_path(1, &[pose(2.0, 1.2), pose(4.0, 0.5)], None).expect("sent");
}

#[test]
fn an_adjustment_checks_the_whole_path() {
    let hand = open(Configuration::default());
    send_path_that_returns(&hand);
    let refused = hand.adjust(1, "joints.maximum_degrees = [60, 60, 120]").expect_err("60 degrees are 1.05 rad");
    assert!(matches!(refused, HandError::SetPoint(SetPointError::PathBeyondJointLimit { joint: 1, .. })), "{refused}");
    assert_eq!(refused.errno(), libc::ERANGE);
    hand.adjust(1, "tendon.minimum = 6").expect("the limits of the joints stay");
    hand.adjust(1, "tendon.minimum = 5").expect("the limits of the joints stay");
    hand.send_position(1, [0.0, 0.5, 1.0]).expect("sent");
    hand.adjust(1, "joints.maximum_degrees = [60, 60, 120]").expect("the path has been replaced");
    // Softer tendons reduce the largest damping ratio, to 1.72 at 1 N/cm and to 1 at 5 N/cm.
    taken_in(&hand, 1);
    hand.send_stiffness(1, kx(1.0)).expect("sent");
    hand.send_damping(1, 1.01).expect("sent");
    until("the finger rests", || hand.report(1).expect("report").arrival.settled);
    send_softening_path(&hand, (5.0, 1.0), 40.0);
    let refused = hand.adjust(1, "tendon.stiffness = [150, 150, 150, 150]");
    assert!(is_refused_damping(&refused), "{refused:?}");
    // An adjustment that lowers the bound of Kx ends the change of Kx along the path, whatever the Kx of the path is.
    hand.adjust(1, "tendon.stiffness = [150, 150, 150, 150]\nstiffness.bound = 3").expect("adjusted");
    hand.send_damping(1, 1.5).expect("only the end of the path counts");
}

#[test]
fn a_clamped_path_beyond_the_adjusted_limits_ends() {
    let mut configuration = Configuration::default();
    configuration.hand.out_of_range = OutOfRange::Clamp;
    let hand = open(configuration);
    send_path_that_returns(&hand);
    taken_in(&hand, 1);
    hand.adjust(1, "joints.maximum_degrees = [60, 60, 120]").expect("adjusted");
    taken_in(&hand, 1);
    let set_point = hand.report(1).expect("report").set_point;
    let away = (set_point.joints - Vector3::new(0.0, 0.5, 1.0)).amax();
    assert!(away < 1e-9 && set_point.motion.is_none(), "{set_point:?}");
}

#[test]
fn clamped_commands_follow_the_adjusted_limits() {
    let mut configuration = Configuration::default();
    configuration.hand.out_of_range = OutOfRange::Clamp;
    let hand = open(configuration);
    hand.send_position(1, [0.0, 0.6, 1.0]).expect("sent");
    hand.adjust(1, "joints.maximum_degrees = [60, 20, 120]").expect("adjusted");
    taken_in(&hand, 1);
    assert_eq!(hand.report(1).expect("report").set_point.joints[1], 20f64.to_radians());
}

#[test]
fn a_finger_that_holds_a_pose_beyond_a_limit_can_be_adjusted() {
    let mut configuration = Configuration::default();
    configuration.fingers[0].simulation.start_degrees = [0.0, 102.0, 60.0];
    let hand = open(configuration);
    let found = hand.report(1).expect("report").set_point.joints;
    assert!(found[1] > 100.5f64.to_radians(), "{found}");
    hand.adjust(1, "events.arrived_degrees = 3").expect("adjusted");
    taken_in(&hand, 1);
    assert_eq!(hand.report(1).expect("report").set_point.joints, found);
    let refused = hand.adjust(1, "joints.maximum_degrees = [60, 99, 120]").expect_err("99 degrees are 1.73 rad");
    assert!(matches!(refused, HandError::SetPoint(SetPointError::SentBeyondJointLimit { joint: 1, .. })), "{refused}");
    assert_eq!(refused.errno(), libc::ERANGE);
}
