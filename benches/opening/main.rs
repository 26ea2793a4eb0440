//! Measures how long a planner waits until the simulated hand holds its pose. The planner waits while the shared
//! library is loaded, and during OpenHand. The stages of OpenHand are also measured. Every measurement runs in a fresh
//! process, as a planner does.
//!
//!     cargo bench --bench opening
//!     cargo bench --bench opening -- --library /usr/local/lib/libsun2xp.so

#[path = "../realtime/attempts.rs"]
mod attempts;

use attempts::Attempts;
use clap::Parser;
use std::error::Error;
use std::ffi::{CStr, CString, c_char, c_int};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;
use sun2xp::hand::{Fingers, Hand, HandError, SimulatedHand, check, find_configuration};
use sun2xp::realtime::now;

/// Largest permitted sum of the medians of loading and OpenHand, ms.
const GOAL: f64 = 150.0;

#[derive(Parser)]
struct Arguments {
    /// Number of processes for each row of the table.
    #[arg(long, default_value_t = 15)]
    runs: usize,
    /// The shared library to measure. The default is the one that cargo has built.
    #[arg(long)]
    library: Option<PathBuf>,
    /// What a child process measures.
    #[arg(long, hide = true)]
    child: Option<Child>,
    /// `cargo bench` passes this option.
    #[arg(long, hide = true)]
    bench: bool,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Child {
    /// The C calls of the shared library.
    Calls,
    /// The stages behind OpenHand.
    Stages,
}

/// A measured duration, ms, with its name in the table.
type Row = (String, f64);

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let library = arguments.library.clone().map_or_else(built_library, Ok)?;
    let rows = match arguments.child {
        Some(Child::Calls) => calls(&library)?,
        Some(Child::Stages) => stages()?,
        None => return table(&library, arguments.runs),
    };
    rows.iter().for_each(|(name, duration)| println!("{name}={duration}"));
    Ok(())
}

/// Returns the library of the same build. Cargo puts it beside the benchmark.
fn built_library() -> Result<PathBuf, Box<dyn Error>> {
    Ok(std::env::current_exe()?.with_file_name("libsun2xp.so"))
}

/// Runs the children and prints the table.
pub fn table(library: &Path, runs: usize) -> Result<(), Box<dyn Error>> {
    println!("{:<44} {:>9} {:>9} {:>9}", "ms, in a fresh process", "smallest", "median", "largest");
    let (mut attempts, mut whole) = (Attempts::default(), 0.0);
    let mut made = [("calls", 0), ("stages", 0)];
    for (child, count) in &mut made {
        let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
        for _ in 0..runs {
            let Some(rows) = attempts.measure(child, || run(child, library)) else { continue };
            *count += 1;
            columns.resize_with(rows.len(), Default::default);
            for (column, (name, duration)) in columns.iter_mut().zip(rows) {
                column.0 = name;
                column.1.push(duration);
            }
        }
        if *count == 0 {
            println!("{child:<44} not measured, because every measurement failed or was skipped");
        }
        for (name, mut durations) in columns {
            durations.sort_by(f64::total_cmp);
            let (median, last) = (durations[durations.len() / 2], durations[durations.len() - 1]);
            println!("{name:<44} {:>9.2} {median:>9.2} {last:>9.2}", durations[0]);
            if *child == "calls" {
                whole += median;
            }
        }
    }
    println!("{attempts}");
    attempts.check(made)?;
    println!("load and OpenHand: {whole:.1} ms; the goal is {GOAL} ms");
    if whole > GOAL { Err("the goal is missed".into()) } else { Ok(()) }
}

/// Runs one child, and returns the durations that it prints.
fn run(child: &str, library: &Path) -> Result<Vec<Row>, Box<dyn Error>> {
    let mut process = Command::new(std::env::current_exe()?);
    process.args(["--child", child, "--library"]).arg(library).env_remove("SUN2XP_CONFIG");
    let output = process.output()?;
    if !output.status.success() {
        return Err(format!("{}, {}", output.status, String::from_utf8_lossy(&output.stderr).trim_end()).into());
    }
    let row = |line: &str| -> Result<Row, Box<dyn Error>> {
        let (name, duration) = line.split_once('=').ok_or_else(|| format!("unexpected output: {line}"))?;
        Ok((name.into(), duration.parse()?))
    };
    String::from_utf8(output.stdout)?.lines().map(row).collect()
}

