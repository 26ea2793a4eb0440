//! `sun2xp monitor`: an open hand in the terminal or in a browser.

pub mod draw;
pub mod finger_state;
mod picture;
pub mod show;
pub mod snapshot;
pub mod source;
pub mod state;
pub mod terminal;
pub mod view;
pub mod wake_ups;
pub mod words;

use crate::failure::Failure;
use crate::web;
use ratatui::crossterm::event::Event;
use show::Controls;
use source::{Source, Wanted};
use std::path::PathBuf;
use sun2xp::telemetry::{self, AttachError};
use terminal::Screen;
use view::View;

/// Shows an open hand in the terminal or on a web page, as it runs: joints, tensions, stiffness, forces, faults with
/// their remedies, events and timing. It only reads, and costs the servos nothing.
///
/// Keys: q quits, space freezes the picture, 1 2 3 or tab shows a finger in detail, s writes a snapshot, ? shows help.
#[derive(clap::Args)]
pub struct Arguments {
    /// Name of the hand (`telemetry.name` of its configuration). Not necessary if only one hand is open.
    #[arg(value_name = "NAME")]
    name: Option<String>,
    /// Folder for snapshots.
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    snapshots: PathBuf,
    /// Show the hand on a web page, with the hand in 3-D, and print the address of the page.
    #[arg(long)]
    web: bool,
    #[command(flatten)]
    address: web::Address,
}

/// Shows the hand until a key or a signal ends the view, or, with `--web`, until a signal ends the program. Waits for a
/// hand if there is none.
///
/// # Errors
/// Returns an error if the page cannot be served. Without `--web`, returns an error if there is no terminal, if the
/// terminal fails, or if several hands are open and none is named.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.web {
        return web::serve(web::listen(&arguments.address)?, Wanted::Named(arguments.name.clone()), None);
    }
    if !Screen::available() {
        return Err("the monitor needs a terminal: use `sun2xp status` for a file, a pipe or a script".into());
    }
    // If several hands are open and none is named, the error lists their names. It must appear in the shell, so the
    // hands are counted before the view takes the terminal.
    let names = telemetry::hands().map_err(AttachError::Names)?;
    if arguments.name.is_none() && names.len() > 1 {
        return Err(Box::new(AttachError::Several(names)));
    }
    let source = Source::start(Wanted::Named(arguments.name.clone()))?;
    let mut view = View::new("looking for the hand".into());
    let controls = Controls { keys: show::monitor_key, tick: |_: &mut View| {}, urgent: |_: &Event| {} };
    show::show(&mut view, &source, &arguments.snapshots, controls)
}
