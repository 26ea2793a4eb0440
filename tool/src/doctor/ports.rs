//! Checks of a hand's ports: whether they can be opened, whether adapters delay bytes, and how long a round trip to the
//! board takes.

use super::finding::{Finding, Rating};
use std::ops::RangeInclusive;
use std::os::unix::fs::MetadataExt;
use std::path::Path;
use std::time::Duration;
use sun2xp::board::protocol::Command;
use sun2xp::board::{Allowance, Link, LinkError, OutgoingCommand, Port, PortError, Terms};
use sun2xp::finger::REPLY_WINDOW;
use sun2xp::hand::ports;
use sun2xp::hand::priority;
use sun2xp::hand::{Fingers, HandError, SimulatedHand};
use sun2xp::model::FingerNumber;
use sun2xp::model::ShownPath;
use sun2xp::model::configuration::{Configuration, FINGERS};
use sun2xp::realtime::{
    Clock, CycleStage, CycleTiming, Distribution, Histograms, MonotonicClock, Schedule, now, spawn,
};

/// If the 99th percentile of the round trips exceeds this fraction of the reply window, little reserve is left.
const LONG: f64 = 0.75;

/// Largest acceptable fraction of lost replies.
const TOO_MANY_LOST: f64 = 0.01;

/// Major device numbers of pseudo-terminals (Documentation/admin-guide/devices.txt of Linux).
const PSEUDO_TERMINALS: RangeInclusive<u64> = 136..=143;

pub(super) fn findings(
    configuration: &Configuration,
    simulated: &SimulatedHand,
    root: &Path,
    duration: Duration,
) -> Result<Vec<Finding>, HandError> {
    let ports = ports(configuration, Fingers::ALL, simulated);
    let each = duration / ports.len() as u32;
    let mut findings = Vec::new();
    for (path, fingers) in ports {
        let simulated = is_pseudo_terminal(&path);
        let subject = format!("port {}", ShownPath(&path));
        let mut link = match Link::open(&path, configuration.fingers[fingers[0].index()].baud) {
            Ok(link) => link,
            Err(error) => {
                findings.push(Finding::new(Rating::Failure, subject, "cannot be opened", advice(&error, root, &path)));
                continue;
            }
        };
        findings.push(match simulated {
            true => Finding::good(subject, "opened: the pseudo-terminal of a simulated board, not used by others"),
            false => latency(subject, link.transport().latency_timer_ms()),
        });
        let priority = priority(configuration, configuration.thread(fingers[0]));
        let owned = configuration.clone();
        let measuring = spawn("sun2xp doctor", priority, move |_| round_trips(&owned, &mut link, &fingers, each))
            .map_err(|source| HandError::System { doing: "start a thread", source })?;
        // A thread that panicked has no result.
        if let Ok(measured) = measuring.join() {
            let subject = format!("round trip on {}", ShownPath(&path));
            findings.push(judge(configuration, subject, measured, simulated));
        }
    }
    Ok(findings)
}

/// Whether a port is a pseudo-terminal. Linux has eight major device numbers for them.
fn is_pseudo_terminal(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|file| PSEUDO_TERMINALS.contains(&(file.rdev() >> 8 & 0xfff)))
}

/// The text of the error, with the port's group if the permission is missing.
fn advice(error: &LinkError, root: &Path, path: &Path) -> String {
    let group = match error {
        LinkError::Port(PortError::Forbidden(_)) => std::fs::metadata(path).ok().and_then(|file| {
            let groups = std::fs::read_to_string(root.join("etc/group")).ok()?;
            group_name(&groups, file.gid()).map(str::to_owned)
        }),
        _ => None,
    };
    match group {
        Some(group) => format!("{error}. The group of the port is {group}: sudo usermod -aG {group} $USER"),
        None => error.to_string(),
    }
}

/// The name of a group in the text of /etc/group.
fn group_name(groups: &str, id: u32) -> Option<&str> {
    groups.lines().find_map(|line| {
        let mut fields = line.split(':');
        let name = fields.next()?;
        (fields.nth(1)?.parse() == Ok(id)).then_some(name)
    })
}

fn latency(subject: String, timer_ms: Option<u32>) -> Finding {
    match timer_ms {
        Some(milliseconds) if milliseconds > 1 => Finding::new(
            Rating::Failure,
            subject,
            format!("opened; its adapter delays bytes by {milliseconds} ms"),
            "Every reply waits for the adapter's latency timer. Write 1 to latency_timer under \
             /sys/bus/usb-serial/devices, or install the udev rule of docs/real-time.md",
        ),
        Some(_) => Finding::good(subject, "opened; its adapter has the shortest latency timer"),
        None => Finding::good(subject, "opened, and no other program uses it; no latency timer"),
    }
}

/// Distribution of the round trips, and the number of cycles in which a finger's reply was missing.
struct Measured {
    times: Distribution,
    lost: u64,
}

