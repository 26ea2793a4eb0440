//! `sun2xp board`: a simulated board as a separate program.

mod faults;
mod manual;
mod orders;

use crate::failure::{Failure, wrong_usage};
use faults::Trouble;
use orders::{Action, Order};
use std::io::{self, BufRead, Write};
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use sun2xp::board::protocol::check;
use sun2xp::hand;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, FINGERS};
use sun2xp::model::{Shown, ShownPath, one_line};
use sun2xp::realtime::Priority;
use sun2xp::simulated::{Pace, SimulatedBoard, SimulatedPort};

/// Runs a simulated board behind a serial port of its own.
///
/// The first line on standard output is the path of the port. Each line on standard input is an order; the end of
/// --help lists the orders. The board answers each order except `quit` with one line: `ok`, `ok PATH`, `state ...` or
/// `error ...`.
///
/// The program ends at `quit` or a signal, and not at the end of standard input, so that it can run detached.
#[derive(clap::Args)]
#[command(after_long_help = manual::help())]
pub struct Arguments {
    /// The configuration file of the simulated fingers. Without it, every key has its default value. The ports in the
    /// file are ignored.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// A finger of the board, 1 to 3. May be repeated. The address of a finger is its number, unless the configuration
    /// sets another address.
    #[arg(
        long = "finger",
        value_name = "N",
        default_values_t = [1, 2, 3],
        value_parser = clap::value_parser!(u8).range(1..=FINGERS as i64)
    )]
    fingers: Vec<u8>,
    /// Push every fingertip with this force as soon as the board starts, N.
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        value_parser = |list: &str| Action::from_list("force", list)
    )]
    force: Option<Action>,
    /// Put a wall in front of every finger as soon as the board starts, cm and N/cm.
    #[arg(
        long,
        value_name = "PX,PY,PZ,NX,NY,NZ,K",
        allow_hyphen_values = true,
        value_parser = |list: &str| Action::from_list("wall", list)
    )]
    wall: Option<Action>,
    /// Put a ball in front of every finger as soon as the board starts, cm and N/cm.
    #[arg(
        long,
        value_name = "X,Y,Z,RADIUS,K",
        allow_hyphen_values = true,
        value_parser = |list: &str| Action::from_list("ball", list)
    )]
    ball: Option<Action>,
    /// Seed of the gauge noise and of the line faults. The noise seed of each finger is derived from it.
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// An order to carry out at the start. May be repeated.
    #[arg(long = "order", value_name = "ORDER")]
    orders: Vec<String>,
    /// Make a symbolic link to the port, and remove it at `quit` or at an error. An existing symbolic link is replaced.
    /// The board's unique number is derived from this path, so a board that is restarted with the same link is the same
    /// board for its host.
    #[arg(long, value_name = "PATH")]
    link: Option<PathBuf>,
    /// SCHED_FIFO priority of the board, where permitted. 0 means not real-time.
    #[arg(long, value_name = "P", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=99))]
    priority: u8,
    /// Expect a host with RATE cycles per second. While its commands are missing, pause the simulation for up to two
    /// seconds, and extend the watchdog by the same time. This is for a busy machine, which delays the bytes of a
    /// pseudo-terminal.
    #[arg(long, value_name = "RATE", value_parser = rate)]
    patient: Option<f64>,
}

/// Starts the board, and executes orders until `quit`.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let orders = orders_in(&arguments.orders)?;
    let mut fingers: Vec<FingerNumber> =
        arguments.fingers.iter().filter_map(|&number| FingerNumber::new(number.into())).collect();
    fingers.sort_unstable();
    // A finger may be named twice.
    fingers.dedup();
    let mut configuration = match &arguments.config {
        Some(file) => hand::Configured::read_for_board(file, &fingers)?.configuration,
        None => Configuration::default(),
    };
    if let Some(seed) = arguments.seed {
        configuration.fingers.iter_mut().for_each(|finger| finger.simulation.seed = seed);
    }
    let mut board = SimulatedBoard::new(&configuration, &fingers)?.numbered(number(arguments.link.as_deref())?);
    for action in [&arguments.force, &arguments.wall, &arguments.ball].into_iter().flatten() {
        for finger in board.fingers() {
            action.apply(finger);
        }
    }
    let pace = arguments.patient.map_or(Pace::RealTime, Pace::patient);
    let priority = Priority { fifo: arguments.priority, core: None };
    let port = SimulatedPort::start(board, pace, priority).map_err(hand::HandError::SimulatedPort)?;
    if let Some(link) = &arguments.link {
        make_link(&port.path(), link)?;
    }
    let session =
        Session { port: &port, configuration: &configuration, link: arguments.link.as_deref(), seed: arguments.seed };
    say(&port.path().display().to_string())?;
    for order in &orders {
        let answer = session.carry_out(order)?;
        if answer.starts_with("error") {
            return Err(wrong_usage(answer));
        }
    }
    session.take_orders()
}

