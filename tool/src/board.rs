//! `sun2xp board`: a simulated board as a program of its own.

mod faults;
mod orders;

use crate::failure::Failure;
use faults::Trouble;
use orders::{Action, Order};
use std::io::{self, BufRead, Write};
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use sun2xp::board::protocol::check;
use sun2xp::hand;
use sun2xp::model::configuration::{Configuration, FINGERS};
use sun2xp::model::{ShownPath, one_line};
use sun2xp::realtime::Priority;
use sun2xp::simulated::{Pace, SimulatedBoard, SimulatedPort};

/// Runs a simulated board behind a serial port of its own.
///
/// The first line of standard output is the port's path. Then each line of standard input is an order, and each is
/// answered with one line: `ok`, `state ...` or `error ...`.
///
///     force FINGER X Y Z                     push the fingertip, N
///     wall FINGER PX PY PZ NX NY NZ K        a wall through P with normal N, stiffness K N/cm
///     ball FINGER X Y Z RADIUS K             a ball
///     hold FINGER                            a hand that holds the finger in the pose it is in
///     free FINGER                            no force, no wall, no ball, no hand
///     state FINGER                           true joints (rad), tip (cm) and tensions (N), torques of the motors
///                                            (N cm), times by the board's clock (ms): now, of the last Command that
///                                            was obeyed, of the end state that followed; NaN: not since the last
///                                            Configure; status bits as in a Reply
///     quit
///
/// What is broken stays so until `mend` or `good`. Parts are counted from 1 to 4; a probability is of each frame from
/// the board, or with `commands` before it to the board, and without MS it is for ever:
///
///     cut FINGER TENDON                      a torn tendon
///     slack FINGER TENDON GRIP               a tendon that slips and bears no more than GRIP, N
///     jam FINGER MOTOR                       a motor that does not turn
///     hot FINGER MOTOR                       a driver that switches off for heat
///     dead-gauge FINGER GAUGE [COUNT]        a gauge that shows COUNT, or what it shows now
///     drift-gauge FINGER GAUGE SPEED         a gauge that drifts, N/s
///     jump FINGER ENCODER COUNTS             an encoder that gains counts
///     zero-lost FINGER                       a board that no longer vouches for its counts
///     emergency FINGER, supply FINGER, sensor FINGER
///                                            the emergency stop input, the motor supply, a sensor that cannot be read
///     reset FINGER                           power lost for a moment
///     mend FINGER                            all that is whole again
///     drop PROBABILITY [MS]                  frames are lost
///     corrupt PROBABILITY [MS]               a bit is turned over
///     delay PROBABILITY LATER [MS]           frames come LATER ms later
///     duplicate PROBABILITY [MS], reorder PROBABILITY [MS]
///     stall MS                               nothing comes, then everything
///     commands drop 0.01, commands stall MS, and so on
///                                            the same to frames to the board
///     good                                   a good line again, both ways
///     unplug, replug                         the port vanishes; another one comes, whose path is answered
///
/// Positions and forces are in the finger's frame, lengths in cm. The end of standard input does not end the program,
/// so that it can run detached; `quit` or a signal does.
#[derive(clap::Args)]
#[command(verbatim_doc_comment)]
pub struct Arguments {
    /// The configuration whose fingers are simulated; without it the default ones. Ports in it do not matter.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// A finger of the board, 1 to 3; may be repeated. Unless configured, its address is its number.
    #[arg(
        long = "finger",
        value_name = "N",
        default_values_t = [1, 2, 3],
        value_parser = clap::value_parser!(u8).range(1..=FINGERS as i64)
    )]
    fingers: Vec<u8>,
    /// Push every fingertip from the start, N.
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        value_parser = |list: &str| Action::from_list("force", list)
    )]
    force: Option<Action>,
    /// A wall before every finger from the start, cm and N/cm.
    #[arg(
        long,
        value_name = "PX,PY,PZ,NX,NY,NZ,K",
        allow_hyphen_values = true,
        value_parser = |list: &str| Action::from_list("wall", list)
    )]
    wall: Option<Action>,
    /// A ball before every finger from the start, cm and N/cm.
    #[arg(
        long,
        value_name = "X,Y,Z,RADIUS,K",
        allow_hyphen_values = true,
        value_parser = |list: &str| Action::from_list("ball", list)
    )]
    ball: Option<Action>,
    /// Seed of the gauge noise; each finger's own follows from it.
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// An order to carry out at the start; may be repeated.
    #[arg(long = "order", value_name = "ORDER")]
    orders: Vec<String>,
    /// A symbolic link to the port, made now and removed by `quit`. A symbolic link that is there is replaced. A board
    /// that is started again with the same link is the same board for its host: its unique number comes from this path.
    #[arg(long, value_name = "PATH")]
    link: Option<PathBuf>,
    /// SCHED_FIFO priority of the board, where permitted; 0: not real-time.
    #[arg(long, value_name = "P", default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=99))]
    priority: u8,
    /// Stand still, for up to two seconds, while the commands of a host of RATE cycles a second stay away: for a busy
    /// machine, which carries the bytes of a pseudo-terminal late. The watchdog waits so much longer.
    #[arg(long, value_name = "RATE", value_parser = rate)]
    patient: Option<f64>,
}

