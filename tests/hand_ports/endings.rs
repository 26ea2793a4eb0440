//! Planners that end without CloseHand: their boards go to the configured end state.

use crate::c::{Bench, STRICT, c_compiler};
use crate::rig::{Board, State, TARGET, goes, on_boards, open, three_boards, turn, write_configuration};
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use sun2xp::board::protocol::Status;
use sun2xp::hand::stop_all;
use sun2xp::model::configuration::EndState;

const HOLD: &str = "end_state = 'hold'\nhold_time_ms = 1500\nhold_torque_limit = 0.3\n";
const HOLD_TIME: Duration = Duration::from_millis(1500);

/// Largest torque of a motor that holds, N cm: `hold_torque_limit` in [`HOLD`].
const MOST_HELD: f64 = 0.3;

/// A C planner that has sent every finger to a pose and then does what `ending` says.
struct Planner {
    process: Child,
    _bench: Bench,
}

impl Planner {
    fn start(boards: &[Board; 3], hand: &str, ending: &str) -> Self {
        let bench = Bench::new();
        let program = bench.build(c_compiler(), STRICT, &["goes.c"]);
        let configuration = bench.path().join("sun2xp.toml");
        write_configuration(&configuration, boards, hand);
        let mut planner = Command::new(program);
        planner.arg(ending).env("SUN2XP_CONFIG", configuration).stdout(Stdio::piped());
        let mut process = planner.spawn().expect("a planner");
        let mut line = String::new();
        BufReader::new(process.stdout.take().expect("its output")).read_line(&mut line).expect("a line");
        assert_eq!(line, "there\n");
        Self { process, _bench: bench }
    }

    /// Waits until the planner has ended with status 3.
    fn ends(mut self) {
        assert_eq!(self.process.wait().expect("it ends").code(), Some(3));
    }

    /// Kills the planner with SIGKILL.
    fn dies(mut self) {
        self.process.kill().expect("killed");
        self.process.wait().expect("gone");
    }
}

