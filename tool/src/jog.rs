//! `sun2xp jog`: opens a hand, and moves it by keys or on a web page.

pub mod commands;
mod keys;
pub mod panel;
mod push;
pub mod stopper;
mod worker;

use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::monitor::show::{self, Controls};
use crate::monitor::source::{Source, Wanted};
use crate::monitor::terminal::Screen;
use crate::monitor::view::View;
use crate::web;
use panel::JogPanel;
use ratatui::crossterm::event::Event;
use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::Arc;
use sun2xp::model::configuration::Configuration;
use sun2xp::{Hand, hand};
use worker::Worker;

/// Opens a hand and moves it by keys. The keys move joints or fingertips, change the stiffness, and push the fingertips
/// of the simulated hand, which yield like springs. Shows the hand as `sun2xp monitor` does.
///
/// Without --config the hand is simulated. The command asks for confirmation before it moves a real hand. The steps of
/// a real hand are limited. The space bar stops all fingers. ? shows all keys.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration of the hand. Without it the hand is simulated.
    #[arg(long, visible_alias = "configuration", value_name = "FILE")]
    config: Option<PathBuf>,
    /// Do not ask before a real hand moves.
    #[arg(long)]
    yes: bool,
    /// Folder for snapshots.
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    snapshots: PathBuf,
    /// Show the hand on a web page instead of in the terminal, and print the address of the page.
    #[arg(long)]
    web: bool,
    /// Let the page move the hand. Whoever has the printed address may then move it.
    #[arg(long, requires = "web")]
    control: bool,
    #[command(flatten)]
    address: web::Address,
}

/// Opens the hand, and closes it at SIGINT, SIGTERM, SIGHUP or SIGQUIT. Without a page, a key closes it too.
///
/// # Errors
/// Returns an error if there is no terminal, if the page cannot be served, if the configuration cannot be used, if the
/// person does not confirm, or if the hand cannot be opened.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if !arguments.web && !Screen::available() {
        return Err("jog needs a terminal: run it in one, or with --web".into());
    }
    // If the page cannot be served, the hand is not opened, and nothing moves.
    let listener = arguments.web.then(|| web::listen(&arguments.address)).transpose()?;
    let mut configuration = match &arguments.config {
        Some(file) => hand::read_configuration(file)?,
        None => {
            writeln!(io::stdout(), "The hand is simulated, because no configuration file was named (--config FILE).")?;
            Configuration::default()
        }
    };
    // The screen and the page show the hand's telemetry.
    configuration.telemetry.enabled = true;
    let mut of_hand = configuration.hand.fingers.members().map(|number| &configuration.fingers[number.index()]);
    let real = of_hand.any(|finger| !finger.simulated());
    if real && !arguments.yes {
        confirm(&configuration, arguments)?;
    }
    writeln!(io::stdout(), "opening the hand ...")?;
    // A signal while the tendons are tightened closes the hand as soon as it is open.
    let interrupt = Interrupt::watch()?;
    let hand = Arc::new(Hand::open(configuration.clone())?);
    if interrupt.requested() {
        return Ok(());
    }
    let own = Wanted::Process(std::process::id());
    if let Some(listener) = listener {
        let control = if arguments.control { Some(web::Control::start(&hand, configuration.clone())?) } else { None };
        return web::serve(listener, own, control);
    }
    let source = Source::start(own)?;
    let worker = Worker::start(hand.clone(), configuration.clone())?;
    let mut view = View::new("the hand is open, and its first cycles have not arrived yet".into());
    view.jog = Some(JogPanel::new(real));
    let stopper = worker.stopper().clone();
    let controls = Controls {
        keys: |view: &mut View, key| keys::press(view, &worker, &configuration, key),
        tick: |view: &mut View| {
            if let Some(panel) = &mut view.jog {
                worker.outcomes().for_each(|outcome| panel.conclude(outcome));
            }
        },
        urgent: move |event: &Event| keys::stop(&stopper, event),
    };
    show::show(&mut view, &source, &arguments.snapshots, controls)
}

/// Asks whether the real hand may move.
fn confirm(configuration: &Configuration, arguments: &Arguments) -> Result<(), Failure> {
    let mut output = io::stdout().lock();
    writeln!(output, "This moves a real hand:")?;
    for number in configuration.hand.fingers.members() {
        let finger = &configuration.fingers[number.index()];
        let port = match finger.board {
            Some(board) => format!("the board {board}"),
            None => finger.port.clone(),
        };
        writeln!(output, "    finger {number}: {port}")?;
    }
    let stop = if arguments.web && !arguments.control {
        writeln!(output, "The tendons will be tightened.")?;
        "Ctrl-C closes the hand."
    } else {
        writeln!(output, "The tendons will be tightened. A step turns a joint by at most 3 degrees,")?;
        writeln!(output, "or moves a tip by at most 0.3 cm and each joint by at most 9 degrees.")?;
        if arguments.web { "On the page, the space bar stops all fingers." } else { "Space stops all fingers." }
    };
    write!(output, "{stop} Keep hands and cables clear. Type yes to continue: ")?;
    output.flush()?;
    let mut answer = String::new();
    io::stdin().read_line(&mut answer)?;
    match answer.trim() {
        "yes" => Ok(()),
        _ => Err("not confirmed, and nothing has moved: type yes, or run the tool with --yes".into()),
    }
}
