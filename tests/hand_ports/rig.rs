//! Board programs, and hands that are configured for their ports.

use crate::settling::{Settling, distance};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command as Program, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use sun2xp::board::protocol::Status;
use sun2xp::hand::Hand;
use sun2xp::model::configuration::Configuration;

/// A pose that differs from [`START`] in every joint, rad.
pub const TARGET: [f64; 3] = [0.2, 0.6, 1.1];

/// The start pose of the simulated fingers, rad.
pub const START: [f64; 3] = [0.0, 30.0 * std::f64::consts::PI / 180.0, 60.0 * std::f64::consts::PI / 180.0];

/// Time limit of a wait. It is longer than any wait of a test should take on a busy machine.
const LIMIT: Duration = Duration::from_secs(20);

/// Allows one hand at a time, because the servos and boards of two hands would delay each other. The guard must be kept
/// for the length of the test.
pub fn turn() -> MutexGuard<'static, ()> {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    crate::pauses::name_pauses();
    // The lock is poisoned if an earlier test has failed. That test has left nothing behind, so the lock is used.
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Options of a board whose host sends 500 commands a second, as in [`on_ports`]. While a busy machine delays these
/// commands, the board's fingers stand still.
pub const PATIENT: [&str; 2] = ["--patient", "500"];

/// The program `sun2xp board` and its standard streams.
pub struct Board {
    process: Child,
    orders: ChildStdin,
    answers: BufReader<ChildStdout>,
    pub port: String,
}

/// The answer to `state`.
#[derive(Debug)]
pub struct State {
    /// rad.
    pub joints: Vec<f64>,
    /// N.
    pub tensions: Vec<f64>,
    /// N cm.
    pub torques: Vec<f64>,
    /// Times on the board's clock, ms: the present time, the arrival of the last Command that was obeyed, and the
    /// beginning of the end state. NaN stands for an event that has not occurred since the last Configure.
    pub times: Vec<f64>,
    pub status: Status,
}

impl Board {
    /// Starts a board with these fingers. It gets the priority and the patience of the library's simulated boards.
    pub fn start(fingers: &[&str]) -> Self {
        Self::start_with(&PATIENT, fingers)
    }

    /// Does the same as [`Board::start`], and makes a symbolic link to the port.
    pub fn start_at(link: &str, fingers: &[&str]) -> Self {
        Self::start_with(&[&PATIENT[..], &["--link", link]].concat(), fingers)
    }

    /// Starts a board whose simulation continues in real time while no commands arrive.
    pub fn start_impatient(fingers: &[&str]) -> Self {
        Self::start_with(&[], fingers)
    }

    pub fn start_with(options: &[&str], fingers: &[&str]) -> Self {
        let mut program = Program::new(crate::c::tool());
        program
            .args(["board", "--priority", "20"])
            .args(options)
            .args(fingers.iter().flat_map(|finger| ["--finger", finger]));
        let mut process = program.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("a board");
        let orders = process.stdin.take().expect("its input");
        let mut answers = BufReader::new(process.stdout.take().expect("its output"));
        let port = line(&mut answers);
        Self { process, orders, answers, port }
    }

    /// The process number.
    pub fn process(&self) -> u32 {
        self.process.id()
    }

    pub fn order(&mut self, order: &str) {
        assert_eq!(self.ask(order), "ok", "{order}");
    }

    pub fn state(&mut self, finger: usize) -> State {
        let answer = self.ask(&format!("state {finger}"));
        let numbers = |name: &str, count: usize| {
            let words = answer.split_whitespace().skip_while(|&word| word != name).skip(1);
            let numbers: Vec<f64> = words.take(count).map(|word| word.parse().expect("a number")).collect();
            assert_eq!(numbers.len(), count, "{answer}");
            numbers
        };
        let status = answer.rsplit_once("status 0x").expect("a status").1;
        State {
            joints: numbers("joints", 3),
            tensions: numbers("tensions", 4),
            torques: numbers("torques", 4),
            times: numbers("times", 3),
            status: Status(u16::from_str_radix(status, 16).expect("bits")),
        }
    }

