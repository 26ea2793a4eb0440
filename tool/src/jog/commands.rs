//! What a person can do to a hand: the type of the commands, and the calls of the hand that carry them out. The
//! terminal and the web page send the same commands.

use serde::{Deserialize, Serialize};
use std::fmt::{self, Display, Formatter};
use std::thread::sleep;
use std::time::Duration;
use sun2xp::groups::FingerCommand;
use sun2xp::model::configuration::{Configuration, OutOfRange};
use sun2xp::{Hand, HandError, Recovering, Stage};

/// Interval at which a recovery is polled.
const POLLED: Duration = Duration::from_millis(2);

/// Largest change of a joint angle in one command to a real finger, rad: 3 degrees. A command for the tip may change a
/// joint angle by three times as much.
pub const REAL_JOINT_STEP: f64 = 0.0524;

/// Largest motion of a fingertip in one command to a real finger, cm.
pub const REAL_TIP_STEP: f64 = 0.3;

/// Angles of an open finger, degrees: in the default hand, the tips of fingers 1 and 2 are 9.2 cm from that of finger 3
/// along y of the palm.
const OPEN_DEGREES: [f64; 3] = [0.0, -25.0, 40.0];

/// Angles of a closed finger, degrees: in the default hand, all tips are at y = 0 of the palm.
const CLOSED_DEGREES: [f64; 3] = [0.0, 5.0, 45.0];

/// A command. In JSON its name is in the key `command`: `{"command": "push", "finger": 1, "force": [0, 0, -1]}`.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(tag = "command", rename_all = "snake_case", deny_unknown_fields)]
pub enum Command {
    /// Sends the desired joint angles, rad.
    Joints { finger: i32, joints: [f64; 3] },
    /// Changes the desired joint angles, rad.
    MoveJoints { finger: i32, by: [f64; 3] },
    /// Sends the desired position of the tip in the finger's frame, cm.
    Tip { finger: i32, tip: [f64; 3] },
    /// Changes the desired position of the tip in the finger's frame, cm.
    MoveTip { finger: i32, by: [f64; 3] },
    /// Sends Kx in the finger's frame, N/cm: `kx[row][column]`.
    Stiffness { finger: i32, kx: [[f64; 3]; 3] },
    /// Multiplies Kx by a factor.
    ScaleStiffness { finger: i32, factor: f64 },
    /// Pushes the tip of a simulated finger with a force in the finger's frame, N, until the next push.
    Push { finger: i32, force: [f64; 3] },
    /// Moves all running fingers apart.
    Open,
    /// Moves all running fingers to the middle of the palm.
    Close,
    /// Stops all fingers at once, as the planner's sun2xp_stop_all does.
    Stop,
    /// Makes a stopped or faulted finger a spring again, which holds its present pose. Takes up to some seconds.
    Recover { finger: i32 },
}

/// A command that is refused. A refused command changes nothing.
#[derive(Debug)]
pub enum Refused {
    /// The hand refuses the command.
    Hand(HandError),
    /// The command would move a real finger too far.
    TooFar {
        finger: i32,
        /// "a joint" or "the tip".
        part: &'static str,
        /// The motion that was asked for, and the largest one, with the unit.
        asked: String,
        most: String,
    },
    /// A joint of a real finger is so far beyond its limits that one step does not bring it back.
    BeyondLimits {
        finger: i32,
        joint: usize,
        /// The desired angle, degrees.
        angle: f64,
    },
    /// No finger runs, so none can be opened or closed.
    NoneRuns,
    /// An emergency stop came before the recovery of the finger began.
    Stopped { finger: i32 },
}

impl Display for Refused {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hand(error) => error.fmt(formatter),
            Self::TooFar { finger, part, asked, most } => write!(
                formatter,
                "the command would move {part} of finger {finger} by {asked}, and one command may move it by at most \
                 {most}, because the finger is real: send smaller steps"
            ),
            Self::BeyondLimits { finger, joint, angle } => write!(
                formatter,
                "the set point of joint {joint} of finger {finger}, {angle:.1} degrees, is more than one step beyond \
                 the limits of the joint: stop the hand, move the finger into its limits by hand, and recover it"
            ),
            Self::NoneRuns => formatter.write_str("no finger runs: recover the fingers first"),
            Self::Stopped { finger } => {
                write!(formatter, "an emergency stop came before finger {finger} began to recover: recover it again")
            }
        }
    }
}

impl From<HandError> for Refused {
    fn from(error: HandError) -> Self {
        Self::Hand(error)
    }
}

