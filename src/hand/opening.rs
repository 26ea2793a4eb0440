//! Does the part of opening a hand that comes before the start of its servo threads: checks the configuration, opens
//! the ports and shakes hands with the boards.

use crate::board::protocol::Status;
use crate::board::{Connection, Link, Terms, capacity, tactile_requests};
use crate::control::Controller;
use crate::finger::events::EventLog;
use crate::finger::{
    BlackBox, Bulletin, Elements, FingerServo, GroupGate, Mailbox, Reflexes, ServedPort, StopSignal, link_handover,
    stop_calls,
};
use crate::hand::admission::Admission;
use crate::hand::events::EventSource;
use crate::hand::hardware::{Hardware, warn_of_lost_zero};
use crate::hand::identities::Identities;
use crate::hand::notice::print_notice;
use crate::hand::port_repair::{KnownBoard, PortRepair};
use crate::hand::simulated_hand::SimulatedHand;
use crate::hand::{ConfigurationError, HandError, SetPointError};
use crate::model::configuration::{Configuration, OnFault, Unusable};
use crate::model::{FingerNumber, Fingers};
use crate::model::{Section, Shown, UnusableConfiguration};
use crate::realtime::{Consumer, CycleTiming, EventCount, Pages, SharedPages, now, ring};
use nalgebra::Matrix3;
use std::path::{Path, PathBuf};

/// Capacity of the timing rings, s. If nothing is collected for longer than this, timings are lost.
const UNCOLLECTED: f64 = 0.8;

/// A finger after the handshake. Its servo side is in a [`ServedPort`].
pub(super) struct Reached {
    pub number: FingerNumber,
    /// The planners' end of the mailbox.
    pub mailbox: Mailbox,
    /// The checks of the planners' commands.
    pub admission: Admission,
    /// Timings from the servo.
    pub timings: Consumer<CycleTiming>,
    /// Cycle records from the servo.
    pub black_box: BlackBox,
    /// Events from the servo.
    pub events: EventLog,
    /// The finger's tactile elements.
    pub touch: Elements,
    /// The planners' end of the reflexes.
    pub reflexes: Reflexes,
}

/// A hand after the handshakes.
pub(super) struct Connected {
    /// The servos' side: the ports, with the servos of their fingers.
    pub lines: Vec<Line>,
    /// The planners' side: an entry for each finger, in the order of the finger numbers.
    pub reached: Vec<Reached>,
    /// The gate that lets a group of set points take effect in the same period in every servo.
    pub gate: GroupGate,
    /// The data for repairing the ports.
    pub repairs: Vec<PortRepair>,
    /// The events of all fingers.
    pub events: EventSource,
    /// The signal that stops the fingers.
    pub alarm: StopSignal,
}

/// A port with its fingers, and the number of the thread that will serve it.
pub(super) struct Line {
    /// Number of the servo thread, 1 to 3.
    pub thread: u8,
    pub port: ServedPort<Connection>,
}

/// Checks everything in a configuration that can be checked without a port: values, initial stiffness, controllers,
/// capacity of the lines.
pub fn check(configuration: &Configuration) -> Result<(), UnusableConfiguration> {
    configuration.check()?;
    for number in FingerNumber::ALL {
        let refused = |unusable| UnusableConfiguration { section: Section::Finger(number), unusable };
        initial_stiffness(configuration, number).map_err(refused)?;
        if configuration.hand.fingers.contains(number) {
            Controller::new(&configuration.fingers[number.index()], configuration.hand.rate).map_err(refused)?;
            carries(configuration, number).map_err(refused)?;
        }
    }
    Ok(())
}

/// Returns the absolute path of the folder for black boxes, which must exist at open. With an absolute path the folder
/// stays the same if the planner changes its working directory.
pub(super) fn black_box_folder(configuration: &Configuration) -> Result<Option<PathBuf>, UnusableConfiguration> {
    match &configuration.hand.black_box {
        Some(folder) if !Path::new(folder).is_dir() => {
            let reason =
                format!("{} is not a folder: create it (mkdir -p), or configure another folder", Shown(folder));
            Err(UnusableConfiguration { section: Section::Hand, unusable: Unusable { key: "black_box", reason } })
        }
        folder => Ok(folder.as_ref().map(|folder| from_here(folder.into()))),
    }
}

/// Returns `path` as an absolute path.
pub(super) fn from_here(path: PathBuf) -> PathBuf {
    // If there is no working directory, a relative path stays as it is. It is not valid then.
    std::path::absolute(&path).unwrap_or(path)
}

