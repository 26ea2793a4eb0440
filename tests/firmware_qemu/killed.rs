//! SIGKILL of a planner: the watchdog of the firmware brings the motors into their end state.

use std::convert::Infallible;
use std::io::{Read, Write};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::Duration;

use crate::attempts::attempts;
use crate::machine::{Asked, Emulated, LM3S6965, Machine, STM32F405};
use crate::pauses::Part;
use crate::{KEYS, PATIENCE, TOLERATED_PAUSE, alone, configuration, text, wait_until};
use sun2xp::board::protocol::{Command, Status};
use sun2xp::board::{Link, OutgoingCommand};
use sun2xp::hand::{Hand, HandError};
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::now;

/// Name of the environment variable that makes this test program a planner. Its value consists of the ports, separated
/// by commas, then a line feed, and then the keys of `[hand]`.
const PLANNER: &str = "SUN2XP_TEST_PLANNER";

/// Opens a hand and holds it in its pose, until this process is killed. If that fails, prints the error and exits. The
/// planner does not try again, because every failure must be counted, and be explained by a pause of the machine.
fn plan(ports_and_keys: &str) -> ! {
    let (ports, keys) = ports_and_keys.split_once('\n').expect("ports and keys");
    let ports: Vec<PathBuf> = ports.split(',').map(PathBuf::from).collect();
    let Err(error) = hold(configuration(&ports, keys));
    // The output of the printing macros is captured in a test.
    let _ = writeln!(std::io::stderr(), "{error}");
    std::process::exit(1)
}

/// Opens a hand and holds it in its pose, until a finger faults.
fn hold(configuration: Configuration) -> Result<Infallible, HandError> {
    let hand = Hand::open(configuration)?;
    loop {
        hand.fingers().numbers().try_for_each(|finger| hand.position(finger).map(drop))?;
        std::thread::sleep(Duration::from_millis(1));
    }
}

struct Planner(Child);

impl Planner {
    fn start(machine: &Machine, keys: &str) -> Self {
        let ports: Vec<String> = machine.ports().iter().map(|port| port.display().to_string()).collect();
        let program = std::env::current_exe().expect("the test's own program");
        let process = std::process::Command::new(program)
            .args(["--exact", "killed::a_killed_planner_leaves_the_motors_in_their_end_state"])
            .env(PLANNER, format!("{}\n{keys}", ports.join(",")))
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the planner starts");
        Self(process)
    }

    fn has_ended(&mut self) -> bool {
        self.0.try_wait().expect("the planner is ours").is_some()
    }

    /// Kills the planner with SIGKILL. Returns an error with what the planner printed if it had already ended.
    fn kill(&mut self) -> Result<(), String> {
        self.0.kill().expect("the planner is ours");
        let status = self.0.wait().expect("the planner is ours");
        if status.signal() == Some(libc::SIGKILL) {
            return Ok(());
        }
        let mut printed = String::new();
        let output = self.0.stderr.as_mut().expect("the planner's output is a pipe");
        output.read_to_string(&mut printed).expect("the planner's output is text");
        Err(format!("the planner ended by itself, {status}: {}", printed.trim_end()))
    }
}

