//! The result of a replay, for people and for other programs.

use super::tally::Tally;
use crate::print::{Cell, Look, Screen, Table};
use serde::Serialize;
use std::ops::Range;
use sun2xp::finger::ControlRecord;
use sun2xp::model::Counted;

/// Largest number of gaps that are listed. Further gaps are only counted.
const MOST_GAPS: usize = 20;

/// The output of `--json`.
#[derive(Debug, Serialize)]
pub struct Report {
    /// Whether every computed value equals the recorded one.
    pub pass: bool,
    /// Version of the library that made the recording.
    library: String,
    /// Whether the file has no end, because its recorder was killed or still runs.
    truncated: bool,
    fingers: Vec<FingerReport>,
}

/// The result for a finger.
#[derive(Debug, Serialize)]
pub struct FingerReport {
    /// 1 to 3.
    finger: i32,
    /// Hz.
    pub rate: f64,
    /// What the file contains.
    #[serde(flatten)]
    pub contents: Tally,
    /// Number of cycles that were computed again.
    pub replayed: u64,
    /// Number of cycles that were not computed again, because the replay waits for a recorded state after the beginning
    /// of the file, after a gap, and after a cycle with an unknown controller.
    pub without_state: u64,
    /// Number of cycles that were not computed again, because the file does not describe their controller.
    pub without_controller: u64,
    first_without_controller: Option<WithoutController>,
    /// Number of cycles that differ from the recorded ones.
    pub different: u64,
    /// Number of recorded states.
    pub states: u64,
    /// Number of recorded states that differ from the computed ones.
    pub different_states: u64,
    /// Number of places where cycles are missing.
    gaps: u64,
    /// Number of cycles that are missing.
    missing_cycles: u64,
    first_gaps: Vec<Gap>,
    pub first_difference: Option<FirstDifference>,
}

/// Cycles that are missing: the numbers of the first and the last one.
#[derive(Clone, Copy, Debug, Serialize)]
struct Gap {
    first: u64,
    last: u64,
}

/// A cycle whose controller the file does not describe.
#[derive(Clone, Copy, Debug, Serialize)]
struct WithoutController {
    cycle: u64,
    /// Number of the controller.
    controller: u32,
}

/// The first difference: a cycle, or the recorded state before it.
#[derive(Debug, Serialize)]
pub struct FirstDifference {
    cycle: u64,
    /// Line of a black box, from 1.
    line: Option<usize>,
    /// Whether the recorded state before the cycle differs, and not what the cycle computed.
    state: bool,
    motors: Vec<Motor>,
    /// The reports of the controller in this cycle as text, recorded and replayed, if they differ.
    reports: Option<[String; 2]>,
}

/// A motor whose torque differs, N cm.
#[derive(Debug, Serialize)]
struct Motor {
    motor: usize,
    recorded: f64,
    replayed: f64,
}

impl Report {
    /// Puts the results of the fingers together.
    pub fn new(library: String, truncated: bool, fingers: Vec<FingerReport>) -> Self {
        Self { pass: fingers.iter().all(FingerReport::pass), library, truncated, fingers }
    }

    /// Returns the report as text.
    pub fn text(&self, screen: &Screen) -> String {
        let mut texts: Vec<String> = self.fingers.iter().map(|finger| finger.text(self, screen)).collect();
        if self.truncated {
            let text = "The file has no end: its recorder was killed, or still runs. What it contains was replayed.\n";
            texts.push(text.into());
        }
        texts.join("\n")
    }
}

impl FingerReport {
    /// The report of a finger of which no cycle is known yet.
    pub fn new(finger: i32, rate: f64) -> Self {
        Self {
            finger,
            rate,
            contents: Tally::default(),
            replayed: 0,
            without_state: 0,
            without_controller: 0,
            first_without_controller: None,
            different: 0,
            states: 0,
            different_states: 0,
            gaps: 0,
            missing_cycles: 0,
            first_gaps: Vec::new(),
            first_difference: None,
        }
    }

    /// Counts cycles that are missing.
    pub fn add_gap(&mut self, missing: Range<u64>) {
        self.gaps += 1;
        self.missing_cycles += missing.end - missing.start;
        if self.first_gaps.len() < MOST_GAPS {
            self.first_gaps.push(Gap { first: missing.start, last: missing.end - 1 });
        }
    }

    /// Counts a cycle whose controller has this number and is not described.
    pub fn add_without_controller(&mut self, cycle: u64, controller: u32) {
        self.without_controller += 1;
        self.first_without_controller.get_or_insert(WithoutController { cycle, controller });
    }

    fn pass(&self) -> bool {
        self.different == 0 && self.different_states == 0
    }

