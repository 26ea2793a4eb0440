//! The hand loses a board or its planner.

use crate::c::board::Board;
use crate::c::{Bench, STRICT, c_compiler, said};
use crate::strict;
use std::process::Command;
use std::time::{Duration, Instant};

#[test]
fn a_finger_whose_board_dies_is_faulted() {
    succeed_while_the_board_dies("faulted.c");
}

#[test]
fn faults_are_reported_by_number_and_in_words() {
    succeed_while_the_board_dies("faults.c");
}

fn succeed_while_the_board_dies(source: &str) {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), &strict(&["-std=c99"]), &[source]);
    let board = Board::start(&bench);
    let mut command = Command::new(&program);
    command.arg(board.id().to_string());
    let run = bench.run(command);
    assert!(run.status.success(), "{}", said(&run));
}

/// With `hand.end_state = "release"`, the default, the motors are without torque however the planner ends. Only the
/// friction of the motors then keeps some tension in the tendons.
#[test]
fn a_planner_that_leaves_without_closing_lets_the_tendons_go() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), STRICT, &["leaves.c"]);
    for (way, status) in
        [("return", Some(3)), ("exit", Some(3)), ("handler", Some(3)), ("thread", Some(3)), ("killed", None)]
    {
        let mut board = Board::start(&bench);
        let mut command = Command::new(&program);
        command.arg(way);
        let run = bench.run(command);
        assert_eq!(run.status.code(), status, "{way}: {}", said(&run));
        let end = Instant::now() + Duration::from_secs(3);
        while board.tension() > 3.0 {
            assert!(Instant::now() < end, "{way}: {} N three seconds later", board.tension());
        }
    }
}
