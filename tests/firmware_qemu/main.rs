//! Tests the library against the reference firmware on an emulated Cortex-M3. This runs the protocol core, which
//! laboratories port to their boards, as compiled for a microcontroller, with its own interrupts and its own time.

#[path = "../common/attempts.rs"]
mod attempts;
mod machine;
#[allow(dead_code)]
#[path = "../common/pauses.rs"]
mod pauses;
#[path = "../common/priority.rs"]
mod priority;
#[path = "../common/settling.rs"]
mod settling;
#[allow(dead_code)]
#[path = "../common/tools.rs"]
mod tools;
mod touch;

use attempts::attempts;
use machine::{Asked, Machine, build};
use pauses::Part;
use settling::{Settling, distance};
use std::path::Path;
use std::process::{Child, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use sun2xp::board::protocol::{Command, Status};
use sun2xp::board::{Link, OutgoingCommand};
use sun2xp::finger::{FaultKind, Stage};
use sun2xp::hand::{Hand, HandError, read_configuration};
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::now;

/// Allows one emulator at a time, because two would compete for the processor. Returns `None` if the emulator or its
/// compiler is missing.
fn alone() -> Option<MutexGuard<'static, ()>> {
    static ONE: Mutex<()> = Mutex::new(());
    let usable = ["arm-none-eabi-gcc", "qemu-system-arm"].iter().all(|tool| tools::available(tool, "the whole test"));
    usable.then(|| ONE.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Returns the configuration of a hand on this port. `keys` are added to the table `[hand]`.
fn configuration(port: &Path, keys: &str) -> Configuration {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path().join("sun2xp.toml");
    // The fingers move in the emulated time, which is slow on a busy machine, so opening may take long.
    let text =
        format!("[hand]\nopen_timeout_ms = 60000\n{keys}\n[finger]\nthread = 1\nport = \"{}\"\n", port.display());
    std::fs::write(&path, text).expect("the configuration is written");
    read_configuration(&path).expect("the configuration is good")
}

const TARGETS: [[f64; 3]; 3] = [[0.1, 0.4, 0.9], [-0.1, 0.6, 1.1], [0.0, 0.7, 0.8]];

/// Largest distance of a finger from its target, rad.
const CLOSE: f64 = 0.02;

/// On a busy machine the finger moves more slowly than real time.
const PATIENCE: Duration = Duration::from_secs(60);

fn farthest(found: [[f64; 3]; 3], wanted: [[f64; 3]; 3]) -> f64 {
    found.into_iter().zip(wanted).map(|(is, wanted)| distance(is, wanted)).fold(0.0, f64::max)
}

fn text(error: HandError) -> String {
    error.to_string()
}

/// Sends all fingers to their targets, and returns their positions when they have been at rest for a while.
fn settled(hand: &Hand) -> Result<[[f64; 3]; 3], String> {
    for (finger, target) in (1..).zip(TARGETS) {
        hand.send_position(finger, target).map_err(text)?;
    }
    let settling = Settling { tolerance: CLOSE, rest: Duration::from_millis(500), patience: PATIENCE };
    settling.wait(hand, [(1, TARGETS[0]), (2, TARGETS[1]), (3, TARGETS[2])])
}

/// Opens a hand on the firmware and calls `work` with it. An attempt may fail, because a busy machine may slow the
/// emulator down too much. Every attempt starts a new emulator.
fn with_hand(what: &str, work: impl Fn(&Machine, &Hand) -> Result<(), String>) {
    with_configured_hand(what, KEYS, work);
}

/// Like [`with_hand`]. `keys` begin in the table `[hand]`, and are followed by the table `[finger]`.
fn with_configured_hand(what: &str, keys: &str, work: impl Fn(&Machine, &Hand) -> Result<(), String>) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let image = build(folder.path());
    attempts(what, TOLERATED_PAUSE, |watch| {
        let machine = Machine::start(&image);
        watch.also(machine.process(), Part::Board);
        let hand = Hand::open(configuration(&machine.port, keys)).map_err(text)?;
        work(&machine, &hand).map_err(|failure| {
            let losses = [1, 2, 3].map(|finger| hand.losses(finger).expect("a finger"));
            format!("{failure}; {losses:?}")
        })
    });
}

/// A hand must survive shorter pauses. A servo that receives nothing for 10 ms has faded its command to the torque of
/// the end state, and its controller restarts when replies arrive again (docs/architecture.md).
const TOLERATED_PAUSE: Duration = Duration::from_millis(50);

const KEYS: &str = "rate = 500.0\nwatchdog_ms = 1000";

#[test]
fn a_hand_settles_where_it_does_on_the_simulated_board() {
    let Some(_alone) = alone() else { return };
    let simulated = Hand::open(configuration(Path::new("simulated"), KEYS)).expect("simulated boards answer");
    let expected = settled(&simulated).expect("the simulated hand runs");
    with_hand("a hand on the firmware settles", |machine, hand| {
        let positions = settled(hand)?;
        let joints = [0, 1, 2].map(|finger| machine.finger(finger).plant.joints().into());
        let losses = hand.losses(1).map_err(text)?;
        let (from_simulated, from_truth) = (farthest(positions, expected), farthest(joints, expected));
        let found = format!(
            "{from_simulated:.4} rad from the simulated hand, {from_truth:.4} rad of it in truth, {} of {} replies \
             lost",
            losses.lost_replies, losses.cycles
        );
        println!("{found}");
        if from_simulated < CLOSE && from_truth < CLOSE { Ok(()) } else { Err(found) }
    });
}

#[test]
fn its_emergency_stop_stops_the_hand() {
    let Some(_alone) = alone() else { return };
    with_hand("an emergency stop on the firmware", |machine, hand| {
        assert_ne!(machine.finger(1).asked.currents, [0; 4]);
        machine.finger(1).faults = Status::EMERGENCY_STOP;
        let noticed = wait_until(PATIENCE, || matches!(hand.status(2).expect("a finger").stage, Stage::Faulted(_)));
        assert!(noticed, "the emergency stop was not noticed");
        match hand.position(2).expect_err("it is faulted") {
            HandError::Faulted { fault, .. } if fault.kind == FaultKind::EmergencyStopInput => {}
            error => return Err(text(error)),
        }
        assert_eq!(machine.finger(1).asked.currents, [0; 4]);
        // The fault input belongs to finger 2.
        [1, 3].into_iter().try_for_each(|finger| hand.position(finger).map(drop).map_err(text))
    });
}

/// Name of the environment variable that makes this test program a planner. Its value is the port, a line feed and the
/// keys of `[hand]`.
const PLANNER: &str = "SUN2XP_TEST_PLANNER";

/// Opens a hand and holds it in its pose, until this process is killed.
fn plan(port_and_keys: &str) -> ! {
    let (port, keys) = port_and_keys.split_once('\n').expect("a port and keys");
    loop {
        // A pause of the machine may trip the short watchdog. The planner then opens the hand again.
        let Ok(hand) = Hand::open(configuration(Path::new(port), keys)) else { continue };
        while (1..=3).all(|finger| hand.position(finger).is_ok()) {
            std::thread::sleep(Duration::from_millis(1));
        }
    }
}

struct Planner(Child);

impl Planner {
    fn start(machine: &Machine, keys: &str) -> Self {
        let program = std::env::current_exe().expect("the test's own program");
        let process = std::process::Command::new(program)
            .args(["--exact", "a_killed_planner_leaves_the_motors_in_their_end_state"])
            .env(PLANNER, format!("{}\n{keys}", machine.port.display()))
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

/// Waits until a condition holds. Returns false after `patience`.
fn wait_until(patience: Duration, mut holds: impl FnMut() -> bool) -> bool {
    let begin = Instant::now();
    while begin.elapsed() < patience {
        if holds() {
            return true;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    false
}

/// Returns whether the firmware reports that its watchdog ended all fingers. After a pause of the machine, the planner
/// may instead detect a fault and stop the fingers itself. Its frames may reach the firmware after the planner was
/// killed.
fn ended_by_watchdog(machine: &Machine) -> bool {
    let mut link = Link::open(&machine.port, 1_000_000).expect("the port is free");
    // Discards what the killed planner did not read.
    while link.receive(now() + 100_000_000).expect("the port is there").is_some() {}
    (1..=3).all(|address| {
        let mut status = None;
        let answered = wait_until(PATIENCE, || {
            link.send(&[OutgoingCommand { address, sequence: 0, command: Command::default() }])
                .expect("the port is there");
            status =
                link.receive(now() + 100_000_000).expect("the port is there").map(|received| received.reply.status);
            status.is_some()
        });
        assert!(answered, "finger {address} does not report its state");
        status.is_some_and(|status| status.has(Status::WATCHDOG_TRIPPED))
    })
}

/// Kills a planner. Returns the time from the arrival of its last command until the watchdog set the currents, for each
/// finger, us in the firmware's time.
fn kill_a_planner(
    machine: &Machine,
    planner: &mut Planner,
    in_end_state: impl Fn([i32; 4]) -> bool,
) -> Result<[u32; 3], String> {
    let pulls = |currents: [i32; 4]| currents != [0; 4] && !in_end_state(currents);
    let running = || (0..3).all(|finger| pulls(machine.finger(finger).asked.currents));
    let begun = [0, 1, 2].map(|finger| machine.finger(finger).asked.samples);
    let moved_on = || (0..3).all(|finger| machine.finger(finger).asked.samples > begun[finger] + 200);
    let ran = wait_until(PATIENCE / 2, || moved_on() && running());
    planner.kill();
    let ran = ran && running();
    // Commands in transit still arrive. 400 ms after the last of them, the slowest watchdog has had time to trip.
    let long_ago = |asked: Asked| asked.now.saturating_sub(asked.arrived_at) > 400_000;
    assert!(
        wait_until(PATIENCE, || (0..3).all(|finger| long_ago(machine.finger(finger).asked))),
        "commands still arrive"
    );
    let asked = [0, 1, 2].map(|finger| machine.finger(finger).asked);
    if !ran {
        return Err("the planner's fingers did not all run when it was killed".into());
    }
    if !ended_by_watchdog(machine) {
        return Err("a finger was not ended by its watchdog".into());
    }
    assert!(asked.iter().all(|asked| in_end_state(asked.currents)), "motors are not in their end state");
    match asked.map(|asked| asked.set_at.checked_sub(asked.arrived_at)) {
        [Some(one), Some(two), Some(three)] => Ok([one, two, three]),
        // The planner sent this command before it noticed that the finger had been ended.
        _ => Err("a command came after the end".into()),
    }
}

#[test]
fn a_killed_planner_leaves_the_motors_in_their_end_state() {
    if let Ok(port_and_keys) = std::env::var(PLANNER) {
        plan(&port_and_keys);
    }
    let Some(_alone) = alone() else { return };
    let folder = tempfile::tempdir().expect("a scratch folder");
    let machine = Machine::start(&build(folder.path()));
    let none = |currents: [i32; 4]| currents == [0; 4];
    // 0.1 N cm over 2.34 N cm/A is 42 735 uA. The minimum tension of a tendon needs more.
    let held = |currents: [i32; 4]| !none(currents) && currents.iter().all(|current| current.abs() <= 42_736);
    let release = "end_state = \"release\"";
    let hold = "end_state = \"hold\"\nhold_torque_limit = 0.1\nhold_time_ms = 1500";
    for end_state in [release, hold] {
        let in_end_state = |currents| if end_state == hold { held(currents) } else { none(currents) };
        let keys = format!("rate = 500.0\nwatchdog_ms = {WATCHDOG_MS}\n{end_state}");
        attempts(&format!("SIGKILL on the firmware, {end_state}"), TOLERATED_BY_WATCHDOG, |watch| {
            let mut planner = Planner::start(&machine, &keys);
            watch.also(planner.0.id(), Part::Servo);
            watch.also(machine.process(), Part::Board);
            let figures = kill_a_planner(&machine, &mut planner, in_end_state)?;
            let found = format!("{figures:?} us from the last command to the end state");
            println!("{found}");
            let expected = 1000 * WATCHDOG_MS..1000 * WATCHDOG_MS + 2000;
            if figures.iter().all(|figure| expected.contains(figure)) { Ok(()) } else { Err(found) }
        });
        let over = wait_until(PATIENCE, || (0..3).all(|finger| none(machine.finger(finger).asked.currents)));
        assert!(over, "the hold does not end");
    }
}

const WATCHDOG_MS: u32 = 18;

/// Two periods of 2 ms less than the watchdog's time. The servo stops a finger one period before its watchdog does.
const TOLERATED_BY_WATCHDOG: Duration = Duration::from_millis(14);
