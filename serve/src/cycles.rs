//! Collects the cycles of the fingers for the States that the server publishes. The cycles of a finger are taken in
//! order, and each cycle is taken at most once. If a stopped finger has no new cycles, a record of its newest report is
//! taken instead.

use crate::goal::Goal;
use std::sync::Arc;
use sun2xp::control::events::Arrival;
use sun2xp::finger::{CycleRecord, FingerReport};
use sun2xp::telemetry::View;
use sun2xp::{Hand, Stage};
use sun2xp_remote_protocol::{FINGERS, Finger, MOST_RECORDS, Record, Stage as SentStage};

type Goals = [Goal; FINGERS];

/// Takes the cycles of the fingers of a hand.
pub struct Cycles {
    hand: Arc<Hand>,
    view: View,
    /// For each finger, the number of the controller that `view` knows.
    controllers: [u32; FINGERS],
    /// For each finger, the number of the last cycle that was taken.
    last: [u64; FINGERS],
    /// For each finger, whether it was caught (see [`crate::silence`]) at the last call.
    caught: [bool; FINGERS],
    records: Vec<CycleRecord>,
}

/// The cycles since the last call.
#[derive(Debug, Default)]
pub struct Taken {
    /// The cycles.
    pub records: Vec<Record>,
    /// Number of cycles that are missing.
    pub missing: u64,
}

impl Cycles {
    /// The cycles of this hand from now on.
    #[must_use]
    pub fn new(hand: Arc<Hand>) -> Self {
        let view = View::new(&hand.configuration());
        let last = std::array::from_fn(|index| {
            hand.report(index as i32 + 1).map_or(0, |report| report.losses.cycles.saturating_sub(1))
        });
        Self { view, controllers: [0; FINGERS], last, caught: [false; FINGERS], records: Vec::new(), hand }
    }

    /// Takes the cycles since the last call. `goals` contain the command numbers. `progress` is the progress of the
    /// fingers toward these goals. It becomes part of the newest record of a finger if this record has the command
    /// number of the goal.
    pub fn take(&mut self, goals: &Goals, progress: &[Arrival; FINGERS]) -> Taken {
        let mut taken = Taken::default();
        for finger in Finger::ALL {
            // There is no report for a finger that is not in the hand.
            let Ok(report) = self.hand.report(i32::from(finger.number())) else { continue };
            self.note_controller(finger, &report);
            let first = taken.records.len();
            self.take_finger(finger, &report, goals, &mut taken);
            if let Some(newest) = taken.records[first..].last_mut()
                && newest.command == goals[finger.index()].command
            {
                let Arrival { arrived, settled } = progress[finger.index()];
                (newest.arrived, newest.settled) = (arrived, settled);
            }
        }
        taken.missing += keep_newest(&mut taken.records, MOST_RECORDS) as u64;
        taken
    }

    fn take_finger(&mut self, finger: Finger, report: &FingerReport, goals: &Goals, taken: &mut Taken) {
        let index = finger.index();
        self.records.clear();
        // The call fails only if the hand does not have the finger. But the finger has a report, so the hand has it.
        let _ = self.hand.records_after(i32::from(finger.number()), self.last[index], &mut self.records);
        for at in 0..self.records.len() {
            let record = self.records[at];
            let mut sent = self.record(finger, &record, goals);
            sent.caught = report.expired && (self.caught[index] || at + 1 == self.records.len());
            self.add(sent, taken);
        }
        self.caught[index] = report.expired;
        // A finger that has stopped has no new cycles. Its report still has its pose.
        if self.records.is_empty() && matches!(report.stage, Stage::Faulted(_) | Stage::Closed) {
            self.last[index] = report.losses.cycles.saturating_sub(1);
            let sent = self.of_report(finger, report, goals);
            self.add(sent, taken);
        }
    }

    /// Adds a record, and counts the cycles that are missing before it. A record with a number that is not finite
    /// cannot be sent, and counts as missing too.
    fn add(&mut self, record: Record, taken: &mut Taken) {
        let last = &mut self.last[record.finger.index()];
        taken.missing += record.cycle.saturating_sub(*last + 1);
        *last = record.cycle;
        let numbers = [&record.joints[..], &record.tip, &record.force, &record.tensions].concat();
        let finite = numbers.iter().chain(record.set_point.iter().flatten()).all(|number| number.is_finite());
        if finite {
            taken.records.push(record);
        } else {
            taken.missing += 1;
        }
    }

    fn record(&mut self, finger: Finger, record: &CycleRecord, goals: &Goals) -> Record {
        let number = i32::from(finger.number());
        let known = sun2xp::FingerNumber::try_from(number)
            .expect("a finger has the same number in the protocol and in the hand");
        let sample = self.view.sample(known, record);
        // In the cycle of a fault, the sample has the set point and the force of the cycle before.
        let stopped = matches!(record.stage, Stage::Faulted(_) | Stage::Closed);
        Record {
            finger,
            stage: stage(&record.stage),
            command: goals[finger.index()].command_at(record.began),
            cycle: record.cycle,
            begin: record.began,
            touching: sample.touching && !stopped,
            caught: false,
            arrived: false,
            settled: false,
            joints: sample.joints,
            set_point: sample.joint_set_point.filter(|_| !stopped),
            tip: self.hand.tip_at(number, sample.joints).unwrap_or_default(),
            force: if stopped { [0.0; 3] } else { sample.tip_force },
            tensions: sample.tensions,
        }
    }

