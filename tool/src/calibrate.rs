//! `sun2xp calibrate`: finds signs, zeros, friction and stiffness of the fingers, and stores them in the configuration
//! file.

mod pose;
mod report;

use crate::failure::Failure;
use crate::print::{self, Progress, Screen};
pub use pose::pose;
use pose::{ask_to_hold, ask_to_release};
use report::{Calibrated, Measured, Report};
use std::io::{self, Write};
use std::path::PathBuf;
use sun2xp::calibration::{self, Findings, Task};
use sun2xp::hand::{Configured, Fingers, Hand, HandError};
use sun2xp::model::ShownPath;
use sun2xp::model::configuration::{ConfiguredFinger, FINGERS, ZeroingMethod};

/// Finds signs, zeros, friction and stiffness of the fingers, and writes them into the configuration file.
///
/// Without --signs, --zero and --identify the tool does all three, in this order. The motors are off at the beginning.
/// After an identification that followed a zeroing, the tool zeroes the finger again, because the zeros depend on the
/// stretch of the tendons and on their moment arms.
///
/// Signs: every motor turns a little in both directions.
///
/// Zero: the tool slackens the tendons and reads the gauges. Then it zeros the encoders by the method
/// `finger.zeroing.method`. Without that key, it zeros them against the stops of the finger if the finger is simulated
/// or `finger.zeroing` gives the angles of its stops, and otherwise at a pose in which you hold the finger. A finger
/// that is not held in the pose is refused.
///
/// Identify: the finger moves its joints in both directions and between their stops, and presses against its lower
/// stops. The whole range of its joints must be free of objects.
///
/// Only the results are written; the rest of the file stays unchanged.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration file. The tool reads it, and writes the results of each task into it.
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// The finger. May be repeated. The default is all fingers. The ports of other fingers are not opened.
    #[arg(long = "finger", value_name = "N", value_parser = clap::value_parser!(i32).range(1..=FINGERS as i64))]
    fingers: Vec<i32>,
    /// Find the signs of motors, encoders and gauges.
    #[arg(long)]
    signs: bool,
    /// Zero gauges and encoders.
    #[arg(long)]
    zero: bool,
    /// Measure friction and tendon stiffness. The finger must have been zeroed.
    #[arg(long)]
    identify: bool,
    /// Do not wait for Enter when a person is to hold a finger or let it go. This is for scripts that use a jig.
    #[arg(long)]
    yes: bool,
    /// Do not write the results.
    #[arg(long)]
    dry_run: bool,
    /// Print one JSON object with the configured and the found values, for other programs.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let configured = Configured::read(&arguments.config)?.local()?;
    let fingers = Fingers::of(&arguments.fingers)?.in_hand(&configured.configuration.hand)?;
    configured.announce(fingers);
    let tasks = arguments.tasks();
    let hand = Hand::open_limp(configured.configuration, Some(arguments.config.clone()), fingers)?;
    let mut report = Report { fingers: Vec::new(), written: None };
    let mut printed = Ok(());
    for finger in fingers.numbers() {
        let before = hand.calibrated(finger)?;
        let mut calibrated = Calibrated { finger, ..Calibrated::default() };
        for (done, &task) in tasks.iter().enumerate() {
            let found = arguments.carry_out(&hand, task, finger, &before).map_err(|failure| match failure {
                Refused::ByPerson(failure) => failure,
                Refused::ByHand(error) => {
                    let rest = fingers.numbers().filter(|&other| other > finger);
                    let instructions = arguments.instructions(finger, &tasks[done..], &rest.collect::<Vec<_>>());
                    format!("{error}. {instructions}").into()
                }
            })?;
            // A zeroing reports the errors that the joint angles had before it. Before the second zeroing, the first
            // one has already corrected them. So of all zeroings, `measured` gets only the errors of the first.
            if !tasks[..done].contains(&task) {
                calibrated.measured.extend(Measured::all(&found));
            }
            // Results are stored after each task, so that they are kept if a later task is refused.
            if !arguments.dry_run {
                hand.store_calibration(finger)?;
            }
        }
        calibrated.compare(&before, &hand.calibrated(finger)?);
        if !arguments.json {
            printed = printed.and(write!(io::stdout(), "{}", calibrated.text(&Screen::stdout())));
        }
        // If the reader of standard output has closed the pipe, the remaining fingers are calibrated all the same. With
        // --dry-run this would be useless, because their results are not stored.
        if arguments.dry_run && printed.is_err() {
            break;
        }
        report.fingers.push(calibrated);
    }
    printed?;
    report.written = (!arguments.dry_run).then(|| arguments.config.clone());
    match (&report.written, arguments.json) {
        (_, true) => print::json(&report)?,
        (None, false) => writeln!(io::stdout(), "nothing written (--dry-run)")?,
        (Some(path), false) => writeln!(io::stdout(), "written to {}", ShownPath(path))?,
    }
    Ok(())
}

