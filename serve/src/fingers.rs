//! Sends to the fingers of the hand what the owner wants of them: new parts of Targets, and the rest of the way to a
//! destination that is far ahead of a finger. When the owner's messages resume after a silence, it also sends the set
//! points of the fingers that were caught meanwhile (see [`crate::silence`]).

mod leading;
mod preparing;

use crate::goal::{Destination, Goal, rows};
use crate::silence::Silence;
use preparing::Prepared;
use std::sync::Arc;
use sun2xp::control::events::Arrival;
use sun2xp::finger::FingerReport;
use sun2xp::groups::FingerCommand;
use sun2xp::hand::SetPointError;
use sun2xp::motion::{PathError, PathPose, Pose, Validity};
use sun2xp::{Hand, HandError, OutOfRange, Stage};
use sun2xp_remote_protocol::{FINGERS, Part};

/// A path has ended when the reference is within this distance of its end, rad. The distance covers rounding errors.
const AT_END: f64 = 1e-6;

/// The fingers of the hand, and what the owner wants of them.
pub struct Fingers {
    hand: Arc<Hand>,
    goals: [Goal; FINGERS],
    /// The largest force with which a set point pulls a fingertip, N. It bounds the lead (see [`crate::lead`]).
    lead_force: f64,
    /// Whether the hand refuses or clamps commands beyond the limits.
    out_of_range: OutOfRange,
}

impl Fingers {
    /// The fingers of this hand, of which nothing is wanted yet. `lead_force` is in N.
    #[must_use]
    pub fn new(hand: Arc<Hand>, lead_force: f64) -> Self {
        let out_of_range = hand.configuration().hand.out_of_range;
        Self { hand, goals: [Goal::default(); FINGERS], lead_force, out_of_range }
    }

    /// Returns what is wanted of each finger.
    #[must_use]
    pub fn goals(&self) -> &[Goal; FINGERS] {
        &self.goals
    }

    /// Returns the progress of each finger toward where the owner wants it. A finger that is caught, or whose set point
    /// is only an intermediate place on the way, has not arrived.
    #[must_use]
    pub fn progress(&self) -> [Arrival; FINGERS] {
        std::array::from_fn(|index| {
            let number = index as i32 + 1;
            let Ok((in_force, report)) = self.hand.newest_in_force(number) else { return Arrival::default() };
            let goal = &self.goals[index];
            let follows = in_force && report.stage == Stage::Running && !report.expired;
            Arrival {
                arrived: follows && report.arrival.arrived && (goal.whole || !goal.is_commanded()),
                settled: follows && report.arrival.settled,
            }
        })
    }

    /// The numbers of the fingers of the hand.
    pub fn numbers(&self) -> impl Iterator<Item = i32> + use<> {
        self.hand.fingers().members().map(|number| number.get())
    }

    /// Ends the paths of the previous owner. Each finger on a path stops at the present pose of this path.
    pub fn end_paths(&mut self, silence: &Silence) {
        for number in self.numbers() {
            let goal = &mut self.goals[number as usize - 1];
            let Ok(report) = self.hand.report(number) else { continue };
            goal.notice(&report);
            let Destination::Path { .. } = goal.destination else { continue };
            goal.destination = Destination::None;
            // The catch has already ended the path of a finger that was caught.
            if !report.expired {
                let mut command = FingerCommand::new(number).validity(silence.of_other());
                command.pose = Some(Pose::Joints(report.reference.joints.into()));
                // A finger that has stopped meanwhile refuses the command, and has no path any more.
                let _ = self.hand.send_group(&[command]);
            }
        }
    }

    /// Begins the epoch of a new owner, who has not commanded any finger yet. The acquire counts as a Target, so before
    /// the epoch begins, fingers that were caught follow their set points again.
    pub fn begin_epoch(&mut self, silence: &Silence) {
        self.keep_valid(silence);
        self.goals.iter_mut().for_each(Goal::begin_epoch);
        self.keep_valid(silence);
    }

    /// Applies the parts of a Target that are new, all of them or none, and renews the validity of the set points of
    /// all fingers. If a servo is so late that it has no room for another group, or if a finger is caught during the
    /// call, no part is applied yet. The parts stay new, and the owner repeats them.
    ///
    /// A finger that stops or is caught in the period after the call discards its part. The hand cannot know this in
    /// advance.
    ///
    /// # Errors
    /// Returns why a finger refuses its part. Then no part is applied, and the validity is not renewed.
    pub fn apply(&mut self, parts: &[Part], silence: &Silence, now: u64) -> Result<(), HandError> {
        let valid = silence.of_commanded();
        let new = parts.iter().filter(|part| {
            let index = part.finger.index();
            self.goals[index].is_new(part)
        });
        let prepared = new.map(|part| self.prepare(part, valid, now)).collect::<Result<Vec<_>, _>>()?;
        let commands: Vec<FingerCommand> = prepared.iter().filter_map(|prepared| prepared.command).collect();
        let with_path = prepared.iter().filter(|prepared| !prepared.path.is_empty());
        let paths: Vec<(i32, &[PathPose])> =
            with_path.map(|prepared| (prepared.finger as i32 + 1, &prepared.path[..])).collect();
        match self.hand.send_group_with_paths(&commands, &paths) {
            Err(HandError::SetPoint(SetPointError::GroupsWaiting(_)) | HandError::Path(PathError::Moved(_))) => {
                self.keep_valid(silence);
                return Ok(());
            }
            sent => sent?,
        }
        for Prepared { finger, goal, .. } in prepared {
            self.goals[finger] = goal;
        }
        self.keep_valid(silence);
        Ok(())
    }

