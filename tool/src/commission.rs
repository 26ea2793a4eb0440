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
mod outcome;
mod person;
mod progress_file;
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
use crate::monitor::words::utc;
use desk::Desk;
use hand_machine::HandMachine;
use outcome::Outcome;
use person::GRAVITY;
use progress_file::{ProgressFile, path_beside};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};
use step::Step;
use sun2xp::hand::Configured;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::model::{FingerNumber, ShownPath};
use terminal::{LEFT, Terminal};
pub use vitals::Vitals;

/// Leads through the bring-up of a finger, and writes what it finds into the configuration file.
///
/// The steps are board, encoders, gauges, motors, zeros, tendons, bound, computer and spring. Each step says what it
/// does and what you should see, asks you to act at the finger, and names what is wrong with its remedy. The motors are
/// off between the steps. Steps that have passed are noted in a file beside the configuration, for example
/// hand.commission.json, and are skipped when the tool runs again.
///
/// Answer each request with Enter when it is done, with n if it cannot be done, and with q to leave.
///
/// Exit status: 0 if every step has passed, 1 if one has not, 2 for wrong usage.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration file. The tool writes the results into it, with comments. If it does not exist, the tool
    /// searches for a board and creates it.
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// The finger.
    #[arg(long, value_name = "N", default_value = "1", value_parser = finger)]
    finger: FingerNumber,
    /// Search for the board of a new configuration file at these ports. A * in the last part of the path stands for any
    /// text. May be repeated. The default is that of hand.search_ports.
    #[arg(long = "port", value_name = "PATH")]
    ports: Vec<String>,
    /// Do this step, and no other, even if it has passed before. May be repeated.
    #[arg(long = "step", value_name = "STEP")]
    steps: Vec<Step>,
    /// Do every step again.
    #[arg(long, conflicts_with = "steps")]
    again: bool,
    /// The masses of the weights for the gauges, kg, in rising order. The weight of the heaviest must be below
    /// `finger.tendon.maximum`.
    #[arg(long, value_name = "KG", value_delimiter = ',', default_values_t = [0.5, 1.0], value_parser = mass)]
    weights: Vec<f64>,
    /// Do not wait for Enter: a jig does what the tool asks for.
    #[arg(long)]
    yes: bool,
}

/// Reads the number of a finger.
pub fn finger(text: &str) -> Result<FingerNumber, String> {
    let number: i32 = text.parse().map_err(|_| "not a number")?;
    FingerNumber::try_from(number).map_err(|_| "not 1, 2 or 3".into())
}

fn mass(text: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(mass) if (0.01..=20.0).contains(&mass) => Ok(mass),
        _ => Err("not a mass of 0.01 to 20 kg".into()),
    }
}

pub fn run(arguments: &Arguments) -> Result<ExitStatus, Failure> {
    if !arguments.config.exists() {
        new_file::create(&arguments.config, arguments.finger, &arguments.ports)?;
    }
    let configured = Configured::read(&arguments.config)?;
    if !configured.configuration.hand.fingers.contains(arguments.finger) {
        let reason = format!("hand.fingers has no finger {}: add it to the list", arguments.finger);
        return Err(wrong_usage(format!("{}: {reason}", ShownPath(&arguments.config))));
    }
    let finger = configured.configuration.fingers[arguments.finger.index()].clone();
    let mut weights: Vec<f64> = arguments.weights.iter().map(|mass| mass * GRAVITY).collect();
    weights.sort_by(f64::total_cmp);
    if let Some(heaviest) = weights.last().filter(|&&heaviest| heaviest > finger.tendon.maximum) {
        let most = finger.tendon.maximum / GRAVITY;
        return Err(wrong_usage(format!(
            "the heaviest weight pulls with {heaviest:.1} N, and finger.tendon.maximum is {:.1} N: give --weights up \
             to {most:.2} kg",
            finger.tendon.maximum
        )));
    }
    let file = path_beside(&arguments.config);
    let progress = ProgressFile::read(&file)?;
    let number = arguments.finger.get();
    let known = progress.fingers.get(&number).cloned().unwrap_or_default();
    let steps = arguments.steps_left(|step| known.steps.contains_key(&step));
    let mut terminal = Terminal::new(arguments.yes, steps.clone());
    terminal.heading(number, &arguments.config, &known.steps)?;
    let mut machine = HandMachine::new(configured.configuration, arguments.finger);
    let mut desk = Desk { machine: &mut machine, person: &mut terminal, finger, weights, vitals: known.vitals };
    let mut session = Session { arguments, file, progress };
    for step in steps {
        if !session.carry_out(&mut desk, step)? {
            return Ok(ExitStatus::FAILURE);
        }
    }
    let text = "The finger is commissioned. At any later time, sun2xp health compares its state with that of today.";
    writeln!(io::stdout(), "\n{text}")?;
    Ok(ExitStatus::SUCCESS)
}

