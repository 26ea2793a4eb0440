//! How well a finger is the spring that it is told to be: the figures of `docs/stiffness.md`.
//!
//!     cargo bench --bench stiffness -- [--quick] [--seed N] [--rates 500,1000,2000] [--schemes "figure 10,state feedback"]
//!                                      [--write docs/stiffness.md] [--plots FOLDER]
//!
//! The pure core against the simulated finger, in memory and on simulated time, with one cycle between sample and torque.

mod cases;
mod closed_loop;
mod contact;
mod motion;
mod plots;
mod robustness;
mod statics;
mod table;

use cases::Case;
use clap::Parser;
use std::error::Error;
use std::path::PathBuf;
use sun2xp::model::configuration::Scheme;

#[derive(Parser)]
#[command(about = "Measures how well a finger is the spring that it is told to be")]
struct Arguments {
    /// Four poses instead of 24.
    #[arg(long)]
    quick: bool,
    /// Seed of the poses, of Kx and of the noise.
    #[arg(long, default_value_t = 20261121)]
    seed: u64,
    /// Hz, separated by commas.
    #[arg(long, value_delimiter = ',', default_values_t = [500.0, 1000.0, 2000.0])]
    rates: Vec<f64>,
    /// Tendon controllers, as in the configuration.
    #[arg(long, value_delimiter = ',', value_parser = scheme, default_values = ["figure 10", "state feedback"])]
    schemes: Vec<Scheme>,
    /// Replaces the table in this file, between its two marks.
    #[arg(long)]
    write: Option<PathBuf>,
    /// Draws step responses and ellipsoids into this folder.
    #[arg(long)]
    plots: Option<PathBuf>,
    /// Cargo passes it.
    #[arg(long, hide = true)]
    bench: bool,
}

fn scheme(name: &str) -> Result<Scheme, String> {
    use serde::Deserialize;
    use serde::de::IntoDeserializer;
    let name: serde::de::value::StrDeserializer<serde::de::value::Error> = name.into_deserializer();
    Scheme::deserialize(name).map_err(|error| error.to_string())
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let poses = if arguments.quick { 4 } else { 24 };
    let mut columns = Vec::new();
    for &rate in &arguments.rates {
        for &scheme in &arguments.schemes {
            let case = Case { scheme, rate, poses, seed: arguments.seed };
            eprintln!("{}", case.name());
            columns.push(table::Column::measure(&case));
        }
    }
    let text = table::markdown(&columns);
    println!("{text}");
    if let Some(file) = &arguments.write {
        table::replace_in(file, &text)?;
    }
    if let Some(folder) = &arguments.plots {
        plots::draw(folder, &arguments.schemes, arguments.seed)?;
    }
    Ok(())
}
