//! Measures how accurately a finger behaves as the commanded spring: the figures of `docs/stiffness.md`.
//!
//!     cargo bench --bench stiffness -- [--quick] [--poses N] [--seed N] [--rates 500,1000,2000]
//!                                      [--controllers "figure 9,state feedback"] [--only TEXT] [--out FOLDER]
//!                                      [--write docs/stiffness.md]
//!     cargo bench --bench stiffness -- --truths [TEXT] [--identified] [--law report] [--seeds N] [--short]
//!     cargo bench --bench stiffness -- --search [TEXT] [--numbers TOML]
//!
//! The controller runs against the simulated finger, in memory and in simulated time. One cycle passes between a
//! sample and its torque.

mod cases;
mod closed_loop;
mod contact;
mod damping_range;
mod fits;
mod identification;
mod motion;
mod overlay;
mod parallel;
mod plots;
mod robustness;
mod search;
mod stability;
mod statics;
mod table;
mod trials;
mod truths;
mod truths_table;

use cases::Case;
use clap::Parser;
use serde::de::{DeserializeOwned, IntoDeserializer};
use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;
use sun2xp::model::configuration::{Law, Scheme};

#[derive(Parser)]
#[command(about = "Measures how accurately a finger behaves as the commanded spring")]
struct Arguments {
    /// Number of random poses. The default is 24, 4 with --quick, 12 with --truths, 6 with --damping, and 2 with
    /// --search.
    #[arg(long)]
    poses: Option<usize>,
    /// Few poses, and 1000 Hz only.
    #[arg(long)]
    quick: bool,
    /// Seed of the poses, of Kx and of the noise.
    #[arg(long, default_value_t = 20261121)]
    seed: u64,
    /// Rates in Hz, separated by commas. The default is 500,1000,2000, or 1000 with --quick. With --truths, --damping
    /// and --search, only the first rate is used, and the default is 1000.
    #[arg(long, value_delimiter = ',')]
    rates: Option<Vec<f64>>,
    /// Tendon controllers, as in the configuration, separated by commas. Figure 10 is always measured first, as the
    /// reference. With --truths, --damping and --search, only the last controller is measured.
    #[arg(long, value_delimiter = ',', value_parser = named::<Scheme>)]
    #[arg(default_values = ["figure 10", "state feedback"])]
    controllers: Vec<Scheme>,
    /// Only rows whose names contain this text, or one of several texts separated by semicolons.
    #[arg(long, default_value = "")]
    only: String,
    /// Measures fingers that differ from their configuration, instead of the table of the default finger. TEXT selects
    /// the fingers whose names contain it, or contain one of several texts separated by semicolons. An empty TEXT
    /// selects all fingers.
    #[arg(long, value_name = "TEXT", num_args = 0..=1, default_missing_value = "")]
    truths: Option<String>,
    /// With --truths or --search: first identifies each finger, and measures it with the identified values.
    #[arg(long)]
    identified: bool,
    /// With --truths: number of seeds. With --search, at most two seeds are used.
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..))]
    seeds: u64,
    /// With --truths: instead of the table, measures whether each finger comes to rest at both ends of the range of
    /// damping ratios that `Hand::send_damping` admits.
    #[arg(long)]
    damping: bool,
    /// With --truths: no walls and no bumps.
    #[arg(long)]
    short: bool,
    /// Searches for better parameters of state feedback for the fingers that TEXT selects, as with --truths. The search
    /// starts from the parameters that --numbers gives.
    #[arg(long, value_name = "TEXT", num_args = 0..=1, default_missing_value = "")]
    search: Option<String>,
    /// With --truths and --search: keys of the finger's configuration to replace, as TOML.
    #[arg(long, default_value = "")]
    keys: String,
    /// With --truths and --search: parameters of state feedback to replace, as TOML.
    #[arg(long, default_value = "")]
    numbers: String,
    /// The law of the spring: exact or report.
    #[arg(long, value_parser = named::<Law>, default_value = "exact")]
    law: Law,
    /// Folder for the plots of step responses and ellipsoids.
    #[arg(long, default_value = concat!(env!("CARGO_TARGET_TMPDIR"), "/stiffness"))]
    out: PathBuf,
    /// Replaces the table in this file, between its two marks.
    #[arg(long)]
    write: Option<PathBuf>,
    /// `cargo bench` passes this option. Without it, as in `cargo test --all-targets`, a quick run is enough.
    #[arg(long, hide = true)]
    bench: bool,
}

fn named<Named: DeserializeOwned>(name: &str) -> Result<Named, String> {
    let name: serde::de::value::StrDeserializer<serde::de::value::Error> = name.into_deserializer();
    Named::deserialize(name).map_err(|error| error.to_string())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = Arguments::parse();
    let (poses, rates) =
        if arguments.quick || !arguments.bench { (4, vec![1000.0]) } else { (24, vec![500.0, 1000.0, 2000.0]) };
    let (poses, rates) = (arguments.poses.unwrap_or(poses), arguments.rates.clone().unwrap_or(rates));
    arguments.controllers.retain(|&scheme| scheme != Scheme::Figure10);
    arguments.controllers.insert(0, Scheme::Figure10);
    let begun = Instant::now();
    if let Some(only) = &arguments.search {
        return search::run(&arguments, only);
    }
    if let (Some(only), true) = (&arguments.truths, arguments.damping) {
        return damping_range::run(&arguments, only);
    }
    if let Some(only) = &arguments.truths {
        return truths_table::run(&arguments, only, begun);
    }
    let mut columns = Vec::new();
    for &rate in &rates {
        for &scheme in &arguments.controllers {
            let case = Case { scheme, rate, poses, seed: arguments.seed, law: arguments.law, numbers: None };
            eprintln!("{}", case.name());
            columns.push(table::Column::measure(&case, &arguments.only));
        }
    }
    let text = table::markdown(&columns);
    println!("{text}");
    eprintln!("{:.0} s", begun.elapsed().as_secs_f64());
    if let Some(file) = &arguments.write {
        table::replace_in(file, &command(), &text)?;
    }
    plots::draw(&arguments.out, &arguments.controllers, arguments.seed)?;
    eprintln!("plots in {}", arguments.out.display());
    Ok(())
}

/// Returns the command as typed, without the option that Cargo adds.
fn command() -> String {
    let typed = std::env::args().skip(1).filter(|argument| argument != "--bench");
    let quoted = typed.map(|argument| if argument.contains(' ') { format!("\"{argument}\"") } else { argument });
    ["cargo bench --bench stiffness --".into()].into_iter().chain(quoted).collect::<Vec<String>>().join(" ")
}
