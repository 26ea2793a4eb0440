//! Fingers on ports move as springs.

use crate::rig::{
    Board, START, State, TARGET, close, farthest, goes, on_boards, on_one_port, open, three_boards, turn, wait_until,
};
use nalgebra::Vector3;
use std::time::{Duration, Instant};
use sun2xp::board::protocol::Status;
use sun2xp::hand::Hand;
use sun2xp::model::configuration::ConfiguredFinger;

fn target(finger: i32) -> [f64; 3] {
    TARGET.map(|angle| angle + 0.05 * f64::from(finger))
}

fn move_all(hand: &Hand) {
    for finger in 1..=3 {
        assert!(farthest(hand, finger, START) < 0.02, "finger {finger}: {:?}", hand.position(finger));
        hand.send_position(finger, target(finger)).expect("sent");
    }
    (1..=3).for_each(|finger| goes(hand, finger, target(finger)));
}

fn tip(hand: &Hand, finger: i32) -> Vector3<f64> {
    ConfiguredFinger::default().links().tip(&hand.position(finger).expect("position").into())
}

/// Waits until the fingertip has moved by at most 0.02 cm for 200 ms. Returns its position.
fn resting_tip(hand: &Hand, finger: i32) -> Vector3<f64> {
    let (mut from, mut since) = (tip(hand, finger), Instant::now());
    wait_until("at rest", || {
        let now = tip(hand, finger);
        if (now - from).norm() > 0.02 {
            (from, since) = (now, Instant::now());
        }
        since.elapsed() > Duration::from_millis(200)
    });
    tip(hand, finger)
}

#[test]
fn three_boards_on_three_ports() {
    let _turn = turn();
    let mut boards = three_boards();
    let hand = open(on_boards(&boards));
    move_all(&hand);
    for (index, board) in boards.iter_mut().enumerate() {
        let sent = target(index as i32 + 1);
        // The board's state contains the true joint angles.
        let there = |state: &State| state.joints.iter().zip(sent).all(|(is, sent)| (is - sent).abs() < 0.03);
        let state = board.wait_for(index + 1, "there", |state| there(state) && !state.limp());
        assert!(state.has(Status::ENABLED), "{state:?}");
    }
    close(hand);
    for (index, board) in boards.iter_mut().enumerate() {
        // The board has confirmed its end state before the hand is closed, so no watchdog was needed.
        let state = board.state(index + 1);
        assert!(state.has(Status::ENDED) && !state.has(Status::WATCHDOG_TRIPPED) && state.limp(), "{state:?}");
    }
}

#[test]
fn one_board_with_three_fingers_on_one_port() {
    let _turn = turn();
    let mut board = Board::start(&["1", "2", "3"]);
    let mut configuration = on_one_port(&board.port, 2_000_000);
    configuration.hand.rate = 1000.0;
    let hand = open(configuration);
    move_all(&hand);
    close(hand);
    for finger in 1..=3 {
        let state = board.state(finger);
        assert!(state.has(Status::ENDED) && !state.has(Status::WATCHDOG_TRIPPED) && state.limp(), "{state:?}");
    }
}

#[test]
fn slack_tendons_are_taken_up_when_the_hand_is_opened_again() {
    let _turn = turn();
    let mut boards = three_boards();
    let hand = open(on_boards(&boards));
    goes(&hand, 2, TARGET);
    close(hand);

    // No motor winds the tendons now, so pushing the finger slackens the tendons whose paths become shorter.
    let off = |state: &State| (Vector3::from_column_slice(&state.joints) - Vector3::from(TARGET)).amax();
    let at_rest = |board: &mut Board| {
        let mut last = board.state(2);
        wait_until("at rest", || {
            std::thread::sleep(Duration::from_millis(50));
            let before = std::mem::replace(&mut last, board.state(2));
            (Vector3::from_column_slice(&before.joints) - Vector3::from_column_slice(&last.joints)).amax() < 1e-4
        });
        last
    };
    // A finger that is pushed for long may bounce back from a stop to its old pose.
    let found = (0..10).find_map(|_| {
        boards[1].order("force 2 2 0 0");
        boards[1].wait_for(2, "pushed", |state| off(state) > 0.2);
        boards[1].order("free 2");
        Some(at_rest(&mut boards[1])).filter(|state| state.tensions.contains(&0.0) && off(state) > 0.15)
    });
    let found = found.expect("a push that loosens tendons");

    let hand = open(on_boards(&boards));
    let tight = boards[1].state(2);
    assert!(tight.tensions.iter().all(|&tension| tension > 3.0), "{tight:?}");
    // The finger holds the pose in which it was found, and continues from there.
    let held = hand.report(2).expect("report").set_point.joints;
    assert!((Vector3::from(hand.position(2).expect("position")) - held).amax() < 0.02);
    // The finger was found with slack tendons. The first tendon that becomes tight turns the joints by 0.09 to
    // 0.13 rad, depending on the motor angles after the push.
    assert!((held - Vector3::from_column_slice(&found.joints)).amax() < 0.16, "found at {found:?}, held at {held}");
    goes(&hand, 2, TARGET);
    goes(&hand, 2, START);
}

#[test]
fn a_pushed_fingertip_gives_way_by_its_stiffness() {
    let _turn = turn();
    let mut boards = three_boards();
    let hand = open(on_boards(&boards));
    let stiffness = 2.0;
    hand.send_stiffness(3, [[stiffness, 0.0, 0.0], [0.0, stiffness, 0.0], [0.0, 0.0, stiffness]]).expect("sent");
    goes(&hand, 3, TARGET);
    let before = resting_tip(&hand, 3);
    let force = Vector3::new(0.6, 0.0, -0.6);
    boards[2].order(&format!("force 3 {} {} {}", force.x, force.y, force.z));
    wait_until("moved", || (tip(&hand, 3) - before).norm() > 0.1);
    let way = resting_tip(&hand, 3) - before;
    assert!((way - force / stiffness).norm() < 0.1, "{way} for {force}");
    boards[2].order("free 3");
    goes(&hand, 3, TARGET);
}

#[test]
fn a_wall_stops_a_fingertip() {
    let _turn = turn();
    let mut boards = three_boards();
    let hand = open(on_boards(&boards));
    let links = ConfiguredFinger::default().links();
    let beyond = [0.3, START[1], START[2]];
    let (from, to) = (links.tip(&START.into()), links.tip(&beyond.into()));
    let wall = 0.5 * (from.x + to.x);
    // Two springs in series: 50 N/cm of the wall, 3 N/cm of the finger.
    boards[0].order(&format!("wall 1 {wall} 0 0 -1 0 0 50"));
    hand.send_position(1, beyond).expect("sent");
    wait_until("at the wall", || tip(&hand, 1).x > wall - 0.05);
    let expected = wall + (to.x - wall) * 3.0 / 53.0;
    let stopped = resting_tip(&hand, 1).x;
    assert!((stopped - expected).abs() < 0.1, "stopped at {stopped} cm, wall at {wall} cm, sent to {} cm", to.x);
    boards[0].order("free 1");
    goes(&hand, 1, beyond);
}