/// Reads the orders of the command line.
fn orders_in(texts: &[String]) -> Result<Vec<Order>, Failure> {
    let read = |text: &String| match Order::read(text) {
        Ok(Some(Order::Quit)) => Err(wrong_usage(
            "quit cannot be given by --order: write it to standard input, or end the program with a signal",
        )),
        Ok(Some(order)) => Ok(order),
        Ok(None) => Err(wrong_usage("an --order is empty: see sun2xp board --help")),
        Err(reason) => Err(wrong_usage(format!("--order {}: {reason}", Shown(text)))),
    };
    texts.iter().map(read).collect()
}

/// Returns the unique number of the board. With a link it is derived from the path of the link, so that it stays the
/// same when the board is restarted. Without a link it is the process number. Process numbers have less than 31 bits,
/// and bit 31 marks a number from a link.
fn number(link: Option<&Path>) -> io::Result<u32> {
    match link {
        Some(link) => Ok(check(std::path::absolute(link)?.as_os_str().as_bytes()) | 1 << 31),
        None => Ok(std::process::id()),
    }
}

/// Prints one line and flushes it, because standard output may be a pipe.
fn say(line: &str) -> io::Result<()> {
    let mut output = io::stdout().lock();
    writeln!(output, "{line}")?;
    output.flush()
}

fn make_link(port: &Path, link: &Path) -> Result<(), Failure> {
    let cannot = |what: &str, error: io::Error| -> Failure {
        format!("cannot {what} the symbolic link {}: {error}: choose another --link", ShownPath(link)).into()
    };
    match std::fs::symlink_metadata(link) {
        Ok(there) if there.is_symlink() => {
            std::fs::remove_file(link).map_err(|error| cannot("replace", error))?;
        }
        Ok(_) => {
            return Err(format!("{} exists and is not a symbolic link: choose another --link", ShownPath(link)).into());
        }
        Err(_) => {}
    }
    std::os::unix::fs::symlink(port, link).map_err(|error| cannot("make", error))
}

/// A running board, and what is needed to execute orders.
struct Session<'a> {
    port: &'a SimulatedPort,
    configuration: &'a Configuration,
    link: Option<&'a Path>,
    seed: Option<u64>,
}

impl Session<'_> {
    /// Executes the orders of standard input until `quit`. At the end of standard input, the function does not return.
    fn take_orders(&self) -> Result<(), Failure> {
        let (mut input, mut line) = (io::stdin().lock(), Vec::new());
        while input.read_until(b'\n', &mut line).is_ok_and(|length| length > 0) {
            // A line that is not UTF-8 is an unknown order.
            match Order::read(&String::from_utf8_lossy(&line)) {
                Ok(Some(Order::Quit)) => return Ok(()),
                Ok(Some(order)) => say(&self.carry_out(&order)?)?,
                Ok(None) => {}
                Err(error) => say(&one_line(&format!("error {error}")))?,
            }
            line.clear();
        }
        loop {
            std::thread::park();
        }
    }

    /// Executes an order and returns the answer.
    fn carry_out(&self, order: &Order) -> Result<String, Failure> {
        let address = |number: u8| Some(self.configuration.address(FingerNumber::new(number.into())?));
        match order {
            Order::For(number, action) => {
                let found =
                    address(*number).and_then(|address| self.port.with_finger(address, |finger| action.apply(finger)));
                Ok(found.unwrap_or_else(|| faults::no_finger(*number)))
            }
            Order::Trouble(trouble) => {
                let answer = trouble.apply(self.port, self.seed.unwrap_or_default(), address);
                if *trouble == Trouble::PlugIn
                    && let Some(link) = self.link
                {
                    make_link(&self.port.path(), link)?;
                }
                Ok(answer)
            }
            Order::Quit => Ok("ok".into()),
        }
    }
}

impl Drop for Session<'_> {
    /// Removes the link, if it still leads to this board.
    fn drop(&mut self) {
        if let Some(link) = self.link
            && std::fs::read_link(link).is_ok_and(|port| port == self.port.path())
        {
            // A link that cannot be removed leads nowhere, and the next board replaces it.
            let _ = std::fs::remove_file(link);
        }
    }
}

fn rate(text: &str) -> Result<f64, String> {
    let rate: f64 = text.parse().map_err(|_| format!("{text} is not a number: give a rate in Hz, for example 1000"))?;
    let sensible = (1.0..=100_000.0).contains(&rate);
    sensible.then_some(rate).ok_or_else(|| format!("{rate} is not between 1 and 100 000 Hz"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No user, not even root, can add a link to a process's folder in /proc, or remove one from it.
    #[test]
    fn a_link_that_cannot_be_made_is_named_with_a_remedy() {
        for (link, begin) in [
            ("/proc/self/exe", "cannot replace the symbolic link /proc/self/exe: "),
            ("/proc/self/port", "cannot make the symbolic link /proc/self/port: "),
        ] {
            let text = make_link(Path::new("port"), Path::new(link)).expect_err("refused").to_string();
            assert!(text.starts_with(begin) && text.ends_with(": choose another --link"), "{text}");
        }
    }
}
