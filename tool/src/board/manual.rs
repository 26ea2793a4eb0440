//! The orders of `sun2xp board`, for its help and for its answer to an unknown order.

use crate::print::{Screen, Table};
use sun2xp::model::Shown;

/// Width of the help where the output is not a terminal, columns. clap uses the same width.
const WIDTH: usize = 100;

/// Indentation of the list, columns.
const INDENT: usize = 2;

/// The syntax of an order, and what the order does.
type Entry = (&'static str, &'static str);

const ACTIONS: [Entry; 10] = [
    ("force FINGER X Y Z", "push the fingertip, N"),
    ("wall FINGER PX PY PZ NX NY NZ K", "put a wall through P with normal N, stiffness K N/cm"),
    ("ball FINGER X Y Z RADIUS K", "put a ball"),
    ("hold FINGER [A B C]", "hold the finger like a jig, in its current pose or at the joint angles A B C, degrees"),
    ("turn FINGER MOTOR TURNS", "turn a motor by hand; negative turns pay its tendon out"),
    ("tighten FINGER", "take up the slack of every tendon by hand"),
    ("hang FINGER TENDON N", "hang a weight on a tendon between its gauge and the finger, N; 0 removes it"),
    ("free FINGER", "remove force, wall, ball and jig"),
    (
        "state FINGER",
        "answer with the true joint angles (rad), tip (cm), tensions (N), motor torques (N cm), three instants on the \
         board's clock (ms), and the status bits of a Reply. The instants are: now, the last Command that was obeyed, \
         and the moment at which the finger went to its end state, after a Stop or when the watchdog tripped. An \
         instant is NaN if the event has not occurred since the last Configure",
    ),
    ("quit", "end the program"),
];

const DEFECTS: [Entry; 24] = [
    ("cut FINGER TENDON", "tear a tendon"),
    ("slack FINGER TENDON GRIP", "let a tendon slip at tensions above GRIP (N, 0 or more)"),
    ("jam FINGER MOTOR", "block a motor"),
    ("hot FINGER MOTOR", "switch a motor driver off, as at over-temperature"),
    ("dead-element FINGER ELEMENT", "make a tactile element, counted from 0, unreadable"),
    ("dead-gauge FINGER GAUGE [COUNT]", "freeze a gauge at COUNT, 0 to 65535, or at its current count"),
    ("drift-gauge FINGER GAUGE SPEED", "let a gauge drift, N/s"),
    ("swap-motors FINGER A B", "swap the cables of two motors"),
    ("swap-encoders FINGER A B", "swap the cables of two encoders"),
    ("swap-gauges FINGER A B", "swap the cables of two gauges"),
    ("swap-tendons FINGER A B", "route two tendons to each other's motor"),
    ("reverse-motor FINGER MOTOR", "connect a motor backwards"),
    ("reverse-encoder FINGER ENCODER", "let an encoder count backwards"),
    ("reverse-gauge FINGER GAUGE", "connect a gauge backwards"),
    ("gauge-gain FINGER GAUGE RATIO", "set the gain of a gauge to RATIO, 0 to 10, times its original value"),
    ("dead-motor FINGER MOTOR", "disconnect a motor"),
    ("dead-encoder FINGER ENCODER", "disconnect an encoder"),
    ("jump FINGER ENCODER COUNTS", "add COUNTS to the count of an encoder"),
    ("zero-lost FINGER", "declare the encoder counts invalid"),
    ("emergency FINGER", "activate the emergency stop input"),
    ("supply FINGER", "let the motor supply fail"),
    ("sensor FINGER", "let a sensor fail"),
    ("reset FINGER", "interrupt the board's power for a moment"),
    ("repair FINGER", "repair all of the above"),
];

const LINE_FAULTS: [Entry; 10] = [
    ("drop PROBABILITY [MS]", "lose frames"),
    ("corrupt PROBABILITY [MS]", "invert one bit of a frame"),
    ("delay PROBABILITY DELAY_MS [MS]", "delay frames by DELAY_MS"),
    ("duplicate PROBABILITY [MS]", "send frames twice"),
    ("reorder PROBABILITY [MS]", "send frames in the wrong order"),
    ("stall MS", "send nothing for MS, then everything at once"),
    ("commands FAULT", "one of the faults above, but for frames to the board. Example: commands drop 0.01"),
    ("good", "end all line faults, in both directions"),
    ("unplug", "remove the port"),
    ("replug", "create a new port and answer with its path"),
];

/// Returns the first word of each entry.
pub fn names() -> impl Iterator<Item = &'static str> {
    let entries = ACTIONS.iter().chain(&DEFECTS).chain(&LINE_FAULTS);
    entries.filter_map(|(usage, _)| usage.split_whitespace().next())
}

/// Returns the answer to a name that is not an order.
pub fn unknown(name: &str) -> String {
    let names: Vec<&str> = names().collect();
    format!("there is no order {}: the orders are {}; see sun2xp board --help", Shown(name), names.join(", "))
}

/// Returns the end of the help, at the width of the terminal.
pub fn help() -> String {
    let width = Screen::stdout().width.unwrap_or(WIDTH);
    let screen = Screen { width: Some(width - INDENT), lines: false, coloured: false };
    let list = |entries: &[Entry]| -> String {
        let mut table = Table::without_header();
        entries.iter().for_each(|&(usage, meaning)| table.row([usage.into(), meaning.into()]));
        table.text(&screen).lines().map(|line| format!("{:INDENT$}{line}\n", "")).collect()
    };
    format!(
        "Orders:\n{}\nDefects, each of which lasts until `repair` (`reset` only for a moment). Tendons, motors, gauges \
         and encoders are numbered 1 to 4:\n{}\nLine faults, each of which lasts until `good` (`unplug` until \
         `replug`), or for MS milliseconds if MS is given. PROBABILITY applies to each frame from the board, or with \
         `commands` to each frame to the board:\n{}\nPositions and forces are in the finger's frame, lengths in \
         cm.\n\n{}",
        list(&ACTIONS),
        list(&DEFECTS),
        list(&LINE_FAULTS),
        crate::failure::EXIT_STATUSES
    )
}
