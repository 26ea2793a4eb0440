//! Sends commands and paths to several fingers: all of them, or none.

use crate::control::SetPoint;
use crate::finger::{PreparedPath, PreparedSetPoint, Stage, Validity};
use crate::hand::admission::{Admission, DampingAdmission};
use crate::hand::dispatcher::Member;
use crate::hand::{FingerCommand, Hand, HandError, PathError, PathPose, Plan, SetPointError};
use crate::model::FingerNumber;
use crate::model::configuration::FINGERS;
use std::time::Duration;

/// A path for a finger: the number of the finger, the poses, and how long the path stays valid after its end (`None`:
/// for the configured time).
pub(super) type PathOfFinger<'a> = (i32, &'a [PathPose], Option<Duration>);

/// What one finger is to get.
#[derive(Clone, Copy, Default)]
struct Wanted<'a> {
    command: Option<&'a FingerCommand>,
    path: Option<(&'a [PathPose], Option<Duration>)>,
}

/// A path that a finger admits.
struct AdmittedPath {
    plan: Plan,
    /// The number of the spring phase (`FingerReport::springs`) for which the path was computed, the period in which
    /// the path begins, and the validity of the path.
    when: (u32, u64, Validity),
    damping: DampingAdmission,
}

impl AdmittedPath {
    fn new(
        member: &Member,
        admission: &Admission,
        poses: &[PathPose],
        valid: Option<Duration>,
    ) -> Result<Self, HandError> {
        let report = member.mailbox.report();
        let plan = admission.path(&report.reference, poses)?;
        if report.stage != Stage::Running {
            return Err(member.refusal(report.stage));
        }
        let when = (report.springs, report.reference.period, Validity::hold_after(valid));
        Ok(Self { plan, when, damping: admission.damping })
    }
}

impl Hand {
    /// Sends commands as [`Hand::send_group`] does, and paths as [`Hand::send_path`] does. Either everything is sent,
    /// or nothing is. Each entry of `paths` has the number of a finger, and the poses of its path. A path begins at
    /// most two periods before or after the commands of other fingers take effect. If the same finger has a command
    /// too, the path begins with the stiffness and damping of this command, and replaces the pose and the validity of
    /// the command.
    ///
    /// A finger that stops, or whose set point expires, in the period after the call discards what it got. The other
    /// fingers keep theirs.
    ///
    /// # Errors
    /// Returns the errors of [`Hand::send_group`] and [`Hand::send_path`]. A finger with two paths is refused like one
    /// with two commands.
    pub fn send_group_with_paths(
        &self,
        commands: &[FingerCommand],
        paths: &[(i32, &[PathPose])],
    ) -> Result<(), HandError> {
        let paths: Vec<PathOfFinger<'_>> = paths.iter().map(|&(finger, poses)| (finger, poses, None)).collect();
        self.send_together(commands, &paths)
    }

