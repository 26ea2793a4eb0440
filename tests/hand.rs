//! A hand on simulated boards: real threads, real pseudo-terminals, real time.

#[allow(dead_code)]
#[path = "common/pauses.rs"]
mod pauses;
#[path = "common/settling.rs"]
mod settling;

use nalgebra::Vector3;
use settling::{Settling, distance};
use std::time::{Duration, Instant};
use sun2xp::finger::Stage;
use sun2xp::hand::{ConfigurationError, Hand, HandError};
use sun2xp::model::configuration::{Configuration, ConfiguredFinger, EndState, NamedHand};

const TARGET: [f64; 3] = [0.2, 0.6, 1.1];

fn open(configuration: Configuration) -> Hand {
    pauses::name_pauses();
    Hand::open(configuration).unwrap_or_else(|error| panic!("open: {error}"))
}

fn farthest(hand: &Hand, finger: i32, target: [f64; 3]) -> f64 {
    let position = hand.position(finger).unwrap_or_else(|error| panic!("finger {finger}: {error}"));
    distance(position, target)
}

/// Waits until the finger has been within 0.02 rad of `target` for 100 ms.
fn settles(hand: &Hand, finger: i32, target: [f64; 3]) {
    let settling = Settling { tolerance: 0.02, rest: Duration::from_millis(100), patience: Duration::from_secs(10) };
    settling.wait(hand, &[(finger, target)]).unwrap_or_else(|error| panic!("finger {finger}: {error}"));
}

#[test]
fn every_finger_holds_its_pose_after_open_and_goes_where_it_is_sent() {
    let hand = open(Configuration::default());
    let start = [0.0, 30f64.to_radians(), 60f64.to_radians()];
    for finger in 1..=3 {
        assert!(farthest(&hand, finger, start) < 0.02, "finger {finger}: {:?}", hand.position(finger));
    }
    for finger in 1..=3 {
        hand.send_position(finger, TARGET.map(|angle| angle + 0.05 * f64::from(finger))).expect("sent");
    }
    for finger in 1..=3 {
        let target = TARGET.map(|angle| angle + 0.05 * f64::from(finger));
        settles(&hand, finger, target);
        let report = hand.report(finger).expect("a report");
        assert_eq!(report.stage, Stage::Running);
        assert!(report.cycle.desired_tensions.min() > 5.0 - 1e-9, "{}", report.cycle.desired_tensions);
        assert!(report.cycle.tensions.min() > 4.8 - 0.15, "{}", report.cycle.tensions);
    }
    let status = hand.status(1).expect("status");
    assert!(status.losses.cycles > 100);
    hand.close();
}

#[test]
fn fingers_with_the_tendons_of_real_hands_open_and_go_where_they_are_sent() {
    let mut configuration = Configuration::default();
    for (finger, hand) in configuration.fingers.iter_mut().zip([NamedHand::Worn, NamedHand::Sheathed, NamedHand::Cheap])
    {
        finger.simulation = hand.simulation();
    }
    let hand = open(configuration);
    // Errors of the gauges displace an uncalibrated finger by up to 0.03 rad.
    let settling = Settling { tolerance: 0.06, rest: Duration::from_millis(300), patience: Duration::from_secs(10) };
    for target in [TARGET, [-0.3, 1.0, 1.5], TARGET] {
        for finger in 1..=3 {
            hand.send_position(finger, target).expect("sent");
        }
        settling.wait(&hand, &[(1, target), (2, target), (3, target)]).unwrap_or_else(|error| panic!("{error}"));
    }
    hand.close();
}

#[test]
fn a_finger_whose_angle_is_no_number_has_not_arrived() {
    assert_eq!(distance([0.2, f64::NAN, 1.1], TARGET), f64::INFINITY);
    assert_eq!(distance([f64::NAN; 3], TARGET), f64::INFINITY);
    assert_eq!(distance([0.0, 0.6, 1.1], TARGET), 0.2);
}

