//! Changes of a finger's configuration while it runs. An ordinary thread makes the new controller, and passes it to the
//! servo as a whole.

use crate::control::motion::PathExtent;
use crate::control::{JointSpring, SetPoint};
use crate::finger::{Adjustable, Replaced};
use crate::hand::admission::{Admission, PATH_ROUNDING, Ranges};
use crate::hand::configuration_file::{Wrong, deserialize, line_of_key, overlay, to_document};
use crate::hand::dispatcher::Member;
use crate::hand::{ConfigurationError, Hand, HandError, SetPointError};
use crate::model::configuration::{ConfiguredFinger, ConfiguredStiffness, OutOfRange};
use crate::model::{Contact, FingerNumber, Section, UnusableConfiguration};
use nalgebra::{Matrix6, Vector3};
use toml_edit::{Document, Item, Table};

/// Dotted keys, and tables of keys, that take effect only at open. They concern the port, the thread, the board, the
/// place in the palm, the initial stiffness, the tactile elements and the simulated finger, or they define the units of
/// the servo's state.
const PERMANENT: &[&str] = &[
    "port",
    "board",
    "baud",
    "reconnect",
    "address",
    "thread",
    "core",
    "priority",
    "base",
    "turn_degrees",
    "encoder",
    "motor.sign",
    "motor.torque_limit",
    "motor.torque_constant",
    "stiffness.initial",
    "touch",
    "simulation",
];

impl Hand {
    /// Changes keys of the configuration of finger 1, 2 or 3 while it runs. `keys` are lines of TOML as in the table
    /// `[finger.N]`, such as `tendon.minimum = 6`. All of them take effect together, within a cycle and without a jump
    /// in torque. Other keys keep their values. `controller.law` applies to later set points.
    ///
    /// A configured `stiffness.bound` was found for one controller. If `keys` changes `controller.scheme` but does not
    /// contain `stiffness.bound`, the smaller of the configured bound and the default bound is used. If the bound is
    /// lowered while a path changes Kx, the Kx of the end of the path takes effect at once.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger is faulted. Returns an error if a key cannot be
    /// read, cannot change while the hand is open, or results in a configuration that cannot be used. Returns an error
    /// if the set point that was sent last, or any part of a path that has not ended, is outside the new limits, unless
    /// commands are clamped. If commands are clamped, a path outside the new joint limits ends, and the finger moves to
    /// the last pose of the path at once. Clamping a set point does not change the time for which it is valid. After an
    /// error nothing is changed.
    pub fn adjust(&self, finger: i32, keys: &str) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let member = self.dispatcher.member(finger)?;
        // The lock is held throughout, so that the second of two concurrent adjustments starts from the result of the
        // first.
        let mut configuration = self.configuration.write();
        let mut changed = configuration.clone();
        changed.fingers[finger.index()] =
            adjusted(finger, &configuration.fingers[finger.index()], keys, configuration.hand.rate)?;
        // A bound below the initial stiffness is no error here: a finger that recovers clamps that stiffness.
        let refused = |refusal| unusable(finger, keys, refusal);
        changed.check().map_err(refused)?;
        let of_finger = |unusable| refused(UnusableConfiguration { section: Section::Finger(finger), unusable });
        let adjustable = Adjustable::new(&changed, finger).map_err(of_finger)?;
        self.dispatcher.hand_over(finger, &changed, adjustable, |adjustable| {
            adjust_member(member, Admission::new(&changed, finger), adjustable)
        })?;
        *configuration = changed;
        Ok(())
    }
}

/// Replaces the limits and the controller. No sender of set points sees one without the other.
fn adjust_member(member: &Member, changed: Admission, adjustable: Adjustable) -> Result<(), HandError> {
    let finger = changed.finger;
    let mut admission = member.admission.write();
    let sent = member.mailbox.sent();
    let joints = joints_within(&changed, &admission.joint_limits, &sent.joints)?;
    let ahead = member.mailbox.path_ahead();
    let leaves = ahead.as_ref().map(|path| leaves_limits(&changed, &admission.joint_limits, path));
    let leaves = leaves.transpose()?.unwrap_or(false);
    let contact = Contact::general(&sent.stiffness, &Matrix6::identity());
    let stiffness = changed.contact(&contact.map_err(|source| SetPointError::Contact { finger, source })?)?;
    let joint_spring = match sent.joint_spring {
        None => None,
        Some(JointSpring { k_theta, torque }) => {
            let rows = [0, 1, 2].map(|row| [0, 1, 2].map(|column| k_theta[(row, column)]));
            JointSpring { k_theta: changed.k_theta(rows)?, torque: changed.torque(torque.into())? }.unless_zero()
        }
    };
    let mut admitted = SetPoint { joints, stiffness, joint_spring, ..sent };
    let stiffest = ahead.and_then(|path| path.stiffest);
    // If the stiffness bound is lowered, the change of Kx along a path ends, and only the Kx of the end of the path
    // counts.
    let softened = stiffest.is_some() && changed.stiffness_bound < admission.stiffness_bound;
    if let Some(stiffest) = stiffest.filter(|_| !softened) {
        let mut along = SetPoint { stiffness: stiffest, ..admitted };
        changed.damping.admit(&mut along)?;
        admitted.damping = along.damping;
    }
    changed.damping.admit(&mut admitted)?;
    let faulted = |fault| HandError::Faulted { finger, fault };
    member.mailbox.adjust(adjustable).map_err(faulted)?;
    if admitted != sent || leaves || softened {
        let replaced = if joints != sent.joints || leaves {
            Replaced::Place
        } else if stiffness != sent.stiffness || softened {
            Replaced::Stiffness
        } else {
            Replaced::Other
        };
        // If the set point is no longer `sent`, a restart, an expiry or a reflex has replaced it meanwhile, and nothing
        // is corrected. The correction is refused only if the finger has faulted since the controller was replaced. A
        // finger that has faulted has no set point that could be outside the limits, and recovers with the new
        // controller.
        let _ = member.mailbox.correct(replaced, &sent, admitted);
    }
    *admission = changed;
    Ok(())
}

