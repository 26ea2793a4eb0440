//! Tests the commands with the simulated hand.

use super::*;
use std::time::{Duration, Instant};
use sun2xp::groups::Until;

/// Longest time in which a finger settles.
const LIMIT: Duration = Duration::from_secs(20);

fn simulated() -> (Hand, Configuration) {
    let configuration = Configuration::default();
    (Hand::open(configuration.clone()).expect("the simulated hand opens"), configuration)
}

/// Waits until the servo has taken the newest set point and the finger rests.
fn settle(hand: &Hand, finger: i32) {
    hand.wait(&[finger], Until::Settled, LIMIT).expect("settles");
}

/// Waits until the condition holds.
fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !holds() {
        assert!(begun.elapsed() < LIMIT, "not within {LIMIT:?}: {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn done(result: Result<String, Refused>) -> String {
    result.unwrap_or_else(|refused| panic!("{refused}"))
}

fn refused(result: Result<String, Refused>) -> String {
    result.expect_err("refused").to_string()
}

#[test]
fn commands_move_joints_and_tips_and_change_the_stiffness() {
    let (hand, configuration) = simulated();
    let execute = |command: Command| command.execute(&hand, &configuration, &|| false);
    let joints = [0.1, 0.5, 0.9];
    assert_eq!(done(execute(Command::Joints { finger: 1, joints })), "finger 1: joints to 5.7, 28.6, 51.6 degrees");
    settle(&hand, 1);
    done(execute(Command::MoveJoints { finger: 1, by: [0.0, 0.1, -0.1] }));
    settle(&hand, 1);
    let reached = hand.position(1).expect("runs");
    assert!(largest_difference(reached, [0.1, 0.6, 0.8]) < 0.02, "{reached:?}");

    let from = hand.tip_at(1, desired_joints(&hand, 1).expect("there")).expect("there");
    done(execute(Command::MoveTip { finger: 1, by: [0.5, 0.0, -0.5] }));
    settle(&hand, 1);
    let tip = hand.fingertip(1).expect("runs").tip;
    assert!(largest_difference(tip, sum(from, [0.5, 0.0, -0.5])) < 0.1, "{from:?} {tip:?}");

    done(execute(Command::Stiffness { finger: 2, kx: [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]] }));
    let kx = || desired_stiffness(&hand, 2).expect("there");
    until("the servo takes Kx", || kx()[2][2] == 1.0);
    done(execute(Command::ScaleStiffness { finger: 2, factor: 1.5 }));
    until("the servo takes Kx", || kx() == [[3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 1.5]]);

    done(execute(Command::Close));
    for finger in 1..=3 {
        settle(&hand, finger);
        // In the finger's frame the middle of the palm is at y = -3.5 cm.
        let tip = hand.fingertip(finger).expect("runs").tip;
        assert!((tip[1] + 3.5).abs() < 0.1, "{tip:?}");
    }
    done(execute(Command::Open));
    settle(&hand, 1);
    assert!(hand.fingertip(1).expect("runs").tip[1] > 0.5);
}

/// Commands that have waited for a recovery follow each other faster than the cycles of the servo.
#[test]
fn relative_commands_after_a_recovery_add_up() {
    let (hand, configuration) = simulated();
    let execute = |command: Command| command.execute(&hand, &configuration, &|| false);
    done(execute(Command::Joints { finger: 1, joints: [0.1, 0.5, 0.9] }));
    settle(&hand, 1);
    hand.stop(1).expect("finger 1");
    done(execute(Command::Recover { finger: 1 }));
    let start = desired_joints(&hand, 1).expect("there");
    let stiffness = desired_stiffness(&hand, 1).expect("there")[0][0];
    for _ in 0..20 {
        done(execute(Command::MoveJoints { finger: 1, by: [0.0, 0.005, 0.0] }));
        done(execute(Command::ScaleStiffness { finger: 1, factor: 0.99 }));
    }
    let at_goal = |joints: [f64; 3]| largest_difference(joints, sum(start, [0.0, 0.1, 0.0])) < 1e-9;
    assert!(at_goal(desired_joints(&hand, 1).expect("there")));
    let softer = desired_stiffness(&hand, 1).expect("there")[0][0];
    assert!((softer - stiffness * 0.99f64.powi(20)).abs() < 1e-9, "{stiffness} {softer}");
    until("the servo takes the last step", || at_goal(hand.report(1).expect("there").set_point.joints.into()));
}