/// Opens the ports of these fingers and shakes hands with each finger. If `limp` is true, the motors stay off.
pub(super) fn reach(
    configuration: &Configuration,
    fingers: Fingers,
    simulated: &SimulatedHand,
    hardware: &mut Hardware,
    limp: bool,
) -> Result<Connected, HandError> {
    // The hand reacts to every emergency stop call that is made after this line.
    let alarm = StopSignal::new(configuration.hand.on_fault == OnFault::Hand, stop_calls());
    let (gate, bulletin) = (GroupGate::new(), Bulletin::new());
    let (mut lines, mut reached, mut repairs) = (Vec::new(), Vec::new(), Vec::new());
    let mut identities = Identities::default();
    let readers = SharedPages::from(Pages::new(EventCount::default()));
    for (path, sharing) in ports(configuration, fingers, simulated) {
        let first = sharing[0];
        let baud = configuration.fingers[first.index()].baud;
        let mut link = hardware.connect(configuration, first, &path)?;
        let (mut servos, mut boards) = (Vec::new(), Vec::new());
        for &number in &sharing {
            let (servo, finger, board) = shake_hands(configuration, number, &bulletin, &mut link)?;
            identities.add(board.finger, &path, &board.identity)?;
            let servo = servo.with(alarm.clone()).in_groups(gate.clone()).with_readers(readers.clone());
            let servo = if link.transport().in_step() { servo.in_step(&configuration.hand) } else { servo };
            servos.push(if limp { servo.limp() } else { servo });
            reached.push(finger);
            boards.push(board);
        }
        let (handover, repair_end) = link_handover();
        // A pseudo-terminal has no bit rate, so a TactileRequest for every finger fits into each period.
        let requests = match simulated.path(first) {
            Some(_) => sharing.len(),
            None => tactile_requests(baud, sharing.len(), configuration.hand.rate),
        };
        lines.push(Line {
            thread: configuration.thread(first),
            port: ServedPort::new(link, servos).with_handover(handover).with_requests(requests),
        });
        // Hardware that the program itself drives (`FingerIo`) has no port that could be reopened: it starts again when
        // a recovery is requested. The port of a simulated board is not reopened, because after its loss the system may
        // use its path for a pseudo-terminal that the planner opens.
        let reconnects = |&number: &FingerNumber| {
            let finger = &configuration.fingers[number.index()];
            finger.reconnect && !finger.has_io() && simulated.path(number).is_none()
        };
        let reconnect = sharing.iter().any(reconnects);
        // With an absolute path, the port is found again after the planner has changed its working directory.
        repairs.push(PortRepair::new(from_here(path), baud, reconnect, boards, repair_end));
    }
    reached.sort_by_key(|finger| finger.number);
    let logs = reached.iter().map(|finger| finger.events.clone()).collect();
    let events = EventSource::new(logs, readers, configuration.hand.period());
    Ok(Connected { lines, reached, gate, repairs, events, alarm })
}

/// Returns the ports of these fingers, each port with its fingers. Fingers that the hand does not have are left out.
pub fn ports(
    configuration: &Configuration,
    fingers: Fingers,
    simulated: &SimulatedHand,
) -> Vec<(PathBuf, Vec<FingerNumber>)> {
    let mut ports: Vec<(PathBuf, Vec<FingerNumber>)> = Vec::new();
    for number in fingers.members().filter(|&number| configuration.hand.fingers.contains(number)) {
        let named = || PathBuf::from(&configuration.fingers[number.index()].port);
        let path = simulated.path(number).unwrap_or_else(named);
        match ports.iter_mut().find(|(known, _)| *known == path) {
            Some((_, fingers)) => fingers.push(number),
            None => ports.push((path, vec![number])),
        }
    }
    ports
}

/// The notice for a board that uses a longer watchdog than configured, because it does not support a shorter one.
fn longer_watchdog(finger: FingerNumber, configured_ms: u16, agreed_ms: u16) -> Option<String> {
    (agreed_ms > configured_ms).then(|| {
        format!(
            "the shortest watchdog time of the board of finger {finger} is {agreed_ms} ms, but hand.watchdog_ms is \
             {configured_ms}. After the last command the motors of this finger may continue for {agreed_ms} ms, plus \
             1 % and 1 ms for the tolerance of the board's timer. If this is too long for the hand, use a board with a \
             shorter watchdog time; otherwise, nothing needs to be done"
        )
    })
}