/// Exchanges frames with every finger on a port as its servo does, but with the motors off.
fn round_trips(
    configuration: &Configuration,
    link: &mut Link<Port>,
    fingers: &[FingerNumber],
    duration: Duration,
) -> Result<Measured, LinkError> {
    let hand = &configuration.hand;
    let deadline = now() + u64::from(hand.open_timeout_ms) * 1_000_000;
    for &finger in fingers {
        let terms = Terms::new(hand, &configuration.fingers[finger.index()]);
        link.shake_hands(configuration.address(finger), &terms, deadline)?;
    }
    let period = (1e9 / hand.rate).round() as u64;
    let (mut histograms, mut lost) = (Histograms::new(), 0);
    let mut schedule = Schedule::new(now() + period, period);
    for cycle in 0..duration.as_nanos() as u64 / period {
        MonotonicClock.sleep_until(schedule.next());
        let sequence = cycle as u8;
        let mut commands = [OutgoingCommand::default(); FINGERS];
        for (command, &finger) in commands.iter_mut().zip(fingers) {
            *command =
                OutgoingCommand { address: configuration.address(finger), sequence, command: Command::default() };
        }
        let began = now();
        link.send(&commands[..fingers.len()])?;
        // The wait is longer than the servo's, so that late replies are measured too.
        let mut allowance = Allowance::for_replies(began + period);
        let mut missing = fingers.len();
        while missing > 0
            && let Some(received) = link.receive_within(&mut allowance)?
        {
            missing -= usize::from(received.sequence == sequence);
        }
        if missing == 0 {
            let mut timing = CycleTiming::default();
            timing.note(CycleStage::Wire, began, now());
            histograms.record(&timing);
        } else {
            lost += 1;
        }
        schedule.advance(now());
    }
    Ok(Measured { times: histograms.distribution(CycleStage::Wire), lost })
}

/// A simulated board answers as soon as the scheduler runs it, so its round trips say nothing about a port. Even if
/// they are too long, the hand can run, so they are at most a warning.
fn judge(
    configuration: &Configuration,
    subject: String,
    measured: Result<Measured, LinkError>,
    simulated: bool,
) -> Finding {
    let Measured { times, lost } = match measured {
        Ok(measured) => measured,
        Err(error) => return Finding::new(Rating::Failure, subject, "none", error.to_string()),
    };
    let window = 1e6 / configuration.hand.rate * REPLY_WINDOW;
    let found = format!(
        "median {:.0}, 99 % {:.0}, worst {:.0} us of {window:.0} us permitted; {lost} of {} lost",
        times.median,
        times.p99,
        times.maximum,
        times.count + lost
    );
    let share_lost = lost as f64 / (times.count + lost).max(1) as f64;
    let verdict = match times.p99 / window {
        share if share > 1.0 || share_lost > TOO_MANY_LOST => Rating::Failure,
        share if share > LONG => Rating::Warning,
        _ => return Finding::good(subject, found),
    };
    if simulated {
        let advice = "The simulated board runs on this machine, which has been too busy to run it in time. The \
                      simulation is then uneven; a real board is not affected. End other programs, and measure again";
        return Finding::new(Rating::Warning, subject, found, advice);
    }
    let advice = "Replies are lost, or arrive late in their cycle: check the cable, raise the baud rate of the board \
         and finger.baud, connect the adapter to a USB port of its own, shorten its latency timer, or lower hand.rate";
    Finding::new(verdict, subject, found, advice)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_trips_are_judged_by_the_reply_window() {
        let judged_on = |p99, lost, simulated| {
            let mut times = Distribution::default();
            (times.count, times.p99) = (1000, p99);
            judge(&Configuration::default(), "x".into(), Ok(Measured { times, lost }), simulated).verdict
        };
        let judged = |p99, lost| judged_on(p99, lost, false);
        // The reply window is 850 us at 1000 Hz.
        assert_eq!(judged(600.0, 0), Rating::Good);
        assert_eq!(judged(700.0, 5), Rating::Warning);
        assert_eq!(judged(900.0, 0), Rating::Failure);
        assert_eq!(judged(600.0, 20), Rating::Failure);
        // A simulated board that is late shows that the machine is busy, not that its port is bad.
        assert_eq!(judged_on(600.0, 0, true), Rating::Good);
        assert_eq!(judged_on(900.0, 20, true), Rating::Warning);
        let silent = Err(LinkError::Silent { milliseconds: 500 });
        let finding = judge(&Configuration::default(), "x".into(), silent, true);
        assert!(finding.verdict == Rating::Failure && finding.advice.contains("switched on"), "{finding:?}");
    }

    #[test]
    fn only_pseudo_terminals_are_simulated_boards() {
        let board = SimulatedHand::start(&Configuration::default(), Fingers::ALL).expect("a hand");
        let ports = ports(&Configuration::default(), Fingers::ALL, &board);
        assert!(ports.iter().all(|(path, _)| is_pseudo_terminal(path)), "{ports:?}");
        assert!(!is_pseudo_terminal(Path::new("/dev/null")) && !is_pseudo_terminal(Path::new("/dev/none")));
    }

    #[test]
    fn latency_timers_are_judged() {
        let verdicts = [None, Some(1), Some(2), Some(16)].map(|timer| latency("x".into(), timer).verdict);
        assert_eq!(verdicts, [Rating::Good, Rating::Good, Rating::Failure, Rating::Failure]);
    }

    #[test]
    fn the_group_of_a_port_is_named() {
        let groups = "root:x:0:\ndialout:x:20:somebody\n";
        assert_eq!((group_name(groups, 20), group_name(groups, 7)), (Some("dialout"), None));
    }
}