/// Why a task was not done.
enum Refused {
    /// Nobody is there to hold the finger.
    ByPerson(Failure),
    /// [`Hand`] has refused the task.
    ByHand(HandError),
}

impl Arguments {
    /// Carries out one task. If the task needs it, the person is first asked to hold the finger or to let it go.
    fn carry_out(&self, hand: &Hand, task: Task, finger: i32, before: &ConfiguredFinger) -> Result<Findings, Refused> {
        let calibrated = hand.calibrated(finger).map_err(Refused::ByHand)?;
        let at_pose = calibrated.zeroing_method() == ZeroingMethod::Pose;
        match task {
            Task::Zero if at_pose => ask_to_hold(finger, before, self.yes),
            Task::Identify if at_pose && self.tasks().contains(&Task::Zero) => ask_to_release(finger, self.yes),
            _ => Ok(()),
        }
        .map_err(Refused::ByPerson)?;
        with_progress(hand, finger, task, "finding signs").map_err(Refused::ByHand)
    }

    /// The requested tasks, in the order of their execution.
    fn tasks(&self) -> Vec<Task> {
        let again = self.zero && self.identify;
        let asked =
            [(Task::Signs, self.signs), (Task::Zero, self.zero), (Task::Identify, self.identify), (Task::Zero, again)];
        let everything = asked.iter().all(|&(_, asked)| !asked);
        asked.into_iter().filter(|&(_, asked)| asked || everything).map(|(task, _)| task).collect()
    }

    /// What to do after a refusal. `left` are the remaining tasks of this finger; all tasks of the `others` remain.
    fn instructions(&self, finger: i32, left: &[Task], others: &[i32]) -> String {
        let kept = [(" --yes", self.yes), (" --dry-run", self.dry_run), (" --json", self.json)];
        let kept: String = kept.into_iter().filter(|&(_, asked)| asked).map(|(option, _)| option).collect();
        let command = format!("sun2xp calibrate --config {}{kept}", ShownPath(&self.config));
        let options = |tasks: &[Task]| {
            let option = |task| match task {
                Task::Signs => " --signs",
                // The self-test is not a task of this command.
                Task::SelfTest => "",
                Task::Zero => " --zero",
                Task::Identify => " --identify",
            };
            let new = |&(place, task): &(usize, &Task)| !tasks[..place].contains(task);
            tasks.iter().enumerate().filter(new).map(|(_, &task)| option(task)).collect::<String>()
        };
        let again = if self.dry_run { self.tasks() } else { left.to_vec() };
        let mut text = format!(
            "The calibration has stopped. To continue after the cause is removed: {command} --finger {finger}{}",
            options(&again)
        );
        if !others.is_empty() {
            let fingers: String = others.iter().map(|other| format!(" --finger {other}")).collect();
            text += &format!("; then for the remaining fingers: {command}{fingers}{}", options(&self.tasks()));
        }
        text
    }
}

/// Runs a task with a limp finger, and shows its progress. `signs` describes the task that finds the signs.
pub fn with_progress(hand: &Hand, finger: i32, task: Task, signs: &str) -> Result<Findings, HandError> {
    let doing = match task {
        Task::Signs => signs,
        Task::SelfTest => "checking the wiring",
        Task::Zero => "zeroing",
        Task::Identify => "identifying",
    };
    // The progress is counted in thousandths.
    let shown = Progress::new(format!("finger {finger}, {doing}"), 1000).with_every_name();
    let progress = |progress: calibration::Progress| {
        shown.now(progress.step.to_string());
        shown.reach((progress.part * 1000.0) as u64);
    };
    match task {
        Task::Signs => hand.find_signs(finger, progress),
        Task::SelfTest => hand.self_test(finger, progress).map(|()| Findings::RightWiring),
        Task::Zero => hand.zero(finger, progress),
        Task::Identify => hand.identify(finger, progress),
    }
}
