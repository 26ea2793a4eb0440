//! Counts the instructions of one servo step with callgrind. The result is the same on every run, so an increase is
//! caused by a change of the code.
//!
//!     cargo bench --bench instructions                    counts, and compares with recorded.toml
//!     cargo bench --bench instructions -- --record        counts, and writes recorded.toml again
//!
//! The benchmark fails if the number is more than 2 % above the recorded number. With another compiler or C library,
//! the code and its number of instructions differ. In that case nothing is compared, and a line on standard error says
//! so. Record again when another compiler or C library becomes the usual one, or when an increase is intended.

#[allow(dead_code, reason = "the benchmark `handwritten` uses the other functions")]
#[path = "../recorded_run/mod.rs"]
mod recorded_run;

use clap::Parser;
use recorded_run::{CYCLES, Recording};
use serde::de::IntoDeserializer;
use serde::de::value::{Error as ValueError, StrDeserializer};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use sun2xp::control::{Activity, Controller, Feedback, State};
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};

/// Names of the schemes, as in a configuration.
const SCHEMES: [&str; 4] = ["figure 9", "figure 10", "figure 11", "state feedback"];

/// Largest permitted increase above the recorded number.
const RISE: f64 = 0.02;

const RECORD: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/instructions/recorded.toml");

/// The C library selects its sine functions by the features of the processor. With this setting it uses those that run
/// on every processor.
const PLAIN_PROCESSOR: &str =
    "glibc.cpu.hwcaps=-AVX2,-AVX2_Usable,-FMA,-FMA_Usable,-FMA4,-AVX_Fast_Unaligned_Load,-ERMS";

#[derive(Parser)]
struct Arguments {
    /// Writes the counts into the file with which later counts are compared.
    #[arg(long)]
    record: bool,
    /// Runs the steps of this scheme, which callgrind counts.
    #[arg(long, hide = true)]
    scheme: Option<String>,
    /// `cargo bench` passes this option.
    #[arg(long, hide = true)]
    bench: bool,
}

/// The content of recorded.toml.
#[derive(Deserialize, Serialize)]
struct Record {
    /// `rustc --version`.
    rustc: String,
    /// Version of the C library.
    libc: String,
    /// Instructions per step, by scheme.
    instructions: BTreeMap<String, f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    if let Some(scheme) = &arguments.scheme {
        return steps(scheme);
    }
    let counted = SCHEMES.iter().map(|scheme| Ok((scheme.to_string(), count(scheme)?)));
    let instructions = counted.collect::<Result<BTreeMap<String, f64>, Box<dyn Error>>>()?;
    let rustc = first_line(&std::env::var("RUSTC").unwrap_or("rustc".into()))?;
    // "ldd (Debian GLIBC 2.36-9+deb12u14) 2.36"
    let libc = first_line("ldd")?.split_whitespace().last().unwrap_or_default().to_string();
    let now = Record { rustc, libc, instructions };
    if arguments.record {
        let text = format!(
            "# Instructions of one servo step, counted by callgrind. Written by: cargo bench --bench instructions -- \
             --record\n{}",
            toml_edit::ser::to_string_pretty(&now)?
        );
        std::fs::write(RECORD, text)?;
    }
    let unusable = |error: &dyn Error| format!("{RECORD} cannot be used ({error}): {HOW_TO_RECORD}");
    let text = std::fs::read_to_string(RECORD).map_err(|error| unusable(&error))?;
    let recorded: Record = toml_edit::de::from_str(&text).map_err(|error| unusable(&error))?;
    compare(&now, &recorded)
}

/// Simulates a run with a scheme, and repeats the cycles of its controller. Callgrind counts only the repetition.
fn steps(scheme: &str) -> Result<(), Box<dyn Error>> {
    let mut finger = ConfiguredFinger::default();
    let name: StrDeserializer<ValueError> = scheme.into_deserializer();
    finger.controller.scheme = Some(Scheme::deserialize(name)?);
    let recording = Recording::new(finger)?;
    recording.repeat(|controller, state, feedback, activity| {
        counted_step(controller, state, feedback, activity);
    });
    Ok(())
}

/// Callgrind counts while this function runs.
#[inline(never)]
fn counted_step(controller: &Controller, state: &mut State, feedback: Option<&Feedback>, activity: &Activity) {
    black_box(controller.cycle(state, feedback, activity));
}

/// Returns the instructions per step.
fn count(scheme: &str) -> Result<f64, Box<dyn Error>> {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("instructions.callgrind");
    let run = Command::new("valgrind")
        .args(["--tool=callgrind", "--toggle-collect=*counted_step*"])
        .arg(format!("--callgrind-out-file={}", file.display()))
        .arg(std::env::current_exe()?)
        .args(["--scheme", scheme])
        .env("GLIBC_TUNABLES", PLAIN_PROCESSOR)
        .output()
        .map_err(|error| format!("cannot run valgrind ({error}): install it"))?;
    if !run.status.success() {
        return Err(format!("valgrind: {}", String::from_utf8_lossy(&run.stderr)).into());
    }
    let text = std::fs::read_to_string(&file)?;
    let total = text.lines().find_map(|line| line.strip_prefix("totals: ")).ok_or_else(|| {
        format!(
            "the output of callgrind, {}, has no line \"totals:\": install valgrind 3.19, which writes it",
            file.display()
        )
    })?;
    Ok(total.trim().parse::<f64>()? / CYCLES as f64)
}

fn compare(now: &Record, recorded: &Record) -> Result<(), Box<dyn Error>> {
    println!("| scheme | instructions per step | recorded |\n|---|---|---|");
    let mut risen = Vec::new();
    for (scheme, count) in &now.instructions {
        let before =
            recorded.instructions.get(scheme).ok_or_else(|| format!("{scheme} is not recorded: {HOW_TO_RECORD}"))?;
        println!("| {scheme} | {count:.1} | {before:.1} |");
        if *count > before * (1.0 + RISE) {
            risen.push(format!("{scheme}: {count:.1}, recorded {before:.1}"));
        }
    }
    println!("\n{}; C library {}", now.rustc, now.libc);
    if (&now.rustc, &now.libc) != (&recorded.rustc, &recorded.libc) {
        eprintln!(
            "NOT COMPARED: the recorded counts are of another compiler or C library ({}; {}). \
             To record the counts of this one: {HOW_TO_RECORD}",
            recorded.rustc, recorded.libc
        );
        return Ok(());
    }
    if risen.is_empty() {
        return Ok(());
    }
    Err(format!(
        "a step needs over {:.0} % more instructions: {}. If this is intended: {HOW_TO_RECORD}",
        100.0 * RISE,
        risen.join("; ")
    )
    .into())
}

const HOW_TO_RECORD: &str =
    "run cargo bench --bench instructions -- --record, and commit benches/instructions/recorded.toml";

fn first_line(program: &str) -> Result<String, Box<dyn Error>> {
    let output = Command::new(program).arg("--version").output().map_err(|error| {
        format!("cannot run `{program} --version` ({error}): install {program}, whose version is a part of the record")
    })?;
    Ok(String::from_utf8_lossy(&output.stdout).lines().next().unwrap_or_default().into())
}
