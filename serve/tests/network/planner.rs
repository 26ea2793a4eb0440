//! A planner in a process of its own, which a test can stop, continue and kill. It is this program, started again.

use super::line::Line;
use super::served::remote;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use sun2xp_remote_client::{FingerCommand, RemoteHand};

/// Environment variables of the planner: its configuration, and what it does.
const CONFIGURATION: &str = "SUN2XP_TEST_REMOTE";
const MOTION: &str = "SUN2XP_TEST_MOTION";

/// Kx of the planner, N/cm. No finger has it before the planner has commanded it.
pub const STIFF: f64 = 2.5;

/// Longest time until the hand is open.
const OPENS: Duration = Duration::from_secs(10);

/// Interval between two set points.
pub const INTERVAL: Duration = Duration::from_millis(10);

/// What the planner does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Joint 1 of every finger swings slowly.
    Swing,
    /// Joint 1 of every finger closes in equal steps, and stays.
    Ramp,
    /// Nothing moves. The planner reads the hand, and does not own it.
    Watch,
}

/// The middle of the swing and its amplitude, rad, and its angular frequency, rad/s.
const MIDDLE: [f64; 3] = [0.0, 0.6, 0.9];
const AMPLITUDE: f64 = 0.15;
const ANGULAR_VELOCITY: f64 = 3.0;

/// Time that the planner waits at the beginning of the ramp.
const RAMP_WAITS: Duration = Duration::from_secs(2);

/// First angle of the ramp, its step, rad, and the number of its steps.
pub const RAMP_BEGIN: f64 = 0.4;
pub const RAMP_STEP: f64 = 0.001;
pub const RAMP_STEPS: u32 = 500;

impl Motion {
    /// Returns the set point at a time after the beginning.
    fn set_point(self, time: Duration) -> [f64; 3] {
        let angle = match self {
            Self::Watch => MIDDLE[1],
            Self::Swing => MIDDLE[1] + AMPLITUDE * (ANGULAR_VELOCITY * time.as_secs_f64()).sin(),
            Self::Ramp => {
                let step = (time.saturating_sub(RAMP_WAITS).as_millis() / INTERVAL.as_millis()) as u32;
                RAMP_BEGIN + RAMP_STEP * f64::from(step.min(RAMP_STEPS))
            }
        };
        [MIDDLE[0], angle, MIDDLE[2]]
    }
}

/// The process of a planner. Dropping this value kills the process.
pub struct Planner {
    process: Child,
}

impl Planner {
    /// Starts a planner at the right end of the line. Returns when the planner has sent its first set point. With
    /// [`Motion::Watch`], returns when the planner has connected to the hand.
    pub fn start(line: &Line, configuration: &str, motion: Motion) -> Self {
        line.right.run(|| Self::start_here(configuration, motion))
    }

    /// Like [`Planner::start`], in the network namespace of this thread.
    pub fn start_here(configuration: &str, motion: Motion) -> Self {
        let mut planner = Command::new(std::env::current_exe().expect("the path of this program"));
        planner.args(["--exact", "planner::planner_process", "--include-ignored", "--nocapture"]);
        planner.env(CONFIGURATION, configuration).env(MOTION, format!("{motion:?}"));
        planner.stdin(Stdio::null()).stdout(Stdio::piped());
        let mut process = planner.spawn().expect("this program");
        let mut lines = BufReader::new(process.stdout.take().expect("a pipe")).lines().map_while(Result::ok);
        let planner = Self { process };
        let mut said = Vec::new();
        while !said.last().is_some_and(|line: &String| line.contains("planner moves")) {
            said.push(lines.next().unwrap_or_else(|| panic!("the planner has ended: {said:?}")));
        }
        // A thread reads what the planner prints later, so that the planner never waits at a full pipe.
        std::thread::spawn(move || lines.for_each(drop));
        planner
    }

    /// Sends a signal to the process.
    #[allow(unsafe_code, reason = "a system call")]
    pub fn signal(&self, signal: i32) {
        // SAFETY: the process is a child that has not been waited for, so the number is its own.
        assert_eq!(unsafe { libc::kill(self.process.id() as i32, signal) }, 0);
    }
}

impl Drop for Planner {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// Reads the hand until this process is killed.
fn watch(configuration: &str) {
    let _hand = RemoteHand::watch(&remote(configuration)).unwrap_or_else(|error| panic!("{error}"));
    println!("planner moves nothing");
    let _ = std::io::stdout().flush();
    loop {
        std::thread::park();
    }
}

/// Opens the hand. On a busy machine, a new connection may not give an answer yet. Then the function tries again.
fn opened(configuration: &str) -> RemoteHand {
    let deadline = Instant::now() + OPENS;
    loop {
        match RemoteHand::open(&remote(configuration)) {
            Ok(hand) => return hand,
            Err(error) => assert!(Instant::now() < deadline, "{error}"),
        }
        std::thread::sleep(INTERVAL);
    }
}

/// Moves the hand until this process is killed or has lost the hand.
fn run(configuration: &str, motion: Motion) {
    let hand = opened(configuration);
    let stiffness = [[STIFF, 0.0, 0.0], [0.0, STIFF, 0.0], [0.0, 0.0, STIFF]];
    let begin = Instant::now();
    for number in 0_u32.. {
        let time = INTERVAL * number;
        let set_point = motion.set_point(time);
        let commands = [1, 2, 3].map(|finger| FingerCommand::new(finger).joints(set_point).stiffness(stiffness));
        // While the line is silent, calls are refused. The planner goes on until it has lost the hand.
        if let Err(error) = hand.send_group(&commands)
            && !hand.is_owner()
        {
            // The write may fail, because perhaps nobody reads the output any more.
            let _ = writeln!(std::io::stdout(), "planner ends: {error}");
            return;
        }
        if number == 0 {
            println!("planner moves");
            let _ = std::io::stdout().flush();
        }
        // Each set point has a fixed time after `begin`, even if earlier calls took long. The tests measure what the
        // hand does, and not what the planner does.
        std::thread::sleep((begin + time + INTERVAL).saturating_duration_since(Instant::now()));
    }
}

/// If this process was started as a planner, runs the planner, and returns true when the planner has ended. The process
/// then has to end. Otherwise returns false.
pub fn ran() -> bool {
    let Ok(configuration) = std::env::var(CONFIGURATION) else { return false };
    match std::env::var(MOTION).as_deref() {
        Ok("Swing") => run(&configuration, Motion::Swing),
        Ok("Ramp") => run(&configuration, Motion::Ramp),
        Ok("Watch") => watch(&configuration),
        other => panic!("{MOTION} is {other:?}"),
    }
    true
}

#[test]
#[ignore = "the program of the planner, which other tests start"]
fn planner_process() {
    assert!(ran(), "another test starts this one");
}