    fn of_report(&self, finger: Finger, report: &FingerReport, goals: &Goals) -> Record {
        let joints = report.cycle.joints.into();
        Record {
            finger,
            stage: stage(&report.stage),
            command: goals[finger.index()].command_at(report.last),
            cycle: report.losses.cycles,
            begin: report.last,
            touching: false,
            caught: report.expired,
            arrived: false,
            settled: false,
            joints,
            set_point: None,
            tip: self.hand.tip_at(i32::from(finger.number()), joints).unwrap_or_default(),
            force: [0.0; 3],
            tensions: report.cycle.tensions.into(),
        }
    }

    /// Reads the geometry of the fingers again after a calibration or an adjustment.
    fn note_controller(&mut self, finger: Finger, report: &FingerReport) {
        let known = &mut self.controllers[finger.index()];
        if *known != report.controller {
            *known = report.controller;
            self.view = View::new(&self.hand.configuration());
        }
    }
}

/// Drops the oldest records until there are at most `most`. The finger with the most records loses its oldest one
/// first, so that every finger keeps its newest. Returns the number of records that were dropped.
fn keep_newest(records: &mut Vec<Record>, most: usize) -> usize {
    let mut counts = [0_usize; FINGERS];
    records.iter().for_each(|record| counts[record.finger.index()] += 1);
    let mut dropped = [0_usize; FINGERS];
    for _ in most..records.len() {
        let longest = (0..FINGERS).max_by_key(|&finger| counts[finger] - dropped[finger]).unwrap_or(0);
        dropped[longest] += 1;
    }
    let before = records.len();
    records.retain(|record| {
        let left = &mut dropped[record.finger.index()];
        let keeps = *left == 0;
        *left = left.saturating_sub(1);
        keeps
    });
    before - records.len()
}

/// Returns a stage in the form in which the protocol sends it.
#[must_use]
pub fn stage(stage: &Stage) -> SentStage {
    match stage {
        Stage::Opening => SentStage::Opening,
        Stage::Limp => SentStage::Limp,
        Stage::Calibrating => SentStage::Calibrating,
        Stage::Running => SentStage::Running,
        Stage::Closing => SentStage::Closing,
        Stage::Faulted(fault) => SentStage::Faulted(fault.kind.number().into()),
        _ => SentStage::Closed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread::sleep;
    use std::time::{Duration, Instant};
    use sun2xp::Configuration;

    fn record(finger: usize, cycle: u64) -> Record {
        let (finger, stage, none) = (Finger::ALL[finger], SentStage::Running, [0.0; 3]);
        let (touching, caught, arrived, settled) = (false, false, false, false);
        let (joints, set_point, tip, force, tensions) = (none, None, none, none, [0.0; 4]);
        let (command, begin) = (0, 0);
        Record {
            finger,
            stage,
            command,
            cycle,
            begin,
            touching,
            caught,
            arrived,
            settled,
            joints,
            set_point,
            tip,
            force,
            tensions,
        }
    }

    /// The protocol demands that no record of a stopped finger has a set point or a force, not even the record of the
    /// cycle in which the finger faulted.
    #[test]
    fn a_finger_that_stops_has_neither_set_point_nor_force() {
        let hand = Arc::new(Hand::open(Configuration::default()).expect("the simulated hand"));
        let mut cycles = Cycles::new(hand.clone());
        let begun = Instant::now();
        let mut take = || {
            // The machine of the tests may be busy.
            assert!(begun.elapsed() < Duration::from_secs(60), "no such record in time");
            sleep(Duration::from_millis(2));
            cycles.take(&Goals::default(), &Default::default()).records
        };
        while !take().iter().any(|record| record.set_point.is_some()) {}
        hand.stop(1).expect("finger 1");
        let mut stopped = 0;
        while stopped < 3 {
            for record in take().iter().filter(|record| matches!(record.stage, SentStage::Faulted(_))) {
                assert_eq!((record.set_point, record.force, record.touching), (None, [0.0; 3], false));
                stopped += 1;
            }
        }
    }

    /// If a State is published late, there can be more new cycles than fit into it.
    #[test]
    fn every_finger_keeps_its_newest_cycles() {
        let of = |finger, count| (0..count).map(move |cycle| record(finger, cycle));
        let mut records: Vec<Record> = of(0, 200).chain(of(1, 200)).chain(of(2, 20)).collect();
        assert_eq!(keep_newest(&mut records, 300), 120);
        let kept = |finger: usize| {
            let of_finger = records.iter().filter(|record| record.finger.index() == finger);
            of_finger.map(|record| record.cycle).collect::<Vec<_>>()
        };
        assert_eq!(kept(0), (60..200).collect::<Vec<_>>());
        assert_eq!(kept(1), (60..200).collect::<Vec<_>>());
        assert_eq!(kept(2), (0..20).collect::<Vec<_>>());
        assert_eq!(keep_newest(&mut records, 300), 0);
    }
}