impl Drop for Planner {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Returns whether the firmware reports for every finger that the watchdog has tripped. After a pause of the machine,
/// the planner may instead detect a fault and stop the fingers itself. The frames that stop them may reach the firmware
/// after the planner was killed.
fn ended_by_watchdog(machine: &Machine) -> bool {
    let ports = machine.ports();
    let fingers_a_port = machine.fingers().len() / ports.len();
    let mut addresses = (1..).zip(machine.fingers());
    addresses.all(|(address, finger)| reports_watchdog(&ports[finger / fingers_a_port], address))
}

fn reports_watchdog(port: &Path, address: u8) -> bool {
    let mut link = Link::open(port, 1_000_000).expect("the port is free");
    // Discards what the killed planner did not read.
    while link.receive(now() + 100_000_000).expect("the port is there").is_some() {}
    let mut status = None;
    let answered = wait_until(PATIENCE, || {
        link.send(&[OutgoingCommand { address, sequence: 0, command: Command::default() }]).expect("the port is there");
        status = link.receive(now() + 100_000_000).expect("the port is there").map(|received| received.reply.status);
        status.is_some()
    });
    assert!(answered, "finger {address} does not report its state");
    status.is_some_and(|status| status.has(Status::WATCHDOG_TRIPPED))
}

/// Kills a planner. Returns a time for each finger, us of the firmware's clock: from the arrival of the planner's last
/// command until the watchdog set the currents.
fn kill_a_planner(
    machine: &Machine,
    planner: &mut Planner,
    in_end_state: impl Fn([i32; 4]) -> bool,
) -> Result<Vec<u32>, String> {
    let asked = || machine.fingers().map(|finger| machine.finger(finger).asked);
    let pulls = |currents: [i32; 4]| currents != [0; 4] && !in_end_state(currents);
    let running = || asked().all(|asked| pulls(asked.currents));
    let begun: Vec<u32> = asked().map(|asked| asked.samples).collect();
    let moved_on = || asked().zip(&begun).all(|(asked, begun)| asked.samples > begun + 200);
    let ran = wait_until(PATIENCE / 2, || planner.has_ended() || moved_on() && running());
    // The kill may take longer than the watchdog's time. So no check after the kill shows whether the fingers were
    // running until then. `ended_by_watchdog` detects a finger that the planner stopped itself.
    let killed = planner.kill();
    // Commands in transit still arrive. 400 ms after the last of them, the slowest watchdog has had time to trip.
    let long_ago = |asked: Asked| asked.now.saturating_sub(asked.arrived_at) > 400_000;
    assert!(wait_until(PATIENCE, || asked().all(long_ago)), "commands still arrive");
    let asked: Vec<Asked> = asked().collect();
    killed?;
    if !ran {
        return Err("the planner's fingers did not all run before it was killed".into());
    }
    if !ended_by_watchdog(machine) {
        return Err("a finger was not ended by its watchdog".into());
    }
    assert!(asked.iter().all(|asked| in_end_state(asked.currents)), "motors are not in their end state");
    // The planner may send a command after the watchdog of a finger has tripped, if it has not noticed this yet.
    let after = asked.iter().map(|asked| asked.set_at.checked_sub(asked.arrived_at));
    after.collect::<Option<_>>().ok_or_else(|| "a command came after the end".into())
}

#[test]
fn a_killed_planner_leaves_the_motors_in_their_end_state() {
    if let Ok(ports_and_keys) = std::env::var(PLANNER) {
        plan(&ports_and_keys);
    }
    motors_reach_their_end_state(LM3S6965);
}

#[test]
fn a_killed_planner_leaves_the_motors_of_the_stm32f405_in_their_end_state() {
    motors_reach_their_end_state(STM32F405);
}

fn motors_reach_their_end_state(emulated: Emulated) {
    let Some(_alone) = alone() else { return };
    let folder = tempfile::tempdir().expect("a scratch folder");
    emulated.build(folder.path());
    let machine = Machine::start(emulated, folder.path());
    translate_firmware(emulated, &machine);
    let none = |currents: [i32; 4]| currents == [0; 4];
    // 0.1 N cm over 2.34 N cm/A is 42 735 uA. The minimum tension of a tendon needs more.
    let held = |currents: [i32; 4]| !none(currents) && currents.iter().all(|current| current.abs() <= 42_736);
    let release = "end_state = \"release\"";
    let hold = "end_state = \"hold\"\nhold_torque_limit = 0.1\nhold_time_ms = 1500";
    for end_state in [release, hold] {
        let in_end_state = |currents| if end_state == hold { held(currents) } else { none(currents) };
        let keys = format!("rate = 500.0\nwatchdog_ms = {WATCHDOG_MS}\n{end_state}");
        attempts(
            &format!("SIGKILL on the firmware, {}, {end_state}", emulated.board),
            TOLERATED_BY_WATCHDOG,
            |watch| {
                let mut planner = Planner::start(&machine, &keys);
                watch.also(planner.0.id(), Part::Servo);
                for process in machine.processes() {
                    watch.also(process, Part::Board);
                }
                let figures = kill_a_planner(&machine, &mut planner, in_end_state)?;
                let found = format!("{figures:?} us from the last command to the end state");
                println!("{found}");
                let expected = 1000 * WATCHDOG_MS..1000 * WATCHDOG_MS + 2000;
                if figures.iter().all(|figure| expected.contains(figure)) { Ok(()) } else { Err(found) }
            },
        );
        let over = wait_until(PATIENCE, || machine.fingers().all(|finger| none(machine.finger(finger).asked.currents)));
        assert!(over, "the hold does not end");
    }
}

/// Opens a hand with a long watchdog, and closes it. The emulator translates each part of the firmware before it first
/// runs this part, and the translation may take longer than the short watchdog tolerates.
fn translate_firmware(emulated: Emulated, machine: &Machine) {
    let what = format!("the first hand on the firmware, {}", emulated.board);
    attempts(&what, TOLERATED_PAUSE, |watch| {
        for process in machine.processes() {
            watch.also(process, Part::Board);
        }
        Hand::open(configuration(&machine.ports(), KEYS)).map(Hand::close).map_err(text)
    });
}

const WATCHDOG_MS: u32 = 18;

/// The watchdog's time minus two periods of 2 ms. The servo stops a finger one period before its watchdog does.
const TOLERATED_BY_WATCHDOG: Duration = Duration::from_millis(14);
