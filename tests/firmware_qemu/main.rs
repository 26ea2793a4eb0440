//! Tests the library against the reference firmware on two kinds of emulated boards. Laboratories port the protocol
//! core of the firmware to their boards. Here it is compiled for a microcontroller, and runs with its own interrupts
//! and its own time.

#[path = "../common/attempts.rs"]
mod attempts;
mod killed;
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
use machine::{Emulated, LM3S6965, Machine, STM32F405};
use pauses::Part;
use settling::{Settling, distance};
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use sun2xp::board::protocol::Status;
use sun2xp::finger::{FaultKind, Stage};
use sun2xp::hand::{Hand, HandError, read_configuration};
use sun2xp::model::configuration::Configuration;

/// Allows one test with emulators at a time, because two would compete for the processors. Returns `None` if the
/// emulator or the compiler of the firmware is missing.
fn alone() -> Option<MutexGuard<'static, ()>> {
    static ONE: Mutex<()> = Mutex::new(());
    let usable = ["arm-none-eabi-gcc", "qemu-system-arm"].iter().all(|tool| tools::available(tool, "the whole test"));
    usable.then(|| ONE.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Returns the configuration of a hand with three fingers on one port, or with a finger on each port. `keys` is
/// added to the text of the configuration: first keys of the table `[hand]`, then whole tables.
fn configuration(ports: &[PathBuf], keys: &str) -> Configuration {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path().join("sun2xp.toml");
    // The fingers move in the emulated time, which is slow on a busy machine, so opening may take long.
    let mut text = String::from("[hand]\nopen_timeout_ms = 60000\n");
    match ports {
        [port] => text += &format!("{keys}\n[finger]\nthread = 1\nport = \"{}\"\n", port.display()),
        ports => {
            let fingers: Vec<usize> = (1..=ports.len()).collect();
            text += &format!("fingers = {fingers:?}\n{keys}\n");
            for (finger, port) in (1..).zip(ports) {
                text += &format!("[finger.{finger}]\nport = \"{}\"\n", port.display());
            }
        }
    }
    std::fs::write(&path, text).expect("the configuration is written");
    read_configuration(&path).expect("the configuration is good")
}

const TARGETS: [[f64; 3]; 3] = [[0.1, 0.4, 0.9], [-0.1, 0.6, 1.1], [0.0, 0.7, 0.8]];

/// Largest distance of a finger from its target, rad.
const CLOSE: f64 = 0.02;

/// Longest wait for anything. On a busy machine, the simulated time of the fingers passes more slowly than real time.
const PATIENCE: Duration = Duration::from_secs(60);

fn farthest(found: &[[f64; 3]], wanted: &[[f64; 3]]) -> f64 {
    found.iter().zip(wanted).map(|(&is, &wanted)| distance(is, wanted)).fold(0.0, f64::max)
}

fn text(error: HandError) -> String {
    error.to_string()
}

/// Sends the fingers to their targets, and returns their positions when they have been at rest for a while.
fn settled(hand: &Hand, fingers: usize) -> Result<Vec<[f64; 3]>, String> {
    let targets: Vec<_> = (1..).zip(TARGETS).take(fingers).collect();
    for &(finger, target) in &targets {
        hand.send_position(finger, target).map_err(text)?;
    }
    let settling = Settling { tolerance: CLOSE, rest: Duration::from_millis(500), patience: PATIENCE };
    settling.wait(hand, &targets)
}

/// Opens a hand on the firmware and calls `work` with it. An attempt may fail, because a busy machine may slow the
/// emulator down too much. Every attempt starts a new emulator.
fn with_hand(emulated: Emulated, what: &str, work: impl Fn(&Machine, &Hand) -> Result<(), String>) {
    with_configured_hand(emulated, what, KEYS, work);
}

/// Like [`with_hand`]. `keys` is that of [`configuration`].
fn with_configured_hand(
    emulated: Emulated,
    what: &str,
    keys: &str,
    work: impl Fn(&Machine, &Hand) -> Result<(), String>,
) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    emulated.build(folder.path());
    let what = format!("{what}, {}", emulated.board);
    attempts(&what, TOLERATED_PAUSE, |watch| {
        let machine = Machine::start(emulated, folder.path());
        for process in machine.processes() {
            watch.also(process, Part::Board);
        }
        let hand = Hand::open(configuration(&machine.ports(), keys)).map_err(text)?;
        work(&machine, &hand).map_err(|failure| {
            let losses = (1..).take(emulated.fingers()).map(|finger| hand.losses(finger).expect("a finger"));
            let losses: Vec<_> = losses.collect();
            format!("{failure}; {losses:?}")
        })
    });
}

/// A hand must survive pauses of the machine that are shorter than this. A servo that receives nothing for 10 ms has
/// faded its command to the torque of the end state, and its controller restarts when replies arrive again
/// (docs/architecture.md).
const TOLERATED_PAUSE: Duration = Duration::from_millis(50);

const KEYS: &str = "rate = 500.0\nwatchdog_ms = 1000";

#[test]
fn a_hand_settles_where_it_does_on_the_simulated_board() {
    settles(LM3S6965);
}

#[test]
fn a_hand_settles_on_the_stm32f405_where_it_does_on_the_simulated_board() {
    settles(STM32F405);
}

fn settles(emulated: Emulated) {
    let Some(_alone) = alone() else { return };
    let simulated = Hand::open(configuration(&["simulated".into()], KEYS)).expect("simulated boards answer");
    let fingers = emulated.fingers();
    let expected = settled(&simulated, fingers).expect("the simulated hand runs");
    with_hand(emulated, "a hand on the firmware settles", |machine, hand| {
        let positions = settled(hand, fingers)?;
        let joints: Vec<_> = (0..fingers).map(|finger| machine.finger(finger).plant.joints().into()).collect();
        let losses = hand.losses(1).map_err(text)?;
        let (from_simulated, from_truth) = (farthest(&positions, &expected), farthest(&joints, &expected));
        let found = format!(
            "measured {from_simulated:.4} rad and true {from_truth:.4} rad from the simulated hand, {} of {} replies \
             lost",
            losses.lost_replies, losses.cycles
        );
        println!("{found}");
        if from_simulated < CLOSE && from_truth < CLOSE { Ok(()) } else { Err(found) }
    });
}

#[test]
fn the_emergency_stop_of_the_lm3s6965_stops_its_finger() {
    stops(LM3S6965);
}

#[test]
fn the_emergency_stop_of_the_stm32f405_stops_its_finger() {
    stops(STM32F405);
}

fn stops(emulated: Emulated) {
    let Some(_alone) = alone() else { return };
    with_hand(emulated, "an emergency stop on the firmware", |machine, hand| {
        assert_ne!(machine.finger(1).asked.currents, [0; 4]);
        machine.finger(1).faults = Status::EMERGENCY_STOP;
        let noticed = wait_until(PATIENCE, || matches!(hand.status(2).expect("a finger").stage, Stage::Faulted(_)));
        assert!(noticed, "the emergency stop was not noticed");
        match hand.position(2).expect_err("it is faulted") {
            HandError::Faulted { fault, .. } if fault.kind == FaultKind::EmergencyStopInput => {}
            error => return Err(text(error)),
        }
        assert_eq!(machine.finger(1).asked.currents, [0; 4]);
        // The emergency stop input belongs to finger 2, so the other fingers keep running.
        let mut others = (1..).take(emulated.fingers()).filter(|&finger| finger != 2);
        others.try_for_each(|finger| hand.position(finger).map(drop).map_err(text))
    });
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