/// A recovery that began after the stop would undo it, and the finger would tighten its tendons.
#[test]
fn a_stop_before_a_recovery_begins_prevents_it() {
    let (hand, configuration) = simulated();
    hand.stop(1).expect("finger 1");
    let recover = Command::Recover { finger: 1 };
    let refusal = refused(recover.execute(&hand, &configuration, &|| true));
    assert!(refusal.contains("emergency stop"), "{refusal}");
    let report = hand.report(1).expect("finger 1");
    assert!(matches!(report.stage, Stage::Faulted(_)) && report.recoveries == 0, "{report:?}");
    done(recover.execute(&hand, &configuration, &|| false));
}

#[test]
fn refusals_have_the_text_of_the_hand_and_change_nothing() {
    let (hand, configuration) = simulated();
    let execute = |command: Command| command.execute(&hand, &configuration, &|| false);
    let before = desired_joints(&hand, 1).expect("there");
    for (command, text) in [
        (Command::MoveJoints { finger: 1, by: [2.0, 0.0, 0.0] }, "joint 0 would be at "),
        (Command::MoveTip { finger: 1, by: [0.0, 0.0, 20.0] }, "the tip of finger 1 cannot be at"),
        (Command::ScaleStiffness { finger: 1, factor: 100.0 }, "above the bound"),
        (Command::Joints { finger: 1, joints: [f64::NAN, 0.0, 0.0] }, "finite"),
        (Command::Push { finger: 1, force: [0.0, 2000.0, 0.0] }, "use a force whose components are smaller"),
        (Command::Joints { finger: 4, joints: before }, "there is no finger 4"),
    ] {
        let refusal = refused(execute(command));
        assert!(refusal.contains(text), "{command:?}: {refusal}");
    }
    assert_eq!(desired_joints(&hand, 1).expect("there"), before);
}

#[test]
fn a_push_deflects_the_tip_by_force_over_stiffness() {
    let (hand, configuration) = simulated();
    let execute = |command: Command| command.execute(&hand, &configuration, &|| false);
    let (force, stiffness) = (0.6, 3.0);
    let kx = std::array::from_fn(|row| std::array::from_fn(|column| if row == column { stiffness } else { 0.0 }));
    done(execute(Command::Stiffness { finger: 3, kx }));
    done(execute(Command::Joints { finger: 3, joints: [0.1, 0.5, 0.9] }));
    settle(&hand, 3);
    // The mean of many cycles: the dither and the noise of the gauges move the tip a little.
    let tip = || {
        let mut mean = [0.0; 3];
        for _ in 0..100 {
            mean = sum(mean, hand.fingertip(3).expect("runs").tip.map(|entry| entry / 100.0));
            std::thread::sleep(Duration::from_millis(3));
        }
        mean
    };
    for axis in 0..3 {
        let mut push = [0.0; 3];
        let mut deflected = [[0.0; 3]; 2];
        for (sign, at) in [-1.0, 1.0].into_iter().zip(&mut deflected) {
            push[axis] = sign * force;
            done(execute(Command::Push { finger: 3, force: push }));
            std::thread::sleep(Duration::from_millis(1500));
            *at = tip();
        }
        let deflection = (deflected[1][axis] - deflected[0][axis]) / 2.0;
        let expected = force / stiffness;
        assert!((deflection / expected - 1.0).abs() < 0.1, "axis {axis}: {deflection} cm, expected {expected} cm");
        done(execute(Command::Push { finger: 3, force: [0.0; 3] }));
    }
}

