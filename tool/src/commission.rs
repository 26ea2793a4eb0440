//! `sun2xp commission`: leads a person through the bring-up of a finger, step by step.

mod computer;
mod configuration_file;
mod desk;
mod encoders;
mod gauges;
mod hand_machine;
mod line;
mod machine;
mod motors;
mod new_file;
mod new_finger;
mod order;
mod outcome;
mod person;
mod port_search;
mod progress_file;
mod session;
mod spring;
mod step;
mod tendons;
mod terminal;
#[cfg(test)]
mod tests;
mod vitals;
mod wrong;
mod zeros;

use crate::failure::{ExitStatus, Failure, wrong_usage};
use desk::Desk;
use hand_machine::HandMachine;
use person::GRAVITY;
use progress_file::{ProgressFile, path_beside};
use session::Session;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use step::Step;
use sun2xp::hand::{Configured, Fingers};
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::model::{FingerNumber, ShownPath};
use terminal::Terminal;
pub use vitals::Vitals;

/// The masses of the weights, kg, if none are given.
const DEFAULT_WEIGHTS: [f64; 2] = [0.5, 1.0];

/// With --yes or --json, `sun2xp health` repeats failed steps and readings without asking. This is the largest number
/// of repetitions in total.
const RETRIES: u32 = 3;

/// Leads through the bring-up of a finger, and writes what it finds into the configuration file.
///
/// The steps are board, computer, encoders, gauges, motors, zeros, tendons, bound and spring. Each step says what it
/// does and what you should see, and names every fault and its remedy. All steps except computer and bound ask you to
/// act at the finger. The motors are off between the steps. Steps that have passed are noted in a file beside the
/// configuration, for example hand.commission.json, and are skipped when the tool runs again.
///
/// Answer each request with Enter when it is done, with n if it cannot be done, and with q to leave.
///
/// Exit status: 0 if every step of this run has passed, 1 if one has not, 2 for wrong usage.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration file. The tool writes the results into it, with comments. If the file does not exist, the tool
    /// searches for a board and creates the file. If the file does not have the finger, the tool searches for a board
    /// and adds the finger.
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// The finger.
    #[arg(long, value_name = "N", default_value = "1", value_parser = finger)]
    finger: FingerNumber,
    /// If the configuration file does not have the finger yet, search for its board at these ports. A * in the last
    /// part of the path stands for any text. May be repeated. By default these are the ports of hand.search_ports.
    #[arg(long = "port", value_name = "PATH")]
    ports: Vec<String>,
    /// Do only this step, even if it has passed before. To do several steps, give this option several times.
    #[arg(long = "step", value_name = "STEP")]
    steps: Vec<Step>,
    /// Do every step again.
    #[arg(long, conflicts_with = "steps")]
    again: bool,
    /// The masses, kg, of the weights that you hang on the tendons during the step "gauges". The tool asks for the
    /// lightest weight first. The heaviest one must not pull with more than `finger.tendon.maximum`.
    #[arg(long, value_name = "KG", value_delimiter = ',', default_values_t = DEFAULT_WEIGHTS, value_parser = mass)]
    weights: Vec<f64>,
    /// Do not wait for Enter. Use this only if a machine, and not a person, does at the finger what the tool asks for.
    #[arg(long)]
    yes: bool,
}

/// Reads the number of a finger.
pub fn finger(text: &str) -> Result<FingerNumber, String> {
    let number = text.parse().ok().and_then(|number: i32| FingerNumber::try_from(number).ok());
    number.ok_or_else(|| "not 1, 2 or 3".into())
}

fn mass(text: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(mass) if (0.01..=20.0).contains(&mass) => Ok(mass),
        _ => Err("not a mass of 0.01 to 20 kg".into()),
    }
}

