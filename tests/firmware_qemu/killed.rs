//! SIGKILL of a planner: the watchdog of the firmware brings the motors into their end state.

use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::Duration;

use crate::attempts::attempts;
use crate::machine::{Asked, Emulated, LM3S6965, Machine, STM32F405};
use crate::pauses::Part;
use crate::{PATIENCE, alone, configuration, wait_until};
use sun2xp::board::protocol::{Command, Status};
use sun2xp::board::{Link, OutgoingCommand};
use sun2xp::hand::Hand;
use sun2xp::realtime::now;

/// Name of the environment variable that makes this test program a planner. Its value is the ports with commas
/// between them, a line feed and the keys of `[hand]`.
const PLANNER: &str = "SUN2XP_TEST_PLANNER";

/// Opens a hand and holds it in its pose, until this process is killed.
fn plan(ports_and_keys: &str) -> ! {
    let (ports, keys) = ports_and_keys.split_once('\n').expect("ports and keys");
    let ports: Vec<PathBuf> = ports.split(',').map(PathBuf::from).collect();
    loop {
        // A pause of the machine may trip the short watchdog. The planner then opens the hand again.
        let Ok(hand) = Hand::open(configuration(&ports, keys)) else { continue };
        while hand.fingers().numbers().all(|finger| hand.position(finger).is_ok()) {
            std::thread::sleep(Duration::from_millis(1));
        }
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
            .stderr(Stdio::null())
            .spawn()
            .expect("the planner starts");
        Self(process)
    }

    /// Kills the planner with SIGKILL.
    fn kill(&mut self) {
        self.0.kill().expect("the planner is running");
        self.0.wait().expect("the planner is ours");
    }
}

impl Drop for Planner {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Returns whether the firmware reports that its watchdog ended all fingers. After a pause of the machine, the planner
/// may instead detect a fault and stop the fingers itself. The frames that stop them may reach the firmware after the
/// planner was killed.
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
    let ran = wait_until(PATIENCE / 2, || moved_on() && running());
    // The kill may take longer than the watchdog's time, so it is not checked afterwards that the fingers were running
    // until the kill. `ended_by_watchdog` detects a finger that the planner stopped itself.
    planner.kill();
    // Commands in transit still arrive. 400 ms after the last of them, the slowest watchdog has had time to trip.
    let long_ago = |asked: Asked| asked.now.saturating_sub(asked.arrived_at) > 400_000;
    assert!(wait_until(PATIENCE, || asked().all(long_ago)), "commands still arrive");
    let asked: Vec<Asked> = asked().collect();
    if !ran {
        return Err("the planner's fingers did not all run before it was killed".into());
    }
    if !ended_by_watchdog(machine) {
        return Err("a finger was not ended by its watchdog".into());
    }
    assert!(asked.iter().all(|asked| in_end_state(asked.currents)), "motors are not in their end state");
    // The planner sends a command after the end if it has not noticed yet that the finger was ended.
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

const WATCHDOG_MS: u32 = 18;

/// The watchdog's time minus two periods of 2 ms. The servo stops a finger one period before its watchdog does.
const TOLERATED_BY_WATCHDOG: Duration = Duration::from_millis(14);