/// Loads the library, and opens and closes the hand.
fn calls(library: &Path) -> Result<Vec<Row>, Box<dyn Error>> {
    let path = CString::new(library.as_os_str().as_encoded_bytes())?;
    let mut begin = Instant::now();
    // SAFETY: the path is a C string. The library has no initializers that need preparation.
    let handle = unsafe { libc::dlopen(path.as_ptr(), libc::RTLD_NOW | libc::RTLD_LOCAL) };
    if handle.is_null() {
        // SAFETY: dlerror returns a C string after dlopen has failed.
        let cause = unsafe { CStr::from_ptr(libc::dlerror()) }.to_string_lossy().into_owned();
        return Err(format!("{} cannot be loaded: {cause}", library.display()).into());
    }
    let mut rows = vec![row("load the shared library", &mut begin)];
    let call = |name: &CStr| {
        // SAFETY: the handle is valid, and the library is never unloaded.
        let address = unsafe { libc::dlsym(handle, name.as_ptr()) };
        assert!(!address.is_null(), "{} does not export {name:?}: give another --library", library.display());
        address
    };
    // SAFETY: the header declares the calls with this signature.
    let [open, close] = [c"OpenHand", c"CloseHand"]
        .map(|name| unsafe { std::mem::transmute::<*mut libc::c_void, extern "C" fn() -> c_int>(call(name)) });
    // SAFETY: the header declares the call with this signature.
    let error =
        unsafe { std::mem::transmute::<*mut libc::c_void, extern "C" fn() -> *const c_char>(call(c"HandError")) };
    begin = Instant::now();
    if open() != 0 {
        // SAFETY: HandError returns a C string that is valid until this thread's next refused call.
        return Err(unsafe { CStr::from_ptr(error()) }.to_string_lossy().into());
    }
    rows.push(row("OpenHand", &mut begin));
    close();
    Ok(rows)
}

/// Opens the hand as OpenHand does, and measures the stages. `Hand::open_as` does not report when the check of the
/// configuration and the start of the boards end. Both are therefore measured separately before the hand is opened, and
/// their durations are subtracted.
fn stages() -> Result<Vec<Row>, Box<dyn Error>> {
    let mut begin = Instant::now();
    let configured = find_configuration()?;
    let mut rows = vec![row("  find and read the configuration", &mut begin)];
    check(&configured.configuration).map_err(HandError::from)?;
    rows.push(row("  check it, with the bound of Kx", &mut begin));
    let checked = rows[1].1;
    let boards = SimulatedHand::start(&configured.configuration, Fingers::ALL)?;
    rows.push(row("  start the simulated boards", &mut begin));
    let started = rows[2].1;
    drop(boards);

    let opening = now();
    let hand = Hand::open_as(configured)?;
    let open = now();
    let first = (1..=3).map(|finger| Ok(hand.report(finger)?.first)).collect::<Result<Vec<u64>, Box<dyn Error>>>()?;
    let first = first.into_iter().min().unwrap_or(opening);
    let milliseconds = |from: u64, to: u64| (to - from) as f64 / 1e6;
    rows.push((
        "  handshakes, and start of the servo threads".into(),
        milliseconds(opening, first) - checked - started,
    ));
    rows.push(("  take-up of slack, until every finger holds".into(), milliseconds(first, open)));
    hand.close();
    Ok(rows)
}

/// Returns the time since `begin`, ms, and sets `begin` to the present time.
fn row(name: &str, begin: &mut Instant) -> Row {
    let duration = begin.elapsed().as_secs_f64() * 1e3;
    *begin = Instant::now();
    (name.into(), duration)
}