    /// Sends these commands and paths, all of them or none.
    pub(super) fn send_together(
        &self,
        commands: &[FingerCommand],
        paths: &[PathOfFinger<'_>],
    ) -> Result<(), HandError> {
        let wanted = self.by_finger(commands, paths)?;
        // The locks are taken in the order of the fingers, and held until every finger has its command. Each kind of
        // check is made for all fingers before the next kind, so that the reported reason does not depend on the
        // finger.
        let mut admissions = [const { None }; FINGERS];
        for number in FingerNumber::ALL {
            let Wanted { command, path } = wanted[number.index()];
            if command.is_none() && path.is_none() {
                continue;
            }
            let admission = admissions[number.index()].insert(self.dispatcher.member(number)?.admission.read());
            if let Some(command) = command {
                command.check_finite(admission)?;
            }
        }
        let mut changes = [const { None }; FINGERS];
        let mut refusal = None;
        for number in FingerNumber::ALL {
            let index = number.index();
            let (Some(admission), Some(command)) = (&admissions[index], wanted[index].command) else { continue };
            match command.admit(admission, &self.dispatcher.last_report(number)?.cycle.joints) {
                Ok(change) => changes[index] = Some(change),
                Err(error) => refusal = Some(listed_first(refusal, error)),
            }
        }
        if let Some(refusal) = refusal {
            return Err(refusal.into());
        }
        let mut plans = [const { None }; FINGERS];
        for number in FingerNumber::ALL {
            let index = number.index();
            let (Some(admission), Some((poses, valid))) = (&admissions[index], wanted[index].path) else { continue };
            plans[index] = Some(AdmittedPath::new(self.dispatcher.member(number)?, admission, poses, valid)?);
        }
        self.send_admitted(&wanted, changes, &plans)
    }

    /// Returns what each finger is to get.
    fn by_finger<'a>(
        &self,
        commands: &'a [FingerCommand],
        paths: &[PathOfFinger<'a>],
    ) -> Result<[Wanted<'a>; FINGERS], HandError> {
        let mut wanted = [Wanted::default(); FINGERS];
        for command in commands {
            let finger = FingerNumber::try_from(command.finger)?;
            self.dispatcher.member(finger)?;
            if wanted[finger.index()].command.replace(command).is_some() {
                return Err(SetPointError::TwiceInGroup(finger).into());
            }
        }
        for &(finger, poses, valid) in paths {
            let finger = FingerNumber::try_from(finger)?;
            self.dispatcher.member(finger)?;
            if wanted[finger.index()].path.replace((poses, valid)).is_some() {
                return Err(SetPointError::TwiceInGroup(finger).into());
            }
        }
        Ok(wanted)
    }

    /// Sends commands and paths that were admitted. `changes` are the changes that the commands make to the set points.
    /// From the preparation of a command or path until it is sent, no other planner can change the set point of its
    /// finger. The limits of the fingers cannot change until everything has been sent.
    fn send_admitted<C: FnOnce(&mut SetPoint) -> Result<(), SetPointError>>(
        &self,
        wanted: &[Wanted<'_>; FINGERS],
        mut changes: [Option<C>; FINGERS],
        plans: &[Option<AdmittedPath>; FINGERS],
    ) -> Result<(), HandError> {
        let mut prepared: [Option<PreparedSetPoint<'_>>; FINGERS] = [const { None }; FINGERS];
        let mut paths: [Option<PreparedPath<'_>>; FINGERS] = [const { None }; FINGERS];
        let mut refusal: Option<HandError> = None;
        for number in FingerNumber::ALL {
            let index = number.index();
            let faulted = |fault| HandError::Faulted { finger: number, fault };
            let command = wanted[index].command.zip(changes[index].take());
            // A fault has precedence over a refusal, as for a command of a single finger. So a refusal is returned only
            // after all fingers were prepared.
            if let Some(AdmittedPath { plan, when, damping }) = &plans[index] {
                let mailbox = &self.dispatcher.member(number)?.mailbox;
                let command = command.map(|(command, change)| (command.replaced(), change));
                let path = mailbox.prepare_path(*when, &plan.table(), command, plan.change(*damping));
                match path.map_err(faulted)? {
                    Ok(Some(path)) => paths[index] = Some(path),
                    Ok(None) => refusal = refusal.or(Some(PathError::Moved(number).into())),
                    Err(error) => refusal = refusal.or(Some(error.into())),
                }
            } else if let Some((command, change)) = command {
                let mailbox = &self.dispatcher.member(number)?.mailbox;
                match mailbox.prepare((command.replaced(), command.validity), change).map_err(faulted)? {
                    Ok(set_point) => prepared[index] = Some(set_point),
                    Err(error) => refusal = refusal.or(Some(error.into())),
                }
            }
        }
        if let Some(refusal) = refusal {
            return Err(refusal);
        }
        for number in FingerNumber::ALL {
            if prepared[number.index()].as_ref().is_some_and(|set_point| !set_point.has_room()) {
                return Err(SetPointError::GroupsWaiting(number).into());
            }
        }
        if prepared.iter().any(Option::is_some) {
            self.dispatcher.gate.send(prepared);
        }
        for path in paths.into_iter().flatten() {
            path.send();
        }
        Ok(())
    }
}

/// Returns the error that the manual of the C call lists first: a Kx that is no spring comes before values that are out
/// of range. Of two errors of one kind, that of the finger with the lower number is returned.
fn listed_first(earlier: Option<SetPointError>, error: SetPointError) -> SetPointError {
    match earlier {
        Some(earlier) if earlier.is_no_spring() || !error.is_no_spring() => earlier,
        _ => error,
    }
}