impl Command {
    /// Returns whether the command ends a push. Such a command moves nothing by itself. It must be carried out even if
    /// many other commands wait or a stop has come: otherwise the push would go on.
    pub fn ends_push(&self) -> bool {
        matches!(self, Self::Push { force: [0.0, 0.0, 0.0], .. })
    }

    /// Carries the command out, and returns what was done, in words. `stopped` returns whether an emergency stop has
    /// come since the command was sent.
    ///
    /// # Errors
    /// Returns an error for each reason in [`Refused`].
    pub fn execute(
        &self,
        hand: &Hand,
        configuration: &Configuration,
        stopped: &dyn Fn() -> bool,
    ) -> Result<String, Refused> {
        match *self {
            Self::Joints { finger, joints } => send_joints(hand, configuration, finger, joints),
            Self::MoveJoints { finger, by } => {
                send_joints(hand, configuration, finger, sum(desired_joints(hand, finger)?, by))
            }
            Self::Tip { finger, tip } => send_tip(hand, configuration, finger, tip),
            Self::MoveTip { finger, by } => {
                let desired = hand.tip_at(finger, desired_joints(hand, finger)?)?;
                send_tip(hand, configuration, finger, sum(desired, by))
            }
            Self::Stiffness { finger, kx } => send_stiffness(hand, finger, kx),
            Self::ScaleStiffness { finger, factor } => {
                let kx = desired_stiffness(hand, finger)?.map(|row| row.map(|entry| entry * factor));
                send_stiffness(hand, finger, kx)
            }
            Self::Push { finger, force } => {
                hand.push_simulated(finger, force)?;
                Ok(match force {
                    [0.0, 0.0, 0.0] => format!("finger {finger}: no push"),
                    [x, y, z] => format!("finger {finger}: pushed with {x:.1}, {y:.1}, {z:.1} N"),
                })
            }
            Self::Open => move_all(hand, configuration, OPEN_DEGREES, "opens"),
            Self::Close => move_all(hand, configuration, CLOSED_DEGREES, "closes"),
            Self::Stop => {
                sun2xp::stop_all();
                Ok("all fingers are stopped".into())
            }
            Self::Recover { finger } => recover(hand, finger, stopped),
        }
    }
}

/// Recovers a finger, unless an emergency stop came before the recovery began.
fn recover(hand: &Hand, finger: i32, stopped: &dyn Fn() -> bool) -> Result<String, Refused> {
    let recovering = Recovering::begin(hand, finger)?;
    // The recovery would undo a stop that came before it began. Later stops end it.
    if stopped() {
        return Err(Refused::Stopped { finger });
    }
    recovering.reconnect()?;
    while !recovering.poll(hand)? {
        sleep(POLLED);
    }
    Ok(format!("finger {finger}: holds its pose"))
}

/// Returns the desired joint angles that were sent last, rad. Commands that have waited for a recovery follow each
/// other within a cycle, so the angles in force do not contain the steps of the earlier commands yet.
pub fn desired_joints(hand: &Hand, finger: i32) -> Result<[f64; 3], HandError> {
    Ok(hand.last_set_point(finger)?.joints.into())
}

/// Returns the Kx that was sent last, N/cm: `[row][column]`.
pub fn desired_stiffness(hand: &Hand, finger: i32) -> Result<[[f64; 3]; 3], HandError> {
    let stiffness = hand.last_set_point(finger)?.stiffness;
    Ok(std::array::from_fn(|row| std::array::from_fn(|column| stiffness[(row, column)])))
}

/// Returns whether a finger has a real port. Returns false if there is no finger with this number.
pub fn is_real(configuration: &Configuration, finger: i32) -> bool {
    let index = usize::try_from(finger).ok().and_then(|number| number.checked_sub(1));
    index.and_then(|index| configuration.fingers.get(index)).is_some_and(|finger| !finger.simulated())
}

fn send_joints(hand: &Hand, configuration: &Configuration, finger: i32, joints: [f64; 3]) -> Result<String, Refused> {
    let desired = desired_joints(hand, finger)?;
    if is_real(configuration, finger) {
        let degrees = largest_difference(admitted(configuration, finger, joints), desired).to_degrees();
        let most = REAL_JOINT_STEP.to_degrees();
        within(finger, ("a joint", degrees, "degrees"), most)?;
    }
    hand.send_position(finger, joints)?;
    let [j0, j1, j2] = admitted(configuration, finger, joints).map(f64::to_degrees);
    Ok(format!("finger {finger}: joints to {j0:.1}, {j1:.1}, {j2:.1} degrees"))
}

