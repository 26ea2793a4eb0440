//! The contents of a recording and the result of its replay, for people and for other programs.

use crate::print::{Cell, Look, Screen, Table};
use serde::Serialize;
use std::collections::BTreeMap;
use sun2xp::control::Activity;
use sun2xp::finger::{CycleRecord, Difference, Recording, Replayed};
use sun2xp::model::Shown;

/// The output of `--json`.
#[derive(Debug, Serialize)]
pub struct Report {
    /// Whether every computed value equals the recorded one.
    pub pass: bool,
    finger: i32,
    /// Hz.
    rate: f64,
    /// Version of the library that made the recording.
    library: String,
    /// Number of cycles.
    cycles: usize,
    first_cycle: Option<u64>,
    last_cycle: Option<u64>,
    /// Time from the first cycle to the last one, s.
    seconds: f64,
    /// Number of cycles in each stage.
    stages: BTreeMap<String, u32>,
    lost_replies: usize,
    most_lost_in_a_row: usize,
    set_points: usize,
    adjustments: usize,
    restarts: usize,
    skipped_periods: u64,
    /// Largest motor torque, N cm.
    largest_motor_torque: f64,
    /// Number of cycles that were computed again.
    replayed: usize,
    different: usize,
    first_difference: Option<FirstDifference>,
}

/// The first cycle that differs.
#[derive(Debug, Serialize)]
struct FirstDifference {
    cycle: u64,
    /// Line of the file, from 1.
    line: usize,
    motors: Vec<Motor>,
    /// The whole reports as text, if they differ.
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
    pub fn new(recording: &Recording, replayed: &Replayed) -> Self {
        let (origin, cycles) = (&recording.origin, &recording.cycles);
        let mut stages = BTreeMap::new();
        for cycle in cycles {
            *stages.entry(Shown(cycle.stage.as_str()).to_string()).or_insert(0) += 1;
        }
        let lost = |cycle: &&CycleRecord<String>| cycle.feedback.is_none();
        let controls = || cycles.iter().filter_map(|cycle| cycle.control.as_ref());
        let mut set_points: Vec<_> = controls()
            .filter_map(|control| match control.input.activity {
                Activity::Follow(set_point) => Some(set_point),
                _ => None,
            })
            .collect();
        set_points.dedup();
        let [first, last] = [cycles.first(), cycles.last()];
        let began = |cycle: Option<&CycleRecord<String>>| cycle.map_or(0, |cycle| cycle.began);
        Self {
            pass: replayed.first.is_none(),
            finger: origin.finger,
            rate: origin.hand.rate,
            library: recording.library.clone(),
            cycles: cycles.len(),
            first_cycle: first.map(|cycle| cycle.cycle),
            last_cycle: last.map(|cycle| cycle.cycle),
            seconds: began(last).saturating_sub(began(first)) as f64 * 1e-9,
            stages,
            lost_replies: cycles.iter().filter(lost).count(),
            most_lost_in_a_row: cycles.split(|one| one.feedback.is_some()).map(<[_]>::len).max().unwrap_or(0),
            set_points: set_points.len(),
            adjustments: controls().filter(|control| control.previous != control.controller).count(),
            restarts: controls().filter(|control| control.input.anew_from.is_some()).count(),
            skipped_periods: controls().map(|control| control.input.skipped).sum(),
            largest_motor_torque: controls().map(|control| control.command.motor_torques.amax()).fold(0.0, f64::max),
            replayed: replayed.cycles,
            different: replayed.different,
            first_difference: replayed.first.as_ref().map(|first| FirstDifference::new(first, recording)),
        }
    }

    pub fn text(&self, screen: &Screen) -> String {
        let mut table = Table::without_header();
        let mut row = |name: &str, text: String| table.row([Cell::new(Look::Dim, name), text.into()]);
        row("finger", format!("{}, at {} Hz, recorded by library {}", self.finger, self.rate, self.library));
        row(
            "cycles",
            match (self.first_cycle, self.last_cycle) {
                (Some(first), Some(last)) => format!("{}, {first} to {last}, {:.3} s", self.cycles, self.seconds),
                _ => "none".into(),
            },
        );
        for (stage, count) in &self.stages {
            row("stage", format!("{count} {stage}"));
        }
        row("lost", format!("{} replies, at most {} in a row", self.lost_replies, self.most_lost_in_a_row));
        row(
            "events",
            format!(
                "{} set points, {} adjustments, {} restarts, {} periods skipped",
                self.set_points, self.adjustments, self.restarts, self.skipped_periods
            ),
        );
        row("motors", format!("at most {:.3} N cm", self.largest_motor_torque));
        let result = match self.pass {
            true => {
                let text = format!("{} cycles, every motor command the same to the last bit", self.replayed);
                Cell::new(Look::Good, text)
            }
            false => Cell::new(Look::Bad, format!("{} of {} cycles differ", self.different, self.replayed)),
        };
        table.row([Cell::new(Look::Dim, "replay"), result]);
        if let Some(first) = &self.first_difference {
            first.add_to(&mut table);
        }
        table.text(screen)
    }
}

impl FirstDifference {
    fn new(first: &Difference, recording: &Recording) -> Self {
        let (recorded, replayed) = (&first.recorded, &first.replayed);
        let (was, is) = (recorded.command.motor_torques, replayed.command.motor_torques);
        let differs = |&motor: &usize| was[motor].to_bits() != is[motor].to_bits();
        let differs_in_report = recorded.report != replayed.report;
        Self {
            cycle: recording.cycles[first.index].cycle,
            // The first line of the file is the header, so the cycle with index 0 is in line 2.
            line: first.index + 2,
            motors: (0..4)
                .filter(differs)
                .map(|motor| Motor { motor: motor + 1, recorded: was[motor], replayed: is[motor] })
                .collect(),
            reports: differs_in_report.then(|| [&recorded.report, &replayed.report].map(|one| format!("{one:?}"))),
        }
    }

    fn add_to(&self, table: &mut Table) {
        let mut row = |name: String, text: String| table.row([Cell::new(Look::Dim, name), text.into()]);
        row("first".into(), format!("cycle {}, line {}", self.cycle, self.line));
        for Motor { motor, recorded, replayed } in &self.motors {
            row(format!("motor {motor}"), format!("recorded {recorded:e}, replayed {replayed:e} N cm"));
        }
        if let Some([recorded, replayed]) = &self.reports {
            row("recorded".into(), recorded.clone());
            row("replayed".into(), replayed.clone());
        }
    }
}