fn shake_hands(
    configuration: &Configuration,
    number: FingerNumber,
    bulletin: &Bulletin,
    link: &mut Link<Connection>,
) -> Result<(FingerServo, Reached, KnownBoard), HandError> {
    let (hand, finger) = (&configuration.hand, &configuration.fingers[number.index()]);
    let unusable = |unusable| ConfigurationError::Unusable { section: format!("finger.{number}"), unusable };
    let (address, terms) = (configuration.address(number), Terms::new(hand, finger));
    let deadline = now() + u64::from(hand.open_timeout_ms) * 1_000_000;
    let (identity, configured) =
        link.shake_hands(address, &terms, deadline).map_err(|source| HandError::Link { finger: number, source })?;
    let longer = longer_watchdog(number, hand.watchdog_ms, configured.terms.watchdog_ms);
    longer.iter().for_each(|text| print_notice(text));
    let counts = identity.counts_per_revolution;
    if counts != 0 && finger.encoder.counts_per_revolution.iter().any(|&configured| configured != counts) {
        let reason =
            format!("the board of finger {number} reports {counts} counts per revolution: configure the same number");
        return Err(unusable(Unusable { key: "encoder.counts_per_revolution", reason }).into());
    }
    let stiffness = initial_stiffness(configuration, number).map_err(unusable)?;
    let (producer, timings) = ring((UNCOLLECTED * hand.rate).ceil() as usize);
    let (recorder, black_box) = BlackBox::new(configuration, number);
    let (servo, mailbox) =
        FingerServo::new(configuration, number, stiffness, &identity, &configured, (producer, recorder))
            .map_err(unusable)?;
    let zero_valid = configured.status.has(Status::ZERO_VALID);
    warn_of_lost_zero(number, finger, zero_valid);
    let has_io = finger.has_io();
    let board = KnownBoard { finger: number, address, terms, identity, zero_valid, has_io, restarts: 0 };
    let (admission, events) = (Admission::new(configuration, number), servo.event_log().clone());
    let touch = servo.touch().clone();
    let (servo, reflexes) = servo.with_reflexes(number, bulletin);
    Ok((servo, Reached { number, mailbox, admission, timings, black_box, events, touch, reflexes }, board))
}

fn initial_stiffness(configuration: &Configuration, number: FingerNumber) -> Result<Matrix3<f64>, Unusable> {
    // The text of the error says what to send, but the hand is not open yet. So only the cause is used, which is the
    // part of the text before the first colon.
    let refused = |error: SetPointError| {
        let text = error.to_string();
        let cause = text.split(": ").next().unwrap_or(&text);
        let reason = format!("{cause}: set a symmetric stiffness with eigenvalues from zero to the bound");
        Unusable { key: "stiffness.initial", reason }
    };
    let admission = Admission::new(configuration, number);
    admission.kx(configuration.fingers[number.index()].stiffness.initial).map_err(refused)
}

/// Checks that the line of a finger can carry all of its traffic at the configured rate.
fn carries(configuration: &Configuration, number: FingerNumber) -> Result<(), Unusable> {
    let finger = &configuration.fingers[number.index()];
    if finger.simulated() || finger.has_io() {
        // A pseudo-terminal has no bit rate, and hardware of the program has no line.
        return Ok(());
    }
    let others = configuration.hand.fingers.members().filter(|&other| other != number);
    let sharing = 1 + others.filter(|other| configuration.fingers[other.index()].shares_port(finger)).count();
    match capacity(finger.baud, sharing, configuration.hand.rate) {
        Ok(_) => Ok(()),
        Err(too_fast) => Err(Unusable { key: "baud", reason: too_fast.to_string() }),
    }
}

/// Refuses to continue if `goes_on` returns false.
pub(super) fn check_goes_on(goes_on: &dyn Fn() -> bool) -> Result<(), HandError> {
    if goes_on() {
        return Ok(());
    }
    let source = std::io::Error::from_raw_os_error(libc::ECANCELED);
    Err(HandError::System { doing: "open the hand while the program ends", source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_board_that_uses_a_longer_watchdog_is_announced() {
        assert_eq!(longer_watchdog(FingerNumber::TWO, 18, 18), None);
        let text = longer_watchdog(FingerNumber::TWO, 18, 20).expect("longer");
        assert!(
            text.contains("finger 2")
                && text.contains("20 ms")
                && text.contains("hand.watchdog_ms is 18.")
                && text.ends_with("; otherwise, nothing needs to be done"),
            "{text}"
        );
    }
}
