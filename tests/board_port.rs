//! The serial port and the simulated board over a real pseudo-terminal, in real time.

#[path = "common/pseudo_terminal.rs"]
mod pseudo_terminal;

use pseudo_terminal::pseudo_terminal;
use std::io::{Read, Write};
use std::os::fd::AsRawFd;
use std::path::Path;
use std::time::{Duration, Instant};
use sun2xp::board::protocol::*;
use sun2xp::board::*;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger, ConfiguredHand};
use sun2xp::realtime::{self, Priority};
use sun2xp::simulated::*;

const MS: u64 = 1_000_000;

fn board() -> SimulatedPort {
    let board = SimulatedBoard::new(&Configuration::default(), &FingerNumber::ALL).unwrap();
    SimulatedPort::start(board, Pace::RealTime, Priority::default()).unwrap()
}

fn terms() -> Terms {
    // The watchdog time is long, because the test machine may be busy. The time of the watchdog is tested on
    // simulated time.
    let hand = ConfiguredHand { watchdog_ms: 500, ..Default::default() };
    Terms::new(&hand, &ConfiguredFinger::default())
}

fn pull() -> Command {
    Command { toggle: true, enable: true, torques: [3000; 4] }
}

#[test]
fn cycles_over_a_pseudo_terminal() {
    let board = board();
    let mut link = Link::open(&board.path(), 1_000_000).unwrap();
    for address in 1..=3 {
        link.shake_hands(address, &terms(), realtime::now() + 2000 * MS).unwrap();
    }
    for sequence in 0..200 {
        let commands = [1, 2, 3].map(|address| OutgoingCommand { address, sequence, command: pull() });
        link.send(&commands).unwrap();
        for address in 1..=3 {
            let received = link.receive(realtime::now() + 1000 * MS).unwrap().expect("a reply within a second");
            assert_eq!((received.address, received.sequence), (address, sequence));
            assert!(received.reply.status.has(Status::ENABLED));
        }
    }
    assert!(link.stop(1, realtime::now() + 1000 * MS).unwrap());
    let counters = link.counters();
    assert_eq!((counters.damaged, counters.foreign, counters.unsent), (0, 0, 0));
    assert_eq!(board.with_finger(1, |finger| finger.enabled()), Some(false));
    assert_eq!(board.with_finger(2, |finger| finger.enabled()), Some(true));
    assert_eq!(board.with_finger(4, |finger| finger.enabled()), None);
}

/// A living child process shares the open file and with it the lock of the port.
#[test]
fn a_port_that_was_closed_opens_again_while_a_forked_child_lives() {
    let board = board();
    let port = Port::open(&board.path(), 1_000_000).unwrap();
    // SAFETY: the child does nothing but wait for its end.
    let child = unsafe { libc::fork() };
    if child == 0 {
        loop {
            // SAFETY: takes no arguments.
            unsafe { libc::pause() };
        }
    }
    assert!(child > 0);
    assert!(
        matches!(Port::open(&board.path(), 1_000_000), Err(PortError::Busy(_))),
        "the port is locked while it is open"
    );
    drop(port);
    let opened = Port::open(&board.path(), 1_000_000);
    // SAFETY: a child of this process that has not been waited for.
    unsafe {
        libc::kill(child, libc::SIGKILL);
        libc::waitpid(child, std::ptr::null_mut(), 0);
    }
    opened.expect("the port is free");
}

#[test]
fn a_deadline_is_kept_when_nothing_arrives() {
    let board = board();
    let mut link = Link::open(&board.path(), 1_000_000).unwrap();
    let deadline = realtime::now() + 20 * MS;
    assert_eq!(link.receive(deadline).unwrap(), None);
    assert!(realtime::now() >= deadline);
}

#[test]
fn a_port_has_one_user_at_a_time_even_after_an_abrupt_end() {
    let board = board();
    let first = Link::open(&board.path(), 1_000_000).unwrap();
    let busy = Link::open(&board.path(), 1_000_000).unwrap_err();
    assert_eq!(busy.errno(), libc::EBUSY);
    assert!(busy.to_string().contains(&*board.path().to_string_lossy()), "{busy}");
    drop(first);
    let mut second = Link::open(&board.path(), 1_000_000).unwrap();
    second.shake_hands(1, &terms(), realtime::now() + 2000 * MS).unwrap();
}

#[test]
fn a_host_that_configures_nothing_gets_every_byte() {
    let board = board();
    let mut host = std::fs::OpenOptions::new().read(true).write(true).open(board.path()).unwrap();
    // Two Hellos whose sequence numbers a terminal would take for an interrupt and a line end.
    for sequence in [0x03, 0x0D] {
        let frame = Frame::Hello(Hello { lowest_version: 1, highest_version: 1 });
        let hello = WireFrame::new(&Message { address: 1, sequence, frame });
        host.write_all(hello.as_bytes()).unwrap();
        let mut wire = vec![0; Kind::Identity.wire_length()];
        host.read_exact(&mut wire).unwrap();
        let identity = Message::read(&Decoder::default().next(&mut &wire[..]).expect("whole")).unwrap();
        assert_eq!((identity.sequence, identity.frame.kind()), (sequence, Kind::Identity));
    }
}

