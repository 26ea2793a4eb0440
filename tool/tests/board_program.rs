//! Tests `sun2xp board`, which runs a board as a separate program and prints the path of its port.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command as Program, Stdio};
use sun2xp::board::*;
use sun2xp::model::configuration::{ConfiguredFinger, ConfiguredHand};
use sun2xp::realtime;

const MS: u64 = 1_000_000;

struct Board {
    process: Child,
    orders: Option<ChildStdin>,
    answers: BufReader<ChildStdout>,
}

impl Board {
    fn start(arguments: &[&str]) -> Self {
        let mut process = Program::new(env!("CARGO_BIN_EXE_sun2xp"))
            .arg("board")
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let answers = BufReader::new(process.stdout.take().unwrap());
        Self { orders: process.stdin.take(), answers, process }
    }

    fn line(&mut self) -> String {
        let mut line = String::new();
        self.answers.read_line(&mut line).unwrap();
        line.trim_end().to_owned()
    }

    fn order(&mut self, order: &str) -> String {
        writeln!(self.orders.as_mut().unwrap(), "{order}").unwrap();
        self.line()
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn shake_hands(port: &Path, address: u8) -> Result<(), LinkError> {
    let terms = Terms::new(&ConfiguredHand::default(), &ConfiguredFinger::default());
    let mut link = Link::open(port, 1_000_000)?;
    link.shake_hands(address, &terms, realtime::now() + 1000 * MS).map(|_| ())
}

/// The numbers after `name` in the answer to `state`.
fn numbers(state: &str, name: &str, count: usize) -> Vec<f64> {
    let words = state.split_whitespace().skip_while(|&word| word != name).skip(1);
    words.take(count).map(|word| word.parse().unwrap()).collect()
}

#[test]
fn a_board_prints_its_port_answers_orders_and_removes_its_link_when_it_ends() {
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("board");
    let mut board = Board::start(&["--finger", "2", "--link", &link.to_string_lossy()]);
    let port = board.line();
    assert_eq!(std::fs::read_link(&link).unwrap(), Path::new(&port));
    shake_hands(&link, 2).unwrap();
    let error = shake_hands(Path::new(&port), 1).unwrap_err();
    assert!(matches!(error, LinkError::WrongAddress { address: 1, .. }), "{error}");

    let before = board.order("state 2");
    assert_eq!(numbers(&before, "joints", 3).len(), 3);
    assert!(numbers(&before, "tensions", 4).iter().all(|&tension| tension > 4.9), "{before}");
    // A force along x can move joint 0 only.
    assert_eq!(board.order("force 2 1 0 0"), "ok");
    while numbers(&board.order("state 2"), "tip", 3)[0] < 0.05 {
        assert!(board.process.try_wait().unwrap().is_none());
    }
    assert!(board.order("force 1 1 0 0").starts_with("error"));

    writeln!(board.orders.as_mut().unwrap(), "quit").unwrap();
    assert!(board.process.wait().unwrap().success());
    assert!(!link.is_symlink());
}

#[test]
fn the_end_of_its_input_does_not_end_the_board() {
    let mut board = Board::start(&[]);
    let port = board.line();
    drop(board.orders.take());
    for address in 1..=3 {
        shake_hands(Path::new(&port), address).unwrap();
    }
    assert!(board.process.try_wait().unwrap().is_none());
}

#[test]
fn defects_occur_while_the_board_runs_and_are_repaired() {
    // A finger that is named twice is one finger.
    let mut board = Board::start(&["--finger", "1", "--finger", "1", "--order", "cut 1 2"]);
    let port = board.line();
    let tensions = |board: &mut Board| numbers(&board.order("state 1"), "tensions", 4);
    assert_eq!(tensions(&mut board)[1], 0.0, "cut by --order");
    assert_eq!(board.order("repair 1"), "ok");
    assert!(tensions(&mut board)[1] > 1.0);
    for order in ["jam 7 1", "state 7"] {
        assert_eq!(
            board.order(order),
            "error this board has no finger 7: name one of the fingers that the board was started with"
        );
    }
    assert!(board.order("jam 1 7").starts_with("error"));
    // The default finger has no tactile elements.
    let without_elements = "error finger 1 has no tactile element with this number: see finger.touch.elements";
    assert_eq!(board.order("dead-element 1 0"), without_elements);
    let answer = board.order("shove 1");
    let orders = ["force", "state", "cut", "drift-gauge", "repair", "drop", "commands", "unplug", "replug"];
    assert!(answer.starts_with("error there is no order shove: "), "{answer}");
    assert!(orders.iter().all(|order| answer.contains(&format!(" {order}"))), "{answer}");

    // The line loses every frame, and then works again.
    assert_eq!(board.order("drop 1"), "ok");
    assert!(matches!(shake_hands(Path::new(&port), 1), Err(LinkError::Silent { .. })));
    assert_eq!(board.order("good"), "ok");
    shake_hands(Path::new(&port), 1).unwrap();

    // The port vanishes while it is in use. The next port works.
    let mut link = Link::open(Path::new(&port), 1_000_000).unwrap();
    assert_eq!(board.order("unplug"), "ok");
    let met = link.receive(realtime::now() + 1000 * MS);
    assert!(matches!(met, Err(LinkError::Port(PortError::Vanished))), "{met:?}");
    drop(link);
    let answer = board.order("replug");
    let port = answer.strip_prefix("ok ").unwrap_or_else(|| panic!("{answer}"));
    shake_hands(Path::new(port), 1).unwrap();
}

#[test]
fn a_line_that_is_no_text_is_answered_and_a_long_line_too() {
    let mut board = Board::start(&["--finger", "1"]);
    board.line();
    board.orders.as_mut().unwrap().write_all(b"\xff\xfe\n").unwrap();
    let answer = board.line();
    assert!(answer.starts_with("error "), "{answer}");
    let answer = board.order(&"commands ".repeat(100_000));
    assert!(answer.starts_with("error usage: commands FAULT"), "{answer}");
    assert_eq!(board.order("good"), "ok");
}

#[test]
fn a_refused_order_leaves_no_link() {
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("board");
    let mut board = Board::start(&["--finger", "1", "--order", "cut 2 1", "--link", &link.to_string_lossy()]);
    assert_eq!(board.process.wait().unwrap().code(), Some(2));
    assert!(!link.is_symlink());
}

/// `sun2xp board` ignores the ports of a file. The simulation must therefore be stable with its time step, even if the
/// file names a real port.
#[test]
fn values_of_the_simulation_are_checked_although_the_file_names_a_port() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("hand.toml");
    let run = |text: &str, finger: &str| {
        std::fs::write(&file, text).unwrap();
        let mut board = Program::new(env!("CARGO_BIN_EXE_sun2xp"));
        board.args(["board", "--finger", finger, "--config"]).arg(&file);
        board.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut board = board.spawn().unwrap();
        // A board that has refused its configuration reads no orders.
        let _ = board.stdin.take().unwrap().write_all(b"quit\n");
        let ended = board.wait_with_output().unwrap();
        (ended.status.code(), String::from_utf8(ended.stderr).unwrap())
    };
    let text = "[finger.1]\nport = '/dev/ttyUSB0'\n[finger.1.simulation]\nrotor_inertia = [1e-8, 1e-8, 1e-8, 1e-8]\n\
                tendon_stiffness = [3000, 3000, 3000, 3000]\n[finger.geometry]\nmotor_radius = [0.2, 0.2, 0.2, 0.2]\n\
                [finger.2]\nport = '/dev/ttyUSB1'\n[finger.3]\nport = '/dev/ttyUSB2'\n";
    let (status, reported) = run(text, "1");
    assert_eq!(status, Some(1), "{reported}");
    assert!(reported.contains("hand.toml:4: finger.1.simulation.rotor_inertia: "), "{reported}");
    // A hand would refuse this file, because only finger 1 names a port. `sun2xp board` accepts it, because the other
    // fingers of the file are on other boards.
    let (status, reported) = run("[finger.1]\nport = '/dev/ttyUSB0'\n", "1");
    assert_eq!(status, Some(0), "{reported}");
}