/// Starts the board, and carries out orders until `quit`.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut configuration = match &arguments.config {
        Some(file) => hand::read_configuration(file)?,
        None => Configuration::default(),
    };
    if let Some(seed) = arguments.seed {
        configuration.fingers.iter_mut().for_each(|finger| finger.simulation.seed = seed);
    }
    let fingers: Vec<usize> = arguments.fingers.iter().map(|&number| usize::from(number) - 1).collect();
    let mut board = SimulatedBoard::new(&configuration, &fingers)?.numbered(number(arguments.link.as_deref())?);
    for action in [&arguments.force, &arguments.wall, &arguments.ball].into_iter().flatten() {
        for finger in board.fingers() {
            action.apply(finger);
        }
    }
    let pace = arguments.patient.map_or(Pace::RealTime, Pace::patient);
    let port = SimulatedPort::start(board, pace, Priority { fifo: arguments.priority, core: None })?;
    if let Some(link) = &arguments.link {
        make_link(&port.path(), link)?;
    }
    say(&port.path().display().to_string())?;
    let desk =
        Desk { port: &port, configuration: &configuration, link: arguments.link.as_deref(), seed: arguments.seed };
    for order in &arguments.orders {
        let order = Order::read(order)?.ok_or("an --order is empty: see sun2xp board --help")?;
        let answer = desk.carry_out(&order)?;
        if answer.starts_with("error") {
            return Err(answer.into());
        }
    }

    for line in io::stdin().lock().lines() {
        let line = line?;
        match Order::read(&line) {
            Ok(Some(Order::Quit)) => {
                if let Some(link) = &arguments.link {
                    std::fs::remove_file(link)?;
                }
                return Ok(());
            }
            Ok(Some(order)) => say(&desk.carry_out(&order)?)?,
            Ok(None) => {}
            Err(error) => say(&one_line(&format!("error {error}")))?,
        }
    }
    loop {
        std::thread::park();
    }
}

/// The board's number: by its link, so that it stays when the board is started again, or else by its process. Processes
/// have numbers of less than 31 bits, and links of more.
fn number(link: Option<&Path>) -> io::Result<u32> {
    match link {
        Some(link) => Ok(check(std::path::absolute(link)?.as_os_str().as_bytes()) | 1 << 31),
        None => Ok(std::process::id()),
    }
}

/// One line, at once, also into a pipe.
fn say(line: &str) -> io::Result<()> {
    let mut output = io::stdout().lock();
    writeln!(output, "{line}")?;
    output.flush()
}

fn make_link(port: &Path, link: &Path) -> Result<(), Failure> {
    match std::fs::symlink_metadata(link) {
        Ok(there) if there.is_symlink() => std::fs::remove_file(link)?,
        Ok(_) => {
            return Err(format!("{} exists and is no symbolic link: choose another --link", ShownPath(link)).into());
        }
        Err(_) => {}
    }
    std::os::unix::fs::symlink(port, link)
        .map_err(|error| format!("cannot make the symbolic link {}: {error}", ShownPath(link)).into())
}

/// Where orders are carried out.
struct Desk<'a> {
    port: &'a SimulatedPort,
    configuration: &'a Configuration,
    link: Option<&'a Path>,
    seed: Option<u64>,
}

impl Desk<'_> {
    /// The answer.
    fn carry_out(&self, order: &Order) -> Result<String, Failure> {
        let address = |number: u8| {
            let index = usize::from(number).checked_sub(1).filter(|&index| index < FINGERS)?;
            Some(self.configuration.address(index))
        };
        match order {
            Order::For(number, action) => {
                let found =
                    address(*number).and_then(|address| self.port.with_finger(address, |finger| action.apply(finger)));
                Ok(found.unwrap_or_else(|| format!("error this board has no finger {number}")))
            }
            Order::Trouble(trouble) => {
                let answer = trouble.happen(self.port, self.seed.unwrap_or_default(), address);
                if *trouble == Trouble::PlugIn
                    && let Some(link) = self.link
                {
                    make_link(&self.port.path(), link)?;
                }
                Ok(answer)
            }
            Order::Quit => Err("quit cannot be given by --order".into()),
        }
    }
}

fn rate(text: &str) -> Result<f64, String> {
    let rate: f64 = text.parse().map_err(|_| format!("{text} is not a number"))?;
    let sensible = (1.0..=100_000.0).contains(&rate);
    sensible.then_some(rate).ok_or_else(|| format!("{rate} is not between 1 and 100 000 Hz"))
}
