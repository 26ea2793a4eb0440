//! Calibration of an open hand on a simulated board: real threads, a real pseudo-terminal, real time.

use std::fs;
use std::time::Duration;
use sun2xp::calibration::{Findings, Obstacle, Progress, Step, Zeros};
use sun2xp::control::AdmissibleDamping;
use sun2xp::finger::Stage;
use sun2xp::hand::{Calibrating, Configured, Fingers, Found, Hand, HandError, PathPose, Pose, SetPointError, Until};
use sun2xp::hand::{read_configuration, store_findings};
use sun2xp::model::FingerNumber;

const FILE: &str = "# The hand on the desk.\n[hand]\nrate = 500\n[finger.zeroing]\nspeed = 2.0\n[finger.encoder]\n\
     zero = [700, -20, 30, 4000] # last year\n[finger.2.gauge]\n\
     zero = [ 204.0, 200.0, 200.0,  # tendon 3 was exchanged\n 190.0 ]\n";

#[test]
fn a_finger_is_calibrated_and_its_file_rewritten() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hand.toml");
    fs::write(&path, FILE).expect("written");
    let hand =
        Hand::open_limp(read_configuration(&path).expect("usable"), Some(path.clone()), Fingers::ALL).expect("open");
    let stage = |finger| hand.report(finger).expect("a report").stage;
    assert_eq!([1, 2, 3].map(stage), [Stage::Limp; 3]);

    let mut steps = Vec::new();
    let signs = hand.find_signs(2, |progress| steps.push(progress.step)).expect("signs");
    let Findings::Signs(signs) = signs else { panic!("{signs:?}") };
    assert_eq!((signs.motor, signs.encoder, signs.gauge), ([1; 4], [1; 4], [1; 4]));
    assert!(steps.contains(&Step::TryingMotors));
    assert_eq!(stage(2), Stage::Limp);

    // Zeroes against the stops: a simulated finger has stops, and no other method is configured. Its controller already
    // has the true zeros.
    let zeros = hand.zero(2, |_| {}).expect("zeros");
    let Findings::Zeros(zeros) = zeros else { panic!("{zeros:?}") };
    for tendon in 0..4 {
        let (found, there) = (zeros.gauge[tendon], [204.0, 200.0, 200.0, 190.0][tendon]);
        assert!((found - there).abs() < 1.0, "{zeros:?}");
        assert!((zeros.encoder[tendon] - [700, -20, 30, 4000][tendon]).abs() <= 8, "{zeros:?}");
    }
    assert_eq!(stage(2), Stage::Running);
    assert_eq!([stage(1), stage(3)], [Stage::Limp; 2]);
    let joints = hand.position(2).expect("position");
    hand.send_position(2, joints).expect("a finger that is zeroed takes set points");

    // Meanwhile another process has stored zeros of finger 1.
    let other = Zeros { encoder: [5, 6, 7, 8], gauge: [0.0; 4], joint_error: Default::default(), range_error: None };
    let other =
        Found::by_calibration(&Findings::Zeros(other), FingerNumber::ONE, &read_configuration(&path).expect("usable"));
    store_findings(&path, &[other]).expect("stored");
    assert!(hand.store_calibration(2).expect("stored"));
    assert!(!hand.store_calibration(2).expect("nothing is left to store"));
    let text = fs::read_to_string(&path).expect("there");
    assert!(text.starts_with("# The hand on the desk.\n[hand]\nrate = 500\n"), "{text}");
    assert!(text.contains("# last year") && text.contains("# tendon 3 was exchanged"), "{text}");
    let (again, found) = (read_configuration(&path).expect("usable"), hand.calibrated(2).expect("there"));
    assert_eq!(again.fingers[1].encoder.zero, found.encoder.zero);
    assert_eq!(again.fingers[0].encoder.zero, [5, 6, 7, 8]);
    assert_eq!(again.fingers[2].encoder.zero, [700, -20, 30, 4000]);

    fs::remove_file(&path).expect("removed");
    hand.find_signs(3, |_| {}).expect("signs");
    let refused = hand.store_calibration(3).expect_err("nowhere to store");
    assert!(
        matches!(&refused, HandError::NotStored { finger: FingerNumber::THREE, .. }) && refused.errno() == libc::ENOENT,
        "{refused}"
    );
    assert!(refused.to_string().ends_with(". Remove the cause and calibrate the finger again"), "{refused}");
    // A later call stores what could not be stored.
    fs::write(&path, "[hand]\nrate = 500\n[finger.3.motor]\nsign = [-1, 1, 1, 1]\n").expect("written");
    assert!(hand.store_calibration(3).expect("stored"));
    assert_eq!(read_configuration(&path).expect("usable").fingers[2].motor.sign, [1; 4]);
    assert!(!hand.store_calibration(3).expect("nothing is left to store"));
}

