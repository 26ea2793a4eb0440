//! The contents of recorded cycles, counted as the cycles pass.

use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Display;
use sun2xp::control::{Activity, SetPoint};
use sun2xp::finger::CycleRecord;
use sun2xp::model::Shown;

/// Largest number of stages that are counted by name. The name of a fault contains its values, so a long recording may
/// have many.
const MOST_STAGES: usize = 64;

/// Counts of one finger's cycles.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Tally {
    /// Number of cycles.
    pub cycles: u64,
    /// Number of the first cycle.
    pub first_cycle: Option<u64>,
    /// Number of the last cycle.
    pub last_cycle: Option<u64>,
    /// Time from the first cycle to the last one, s.
    pub seconds: f64,
    /// Number of cycles in each stage.
    pub stages: BTreeMap<String, u64>,
    /// Number of lost replies.
    pub lost_replies: u64,
    /// Most lost replies in a row.
    pub most_lost_in_a_row: u64,
    /// Number of set points.
    pub set_points: u64,
    /// Number of cycles in which another controller took over.
    pub adjustments: u64,
    /// Number of restarts of a controller.
    pub restarts: u64,
    /// Number of skipped periods.
    pub skipped_periods: u64,
    /// Largest motor torque, N cm.
    pub largest_motor_torque: f64,
    #[serde(skip)]
    began: u64,
    #[serde(skip)]
    lost_in_a_row: u64,
    #[serde(skip)]
    set_point: Option<SetPoint>,
}

impl Tally {
    /// Counts a cycle.
    pub fn add<S: Display>(&mut self, record: &CycleRecord<S>) {
        if self.cycles == 0 {
            (self.first_cycle, self.began) = (Some(record.cycle), record.began);
        }
        self.cycles += 1;
        self.last_cycle = Some(record.cycle);
        self.seconds = record.began.saturating_sub(self.began) as f64 * 1e-9;
        let stage = Shown(&record.stage.to_string()).to_string();
        let known = self.stages.len() < MOST_STAGES || self.stages.contains_key(&stage);
        *self.stages.entry(if known { stage } else { "other".into() }).or_default() += 1;
        match record.feedback {
            Some(_) => self.lost_in_a_row = 0,
            None => {
                self.lost_replies += 1;
                self.lost_in_a_row += 1;
                self.most_lost_in_a_row = self.most_lost_in_a_row.max(self.lost_in_a_row);
            }
        }
        let Some(control) = &record.control else { return };
        if let Activity::Follow(set_point) = control.input.activity
            && self.set_point.replace(set_point) != Some(set_point)
        {
            self.set_points += 1;
        }
        self.adjustments += u64::from(control.previous != control.controller);
        self.restarts += u64::from(control.input.anew_from.is_some());
        self.skipped_periods = self.skipped_periods.saturating_add(control.input.skipped);
        self.largest_motor_torque = self.largest_motor_torque.max(control.command.motor_torques.amax());
    }
}
