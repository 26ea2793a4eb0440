//! `sun2xp calibrate`: signs, zeros, friction and stiffness of the fingers, into the configuration file.

use crate::board::Failure;
use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;
use sun2xp::control::calibration::{Findings, Progress, Step};
use sun2xp::hand::{Configured, Fingers, Hand};
use sun2xp::model::ShownPath;
use sun2xp::model::configuration::{ConfiguredFinger, FINGERS};

/// Finds signs, zeros, friction and stiffness of the fingers and writes them into the configuration file.
///
/// Without --signs, --zero and --identify it does all three, in this order. The motors are off in the beginning. Signs: every
/// motor turns a little, to and fro. Zero: tendons are let out and gauges read, then the encoders are zeroed as
/// `finger.zeroing.method` says. Identify: the finger goes to its lower stops, moves its joints to and fro and presses. Needs
/// the room that the joints can reach, and nothing in the hand. Only keys that changed are written; comments stay.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration file: read, and rewritten at the end.
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// Which finger; may be given again. Without it: all. The ports of the others are not opened.
    #[arg(long = "finger", value_name = "N", value_parser = clap::value_parser!(i32).range(1..=FINGERS as i64))]
    fingers: Vec<i32>,
    /// Find which way motors, encoders and gauges count.
    #[arg(long)]
    signs: bool,
    /// Zero gauges and encoders.
    #[arg(long)]
    zero: bool,
    /// Measure friction and tendon stiffness. The finger must have been zeroed.
    #[arg(long)]
    identify: bool,
    /// Write nothing.
    #[arg(long)]
    dry_run: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let configured = Configured::read(&arguments.config)?;
    let fingers = Fingers::of(&arguments.fingers)?;
    configured.announce(fingers);
    let everything = !(arguments.signs || arguments.zero || arguments.identify);
    let hand = Hand::open_limp(configured.configuration, Some(arguments.config.clone()), fingers)?;
    for finger in fingers.numbers() {
        let before = hand.calibrated(finger)?;
        if everything || arguments.signs {
            tell(hand.find_signs(finger, show(finger))?)?;
        }
        if everything || arguments.zero {
            tell(hand.zero(finger, show(finger))?)?;
        }
        if everything || arguments.identify {
            tell(hand.identify(finger, show(finger))?)?;
        }
        compare(finger, &before, &hand.calibrated(finger)?)?;
        // After each finger: what was found is kept if the next one is refused.
        if !arguments.dry_run {
            hand.store_calibration()?;
        }
    }
    let mut output = io::stdout().lock();
    match arguments.dry_run {
        true => writeln!(output, "nothing written (--dry-run)")?,
        false => writeln!(output, "written to {}", ShownPath(&arguments.config))?,
    }
    Ok(())
}

/// Progress on standard error: a line that is overwritten on a terminal, else one line for each step.
fn show(finger: i32) -> impl FnMut(Progress) {
    let terminal = io::stderr().is_terminal();
    let mut last = None;
    move |progress| {
        let what = match progress.step {
            Step::TakingUpSlack => "taking up slack",
            Step::ZeroingGauges => "zeroing gauges, tendons let out",
            Step::TryingPose => "pushing lightly against what holds the pose",
            Step::ReadingEncoders => "reading encoders",
            Step::SeekingStops => "seeking stops",
            Step::TryingMotors => "trying motors",
            Step::ComparingGauges => "comparing gauges",
            Step::MovingJoints => "moving joints",
            Step::Pressing => "pressing",
            Step::Returning => "returning",
        };
        let percent = (progress.part * 100.0) as u32;
        if last != Some((progress.step, if terminal { percent } else { 0 })) {
            let (begin, end) = if terminal { ("\r\x1b[K", "") } else { ("", "\n") };
            // Nobody may be reading it: no reason to stop the finger.
            let _ = write!(io::stderr(), "{begin}finger {finger}: {percent:3} % {what}{end}");
            last = Some((progress.step, if terminal { percent } else { 0 }));
        }
    }
}

/// What is found and stored nowhere.
fn tell(findings: Findings) -> io::Result<()> {
    let mut output = io::stdout().lock();
    if io::stderr().is_terminal() {
        let _ = writeln!(io::stderr());
    }
    match findings {
        Findings::Signs(_) => Ok(()),
        Findings::Zeros(zeros) => {
            let degrees = zeros.joint_error.map(f64::to_degrees);
            writeln!(output, "joint angles were off by, degrees:      {}", list(degrees.as_slice(), 2))?;
            if let Some(range) = zeros.range_error {
                writeln!(
                    output,
                    "way between stops, more than configured: {}",
                    list(range.map(f64::to_degrees).as_slice(), 2)
                )?;
            }
            Ok(())
        }
        Findings::Identified(found) => {
            writeln!(output, "gauge gain over the configured one: {}", list(found.gauge_gain.as_slice(), 4))?;
            writeln!(output, "motor torque over command, by the gauges: {}", list(found.motor_ratio.as_slice(), 3))?;
            writeln!(output, "viscous joint friction, N cm s/rad:       {}", list(found.joint_viscous.as_slice(), 3))?;
            writeln!(output, "motor travel not explained, cm rms:       {:.5}", found.travel_residual)
        }
    }
}

/// A table of what was configured and what was found.
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
    row("friction.joint_coulomb, N cm", list(&old.joint_coulomb, 4), list(&new.joint_coulomb, 4))
}

fn list<T: Display>(values: &[T], digits: usize) -> String {
    values.iter().map(|value| format!("{value:.digits$}")).collect::<Vec<_>>().join(" ")
}