/// Checks the joint angles of the last set point, rad, against the changed limits. A finger that was found in a pose
/// beyond a limit may hold that pose, so only limits that are narrower than `before`, rad, count.
fn joints_within(
    changed: &Admission,
    before: &(Vector3<f64>, Vector3<f64>),
    sent: &Vector3<f64>,
) -> Result<Vector3<f64>, SetPointError> {
    let (mut low, mut high) = changed.joint_limits;
    for joint in 0..3 {
        if low[joint] <= before.0[joint] {
            low[joint] = low[joint].min(sent[joint]);
        }
        if high[joint] >= before.1[joint] {
            high[joint] = high[joint].max(sent[joint]);
        }
    }
    let admitted = Ranges { joint_limits: (low, high), ..changed.ranges() }.joints((*sent).into());
    admitted.map_err(|error| match error {
        SetPointError::BeyondJointLimit { finger, joint, value, low, high } => {
            SetPointError::SentBeyondJointLimit { finger, joint, value, low, high }
        }
        other => other,
    })
}

/// Returns whether a path that has not ended leaves the changed joint limits. A path may begin beyond a limit, so only
/// limits that are narrower than `before`, rad, are compared with the path.
fn leaves_limits(
    changed: &Admission,
    before: &(Vector3<f64>, Vector3<f64>),
    path: &PathExtent,
) -> Result<bool, SetPointError> {
    for joint in 0..3 {
        let (low, high) = (changed.joint_limits.0[joint], changed.joint_limits.1[joint]);
        let (least, most) = (path.lowest[joint], path.highest[joint]);
        let above = high < before.1[joint] && most > high + PATH_ROUNDING;
        let below = low > before.0[joint] && least < low - PATH_ROUNDING;
        if !above && !below {
            continue;
        }
        if changed.out_of_range == OutOfRange::Clamp {
            return Ok(true);
        }
        let value = if above { most } else { least };
        return Err(SetPointError::PathBeyondJointLimit { finger: changed.finger, joint, value, low, high });
    }
    Ok(false)
}

/// Returns the configuration of a finger in which `keys` have replaced some values. `rate` is in Hz.
fn adjusted(
    number: FingerNumber,
    finger: &ConfiguredFinger,
    keys: &str,
    rate: f64,
) -> Result<ConfiguredFinger, ConfigurationError> {
    let refused = |wrong: Wrong| ConfigurationError::Adjustment {
        finger: number,
        line: wrong.line(keys).unwrap_or(1),
        reason: wrong.to_string(),
    };
    let over = Document::parse(keys).map_err(|error| refused(Wrong::in_syntax(error)))?;
    if let Some(key) = permanent(over.as_table(), "") {
        return Err(ConfigurationError::Permanent { key });
    }
    let present = to_document(finger).map_err(refused)?;
    let mut merged = present.as_table().clone();
    overlay(&mut merged, over.as_table());
    let mut changed: ConfiguredFinger = deserialize(&merged).map_err(refused)?;
    let named = over.get("stiffness").is_some_and(|stiffness| stiffness.get("bound").is_some());
    if changed.controller.scheme(rate) != finger.controller.scheme(rate) && !named {
        let default = ConfiguredStiffness::default_bound(rate);
        changed.stiffness.bound = changed.stiffness.bound.map(|bound| bound.min(default));
    }
    Ok(changed)
}

/// Returns the error for a configuration that cannot be used with `keys`. If `keys` contains the refused key, the error
/// names its line.
fn unusable(finger: FingerNumber, keys: &str, refusal: UnusableConfiguration) -> ConfigurationError {
    match line_of_key(keys, refusal.unusable.key) {
        Some(line) if refusal.section == Section::Finger(finger) => {
            ConfigurationError::Adjustment { finger, line, reason: refusal.unusable.to_string() }
        }
        _ => refusal.into(),
    }
}

/// Returns the first key that takes effect only at open.
fn permanent(table: &Table, above: &str) -> Option<String> {
    table.iter().find_map(|(key, item)| {
        let path = if above.is_empty() { key.to_string() } else { format!("{above}.{key}") };
        if PERMANENT.contains(&path.as_str()) {
            return Some(path);
        }
        match item.clone() {
            Item::Table(below) => permanent(&below, &path),
            Item::Value(value) => permanent(&value.as_inline_table()?.clone().into_table(), &path),
            Item::None | Item::ArrayOfTables(_) => None,
        }
    })
}

#[cfg(test)]
mod tests;