fn send_tip(hand: &Hand, configuration: &Configuration, finger: i32, tip: [f64; 3]) -> Result<String, Refused> {
    if is_real(configuration, finger) {
        let desired = desired_joints(hand, finger)?;
        let way = sum(tip, hand.tip_at(finger, desired)?.map(|entry| -entry));
        let distance = way.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
        within(finger, ("the tip", distance, "cm"), REAL_TIP_STEP)?;
        // Near a singular pose, or from one solution of the inverse kinematics to another, a small motion of the tip is
        // a large motion of the joints.
        let degrees = largest_difference(hand.joints_at(finger, tip)?, desired).to_degrees();
        within(finger, ("a joint", degrees, "degrees"), 3.0 * REAL_JOINT_STEP.to_degrees())?;
    }
    hand.send_tip(finger, tip)?;
    let [x, y, z] = tip;
    Ok(format!("finger {finger}: tip to {x:.2}, {y:.2}, {z:.2} cm"))
}

fn send_stiffness(hand: &Hand, finger: i32, kx: [[f64; 3]; 3]) -> Result<String, Refused> {
    hand.send_stiffness(finger, kx)?;
    let [x, y, z] = [kx[0][0], kx[1][1], kx[2][2]];
    Ok(format!("finger {finger}: Kx {x:.2}, {y:.2}, {z:.2} N/cm along x, y, z"))
}

/// Moves all running fingers towards these angles, real fingers by at most one step.
fn move_all(
    hand: &Hand,
    configuration: &Configuration,
    degrees: [f64; 3],
    verb: &'static str,
) -> Result<String, Refused> {
    let mut commands = Vec::new();
    for (finger, configured) in (1..).zip(&configuration.fingers) {
        if hand.report(finger).is_ok_and(|report| report.stage == Stage::Running) {
            let desired = desired_joints(hand, finger)?;
            let (low, high) = configured.joint_limits();
            let most = if configured.simulated() { f64::INFINITY } else { REAL_JOINT_STEP };
            let mut joints = [0.0; 3];
            for (joint, next) in joints.iter_mut().enumerate() {
                let target = degrees[joint].to_radians().clamp(low[joint], high[joint]);
                // The finger may hold a pose beyond its limits. If the angle is still beyond the limits after one step,
                // a hand that clamps would move the joint to its limit at once, which is more than one step.
                let angle = towards(desired[joint], target, most);
                if !(low[joint]..=high[joint]).contains(&angle) {
                    return Err(Refused::BeyondLimits { finger, joint, angle: desired[joint].to_degrees() });
                }
                *next = angle;
            }
            commands.push(FingerCommand::new(finger).joints(joints));
        }
    }
    if commands.is_empty() {
        return Err(Refused::NoneRuns);
    }
    hand.send_group(&commands)?;
    Ok(format!("the hand {verb}"))
}

/// Returns the joint angles that the hand uses if `joints` are sent, rad. A hand that clamps uses the nearest angles
/// within the limits.
fn admitted(configuration: &Configuration, finger: i32, joints: [f64; 3]) -> [f64; 3] {
    let index = usize::try_from(finger).ok().and_then(|number| number.checked_sub(1));
    match index.and_then(|index| configuration.fingers.get(index)) {
        Some(configured) if configuration.hand.out_of_range == OutOfRange::Clamp => {
            let (low, high) = configured.joint_limits();
            std::array::from_fn(|joint| joints[joint].clamp(low[joint], high[joint]))
        }
        _ => joints,
    }
}

/// Moves an angle towards a target by at most this much.
fn towards(from: f64, target: f64, most: f64) -> f64 {
    if (target - from).abs() <= most { target } else { from + most.copysign(target - from) }
}

/// Refuses a motion of the part if it is larger than `most`. Both are in `unit`.
fn within(finger: i32, (part, asked, unit): (&'static str, f64, &str), most: f64) -> Result<(), Refused> {
    // The comparison is false for NaN, which the hand refuses with a better text.
    if asked > most * (1.0 + 1e-9) {
        let [asked, most] = [asked, most].map(|motion| format!("{motion:.2} {unit}"));
        return Err(Refused::TooFar { finger, part, asked, most });
    }
    Ok(())
}

fn sum(left: [f64; 3], right: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|index| left[index] + right[index])
}

fn largest_difference(left: [f64; 3], right: [f64; 3]) -> f64 {
    (0..3).map(|index| (left[index] - right[index]).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