/// A finger on two days: its measurements, and its configuration with them.
pub struct Examined {
    pub before: (Vitals, ConfiguredFinger),
    pub today: (Vitals, ConfiguredFinger),
}

/// Measures a commissioned finger again, without changing a file.
pub fn examine(file: &Path, finger: FingerNumber, yes: bool, quiet: bool) -> Result<Examined, Failure> {
    let configured = Configured::read(file)?;
    let beside = path_beside(file);
    let vitals = ProgressFile::read(&beside)?.fingers.remove(&finger.get()).unwrap_or_default().vitals;
    if vitals.tendon_stiffness.is_none() {
        let advice = format!("run sun2xp commission --config {} --finger {finger} first", ShownPath(file));
        return Err(format!("{} has no measurements of finger {finger}: {advice}", ShownPath(&beside)).into());
    }
    let before = configured.configuration.fingers[finger.index()].clone();
    let steps = vec![Step::Zeros, Step::Tendons];
    let mut terminal = Terminal::new(yes, steps.clone());
    terminal.quiet = quiet;
    let mut machine = HandMachine::new(configured.configuration, finger);
    let mut desk = Desk {
        machine: &mut machine,
        person: &mut terminal,
        finger: before.clone(),
        weights: Vec::new(),
        vitals: Vitals::default(),
    };
    for step in steps {
        let outcome = desk.carry_out(step)?;
        if let Some(wrong) = outcome.wrong.iter().find(|wrong| !wrong.compensated()) {
            return Err(format!("the step {step} stopped: {wrong}").into());
        }
    }
    let today = (desk.vitals.clone(), desk.finger.clone());
    Ok(Examined { before: (vitals, before), today })
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

/// The date and time, UTC.
fn now() -> String {
    // A clock before 1970 is wrong anyway.
    utc(SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()))
}

/// The files of a commissioning.
struct Session<'a> {
    arguments: &'a Arguments,
    file: PathBuf,
    progress: ProgressFile,
}

impl Session<'_> {
    /// Completes a step and stores its results. Returns whether it has passed.
    fn carry_out(&mut self, desk: &mut Desk, step: Step) -> Result<bool, Failure> {
        let before = desk.finger.clone();
        let outcome = match desk.complete(step) {
            Ok(outcome) => outcome,
            Err(failure) if failure.to_string() == LEFT => {
                writeln!(io::stdout(), "\nLeft. {}", self.continuation())?;
                return Ok(false);
            }
            Err(failure) => return Err(format!("{failure}\n{}", self.continuation()).into()),
        };
        if !outcome.passed() {
            writeln!(io::stdout(), "\n{}", self.continuation())?;
            return Ok(false);
        }
        self.store(desk, step, &before, &outcome)?;
        Ok(true)
    }

    fn store(&mut self, desk: &Desk, step: Step, before: &ConfiguredFinger, outcome: &Outcome) -> Result<(), Failure> {
        let (number, when) = (self.arguments.finger.get(), now());
        let comment = format!("{when}, {step}: {}", outcome.found.first().map_or("", String::as_str));
        configuration_file::store(&self.arguments.config, number, before, &desk.finger, &comment)?;
        self.progress.note(number, step, outcome, &desk.vitals, when);
        self.progress.write(&self.file)
    }

    /// How to go on later.
    fn continuation(&self) -> String {
        format!(
            "The motors are off. To continue: sun2xp commission --config {} --finger {}",
            ShownPath(&self.arguments.config),
            self.arguments.finger
        )
    }
}