    /// Renews the validity of the set point of every finger. A finger that was caught follows again, from where it is.
    pub fn keep_valid(&mut self, silence: &Silence) {
        for number in self.numbers() {
            let index = number as usize - 1;
            let Ok(report) = self.hand.report(number) else { continue };
            self.goals[index].notice(&report);
            let commanded = self.goals[index].is_commanded();
            let valid = if commanded { silence.of_commanded() } else { silence.of_other() };
            // A finger that has stopped needs no validity.
            let _ = self.hand.keep_valid(number, valid);
            if self.goals[index].is_interrupted(&report) {
                self.resume(number, &report, valid);
            }
        }
    }

    /// Keeps the set points of running fingers valid while an acquire recovers other fingers. A finger that was caught
    /// keeps its place, and does not go to its end state.
    pub fn keep_waiting(&self, silence: &Silence) {
        for number in self.numbers() {
            if self.hand.report(number).is_ok_and(|report| report.stage == Stage::Running) {
                let _ = self.hand.keep_valid(number, silence.of_other());
            }
        }
    }

    /// Forgets the command numbers of the previous owner.
    pub fn forget_commands(&mut self) {
        self.goals.iter_mut().for_each(Goal::forget_command);
    }

    /// Advances the set points of fingers whose destination is far ahead of them.
    pub fn advance(&mut self, silence: &Silence, now: u64) {
        if !silence.is_valid(now) {
            return;
        }
        for number in self.numbers() {
            let index = number as usize - 1;
            let Ok(report) = self.hand.report(number) else { continue };
            self.goals[index].notice(&report);
            let goal = self.goals[index];
            if report.stage != Stage::Running || report.expired {
                continue;
            }
            if let Destination::Path { end, until } = goal.destination {
                if now >= until && (report.reference.joints - end).amax() < AT_END {
                    // From now on, the end of the path is an ordinary destination, and the whole way to it has been
                    // sent.
                    (self.goals[index].destination, self.goals[index].whole) = (Destination::Joints(end), true);
                } else if self.admitted(number, &goal, &report, &report.reference.joints) < 1.0 {
                    // The finger lags behind its path. It leaves the path and moves straight to the last pose.
                    (self.goals[index].destination, self.goals[index].whole) = (Destination::Joints(end), false);
                    self.send(number, &report, silence.of_commanded(), false);
                }
            } else if goal.is_commanded() && !goal.whole {
                self.send(number, &report, silence.of_commanded(), false);
            }
        }
    }

    /// Sends everything that the owner wants of a finger that was caught. Sends nothing if the owner wants a path.
    fn resume(&mut self, number: i32, report: &FingerReport, valid: Validity) {
        let goal = &mut self.goals[number as usize - 1];
        if let Destination::Path { .. } = goal.destination {
            // The times of the path are in the past. The finger stays where it is, until the next command.
            goal.destination = Destination::None;
            return;
        }
        self.send(number, report, valid, true);
    }

    /// Sends the farthest set point that the bound of the lead (see [`crate::lead`]) admits on the way to a finger's
    /// destination. If `spring` is set, also sends the finger's Kx and damping.
    fn send(&mut self, number: i32, report: &FingerReport, valid: Validity, spring: bool) {
        let index = number as usize - 1;
        let goal = match spring {
            true => {
                let goal = self.keeping(number, self.goals[index], report);
                goal.and_then(|goal| self.pulled(number, goal, report))
            }
            false => Ok(self.goals[index]),
        };
        let Ok(goal) = goal else { return };
        let Ok((place, whole)) = self.led(number, &goal, report) else { return };
        if !spring && !whole && place.is_some_and(|place| place.is_near(&report.set_point.joints)) {
            return;
        }
        let mut command = FingerCommand::new(number).validity(valid);
        command.pose = place.map(|place| place.pose);
        if let Some((kx, damping)) = goal.spring.filter(|_| spring) {
            command = command.stiffness(rows(&kx)).damping(damping);
        }
        // A finger that has stopped meanwhile refuses the command. The next report of the finger shows the stop.
        if self.hand.send_group(&[command]).is_ok() {
            (self.goals[index].destination, self.goals[index].kept) = (goal.destination, goal.kept);
            self.goals[index].note_sent(report, whole);
        }
    }
}