pub fn run(arguments: &Arguments) -> Result<ExitStatus, Failure> {
    let (file, number) = (path_beside(&arguments.config), arguments.finger.get());
    if !arguments.config.exists() {
        new_file::create(&arguments.config, arguments.finger, &arguments.ports)?;
        ProgressFile::forget(&file, number)?;
    }
    let configured = Configured::read(&arguments.config)?.local()?;
    let configured = match configured.configuration.hand.fingers.contains(arguments.finger) {
        true => configured,
        false => {
            new_finger::add(&arguments.config, &configured.configuration, arguments.finger, &arguments.ports)?;
            ProgressFile::forget(&file, number)?;
            Configured::read(&arguments.config)?.local()?
        }
    };
    configured.announce(Fingers::one(arguments.finger));
    let finger = configured.configuration.fingers[arguments.finger.index()].clone();
    let mut weights: Vec<f64> = arguments.weights.iter().map(|mass| mass * GRAVITY).collect();
    weights.sort_by(f64::total_cmp);
    if let Some(heaviest) = weights.last().filter(|&&heaviest| heaviest > finger.tendon.maximum) {
        let most = heaviest_mass(finger.tendon.maximum);
        return Err(wrong_usage(format!(
            "the heaviest weight pulls with {heaviest:.1} N, and finger.tendon.maximum is {:.1} N: give --weights up \
             to {most:.2} kg",
            finger.tendon.maximum
        )));
    }
    let known = ProgressFile::read(&file)?.fingers.remove(&number).unwrap_or_default();
    let steps = arguments.steps_left(|step| known.steps.contains_key(&step));
    let mut terminal = Terminal::new(arguments.yes, steps.clone());
    terminal.heading(number, &arguments.config, &known)?;
    let mut machine = HandMachine::new(configured.configuration, arguments.finger);
    let mut desk = Desk { machine: &mut machine, person: &mut terminal, finger, weights, vitals: known.vitals };
    let session = Session { config: &arguments.config, finger: arguments.finger, weights: &arguments.weights, file };
    for step in steps {
        if !session.carry_out(&mut desk, step)? {
            return Ok(ExitStatus::FAILURE);
        }
    }
    writeln!(io::stdout(), "\n{}", session.closing()?)?;
    Ok(ExitStatus::SUCCESS)
}

/// Returns the largest mass that may hang on a tendon, kg, rounded down to 0.01 kg. `maximum` is the largest permitted
/// tension, N.
fn heaviest_mass(maximum: f64) -> f64 {
    (maximum / GRAVITY * 100.0).floor() / 100.0
}

/// The measurements of a finger at its commissioning and today, each with the configuration that belongs to them.
pub struct Examined {
    pub before: (Vitals, ConfiguredFinger),
    pub today: (Vitals, ConfiguredFinger),
}

/// Measures a commissioned finger again, without changing a file.
pub fn examine(file: &Path, finger: FingerNumber, yes: bool, quiet: bool) -> Result<Examined, Failure> {
    let configured = Configured::read(file)?.local()?;
    configured.announce(Fingers::one(finger));
    let beside = path_beside(file);
    let known = ProgressFile::read(&beside)?.fingers.remove(&finger.get()).unwrap_or_default();
    let advice = format!("run sun2xp commission --config {} --finger {finger} first", ShownPath(file));
    if known.vitals.tendon_stiffness.is_none() {
        return Err(format!("{} has no measurements of finger {finger}: {advice}", ShownPath(&beside)).into());
    }
    if let Some(fault) = known.open_fault(Step::Tendons) {
        return Err(format!("{fault}: {advice}").into());
    }
    if ![Step::Zeros, Step::Tendons].iter().all(|step| known.steps.contains_key(step)) {
        return Err(format!(
            "the step \"zeros\" or \"tendons\" of finger {finger} does not count as passed: it was not done, it has \
             failed, or an earlier step was repeated after it: {advice}"
        )
        .into());
    }
    let before = configured.configuration.fingers[finger.index()].clone();
    let steps = vec![Step::Zeros, Step::Tendons];
    let mut terminal = Terminal::new(yes, steps.clone());
    (terminal.quiet, terminal.retries) = (quiet, RETRIES);
    let mut machine = HandMachine::new(configured.configuration, finger);
    let mut desk = Desk {
        machine: &mut machine,
        person: &mut terminal,
        finger: before.clone(),
        weights: Vec::new(),
        vitals: Vitals::default(),
    };
    measure(&mut desk, &steps)?;
    let today = (desk.vitals.clone(), desk.finger.clone());
    Ok(Examined { before: (known.vitals, before), today })
}

/// Does these steps. A step that fails is repeated as long as the person agrees. Without a person (--yes or --json), it
/// is repeated until the [`RETRIES`] are used up.
fn measure(desk: &mut Desk, steps: &[Step]) -> Result<(), Failure> {
    for &step in steps {
        let outcome = desk.complete(step, |_| Ok(()))?;
        if let Some(wrong) = outcome.wrong.iter().find(|wrong| !wrong.compensated()) {
            return Err(format!("the step \"{step}\" stopped: {}", wrong.with_remedy()).into());
        }
    }
    Ok(())
}

impl Arguments {
    /// The steps to do, in their order.
    fn steps_left(&self, done: impl Fn(Step) -> bool) -> Vec<Step> {
        let wanted = |step: &Step| match self.steps.is_empty() {
            true => self.again || !done(*step),
            false => self.steps.contains(step),
        };
        Step::ALL.into_iter().filter(wanted).collect()
    }
}
