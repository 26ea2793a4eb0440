//! Messages a second in one direction.

use crate::link::{ANSWER, Engine, Sending};
use crate::percentiles::median;
use crate::{Failure, LENGTH, certificates, echo};
use std::time::Instant;

/// Measures how many messages of 200 bytes go from a client to the server in a second.
#[derive(clap::Args)]
pub struct Arguments {
    /// Number of measurements of each engine.
    #[arg(long, default_value_t = Self::default().repeats)]
    repeats: usize,
    /// Number of messages in each measurement.
    #[arg(long, default_value_t = Self::default().messages)]
    messages: u64,
}

impl Default for Arguments {
    fn default() -> Self {
        Self { repeats: 5, messages: 200_000 }
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let folder = tempfile::tempdir()?;
    certificates::write(folder.path())?;
    let mut servers = Vec::new();
    let mut links = Vec::new();
    for engine in Engine::ALL {
        let (child, port) = echo::start(engine, folder.path())?;
        links.push((engine, engine.connect(port, folder.path())?));
        servers.push(child);
    }
    println!("| sending | engine | messages/s | MB/s |\n|---|---|---|---|");
    for (name, sending) in [("each at once", Sending::AtOnce), ("in batches", Sending::Together)] {
        let mut rates: Vec<Vec<f64>> = links.iter().map(|_| Vec::new()).collect();
        for _ in 0..arguments.repeats {
            for ((_, link), rates) in links.iter_mut().zip(&mut rates) {
                let begin = Instant::now();
                link.flood(&[ANSWER; LENGTH], arguments.messages, sending)?;
                rates.push(arguments.messages as f64 / begin.elapsed().as_secs_f64());
            }
        }
        for ((engine, _), rates) in links.iter().zip(rates) {
            let rate = median(rates);
            println!("| {name} | {} | {rate:.0} | {:.1} |", engine.name(), rate * LENGTH as f64 * 1e-6);
        }
    }
    println!(
        "\nMessages of {LENGTH} bytes. Medians over {} repeats of {} messages.\n",
        arguments.repeats, arguments.messages
    );
    Ok(())
}
