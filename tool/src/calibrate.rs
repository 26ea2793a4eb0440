//! `sun2xp calibrate`: finds signs, zeros, friction and stiffness of the fingers, and stores them in the configuration
//! file.

mod pose;

use crate::failure::Failure;
use pose::{ask_to_hold, ask_to_release};
use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;
use sun2xp::calibration::{Findings, Progress, Task};
use sun2xp::hand::{Configured, Fingers, Hand};
use sun2xp::model::ShownPath;
use sun2xp::model::configuration::{ConfiguredFinger, FINGERS, ZeroingMethod};

/// Finds signs, zeros, friction and stiffness of the fingers, and writes them into the configuration file.
///
/// Without --signs, --zero and --identify the tool does all three, in this order. The motors are off at the beginning.
///
/// Signs: every motor turns a little in both directions.
///
/// Zero: the tendons are slackened and the gauges read. Then the encoders are zeroed by the method
/// `finger.zeroing.method`. Without that key, they are zeroed against the stops of the finger if `finger.zeroing` gives
/// their angles, or else at a pose in which you hold the finger. A finger that is not held in the pose is refused.
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
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let configured = Configured::read(&arguments.config)?;
    let fingers = Fingers::of(&arguments.fingers)?;
    configured.announce(fingers);
    let tasks = arguments.tasks();
    let hand = Hand::open_limp(configured.configuration, Some(arguments.config.clone()), fingers)?;
    for finger in fingers.numbers() {
        let before = hand.calibrated(finger)?;
        for (done, &task) in tasks.iter().enumerate() {
            let at_pose = hand.calibrated(finger)?.zeroing_method() == ZeroingMethod::Pose;
            let progress = show(finger, task);
            let found = match task {
                Task::Signs => hand.find_signs(finger, progress),
                Task::Zero => {
                    if at_pose {
                        ask_to_hold(finger, &before, arguments.yes)?;
                    }
                    hand.zero(finger, progress)
                }
                Task::Identify => {
                    if at_pose && tasks.contains(&Task::Zero) {
                        ask_to_release(finger, arguments.yes)?;
                    }
                    hand.identify(finger, progress)
                }
            };
            let found = found.map_err(|error| {
                end_line();
                let rest = fingers.numbers().filter(|&other| other > finger);
                format!("{error}\n{}", arguments.instructions(finger, &tasks[done..], &rest.collect::<Vec<_>>()))
            })?;
            report(found)?;
            // Results are stored after each task, so that they are kept if a later task is refused.
            if !arguments.dry_run {
                hand.store_calibration(finger)?;
            }
        }
        compare(finger, &before, &hand.calibrated(finger)?)?;
    }
    let mut output = io::stdout().lock();
    match arguments.dry_run {
        true => writeln!(output, "nothing written (--dry-run)")?,
        false => writeln!(output, "written to {}", ShownPath(&arguments.config))?,
    }
    Ok(())
}

impl Arguments {
    /// The requested tasks, in the order of their execution.
    fn tasks(&self) -> Vec<Task> {
        let asked = [(Task::Signs, self.signs), (Task::Zero, self.zero), (Task::Identify, self.identify)];
        let everything = asked.iter().all(|&(_, asked)| !asked);
        asked.into_iter().filter(|&(_, asked)| asked || everything).map(|(task, _)| task).collect()
    }