/// The finger is stopped while it takes up slack with its new zeros.
#[test]
fn results_are_stored_although_the_finger_faults_before_it_is_a_spring_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hand.toml");
    fs::write(&path, "[finger]\nport = 'simulated'\nzeroing.method = 'pose'\n").expect("written");
    let hand = Hand::open_as(Configured::read(&path).expect("usable")).expect("open");
    let stop = |progress: Progress| {
        if progress.step == Step::TakingUpSlack && progress.part == 1.0 {
            hand.stop(1).expect("stopped");
        }
    };
    let refused = hand.zero(1, stop).expect_err("the finger was stopped");
    assert!(matches!(refused, HandError::Faulted { finger: FingerNumber::ONE, .. }), "{refused}");
    let found = hand.calibrated(1).expect("there");
    hand.recover(1).unwrap_or_else(|error| panic!("{error}"));
    assert!(hand.store_calibration(1).expect("stored"));
    let stored = read_configuration(&path).expect("usable").fingers[0].clone();
    assert_eq!(stored.encoder.zero, found.encoder.zero);
    assert!(!hand.store_calibration(1).expect("nothing is left to store"));
}

#[test]
fn a_refused_calibration_leaves_the_finger_limp_and_says_why() {
    let mut configuration = read_default();
    configuration.fingers[0].zeroing.method = Some(sun2xp::model::configuration::ZeroingMethod::Stops);
    configuration.fingers[0].zeroing.time_limit_s = 1.0;
    let hand = Hand::open(configuration.clone()).expect("open");
    let mut calibrating = Calibrating::begin(&hand, 1, sun2xp::calibration::Task::Zero).expect("begun");
    let second = Calibrating::begin(&hand, 1, sun2xp::calibration::Task::Zero);
    assert!(matches!(second, Err(HandError::Busy(FingerNumber::ONE))), "{second:?}");
    let refused = loop {
        match calibrating.poll(&hand) {
            Ok(_) => std::thread::sleep(std::time::Duration::from_millis(5)),
            Err(error) => break error,
        }
    };
    let expected = matches!(
        refused,
        HandError::Calibration { finger: FingerNumber::ONE, limp: true, obstacle: Obstacle::TimeLimit { .. } }
    );
    assert!(expected, "{refused}");
    assert_eq!(refused.errno(), libc::ETIMEDOUT);
    assert_eq!(hand.report(1).expect("a report").stage, Stage::Limp);
    assert_eq!(hand.calibrated(1).expect("there"), configuration.fingers[0]);
    assert!(!hand.store_calibration(1).expect("nowhere to store"));
    assert!(matches!(hand.zero(4, |_| {}), Err(HandError::NoSuchFinger(4))));
}

/// Nothing switches the motors of a limp finger on, so it does not help to wait.
#[test]
fn calls_to_a_limp_finger_are_refused_without_the_advice_to_wait() {
    let hand = Hand::open_limp(read_default(), None, Fingers::ALL).expect("open");
    let pose = PathPose { time: 3.0, pose: Pose::Joints([0.2, 0.6, 1.1]), stiffness: None };
    let waiting = hand.wait(&[1], Until::Settled, Duration::from_secs(10));
    for refused in [waiting, hand.send_path(1, &[pose], None)] {
        let refused = refused.expect_err("limp");
        assert!(matches!(refused, HandError::Limp(FingerNumber::ONE)), "{refused}");
        let text = refused.to_string();
        assert!(text.contains("motors of finger 1 are off") && !text.contains("wait until"), "{text}");
        assert_eq!(refused.errno(), libc::EBUSY);
    }
    // The fault of another finger is reported first.
    hand.stop(2).expect("finger 2");
    while !matches!(hand.report(2).expect("a report").stage, Stage::Faulted(_)) {
        std::thread::sleep(Duration::from_millis(1));
    }
    let refused = hand.wait(&[1, 2, 3], Until::Settled, Duration::from_secs(10)).expect_err("limp and faulted");
    assert!(matches!(refused, HandError::Faulted { finger: FingerNumber::TWO, .. }), "{refused}");
}

