//! A case: the stage of a hand, and what the threads of its planner do at the same time.

use crate::planners::{InC, InRust, Planner};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::fs::read_dir;
use std::thread;
use std::time::{Duration, Instant};

/// Longest time in which a hand reaches a stage on a busy machine.
const PATIENCE: Duration = Duration::from_secs(30);

/// Stage of finger 1 when the threads begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stage {
    /// OpenHand runs at the same time.
    Opening,
    Running,
    Limp,
    Calibrating,
    Faulted,
    Recovering,
    /// CloseHand, or a drop of the Hand, runs at the same time.
    Closing,
}

/// The call of a thread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    Open,
    Calibrate,
    Recover,
    /// CloseHand, or a drop of the Hand.
    Close,
    /// CloseHand in a callback for events.
    CloseInCallback,
    /// Hand::end.
    End,
    Exit,
    StopAll,
    WaitForEvent,
    WaitForFinger,
}

/// Stages and ways to shut down for a planner that uses the C calls.
const IN_C: ([Stage; 6], [Action; 3]) = (
    [Stage::Opening, Stage::Running, Stage::Calibrating, Stage::Faulted, Stage::Recovering, Stage::Closing],
    [Action::Close, Action::CloseInCallback, Action::Exit],
);

/// Stages and ways to shut down for a planner in Rust.
const IN_RUST: ([Stage; 6], [Action; 2]) = (
    [Stage::Running, Stage::Limp, Stage::Calibrating, Stage::Faulted, Stage::Recovering, Stage::Closing],
    [Action::Close, Action::End],
);

/// Number of combinations of a stage and a way to shut down.
pub const COMBINATIONS: usize = IN_C.0.len() * IN_C.1.len() + IN_RUST.0.len() * IN_RUST.1.len();

#[derive(Debug)]
pub struct Case {
    /// Whether the planner uses the C calls.
    in_c: bool,
    /// Whether one servo thread serves all fingers.
    one_servo: bool,
    stage: Stage,
    /// What each thread does, and the delay before it.
    threads: Vec<(Action, Duration)>,
}

struct Dice(Pcg64);

impl Dice {
    /// 0 to `sides` - 1.
    fn throw(&mut self, sides: u64) -> usize {
        ((self.0.next_u64() >> 16) % sides) as usize
    }

    fn chance(&mut self) -> bool {
        self.throw(2) == 0
    }

    /// Up to half a second. Delays of each order of magnitude are equally frequent.
    fn delay(&mut self) -> Duration {
        let longest = 1 << (4 + self.throw(16));
        Duration::from_micros(self.throw(longest) as u64)
    }
}

impl Case {
    /// The case with this number in the run with this seed.
    pub fn random(seed: u64, number: u64) -> Self {
        let mut dice = Dice(Pcg64::seed_from_u64(seed.wrapping_mul(1000).wrapping_add(number)));
        let number = number as usize % COMBINATIONS;
        let rust = number.checked_sub(IN_C.0.len() * IN_C.1.len());
        let (stage, endings) = match rust {
            None => (IN_C.0[number % IN_C.0.len()], IN_C.1.as_slice()),
            Some(rust) => (IN_RUST.0[rust % IN_RUST.0.len()], IN_RUST.1.as_slice()),
        };
        let ending = endings[rust.unwrap_or(number) / IN_C.0.len()];
        let mut threads = match stage {
            Stage::Opening => vec![(Action::Open, Duration::ZERO)],
            Stage::Calibrating => vec![(Action::Calibrate, Duration::ZERO)],
            Stage::Recovering => vec![(Action::Recover, Duration::ZERO)],
            Stage::Closing => vec![(Action::Close, Duration::ZERO)],
            Stage::Running | Stage::Limp | Stage::Faulted => vec![],
        };
        threads.push((ending, dice.delay()));
        if dice.chance() {
            threads.push((endings[dice.throw(endings.len() as u64)], dice.delay()));
        }
        for beside in [Action::StopAll, Action::WaitForEvent, Action::WaitForFinger] {
            if dice.chance() {
                threads.push((beside, dice.delay()));
            }
        }
        Self { in_c: rust.is_none(), one_servo: dice.chance(), stage, threads }
    }

    /// Whether the process of the case ends with exit.
    pub fn exits(&self) -> bool {
        self.threads.iter().any(|(action, _)| *action == Action::Exit)
    }

    /// The text of the configuration file.
    pub fn configuration(&self) -> String {
        let thread = u8::from(self.one_servo);
        format!(
            "[hand]\nrate = 500\nopen_timeout_ms = 20000\nprint_refusals = false\n\
             [finger]\nport = 'simulated'\nthread = {thread}\n[finger.zeroing]\nmethod = 'pose'\n"
        )
    }

    /// Runs the case in this process.
    ///
    /// # Panics
    /// Panics if the hand does not reach the stage, or if threads of the library remain.
    pub fn run(&self) {
        let tasks_before = tasks();
        let (in_c, in_rust) = (InC, InRust::default());
        let planner: &dyn Planner = if self.in_c { &in_c } else { &in_rust };
        if self.stage != Stage::Opening {
            assert!(planner.open(self.stage == Stage::Limp), "the hand opens");
        }
        if matches!(self.stage, Stage::Faulted | Stage::Recovering) {
            planner.stop_all();
            reach(planner, Stage::Faulted);
        }
        thread::scope(|scope| {
            let mut threads = Vec::new();
            for &(action, delay) in &self.threads {
                let body = move || {
                    thread::sleep(delay);
                    planner.act(action);
                };
                threads.push((action, scope.spawn(body)));
                if matches!(action, Action::Calibrate | Action::Recover) {
                    reach(planner, self.stage);
                }
            }
            // Threads that calibrate or wait may end only when the hand is closed. So the scope joins them after the
            // close.
            let ends = |action| !matches!(action, Action::Calibrate | Action::WaitForEvent | Action::WaitForFinger);
            for (_, thread) in threads.into_iter().filter(|(action, _)| ends(*action)) {
                thread.join().expect("no panic");
            }
            planner.act(Action::Close);
        });
        let limit = Instant::now() + PATIENCE;
        // A thread disappears from the list a moment after it was joined.
        while tasks() > tasks_before {
            assert!(Instant::now() < limit, "{} threads remain, {tasks_before} were there before", tasks());
            thread::sleep(Duration::from_millis(1));
        }
    }
}

/// Waits until finger 1 is in this stage.
fn reach(planner: &dyn Planner, stage: Stage) {
    let limit = Instant::now() + PATIENCE;
    while planner.stage() != Some(stage) {
        assert!(Instant::now() < limit, "not {stage:?} but {:?}", planner.stage());
        thread::sleep(Duration::from_millis(1));
    }
}

/// Number of threads of this process.
fn tasks() -> usize {
    read_dir("/proc/self/task").expect("the list of threads").count()
}