impl Drop for Planner {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn holds(state: &State) -> bool {
    state.has(Status::HOLDING)
}

fn assert_held_within_the_limit(state: &State) {
    let strongest = state.torques.iter().fold(0.0f64, |most, torque| most.max(torque.abs()));
    assert!(strongest > 0.2 && strongest <= MOST_HELD, "{state:?}");
}

#[test]
fn a_killed_planner_leaves_its_motors_released() {
    let _turn = turn();
    let mut boards = three_boards();
    let planner = Planner::start(&boards, "", "wait");
    for (index, board) in boards.iter_mut().enumerate() {
        // A servo that was paused for 10 ms lets its motors go for a moment, so the test waits until they are driven.
        board.wait_for(index + 1, "driven", |state| state.has(Status::ENABLED) && !state.limp());
    }
    planner.dies();
    for (index, board) in boards.iter_mut().enumerate() {
        let state = board.wait_for(index + 1, "ended", |state| state.has(Status::ENDED));
        assert!(state.has(Status::WATCHDOG_TRIPPED) && state.limp(), "{state:?}");
    }
    // The next planner finds the boards ready.
    goes(&open(on_boards(&boards)), 2, TARGET);
}

#[test]
fn a_killed_planner_leaves_its_motors_holding_for_a_while() {
    let _turn = turn();
    let mut boards = three_boards();
    let planner = Planner::start(&boards, HOLD, "wait");
    let strongest = boards[0].state(1).torques.into_iter().fold(0.0, f64::max);
    assert!(strongest > MOST_HELD, "nothing to bound: {strongest} N cm");
    let killed = Instant::now();
    planner.dies();
    for (index, board) in boards.iter_mut().enumerate() {
        assert_held_within_the_limit(&board.wait_for(index + 1, "holding", holds));
    }
    for (index, board) in boards.iter_mut().enumerate() {
        let state = board.wait_for(index + 1, "released", |state| !holds(state));
        assert!(state.has(Status::ENDED) && state.has(Status::WATCHDOG_TRIPPED) && state.limp(), "{state:?}");
        assert!(killed.elapsed() >= HOLD_TIME, "released after {:?}", killed.elapsed());
    }
}

#[test]
fn a_planner_that_returns_or_exits_releases_by_itself() {
    let _turn = turn();
    for ending in ["return", "exit"] {
        let mut boards = three_boards();
        Planner::start(&boards, "", ending).ends();
        for (index, board) in boards.iter_mut().enumerate() {
            let state = board.state(index + 1);
            assert!(state.has(Status::ENDED) && state.limp(), "{ending}: {state:?}");
            assert!(!state.has(Status::WATCHDOG_TRIPPED), "{ending}: left to the watchdog: {state:?}");
        }
    }
}

#[test]
fn a_planner_that_returns_leaves_its_motors_holding_for_a_while() {
    let _turn = turn();
    let mut boards = three_boards();
    let planner = Planner::start(&boards, HOLD, "return");
    planner.ends();
    for (index, board) in boards.iter_mut().enumerate() {
        let state = board.wait_for(index + 1, "released", |state| !holds(state));
        let [now, _, ended] = state.times[..] else { panic!("three times") };
        assert!(state.has(Status::ENDED) && state.limp() && now - ended >= 1499.0, "{state:?}");
        assert!(!state.has(Status::WATCHDOG_TRIPPED), "left to the watchdog: {state:?}");
    }
}

#[test]
fn a_planner_that_skips_its_exit_handlers_is_stopped_by_the_watchdogs() {
    let _turn = turn();
    let mut boards = three_boards();
    Planner::start(&boards, "", "_exit").ends();
    for (index, board) in boards.iter_mut().enumerate() {
        let state = board.wait_for(index + 1, "ended", |state| state.has(Status::ENDED));
        assert!(state.has(Status::WATCHDOG_TRIPPED) && state.limp(), "{state:?}");
    }
}

/// A user who configures *hold* has something that must not fall. With this end state, the boards therefore hold after
/// sun2xp_stop_all too, with limited torque for a limited time.
#[test]
fn an_emergency_stop_releases_at_once_or_holds_for_a_while_as_configured() {
    let _turn = turn();
    for end_state in [EndState::Release, EndState::Hold] {
        let mut boards = three_boards();
        let mut configuration = on_boards(&boards);
        configuration.hand.end_state = end_state;
        (configuration.hand.hold_time_ms, configuration.hand.hold_torque_limit) = (1500, MOST_HELD);
        // The thread that reopens ports must not end a hold.
        configuration.fingers[1].reconnect = true;
        let hand = open(configuration);
        goes(&hand, 2, TARGET);
        stop_all();
        for (index, board) in boards.iter_mut().enumerate() {
            let state = board.wait_for(index + 1, "ended", |state| state.has(Status::ENDED));
            assert!(!state.has(Status::WATCHDOG_TRIPPED), "left to the watchdog: {state:?}");
            match end_state {
                EndState::Release => assert!(!holds(&state) && state.limp(), "{state:?}"),
                EndState::Hold => assert!(holds(&state), "{state:?}"),
                other => panic!("no expectation for {other:?}"),
            }
            if holds(&state) {
                assert_held_within_the_limit(&state);
            }
        }
        for (index, board) in boards.iter_mut().enumerate() {
            let state = board.wait_for(index + 1, "released", |state| !holds(state));
            let [now, _, ended] = state.times[..] else { panic!("three times") };
            assert!(state.limp() && (end_state == EndState::Release || now - ended >= 1499.0), "{state:?}");
        }
    }
}

#[test]
fn the_documentation_says_what_an_emergency_stop_holds() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |file: &str| std::fs::read_to_string(root.join(file)).expect("a text");
    let after = |text: &str, begin: &str, end: &str| {
        let from = text.split_once(begin).unwrap_or_else(|| panic!("no {begin:?}")).1;
        from.split_once(end).unwrap_or_else(|| panic!("no {end:?}")).0.to_owned()
    };
    for (place, text) in [
        (
            "the manual of sun2xp_stop_all",
            after(&read("include/sun2xp.h"), "sun2xp_stop_all - emergency stop", "Threads:"),
        ),
        (
            "docs/sun2xp.toml",
            after(&read("docs/sun2xp.toml"), "# What the motors do when commands stop", "hold_time_ms ="),
        ),
        ("docs/faults.md", after(&read("docs/faults.md"), "## Stopping and recovering", "## All faults")),
    ] {
        assert!(text.contains("sun2xp_stop_all") && text.contains("hold_time_ms"), "{place}: {text}");
    }
}
