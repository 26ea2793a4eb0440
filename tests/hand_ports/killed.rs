//! SIGKILL for a planner: how long its boards' motors go on, by the boards' own clocks.

use crate::c::{Bench, STRICT, c_compiler};
use crate::rig::{Board, State, turn};
use std::fmt::Write;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use sun2xp::board::protocol::Status;

/// A planner meets a watchdog of 18 ms where the machine pauses, and is then tried again.
const ATTEMPTS: u32 = 40;

/// Within so many ms of the kill, and of the last good reply, motors are to be in their end state.
const WITHIN: f64 = 20.0;

struct Planner(Child);

impl Planner {
    /// A C planner that has sent every finger somewhere, and waits; none where a finger has faulted.
    fn start(folder: &Path, program: &Path, boards: &[Board; 3], hand: &str) -> Option<Self> {
        let mut configuration = format!("[hand]\n{hand}");
        for (index, board) in boards.iter().enumerate() {
            write!(configuration, "[finger.{}]\nport = '{}'\n", index + 1, board.port).expect("a text");
        }
        let file = folder.join("sun2xp.toml");
        fs::write(&file, configuration).expect("written");
        let mut planner = Command::new(program);
        planner.arg("wait").env("SUN2XP_CONFIG", file).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut planner = Self(planner.spawn().expect("a planner"));
        let mut line = String::new();
        let output = planner.0.stdout.take().expect("its output");
        BufReader::new(output).read_line(&mut line).expect("a line");
        (line == "there\n").then_some(planner)
    }
}

impl Drop for Planner {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Kills planners of three boards until it has happened `rounds` times to one whose fingers all ran. Of each finger: ms from
/// its last command, and at most from the kill, to its end state.
fn kill_planners(
    start: impl Fn(&[Board; 3]) -> Option<Planner>,
    rounds: usize,
    in_end_state: impl Fn(&State) -> bool,
) -> Vec<(f64, f64)> {
    let mut boards = ["1", "2", "3"].map(|finger| Board::start_impatient(&[finger]));
    let mut figures = Vec::new();
    for _ in 0..ATTEMPTS {
        let Some(planner) = start(&boards) else { continue };
        let asked = [0, 1, 2].map(|index: usize| boards[index].state(index + 1));
        // It is killed and waited for.
        drop(planner);
        if !asked.iter().all(|state| state.has(Status::ENABLED)) {
            continue;
        }
        for (index, asked) in asked.iter().enumerate() {
            let state = boards[index].wait_for(index + 1, "ended", |state| state.has(Status::ENDED));
            assert!(state.has(Status::WATCHDOG_TRIPPED) && in_end_state(&state), "{state:?}");
            let [_, commanded, ended] = state.times[..] else { panic!("three times") };
            figures.push((ended - commanded, ended - asked.times[0]));
        }
        if figures.len() >= 3 * rounds {
            break;
        }
    }
    figures
}

/// `SUN2XP_ROUNDS=20 cargo test --test hand_ports the_watchdogs_time -- --nocapture` for more rounds.
#[test]
fn a_killed_planners_motors_are_in_their_end_state_after_the_watchdogs_time() {
    let _turn = turn();
    let rounds = std::env::var("SUN2XP_ROUNDS").map_or(1, |rounds| rounds.parse().expect("a number"));
    let bench = Bench::new();
    let program = bench.build(c_compiler(), STRICT, &["goes.c"]);
    let strongest = |state: &State| state.torques.iter().fold(0.0f64, |most, torque| most.max(torque.abs()));
    let hold = "end_state = 'hold'\nhold_time_ms = 1500\nhold_torque_limit = 0.2\n";
    for (name, keys) in [("release", ""), ("hold", hold)] {
        let start = |boards: &[Board; 3]| Planner::start(bench.path(), &program, boards, keys);
        let figures = kill_planners(start, rounds, |state| match name {
            "release" => state.limp(),
            _ => state.has(Status::HOLDING) && strongest(state) > 0.1 && strongest(state) <= 0.2,
        });
        assert!(!figures.is_empty(), "{name}: no planner's fingers all ran on this machine");
        let worst = |of: fn(&(f64, f64)) -> f64| figures.iter().map(of).fold(0.0, f64::max);
        let least = figures.iter().map(|figure| figure.1).fold(f64::INFINITY, f64::min);
        println!(
            "{name}, {} fingers: end state {:.1} ms after the last command at worst, {least:.1} to {:.1} ms after the kill",
            figures.len(),
            worst(|figure| figure.0),
            worst(|figure| figure.1)
        );
        // By the board's own clock the machine has no say in the first; the second counts how long asking and killing took.
        assert!(worst(|figure| figure.0) <= WITHIN && least <= WITHIN, "{name}: {figures:?}");
    }
}