    /// Queries the state of a finger until the condition holds.
    pub fn wait_for(&mut self, finger: usize, what: &str, wanted: impl Fn(&State) -> bool) -> State {
        let begun = Instant::now();
        loop {
            let state = self.state(finger);
            if wanted(&state) {
                return state;
            }
            assert!(begun.elapsed() < LIMIT, "finger {finger}: not {what}: {state:?}");
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// Kills the board with SIGKILL.
    pub fn kill(&mut self) {
        self.process.kill().expect("killed");
        self.process.wait().expect("gone");
    }

    /// Sends SIGSTOP or SIGCONT. The port of a stopped board stays open, but nothing answers.
    pub fn signal(&self, signal: libc::c_int) {
        // SAFETY: the process has not been waited for, so the number is still its own.
        assert_eq!(unsafe { libc::kill(self.process.id() as libc::pid_t, signal) }, 0);
    }

    fn ask(&mut self, order: &str) -> String {
        writeln!(self.orders, "{order}").expect("an order");
        line(&mut self.answers)
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl State {
    pub fn has(&self, bits: Status) -> bool {
        self.status.has(bits)
    }

    pub fn limp(&self) -> bool {
        self.torques.iter().all(|&torque| torque == 0.0)
    }
}

fn line(answers: &mut BufReader<ChildStdout>) -> String {
    let mut line = String::new();
    answers.read_line(&mut line).expect("an answer");
    line.trim_end().to_owned()
}

/// Three boards with one finger each.
pub fn three_boards() -> [Board; 3] {
    ["1", "2", "3"].map(|finger| Board::start(&[finger]))
}

/// The configuration of a hand on these ports. A busy machine delays the bytes of a pseudo-terminal by some ms, and
/// occasionally by many. So periods are twice the default, and watchdogs are as long as possible. Set points move
/// slowly, so that a finger does not run far while the servo receives nothing.
pub fn on_ports(ports: [&str; 3]) -> Configuration {
    let mut configuration = Configuration::default();
    (configuration.hand.rate, configuration.hand.watchdog_ms) = (500.0, 1000);
    configuration.hand.open_timeout_ms = 20_000;
    for (finger, port) in configuration.fingers.iter_mut().zip(ports) {
        finger.port = port.into();
        finger.controller.set_point_speed = Some(1.0);
    }
    configuration
}

/// The configuration of a hand on the ports of three boards.
pub fn on_boards(boards: &[Board; 3]) -> Configuration {
    on_ports(boards.each_ref().map(|board| board.port.as_str()))
}

/// The configuration of a hand whose three fingers share a port, and therefore a thread.
pub fn on_one_port(port: &str, baud: u32) -> Configuration {
    let mut configuration = on_ports([port; 3]);
    for finger in &mut configuration.fingers {
        (finger.baud, finger.thread) = (baud, 1);
    }
    configuration
}

pub fn open(configuration: Configuration) -> Hand {
    Hand::open(configuration).unwrap_or_else(|error| panic!("open: {error}"))
}

/// Returns how far a finger is from `target`: the largest difference of a joint angle, rad.
pub fn farthest(hand: &Hand, finger: i32, target: [f64; 3]) -> f64 {
    let position = hand.position(finger).unwrap_or_else(|error| panic!("finger {finger}: {error}"));
    distance(position, target)
}

/// Sends a finger to a pose and waits until it has been within 0.02 rad for 100 ms.
pub fn goes(hand: &Hand, finger: i32, target: [f64; 3]) {
    hand.send_position(finger, target).unwrap_or_else(|error| panic!("finger {finger}: {error}"));
    settles(hand, finger, target);
}

/// Waits until a finger has been within 0.02 rad of `target` for 100 ms.
pub fn settles(hand: &Hand, finger: i32, target: [f64; 3]) {
    let settling = Settling { tolerance: 0.02, rest: Duration::from_millis(100), patience: LIMIT };
    if let Err(error) = settling.wait(hand, &[(finger, target)]) {
        panic!("finger {finger} does not settle: {error}; {:?}", hand.report(finger));
    }
}

/// Waits until a condition holds.
pub fn wait_until(what: &str, mut wanted: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !wanted() {
        assert!(begun.elapsed() < LIMIT, "not {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Closes a hand. If that never ends, the test fails instead of hanging.
pub fn close(hand: Hand) {
    let (closed, receiver) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        hand.close();
        closed.send(())
    });
    receiver.recv_timeout(LIMIT).expect("the hand closes");
}

/// Writes a configuration file with the values of [`on_ports`], and more keys of `[hand]`.
pub fn write_configuration(file: &Path, boards: &[Board; 3], hand: &str) {
    let mut text = format!(
        "[hand]\nrate = 500\nwatchdog_ms = 1000\nopen_timeout_ms = 20000\n\
         {hand}[finger.controller]\nset_point_speed = 1.0\n"
    );
    for (index, board) in boards.iter().enumerate() {
        text += &format!("[finger.{}]\nport = '{}'\n", index + 1, board.port);
    }
    std::fs::write(file, text).expect("written");
}