/// Two fingers at once: one is zeroed against its stops. The other, whose tendons differ in stiffness from the
/// configuration, is identified.
#[test]
fn fingers_are_zeroed_against_their_stops_and_identified() {
    let mut configuration = read_default();
    configuration.hand.rate = 500.0;
    for finger in &mut configuration.fingers {
        // With a small range of motion and little tension, the calibration is quick.
        finger.zeroing.method = Some(sun2xp::model::configuration::ZeroingMethod::Stops);
        finger.zeroing.speed = 1.5;
        finger.joints.minimum_degrees = [-30.0, -10.0, 30.0];
        finger.joints.maximum_degrees = [30.0, 50.0, 90.0];
        finger.tendon.maximum = 35.0;
    }
    // If the zeros of the gauges were 0 counts, noise below 0 counts would be clipped.
    configuration.fingers[0].gauge.zero = [204.0; 4];
    configuration.fingers[1].simulation.tendon_stiffness = [330.0, 270.0, 315.0, 285.0];
    let hand = Hand::open(configuration).expect("open");
    let (mut sought, mut pressed) = (Vec::new(), Vec::new());
    let (zeros, identified) = std::thread::scope(|scope| {
        let zeros = scope.spawn(|| hand.zero(1, |progress| sought.push(progress.step)));
        let identified = hand.identify(2, |progress| pressed.push(progress.step));
        (zeros.join().expect("no panic"), identified)
    });
    let Ok(Findings::Zeros(zeros)) = zeros else { panic!("{zeros:?}") };
    assert!(sought.contains(&Step::ZeroingGauges) && sought.contains(&Step::SeekingStops), "{sought:?}");
    // The zeros of the simulated encoders and the stops are where the configuration says.
    for tendon in 0..4 {
        assert!(zeros.encoder[tendon].abs() <= 8 && (zeros.gauge[tendon] - 204.0).abs() < 1.0, "{zeros:?}");
    }
    assert!(zeros.range_error.is_some_and(|range| range.amax() < 0.01), "{zeros:?}");
    let Ok(Findings::Identified(found)) = identified else { panic!("{identified:?}") };
    assert!(pressed.contains(&Step::MovingJoints) && pressed.contains(&Step::Pressing), "{pressed:?}");
    for (tendon, truth) in [330.0, 270.0, 315.0, 285.0].into_iter().enumerate() {
        assert!((found.tendon_stiffness[tendon] / truth - 1.0).abs() < 0.02, "{found:?}");
    }
    // The findings are in force at once, for finger 2 only, and all fingers are under control.
    assert_eq!(hand.calibrated(2).expect("there").tendon.stiffness, <[f64; 4]>::from(found.tendon_stiffness));
    assert_eq!(hand.calibrated(1).expect("there").tendon.stiffness, [300.0; 4]);
    // The range of the damping ratio depends on the stiffness of the tendons.
    let refused = hand.send_damping(2, 9.0).expect_err("above every range");
    let HandError::SetPoint(SetPointError::Damping { stiffness, least, most, .. }) = refused else {
        panic!("{refused}")
    };
    let range = AdmissibleDamping::new(&hand.calibrated(2).expect("there"), 500.0).range(stiffness);
    assert_eq!((least, most), range);
    assert_eq!([1, 2, 3].map(|finger| hand.report(finger).expect("a report").stage), [Stage::Running; 3]);
}

#[test]
fn a_calibration_that_a_stop_has_ended_is_not_in_progress() {
    let mut configuration = read_default();
    configuration.fingers[0].zeroing.method = Some(sun2xp::model::configuration::ZeroingMethod::Stops);
    let hand = Hand::open(configuration).expect("open");
    let part = || hand.status(1).expect("a status").calibration;
    let mut calibrating = Calibrating::begin(&hand, 1, sun2xp::calibration::Task::Zero).expect("begun");
    while part() == 0.0 {
        calibrating.poll(&hand).expect("in progress");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    hand.stop(1).expect("finger 1");
    while calibrating.poll(&hand).is_ok() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert_eq!(part(), 0.0);
    hand.recover(1).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(part(), 0.0);
}

fn read_default() -> sun2xp::model::configuration::Configuration {
    sun2xp::model::configuration::Configuration::default()
}
