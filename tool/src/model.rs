//! `sun2xp model`: the configured hand as a file for other programs.

pub mod geometry;
mod mjcf;
mod palm;
pub mod shape;
mod urdf;
mod xml;

pub use geometry::geometry;

use crate::failure::{Failure, unwritable};
use std::io::{self, Write};
use std::path::PathBuf;
use sun2xp::files::replace_file;
use sun2xp::hand;
use sun2xp::model::configuration::Configuration;

/// Writes a model of the configured hand for other programs: palm, fingers, joints with their stops, masses, tendons
/// and the object of the simulation.
///
/// Masses and friction are those of `[finger.simulation]`. Moment arms are `finger.geometry.r` times `moment_arm_ratio`
/// of that table. Shapes and colours are only for display. The frames of the fingertips are `finger1_tip` to
/// `finger3_tip`.
#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    format: Format,
    /// The configuration file. The default is the file that OpenHand would use.
    #[arg(long, visible_alias = "configuration", value_name = "FILE")]
    config: Option<PathBuf>,
    /// Write to this file instead of the standard output.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(clap::Args)]
#[group(required = true, multiple = false)]
struct Format {
    /// URDF, for ROS 2 and RViz.
    #[arg(long)]
    urdf: bool,
    /// MJCF, for MuJoCo 3.4 or later.
    #[arg(long)]
    mjcf: bool,
    /// The geometry as the web page draws it, in cm, rad and kg.
    #[arg(long)]
    json: bool,
}

/// Returns the URDF of a hand.
pub fn urdf(configuration: &Configuration) -> String {
    urdf::urdf(&geometry(configuration), configuration)
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let configuration = match &arguments.config {
        Some(file) => hand::Configured::read(file)?.configuration,
        None => hand::find_configuration()?.configuration,
    };
    let text = match arguments.format {
        Format { urdf: true, .. } => urdf(&configuration),
        Format { mjcf: true, .. } => mjcf::mjcf(&geometry(&configuration), &configuration)?,
        Format { .. } => serde_json::to_string_pretty(&geometry(&configuration))? + "\n",
    };
    match &arguments.output {
        None => io::stdout().lock().write_all(text.as_bytes())?,
        Some(path) => {
            replace_file(path, |file| file.write_all(text.as_bytes())).map_err(|error| unwritable(path, &error))?;
        }
    }
    Ok(())
}