#[test]
fn a_stopped_finger_recovers() {
    let (hand, configuration) = simulated();
    let execute = |command: Command| command.execute(&hand, &configuration, &|| false);
    // Not Command::Stop, which stops the hands of the other tests in this process too.
    hand.stop(2).expect("there");
    until("finger 2 stops", || hand.fault(2).expect("there").stopped.is_some());
    let refusal = refused(execute(Command::MoveJoints { finger: 2, by: [0.0; 3] }));
    assert!(refusal.starts_with("finger 2 is faulted"), "{refusal}");
    assert_eq!(done(execute(Command::Recover { finger: 2 })), "finger 2: holds its pose");
    done(execute(Command::MoveJoints { finger: 2, by: [0.0, 0.05, 0.0] }));
}

#[test]
fn a_real_finger_moves_in_small_steps() {
    // The hand is simulated, but the commands take finger 1 for a real one.
    let (hand, mut configuration) = simulated();
    configuration.fingers[0].port = "/dev/ttyUSB0".into();
    let execute = |command: Command| command.execute(&hand, &configuration, &|| false);
    let refusal = refused(execute(Command::MoveJoints { finger: 1, by: [0.1, 0.0, 0.0] }));
    let named = refusal.contains("a joint of finger 1 by 5.73 degrees") && refusal.contains("at most 3.00 degrees");
    assert!(named, "{refusal}");
    let refusal = refused(execute(Command::MoveTip { finger: 1, by: [0.0, 0.4, 0.0] }));
    assert!(refusal.contains("the tip of finger 1 by 0.40 cm") && refusal.contains("at most 0.30 cm"), "{refusal}");
    done(execute(Command::MoveJoints { finger: 2, by: [0.1, 0.0, 0.0] }));
    done(execute(Command::MoveJoints { finger: 1, by: [0.05, 0.0, 0.0] }));
    settle(&hand, 1);
    let before = desired_joints(&hand, 1).expect("there");
    done(execute(Command::Close));
    settle(&hand, 1);
    let way = largest_difference(desired_joints(&hand, 1).expect("there"), before);
    assert!((way - REAL_JOINT_STEP).abs() < 1e-6, "{way}");
}

/// A finger that rests on a stop beyond its limits holds this pose after opening.
#[test]
fn a_real_finger_beyond_its_limits_does_not_jump_to_them() {
    for out_of_range in [OutOfRange::Refuse, OutOfRange::Clamp] {
        let mut configuration = Configuration::default();
        configuration.hand.fingers = sun2xp::hand::Fingers::only(1).expect("a finger");
        configuration.hand.out_of_range = out_of_range;
        let finger = &mut configuration.fingers[0];
        finger.joints.minimum_degrees[1] = 45.0;
        finger.simulation.stop_margin_degrees = 20.0;
        let hand = Hand::open(configuration.clone()).expect("the simulated hand opens");
        // The commands take the finger for a real one.
        configuration.fingers[0].port = "/dev/ttyUSB0".into();
        let before = desired_joints(&hand, 1).expect("there");
        assert!(before[1] < 33.0f64.to_radians(), "{before:?}");
        for command in [Command::Open, Command::Close, Command::MoveJoints { finger: 1, by: [0.0, 0.02, 0.0] }] {
            refused(command.execute(&hand, &configuration, &|| false));
        }
        let text = refused(Command::Close.execute(&hand, &configuration, &|| false));
        assert!(
            text.starts_with("the set point of joint 1 of finger 1, ") && text.contains("move the finger into"),
            "{text}"
        );
        assert_eq!(desired_joints(&hand, 1).expect("there"), before);
    }
}

#[test]
fn commands_have_names_in_json() {
    let push = Command::Push { finger: 1, force: [0.0, 0.0, -1.0] };
    let text = serde_json::to_string(&push).expect("written");
    assert_eq!(text, r#"{"command":"push","finger":1,"force":[0.0,0.0,-1.0]}"#);
    assert_eq!(serde_json::from_str::<Command>(&text).expect("read"), push);
    assert_eq!(serde_json::from_str::<Command>(r#"{"command":"stop"}"#).expect("read"), Command::Stop);
    assert!(serde_json::from_str::<Command>(r#"{"command":"recover","finger":1,"force":2}"#).is_err());
}
