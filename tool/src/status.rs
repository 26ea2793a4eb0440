//! `sun2xp status`: the state of the open hands, as text or as JSON.

use crate::failure::{ExitStatus, Failure, complain};
use crate::monitor::finger_state::FingerState;
use crate::monitor::state::{HandState, Tracker};
use crate::monitor::words::{span, wrap};
use crate::print::{self, Cell, Look, Screen, Table, painted};
use serde::Serialize;
use std::io::{self, Write};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};
use sun2xp::telemetry::{self, AttachError, Ended, Reader};

/// Time over which the rate is measured.
const MEASURING: Duration = Duration::from_millis(500);

/// Longest time to wait for the status of every finger.
const LONGEST: Duration = Duration::from_secs(3);

/// Width of texts in a pipe, in a file or on a very narrow terminal, columns.
const WIDTH: usize = 100;

/// Prints the state of an open hand, or of all open hands: stages, joints, tips, forces, tensions and timing, and
/// faults with their remedies.
///
/// Exit status: 0 if every hand answers and no finger is faulted, 1 if not or if no hand is open, 2 for wrong usage.
#[derive(clap::Args)]
pub struct Arguments {
    /// Name of the hand (`telemetry.name` of its configuration). Without it, all open hands.
    #[arg(value_name = "NAME")]
    name: Option<String>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Hands {
    hands: Vec<HandState>,
}

/// Prints the state.
///
/// # Errors
/// Returns an error if there is no such hand.
pub fn run(arguments: &Arguments) -> Result<ExitStatus, Failure> {
    let names = telemetry::hands().map_err(AttachError::Names)?;
    let mut hands = Vec::new();
    let mut failed = false;
    if arguments.name.is_some() || names.is_empty() {
        // Without any hand this fails, and the reason names the remedy.
        hands.push(state(arguments.name.as_deref())?);
    } else {
        for name in &names {
            match state(Some(name)) {
                Ok(hand) => hands.push(hand),
                // A hand that ends or does not answer does not hide the others.
                Err(failure) => {
                    complain(&failure.to_string());
                    failed = true;
                }
            }
        }
    }
    let well = !failed && !hands.iter().any(HandState::faulted);
    if arguments.json {
        print::json(&Hands { hands })?;
    } else {
        let screen = Screen::stdout();
        let text: Vec<String> = hands.iter().map(|hand| describe(hand, &screen)).collect();
        let mut output = io::stdout().lock();
        output.write_all(text.join("\n").as_bytes())?;
        output.flush()?;
    }
    Ok(if well { ExitStatus::SUCCESS } else { ExitStatus::FAILURE })
}

/// Reads a hand until the state of every finger is known.
fn state(name: Option<&str>) -> Result<HandState, Failure> {
    let mut reader = Reader::attach(name)?;
    let mut tracker = Tracker::new(reader.description());
    let begun = Instant::now();
    let complete = |tracker: &Tracker| {
        let known = |finger: &FingerState| finger.known && (finger.sample.is_some() || finger.fault.is_some());
        tracker.state.fingers.iter().all(known)
    };
    while begun.elapsed() < MEASURING || (begun.elapsed() < LONGEST && !complete(&tracker)) {
        let mut messages = Vec::new();
        let received = reader.read(MEASURING / 5, &mut messages);
        tracker.apply(&messages, received.as_ref().map(|received| received.lost).unwrap_or_default());
        if let Err(end) = received {
            // The other error, a damaged shared memory, has a text that names the remedy.
            let remedy = if end == Ended::Closed { ". Open it again, and repeat the command" } else { "" };
            return Err(format!("cannot read the hand \"{}\" any more: {end}{remedy}", tracker.state.name).into());
        }
    }
    Ok(tracker.state)
}

fn describe(hand: &HandState, screen: &Screen) -> String {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs());
    let age = span(now.saturating_sub(hand.opened) as f64);
    let kind = if hand.real { "real fingers" } else { "simulated" };
    let mut text = format!(
        "{}  process {}, {} Hz, {kind}, open for {age}, library {}\n\n",
        painted(screen, Look::Title, &format!("hand {}", hand.name)),
        hand.process,
        hand.rate,
        hand.library
    );
    text += &motion(hand).text(screen);
    text += "\n";
    text += &timing(hand).text(screen);
    let width = screen.width.unwrap_or(WIDTH);
    for finger in &hand.fingers {
        let faults = finger.fault.iter().map(|fault| (Look::Bad, "fault", fault));
        let warnings = finger.warning.iter().map(|warning| (Look::Warning, "warning", warning));
        for (look, kind, fault) in faults.chain(warnings) {
            let title = format!("finger {}, {kind} {}", finger.finger, fault.number);
            text += &format!("\n{}\n", painted(screen, look, &title));
            for line in wrap(&format!("{}.", fault.text), width - 4) {
                text += &format!("    {line}\n");
            }
        }
    }
    text
}

fn motion(hand: &HandState) -> Table {
    let titles = ["finger", "stage", "joints, deg", "tip in palm, cm", "tip force, N", "Kx, N/cm", "tensions, N"];
    let mut table = Table::new(titles).numeric(2..7);
    for finger in &hand.fingers {
        let stage = match finger.stage {
            "faulted" => Cell::new(Look::Bad, "faulted"),
            "running" => Cell::new(Look::Good, "running"),
            stage => Cell::new(Look::Warning, stage),
        };
        let mut cells = vec![finger.finger.to_string().into(), stage];
        if let Some(sample) = &finger.sample {
            cells.extend([
                numbers(&sample.joints.map(f64::to_degrees), 1).into(),
                numbers(&sample.tip, 2).into(),
                numbers(&sample.tip_force_in_palm, 2).into(),
                sample.kx.map_or("-".into(), |kx| numbers(&std::array::from_fn::<_, 3, _>(|i| kx[i][i]), 1)).into(),
                numbers(&sample.tensions, 1).into(),
            ]);
        }
        table.row(cells);
    }
    table
}

fn timing(hand: &HandState) -> Table {
    let titles = ["finger", "rate, Hz", "wake-up, us: median", "99.9 %", "largest", "cycles", "overruns", "no reply"];
    let mut table = Table::new(titles).numeric(1..8);
    for finger in &hand.fingers {
        let count = |count: u64| Cell::new(if count > 0 { Look::Warning } else { Look::Plain }, count.to_string());
        table.row([
            finger.finger.to_string().into(),
            format!("{:.0}", finger.rate).into(),
            format!("{:.0}", finger.wake_up.median).into(),
            format!("{:.0}", finger.wake_up.p999).into(),
            format!("{:.0}", finger.wake_up.maximum).into(),
            finger.losses.cycles.to_string().into(),
            count(finger.losses.overruns),
            count(finger.losses.lost_replies),
        ]);
    }
    table
}

fn numbers(values: &[f64], decimals: usize) -> String {
    values.iter().map(|value| format!("{value:.decimals$}")).collect::<Vec<_>>().join(" ")
}