#[test]
fn two_hands_live_in_one_process() {
    let (one, other) = (open(Configuration::default()), open(Configuration::default()));
    one.send_position(2, TARGET).expect("sent");
    settles(&one, 2, TARGET);
    assert!(farthest(&other, 2, TARGET) > 0.1, "the other hand must not have moved");
    drop(one);
    other.send_position(2, TARGET).expect("sent");
    settles(&other, 2, TARGET);
}

/// The end state itself is tested on boards in other processes, in tests/hand_ports/endings.rs.
#[test]
fn fingers_on_one_thread_whose_end_state_is_hold_go_where_they_are_sent() {
    let mut configuration = Configuration::default();
    configuration.fingers.iter_mut().for_each(|finger| finger.thread = 2);
    configuration.hand.end_state = EndState::Hold;
    let hand = open(configuration);
    for finger in 1..=3 {
        hand.send_position(finger, TARGET).expect("sent");
    }
    for finger in 1..=3 {
        settles(&hand, finger, TARGET);
    }
}

#[test]
fn a_pushed_finger_gives_way_like_its_spring() {
    let hand = open(Configuration::default());
    let links = ConfiguredFinger::default().links();
    let tip = || links.tip(&hand.position(1).expect("position").into());
    let (before, at_rest) = (hand.position(1).expect("position"), tip());
    let force = Vector3::new(0.0, 0.0, -1.0);
    hand.push_simulated(1, force.into()).expect("pushed");
    // The initial stiffness is 3 N/cm. The tip must move by the deflection of this spring, and stay there.
    let expected = force / 3.0;
    let limit = Instant::now() + Duration::from_secs(10);
    let mut since = Instant::now();
    while since.elapsed() < Duration::from_millis(200) {
        let way = tip() - at_rest;
        if (way - expected).norm() > 0.1 {
            since = Instant::now();
        }
        assert!(Instant::now() < limit, "the tip gives way by {way} cm instead of {expected} cm");
        std::thread::sleep(Duration::from_millis(2));
    }
    hand.push_simulated(1, [0.0; 3]).expect("released");
    settles(&hand, 1, before);
}

#[test]
fn refusals_change_nothing() {
    let hand = open(Configuration::default());
    let before = hand.report(3).expect("report").set_point;
    let refused = [
        hand.send_position(0, TARGET),
        hand.send_position(4, TARGET),
        hand.send_position(3, [0.0, f64::NAN, 1.0]),
        hand.send_position(3, [0.0, 0.5, 3.0]),
        hand.send_stiffness(3, [[7.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        hand.send_stiffness(3, [[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    ];
    let errnos = refused.map(|result| result.expect_err("refused").errno());
    use libc::{EDOM, EINVAL, ERANGE};
    assert_eq!(errnos, [EINVAL, EINVAL, EINVAL, ERANGE, ERANGE, EDOM]);
    // Waits until a cycle that would have used a refused set point is certainly over.
    let cycles = hand.report(3).expect("report").losses.cycles;
    while hand.report(3).expect("report").losses.cycles < cycles + 5 {
        std::thread::yield_now();
    }
    assert_eq!(hand.report(3).expect("report").set_point, before);
}

#[test]
fn a_rate_the_line_cannot_carry_is_refused_with_the_arithmetic() {
    let mut configuration = Configuration::default();
    configuration.fingers[1].port = "/dev/ttyS0".into();
    configuration.fingers[1].baud = 115_200;
    let Err(HandError::Configuration(ConfigurationError::Unusable { section, unusable })) = Hand::open(configuration)
    else {
        panic!("115 200 baud cannot carry 1000 cycles a second")
    };
    assert_eq!((section.as_str(), unusable.key), ("finger.2", "baud"));
    assert!(unusable.reason.contains("us"), "{}", unusable.reason);
}

#[test]
fn a_port_that_is_not_there_is_named() {
    let mut configuration = Configuration::default();
    configuration.fingers[2].port = "/dev/there-is-no-such-port".into();
    let error = Hand::open(configuration).err().expect("refused");
    assert_eq!(error.errno(), libc::ENOENT);
    let text = error.to_string();
    assert!(text.contains("finger 3") && text.contains("/dev/there-is-no-such-port"), "{text}");
}
