//! Sends what the owner wants to the fingers of the hand: new parts of Targets, the rest of the way to a destination
//! that is far ahead of a finger, and the set points of fingers that were caught and whose owner lives again.

mod leading;

use crate::goal::{Destination, Goal, is_path, rows};
use crate::silence::Silence;
use std::sync::Arc;
use sun2xp::control::events::Arrival;
use sun2xp::finger::FingerReport;
use sun2xp::groups::FingerCommand;
use sun2xp::hand::plan_path;
use sun2xp::motion::{PathPose, Pose, Validity};
use sun2xp::nalgebra::Vector3;
use sun2xp::{FingerNumber, Hand, HandError, OutOfRange, Stage};
use sun2xp_remote_protocol::{FINGERS, Part, Place};

/// A set point that moves by less than this, rad, is not sent.
const SMALLEST_STEP: f64 = 1e-4;

/// The fingers of the hand, and what the owner wants of them.
pub struct Fingers {
    hand: Arc<Hand>,
    goals: [Goal; FINGERS],
    /// The largest force of the lead, N.
    lead_force: f64,
    /// Whether commands beyond the limits are refused. Otherwise they are clamped.
    refuses: bool,
}

/// A part of a Target before it is sent: the goal that results, the command for the group, and the poses of its path.
struct Prepared {
    finger: usize,
    goal: Goal,
    /// None if there is only a path.
    command: Option<FingerCommand>,
    path: Vec<PathPose>,
}

impl Fingers {
    /// The fingers of this hand, of which nothing is wanted yet. `lead_force` is in N.
    #[must_use]
    pub fn new(hand: Arc<Hand>, lead_force: f64) -> Self {
        let refuses = hand.configuration().hand.out_of_range == OutOfRange::Refuse;
        Self { hand, goals: [Goal::default(); FINGERS], lead_force, refuses }
    }

    /// Returns what is wanted of each finger.
    #[must_use]
    pub fn goals(&self) -> &[Goal; FINGERS] {
        &self.goals
    }

    /// Returns the progress of each finger toward where the owner wants it. A finger that is caught, or that has only a
    /// set point on the way there, has not arrived.
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

    /// Begins the epoch of a new owner. A finger that follows a path of the previous owner stops at the present pose of
    /// this path.
    pub fn begin_epoch(&mut self, silence: &Silence) {
        for number in self.numbers() {
            let mut goal = std::mem::take(&mut self.goals[number as usize - 1]);
            let Ok(report) = self.hand.report(number) else { continue };
            goal.notice(&report);
            if let Destination::Path(_) = goal.destination {
                // A finger that has stopped meanwhile refuses this, and has no path any more.
                let _ = self.hand.send_position(number, report.reference.joints.into());
            }
        }
        self.keep_valid(silence);
    }