    /// What to do after a refusal. `left` are the remaining tasks of this finger; all tasks of the `others` remain.
    fn instructions(&self, finger: i32, left: &[Task], others: &[i32]) -> String {
        let command = format!("sun2xp calibrate --config {}", ShownPath(&self.config));
        let options = |tasks: &[Task]| {
            let option = |task| match task {
                Task::Signs => " --signs",
                Task::Zero => " --zero",
                Task::Identify => " --identify",
            };
            tasks.iter().map(|&task| option(task)).collect::<String>()
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

/// Ends the progress line on a terminal.
fn end_line() {
    if io::stderr().is_terminal() {
        let _ = writeln!(io::stderr());
    }
}

/// Shows progress on standard error. On a terminal one line is overwritten; otherwise there is one line per step.
fn show(finger: i32, task: Task) -> impl FnMut(Progress) {
    let doing = match task {
        Task::Signs => "finding signs",
        Task::Zero => "zeroing",
        Task::Identify => "identifying",
    };
    let terminal = io::stderr().is_terminal();
    let mut last = None;
    move |progress| {
        let percent = (progress.part * 100.0) as u32;
        if last != Some((progress.step, if terminal { percent } else { 0 })) {
            let (begin, end) = if terminal { ("\r\x1b[K", "") } else { ("", "\n") };
            // A failed write, for example because no program reads standard error, is no reason to stop the finger.
            let _ = write!(io::stderr(), "{begin}finger {finger}, {doing}: {percent:3} %, {}{end}", progress.step);
            last = Some((progress.step, if terminal { percent } else { 0 }));
        }
    }
}

/// Prints results that are not stored.
fn report(findings: Findings) -> io::Result<()> {
    let mut output = io::stdout().lock();
    end_line();
    match findings {
        Findings::Signs(_) => Ok(()),
        Findings::Zeros(zeros) => {
            let degrees = zeros.joint_error.map(f64::to_degrees);
            writeln!(output, "joint angle errors before zeroing, degrees: {}", list(degrees.as_slice(), 2))?;
            if let Some(range) = zeros.range_error {
                writeln!(
                    output,
                    "measured minus configured range, degrees:   {}",
                    list(range.map(f64::to_degrees).as_slice(), 2)
                )?;
            }
            Ok(())
        }
        Findings::Identified(found) => {
            writeln!(output, "gauge gain / configured gain:          {}", list(found.gauge_gain.as_slice(), 4))?;
            writeln!(output, "motor torque by gauges / command:      {}", list(found.motor_ratio.as_slice(), 3))?;
            writeln!(output, "viscous joint friction, N cm s/rad:    {}", list(found.joint_viscous.as_slice(), 3))?;
            writeln!(output, "residual of the motor travel, cm rms:  {:.5}", found.travel_residual)
        }
    }
}

/// Prints a table of the configured and the found values.
fn compare(finger: i32, before: &ConfiguredFinger, after: &ConfiguredFinger) -> io::Result<()> {
    let mut output = io::stdout().lock();
    writeln!(output, "{:<32} {:<36} {:<36} changed", format!("finger.{finger}"), "configured", "found")?;
    let mut row = |key: &str, before: String, after: String| {
        let changed = if before == after { "" } else { "*" };
        writeln!(output, "{key:<32} {before:<36} {after:<36} {changed}")
    };
    row("motor.sign", list(&before.motor.sign, 0), list(&after.motor.sign, 0))?;
    row("encoder.sign", list(&before.encoder.sign, 0), list(&after.encoder.sign, 0))?;
    row("encoder.zero", list(&before.encoder.zero, 0), list(&after.encoder.zero, 0))?;
    let scales = |finger: &ConfiguredFinger| list(&finger.gauge.newton_per_count, 5);
    row("gauge.newton_per_count, N", scales(before), scales(after))?;
    row("gauge.zero", list(&before.gauge.zero, 1), list(&after.gauge.zero, 1))?;
    row("tendon.stiffness, N/cm", list(&before.tendon.stiffness, 1), list(&after.tendon.stiffness, 1))?;
    let (old, new) = (&before.friction, &after.friction);
    row("friction.motor_coulomb, N cm", list(&old.motor_coulomb, 4), list(&new.motor_coulomb, 4))?;
    row("friction.conduit", list(&old.conduit, 4), list(&new.conduit, 4))?;
    row("friction.pulley", list(&old.pulley, 4), list(&new.pulley, 4))?;
    row("friction.joint_coulomb, N cm", list(&old.joint_coulomb, 4), list(&new.joint_coulomb, 4))?;
    let tolerances = |finger: &ConfiguredFinger| {
        let monitors = &finger.monitors;
        [monitors.friction_tolerance, monitors.moment_arm_tolerance, monitors.gauge_tolerance]
    };
    let names = ["friction", "moment_arm", "gauge"];
    for (name, (old, new)) in names.iter().zip(tolerances(before).into_iter().zip(tolerances(after))) {
        row(&format!("monitors.{name}_tolerance"), list(&[old], 3), list(&[new], 3))?;
    }
    for (joint, (old, new)) in before.geometry.r.iter().zip(&after.geometry.r).enumerate() {
        row(&format!("geometry.r, row {}, cm", joint + 1), list(old, 4), list(new, 4))?;
    }
    Ok(())
}

fn list<T: Display>(values: &[T], digits: usize) -> String {
    values.iter().map(|value| format!("{value:.digits$}")).collect::<Vec<_>>().join(" ")
}