    fn text(&self, report: &Report, screen: &Screen) -> String {
        let mut table = Table::without_header();
        let mut row = |name: &str, text: String| table.row([Cell::new(Look::Dim, name), text.into()]);
        row("finger", format!("{}, at {} Hz, recorded by library {}", self.finger, self.rate, report.library));
        let contents = &self.contents;
        row(
            "cycles",
            match (contents.first_cycle, contents.last_cycle) {
                (Some(first), Some(last)) => {
                    format!("{}, {first} to {last}, {:.3} s", contents.cycles, contents.seconds)
                }
                _ => "none".into(),
            },
        );
        for (stage, count) in &contents.stages {
            row("stage", format!("{count} {stage}"));
        }
        row(
            "lost",
            format!(
                "{}, at most {} in a row",
                Counted(contents.lost_replies, "reply", "replies"),
                contents.most_lost_in_a_row
            ),
        );
        let Tally { set_points, adjustments, restarts, skipped_periods, .. } = contents;
        row(
            "events",
            format!(
                "{}, {}, {}, {} skipped",
                Counted(*set_points, "set point", "set points"),
                Counted(*adjustments, "adjustment", "adjustments"),
                Counted(*restarts, "restart", "restarts"),
                Counted(*skipped_periods, "period", "periods")
            ),
        );
        row("motors", format!("at most {:.3} N cm", contents.largest_motor_torque));
        self.add_gaps_to(&mut table);
        self.add_result_to(&mut table);
        table.text(screen)
    }

    fn add_gaps_to(&self, table: &mut Table) {
        let mut row = |text: String| table.row([Cell::new(Look::Dim, "gap"), Cell::new(Look::Warning, text)]);
        for Gap { first, last } in &self.first_gaps {
            row(match last - first {
                0 => format!("cycle {first} is missing"),
                more => format!("{} cycles are missing: {first} to {last}", more + 1),
            });
        }
        let more = self.gaps - self.first_gaps.len() as u64;
        if more > 0 {
            row(format!(
                "{}; all gaps together: {} missing cycles",
                Counted(more, "more gap", "more gaps"),
                self.missing_cycles
            ));
        }
        if self.without_state > 0 {
            let text = format!(
                "{}, because the replay waits for a recorded state after the beginning of the file, after a gap, and \
                 after a cycle with an unknown controller",
                Counted(self.without_state, "cycle", "cycles")
            );
            table.row([Cell::new(Look::Dim, "not replayed"), text.into()]);
        }
        if let Some(WithoutController { cycle, controller }) = self.first_without_controller {
            let cycles = Counted(self.without_controller, "cycle", "cycles");
            let text = format!(
                "{cycles}, from cycle {cycle} on, because the file does not describe controller {controller}: \
                 the description was lost during the recording, or the file was altered. Record again, or copy the \
                 file again"
            );
            table.row([Cell::new(Look::Dim, "not replayed"), Cell::new(Look::Warning, text)]);
        }
    }

    fn add_result_to(&self, table: &mut Table) {
        let result = match self.pass() {
            true if self.replayed == 0 && self.without_state + self.without_controller > 0 => {
                Cell::new(Look::Warning, "no cycle")
            }
            true => {
                let text = format!(
                    "{}, every motor command the same to the last bit",
                    Counted(self.replayed, "cycle", "cycles")
                );
                Cell::new(Look::Good, text)
            }
            false => Cell::new(Look::Bad, format!("{} of {} cycles differ", self.different, self.replayed)),
        };
        table.row([Cell::new(Look::Dim, "replay"), result]);
        if self.different_states > 0 {
            let text = format!("{} of {} recorded states differ", self.different_states, self.states);
            table.row([Cell::new(Look::Dim, "states"), Cell::new(Look::Bad, text)]);
        }
        if let Some(first) = &self.first_difference {
            first.add_to(table);
        }
    }
}

impl FirstDifference {
    /// A cycle that differs.
    pub fn in_cycle(cycle: u64, recorded: &ControlRecord, replayed: &ControlRecord) -> Self {
        let (was, is) = (recorded.command.motor_torques, replayed.command.motor_torques);
        let differs = |&motor: &usize| was[motor].to_bits() != is[motor].to_bits();
        let differs_in_report = recorded.report != replayed.report;
        Self {
            cycle,
            line: None,
            state: false,
            motors: (0..4)
                .filter(differs)
                .map(|motor| Motor { motor: motor + 1, recorded: was[motor], replayed: is[motor] })
                .collect(),
            reports: differs_in_report.then(|| [&recorded.report, &replayed.report].map(|one| format!("{one:?}"))),
        }
    }

    /// Adds the line of the file, from 1.
    pub fn in_line(self, line: usize) -> Self {
        Self { line: Some(line), ..self }
    }

    /// A recorded state that differs.
    pub fn in_state(cycle: u64) -> Self {
        Self { cycle, line: None, state: true, motors: Vec::new(), reports: None }
    }

    fn add_to(&self, table: &mut Table) {
        let mut row = |name: String, text: String| table.row([Cell::new(Look::Dim, name), text.into()]);
        let place = if self.state { "the recorded state before cycle" } else { "cycle" };
        let line = self.line.map_or(String::new(), |line| format!(", line {line}"));
        row("first".into(), format!("{place} {}{line}", self.cycle));
        for Motor { motor, recorded, replayed } in &self.motors {
            row(format!("motor {motor}"), format!("recorded {recorded:e}, replayed {replayed:e} N cm"));
        }
        if let Some([recorded, replayed]) = &self.reports {
            row("recorded".into(), recorded.clone());
            row("replayed".into(), replayed.clone());
        }
    }
}
