//! Measures, with the boards' own clocks, how long the motors keep running after a SIGKILL of the planner.

use crate::attempts::attempts;
use crate::c::{Bench, STRICT, c_compiler};
use crate::pauses::{Part, PauseWatch};
use crate::rig::{Board, State, turn};
use std::fmt::Write;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use sun2xp::board::protocol::Status;

/// Shortest pause of the machine that excuses a failed attempt: two periods less than the watchdog's 18 ms. The servo
/// stops a finger one period before the watchdog would, and this limit is one more period shorter.
const TOLERATED_PAUSE: Duration = Duration::from_millis(16);

/// Longest time to the motors' end state, ms, from the kill and from the last command.
const WITHIN: f64 = 20.0;

struct Planner(Child);

impl Planner {
    /// A C planner that sends every finger to a pose and waits.
    fn start(folder: &Path, program: &Path, boards: &[Board; 3], hand: &str) -> Self {
        let mut configuration = format!("[hand]\n{hand}");
        for (index, board) in boards.iter().enumerate() {
            write!(configuration, "[finger.{}]\nport = '{}'\n", index + 1, board.port).expect("a text");
        }
        let file = folder.join("sun2xp.toml");
        fs::write(&file, configuration).expect("written");
        let mut planner = Command::new(program);
        planner.arg("wait").env("SUN2XP_CONFIG", file).stdout(Stdio::piped()).stderr(Stdio::null());
        Self(planner.spawn().expect("a planner"))
    }

    /// Waits until every finger has arrived. Returns an error if one has faulted.
    fn arrives(&mut self) -> Result<(), String> {
        let mut line = String::new();
        let output = self.0.stdout.take().expect("its output");
        BufReader::new(output).read_line(&mut line).expect("a line");
        if line == "there\n" { Ok(()) } else { Err(format!("the planner's fingers are not there: {line:?}")) }
    }
}

impl Drop for Planner {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Kills the planner of three boards while all its fingers run. Returns for each finger the ms from its last command to
/// its end state, and an upper bound of the ms from the end of the planner to this end state.
fn kill_planner(
    mut planner: Planner,
    boards: &mut [Board; 3],
    in_end_state: impl Fn(&State) -> bool,
) -> Result<[(f64, f64); 3], String> {
    planner.arrives()?;
    let asked = [0, 1, 2].map(|index: usize| (boards[index].state(index + 1), Instant::now()));
    // Dropping the planner kills it and waits for its end.
    drop(planner);
    let killed = Instant::now();
    if !asked.iter().all(|(state, _)| state.has(Status::ENABLED)) {
        return Err(format!("a finger has stopped before the planner was killed: {asked:?}"));
    }
    let mut figures = [(0.0, 0.0); 3];
    for (index, (asked, at)) in asked.iter().enumerate() {
        let state = boards[index].wait_for(index + 1, "ended", |state| state.has(Status::ENDED));
        if !(state.has(Status::WATCHDOG_TRIPPED) && in_end_state(&state)) {
            return Err(format!("not in its end state by its watchdog: {state:?}"));
        }
        let [_, commanded, ended] = state.times[..] else { panic!("three times") };
        let before = 1e3 * (killed - *at).as_secs_f64();
        figures[index] = (ended - commanded, ended - asked.times[0] - before);
    }
    Ok(figures)
}

/// `SUN2XP_ROUNDS=20 cargo test --test hand_ports the_watchdogs_time -- --nocapture` runs more rounds.
#[test]
fn a_killed_planners_motors_are_in_their_end_state_after_the_watchdogs_time() {
    let _turn = turn();
    let rounds = std::env::var("SUN2XP_ROUNDS").map_or(1, |rounds| rounds.parse().expect("a number"));
    let bench = Bench::new();
    let program = bench.build(c_compiler(), STRICT, &["goes.c"]);
    let strongest = |state: &State| state.torques.iter().fold(0.0f64, |most, torque| most.max(torque.abs()));
    let hold = "end_state = 'hold'\nhold_time_ms = 1500\nhold_torque_limit = 0.2\n";
    for (name, keys) in [("release", ""), ("hold", hold)] {
        let in_end_state = |state: &State| match name {
            "release" => state.limp(),
            _ => state.has(Status::HOLDING) && strongest(state) > 0.1 && strongest(state) <= 0.2,
        };
        let mut boards = ["1", "2", "3"].map(|finger| Board::start_impatient(&[finger]));
        let mut attempt = |watch: &PauseWatch| {
            boards.iter().for_each(|board| watch.also(board.process(), Part::Board));
            let planner = Planner::start(bench.path(), &program, &boards, keys);
            watch.also(planner.0.id(), Part::Servo);
            let figures = kill_planner(planner, &mut boards, in_end_state)?;
            let within = figures.iter().all(|figure| figure.0 <= WITHIN && figure.1 <= WITHIN);
            if within { Ok(figures) } else { Err(format!("{name}: {figures:?}")) }
        };
        let figures: Vec<_> = (0..rounds)
            .flat_map(|_| attempts(&format!("SIGKILL, {name}"), TOLERATED_PAUSE, &mut attempt).into_iter().flatten())
            .collect();
        let worst = |of: fn(&(f64, f64)) -> f64| figures.iter().map(of).fold(0.0, f64::max);
        println!(
            "{name}, {} fingers: end state at most {:.1} ms after the last command, and at most {:.1} ms after the \
             planner was gone",
            figures.len(),
            worst(|figure| figure.0),
            worst(|figure| figure.1)
        );
    }
}