    /// Applies the parts of a Target that are new, all of them or none, and renews the validity of everything else.
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
        if !prepared.is_empty() {
            let commands: Vec<FingerCommand> = prepared.iter().filter_map(|prepared| prepared.command).collect();
            self.hand.send_group(&commands)?;
        }
        for Prepared { finger, goal, path, .. } in prepared {
            if !path.is_empty() {
                // It was checked already. It is refused only if the finger has stopped since.
                self.hand.send_path(finger as i32 + 1, &path, None)?;
            }
            self.goals[finger] = goal;
        }
        self.keep_valid(silence);
        Ok(())
    }

    /// Renews the validity of every finger. A finger that was caught follows again, from where it is.
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

    /// Keeps the set points of fingers valid that wait until an acquire has recovered other fingers. A finger that was
    /// caught meanwhile keeps its place.
    pub fn keep_waiting(&self, silence: &Silence) {
        for number in self.numbers() {
            if self.hand.report(number).is_ok_and(|report| report.stage == Stage::Running && !report.expired) {
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
            if let Destination::Path(end) = goal.destination {
                if self.admitted(number, &goal, &report, &report.reference.joints) < 1.0 {
                    // The finger lags behind its path. It continues to the end of the path as to a single pose.
                    (self.goals[index].destination, self.goals[index].whole) = (Destination::Joints(end), false);
                    self.send(number, &report, silence.of_commanded(), false);
                }
            } else if goal.is_commanded() && !goal.whole {
                self.send(number, &report, silence.of_commanded(), false);
            }
        }
    }

    /// Sends everything that the owner wants of a finger that was caught.
    fn resume(&mut self, number: i32, report: &FingerReport, valid: Validity) {
        let goal = &mut self.goals[number as usize - 1];
        if let Destination::Path(_) = goal.destination {
            // The times of the path are in the past. The finger stays where it is, until the next command.
            goal.destination = Destination::None;
            return;
        }
        self.send(number, report, valid, true);
    }

    /// Sends the destination of a finger, as far as the lead admits it, and its spring if `spring` is set.
    fn send(&mut self, number: i32, report: &FingerReport, valid: Validity, spring: bool) {
        let index = number as usize - 1;
        let goal = self.goals[index];
        let Ok((pose, whole)) = self.led(number, &goal, report) else { return };
        if !spring && !whole && is_near(pose, report) {
            return;
        }
        let mut command = FingerCommand::new(number).validity(valid);
        command.pose = pose;
        if let Some((kx, damping)) = goal.spring.filter(|_| spring) {
            command = command.stiffness(rows(&kx)).damping(damping);
        }
        // A finger that has stopped meanwhile refuses the command. The next call detects that.
        if self.hand.send_group(&[command]).is_ok() {
            self.goals[index].note_sent(report, whole);
        }
    }

    /// Prepares a new part.
    fn prepare(&self, part: &Part, valid: Validity, now: u64) -> Result<Prepared, HandError> {
        let (finger, number) = (part.finger.index(), i32::from(part.finger.number()));
        let report = self.hand.report(number)?;
        let mut path = Vec::new();
        let destination = match &part.place {
            Place::Kept => None,
            Place::Joints(joints) => Some(Destination::Joints(Vector3::from(*joints))),
            Place::Tip(tip) => Some(Destination::Tip(self.hand.joints_at(number, *tip)?.into())),
            Place::Path(poses) => {
                path.extend(poses.iter().map(|pose| PathPose {
                    time: pose.time,
                    pose: Pose::Joints(pose.joints),
                    stiffness: None,
                }));
                let finger = FingerNumber::try_from(number)?;
                if !matches!(report.stage, Stage::Running | Stage::Faulted(_)) {
                    return Err(HandError::Busy(finger));
                }
                plan_path(&self.hand.configuration(), finger, &report.reference, &path)?;
                poses.last().map(|pose| Destination::Path(pose.joints.into()))
            }
        };
        let mut goal = self.goals[finger].with(part, destination, &report, now);
        if !is_path(part) && report.expired && matches!(goal.destination, Destination::Path(_)) {
            goal.destination = Destination::None; // The times of an interrupted path are in the past.
        }
        let mut command = FingerCommand::new(number).validity(valid);
        (command.stiffness, command.damping) = (part.stiffness, part.damping);
        if let Place::Joints(joints) = &part.place {
            match self.within_limits(number, joints)? {
                Some(admitted) => goal.destination = Destination::Joints(admitted),
                // The hand refuses the group, with the reason.
                None => command.pose = Some(Pose::Joints(*joints)),
            }
        }
        if command.pose.is_none() {
            (command.pose, goal.whole) = self.led(number, &goal, &report)?;
        }
        if goal.destination == Destination::None && part.stiffness.is_some() {
            // The new Kx pulls the finger to the set point in force, which may be far ahead of it.
            let place = Destination::Joints(report.set_point.joints);
            let mut pulled = goal;
            (pulled.destination, pulled.whole) = (place, false);
            if let (pose, false) = self.led(number, &pulled, &report)? {
                (goal, command.pose) = (pulled, pose);
            }
        }
        if let Some((kx, damping)) = goal.spring.filter(|_| report.expired) {
            // The finger was caught and has the soft spring. The command contains the spring that the owner wants.
            (command.stiffness, command.damping) = (Some(rows(&kx)), Some(damping));
        }
        let empty = command.pose.is_none() && command.stiffness.is_none() && command.damping.is_none();
        Ok(Prepared { finger, goal, command: (!empty).then_some(command), path })
    }
}

/// Whether the set point in force is almost at this pose.
fn is_near(pose: Option<Pose>, report: &FingerReport) -> bool {
    let near = |joints: [f64; 3]| (Vector3::from(joints) - report.set_point.joints).amax() < SMALLEST_STEP;
    matches!(pose, Some(Pose::Joints(joints)) if near(joints))
}