/// Returns whether the port is marked for exclusive use, which locks out everyone except root.
fn exclusive(path: &Path) -> bool {
    let Ok(file) = std::fs::OpenOptions::new().read(true).write(true).open(path) else { return true };
    let mut exclusive: libc::c_int = -1;
    // SAFETY: the descriptor is open, and the request writes one int.
    assert_eq!(unsafe { libc::ioctl(file.as_raw_fd(), libc::TIOCGEXCL, &mut exclusive) }, 0);
    exclusive != 0
}

/// The system lets only root open a port that is marked for exclusive use. The lock of the port makes `Port::open` fail
/// for root too.
#[test]
fn a_refused_open_leaves_the_port_to_its_user() {
    let (control, path) = pseudo_terminal();
    let mut port = Port::open(&path, 1_000_000).unwrap();
    assert_eq!(port.write(b"command").unwrap(), 7);
    assert_eq!(Port::open(&path, 1_000_000).unwrap_err().errno(), libc::EBUSY);
    assert!(exclusive(&path), "the mark of the first user was removed");
    let mut poll = libc::pollfd { fd: control.as_raw_fd(), events: libc::POLLIN, revents: 0 };
    // SAFETY: the pointer refers to one pollfd.
    assert_eq!(unsafe { libc::poll(&mut poll, 1, 10_000) }, 1, "what the first user has sent was discarded");
    let mut received = [0; 8];
    let mut control = std::fs::File::from(control);
    assert_eq!(control.read(&mut received).unwrap(), 7);
    assert_eq!(&received[..7], b"command");
    drop(port);
    assert!(!exclusive(&path));
}

#[test]
fn exclusive_use_ends_with_its_user() {
    let board = board();
    let link = Link::open(&board.path(), 1_000_000).unwrap();
    drop(link);
    assert!(!exclusive(&board.path()));
}

#[test]
fn exclusive_use_does_not_outlive_a_user_that_was_killed() {
    let board = board();
    let port = std::fs::OpenOptions::new().read(true).write(true).open(board.path()).unwrap();
    // SAFETY: the descriptor is open; the request takes no pointer.
    assert_eq!(unsafe { libc::ioctl(port.as_raw_fd(), libc::TIOCEXCL) }, 0);
    drop(port);
    let waiting = Instant::now();
    while exclusive(&board.path()) {
        assert!(waiting.elapsed() < Duration::from_secs(10), "still marked");
        std::thread::yield_now();
    }
}

#[test]
fn answers_that_one_host_left_unread_do_not_reach_the_next() {
    let board = board();
    let mut link = Link::open(&board.path(), 1_000_000).unwrap();
    link.shake_hands(1, &terms(), realtime::now() + 2000 * MS).unwrap();
    for sequence in 0..50 {
        link.send(&[OutgoingCommand { address: 1, sequence, command: pull() }]).unwrap();
    }
    drop(link);
    let mut link = Link::open(&board.path(), 1_000_000).unwrap();
    // The first host's motors are still enabled. The handshake waits for the watchdog.
    link.shake_hands(1, &terms(), realtime::now() + 5000 * MS).unwrap();
    link.send(&[OutgoingCommand { address: 1, sequence: 99, command: pull() }]).unwrap();
    let received = link.receive(realtime::now() + 1000 * MS).unwrap().expect("a reply");
    assert_eq!(received.sequence, 99);
}

#[test]
fn the_end_of_the_board_is_an_error_and_not_a_silence() {
    let board = board();
    let mut link = Link::open(&board.path(), 1_000_000).unwrap();
    drop(board);
    let error = link.receive(realtime::now() + 5000 * MS).unwrap_err();
    assert!(matches!(error, LinkError::Port(PortError::Vanished)), "{error:?}");
    assert_eq!(error.errno(), libc::EIO);
}

#[test]
fn a_port_that_cannot_be_opened_names_the_reason() {
    let errno = |path: &str| Port::open(Path::new(path), 1_000_000).unwrap_err().errno();
    assert_eq!(errno("/nonexistent/port"), libc::ENOENT);
    assert_eq!(errno("/dev/null"), libc::ENOTTY);
    let file = tempfile::NamedTempFile::new().unwrap();
    assert_eq!(errno(&file.path().to_string_lossy()), libc::ENOTTY);
    assert_eq!(errno(&std::env::temp_dir().to_string_lossy()), libc::ENOTTY);
    // Here the library passes on the system's errno: there is no device behind the file of a socket.
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("socket");
    let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
    assert_eq!(errno(&socket.to_string_lossy()), libc::ENXIO);
    assert_eq!(errno(&"x".repeat(5000)), libc::ENAMETOOLONG);
    let error = Port::open(Path::new("/dev/null\0hidden"), 1_000_000).unwrap_err();
    assert!(error.to_string().contains(r"/dev/null\0hidden"), "{error}");
}

#[test]
fn silence_on_a_real_clock_ends_the_torque() {
    let board = board();
    let mut link = Link::open(&board.path(), 1_000_000).unwrap();
    let short = Terms { watchdog_ms: 20, ..terms() };
    link.shake_hands(1, &short, realtime::now() + 2000 * MS).unwrap();
    link.send(&[OutgoingCommand { address: 1, sequence: 0, command: pull() }]).unwrap();
    assert!(link.receive(realtime::now() + 1000 * MS).unwrap().is_some());
    let waiting = Instant::now();
    while board.with_finger(1, |finger| finger.enabled()) == Some(true) {
        assert!(waiting.elapsed() < Duration::from_secs(10), "the watchdog does not trip");
        std::thread::yield_now();
    }
}
