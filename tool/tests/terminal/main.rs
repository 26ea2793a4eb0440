//! `sun2xp monitor`, `sun2xp jog` and `sun2xp status` as a person uses them: in a terminal, with keys. tmux is the
//! terminal.

#[allow(dead_code)]
#[path = "../../../tests/common/tools.rs"]
mod tools;

mod screen;

use screen::Terminal;
use std::fs;
use std::process::{Command, Output};
use sun2xp::{Configuration, Hand};

const TOOL: &str = env!("CARGO_BIN_EXE_sun2xp");

fn open(name: &str) -> Hand {
    let mut configuration = Configuration::default();
    configuration.telemetry.name = name.into();
    Hand::open(configuration).expect("the simulated hand opens")
}

fn status(arguments: &[&str]) -> Output {
    Command::new(TOOL).arg("status").args(arguments).output().expect("the tool runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn the_monitor_shows_a_hand_until_a_key_ends_it() {
    if !tools::available("tmux", "the keys of the monitor") {
        return;
    }
    let hand = open("tmux-monitor");
    let folder = tempfile::tempdir().expect("a folder");
    let command = format!("{TOOL} monitor tmux-monitor --snapshots {}", folder.path().display());
    let terminal = Terminal::start("monitor", (80, 24), &command);
    terminal.until(&["finger 1 running", "finger 3 running", "live", "1000 Hz", "J2 ├", "T4 │", "overruns"]);

    hand.send_position(1, [0.3, 0.5, 1.0]).expect("sent");
    terminal.until(&["17.2°"]);
    terminal.keys(&["Space"]);
    terminal.until(&["frozen for"]);
    hand.send_position(1, [0.0, 0.5, 1.0]).expect("sent");
    terminal.until(&["frozen for 2.", "17.2°"]);
    terminal.keys(&["Space"]);
    terminal.until(&["live"]);

    terminal.keys(&["2"]);
    terminal.until(&["finger 2 in detail", "Kx in the frame of finger 2"]);
    terminal.keys(&["Tab"]);
    terminal.until(&["finger 3 in detail"]);
    terminal.keys(&["Escape"]);
    terminal.until(&["finger 1 running"]);
    terminal.keys(&["?"]);
    terminal.until(&["help: ? closes it"]);
    terminal.keys(&["?"]);

    terminal.keys(&["s"]);
    terminal.until(&["wrote", ".json", ".txt", ".svg"]);
    let mut names: Vec<_> =
        fs::read_dir(folder.path()).expect("there").map(|entry| entry.expect("there").path()).collect();
    names.sort();
    let state: serde_json::Value = serde_json::from_slice(&fs::read(&names[0]).expect("there")).expect("JSON");
    assert_eq!((state["name"].as_str(), state["fingers"].as_array().map(Vec::len)), (Some("tmux-monitor"), Some(3)));
    assert!(fs::read_to_string(&names[2]).expect("there").contains("finger 2 running"));

    terminal.resize((130, 45));
    terminal.until(&["tip force", "wake-ups of"]);
    hand.stop(2).expect("there");
    let fault = screen::fault_of(&hand, 2);
    terminal.until_words(&format!("finger 2, fault {}: {fault}", fault.kind.number()));

    hand.close();
    terminal.until(&["ended"]);
    terminal.until_words("This view waits for the next hand; q quits");
    let _next = open("tmux-monitor");
    terminal.until(&["live", "finger 2 running"]);
    terminal.keys(&["q"]);
    // The shell is back, and the terminal echoes keys and reads lines again.
    terminal.until(&["status 0"]);
    terminal.run("stty -a | tr ' ' '\\n' | grep -x -e echo -e icanon | tr '\\n' ' '");
    terminal.until(&["echo", "icanon"]);
}

#[test]
fn a_signal_and_a_missing_hand_leave_a_usable_terminal() {
    if !tools::available("tmux", "the terminal after a signal") {
        return;
    }
    let command = format!("sh -c 'echo $$ > \"$PIDFILE\"; exec {TOOL} monitor tmux-none'");
    let terminal = Terminal::start("signal", (80, 24), &command);
    terminal.until(&["waiting for a hand", "tmux-none"]);
    // SAFETY: the monitor runs until it gets this signal, so the number is still its own.
    assert_eq!(unsafe { libc::kill(terminal.process(), libc::SIGTERM) }, 0);
    terminal.until(&["status 0"]);
    terminal.run("stty -a | tr ' ' '\\n' | grep -x -e echo -e icanon | tr '\\n' ' '");
    terminal.until(&["echo", "icanon"]);
}

#[test]
fn jog_moves_and_pushes_the_simulated_hand() {
    if !tools::available("tmux", "the keys of jog") {
        return;
    }
    let terminal = Terminal::start("jog", (100, 30), &format!("{TOOL} jog"));
    terminal.until(&["sun2xp jog", "finger 3 running", "jog finger 1", "[j joints 1°]", "live"]);
    terminal.keys(&["]", "]", "Right", "Right"]);
    terminal.until(&["finger 1: joints to 10.0, 30.0, 60.0 degrees"]);
    terminal.keys(&["]"]);
    // The range of joint 0 ends at 60 degrees.
    terminal.keys(&["Right", "Right", "Right", "Right", "Right", "Right"]);
    terminal.until_words("rad, outside the limits of finger 1, -1.0472 to 1.0472 rad: send an angle within the limits");
    terminal.keys(&["2", "t", "Up"]);
    terminal.until(&["finger 2: tip to"]);
    terminal.keys(&["f", "Down"]);
    terminal.until(&["push on finger 2: 0.00 0.00 -2.00 N", "touching"]);
    terminal.keys(&["0", "+"]);
    terminal.until(&["finger 2: Kx 3.75, 3.75, 3.75"]);
    terminal.keys(&["Space"]);
    terminal.until(&["EMERGENCY STOP: all fingers", "FAULTED"]);
    terminal.keys(&["r"]);
    terminal.until(&["finger 2: holds its pose", "finger 2 running"]);
    terminal.keys(&["q"]);
    terminal.until(&["status 0"]);
}

/// A board at a pseudo-terminal is a real hand for jog.
#[test]
fn jog_asks_before_a_real_hand_moves_and_limits_its_steps() {
    if !tools::available("tmux", "jog with a real hand") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let [link, file] = ["board", "hand.toml"].map(|name| folder.path().join(name));
    let text = format!("[hand]\nrate = 500\n[finger]\nport = \"{}\"\nthread = 1\nbaud = 2_000_000\n", link.display());
    fs::write(&file, text).expect("written");
    let command = format!("{TOOL} jog --config {}", file.display());
    let terminal = Terminal::start("asks", (100, 30), &command);
    terminal.until(&["This moves a real hand", "finger 3: /", "at most 9 degrees", "Type yes"]);
    terminal.run("no");
    terminal.until(&["not confirmed, and nothing has moved", "status 1"]);
    drop(terminal);

    let _board = screen::Board::start(TOOL, &link);
    let terminal = Terminal::start("moves", (100, 30), &command);
    terminal.until(&["Type yes"]);
    terminal.run("yes");
    terminal.until(&["real fingers", "finger 3 running", "a real hand: steps are limited"]);
    terminal.keys(&["]", "]", "]", "]", "Right"]);
    terminal.until(&["[j joints 3°]", "finger 1: joints to 3.0, 30.0, 60.0 degrees"]);
    terminal.keys(&["f", "Right"]);
    terminal.until_words("finger 1 is not simulated: only a simulated finger");
    terminal.keys(&["q"]);
    terminal.until(&["status 0"]);
}

#[test]
fn status_describes_the_hand_and_its_faults() {
    let hand = open("status-test");
    let well = status(&["status-test"]);
    let described = text(&well.stdout);
    assert_eq!(well.status.code(), Some(0), "{described}{}", text(&well.stderr));
    for part in ["hand status-test", "1000 Hz", "simulated", "running", "99.9 %"] {
        assert!(described.contains(part), "{part:?} is not in\n{described}");
    }
    assert!(!described.contains('\u{1b}') && described.lines().all(|line| line.len() <= 120), "{described}");

    hand.stop(3).expect("there");
    let fault = screen::fault_of(&hand, 3);
    let faulted = status(&["status-test"]);
    let described = text(&faulted.stdout);
    assert_eq!(faulted.status.code(), Some(1), "{described}");
    let remedy: String = fault.to_string().split_whitespace().collect();
    assert!(described.split_whitespace().collect::<String>().contains(&remedy), "{described}");

    let json = status(&["status-test", "--json"]);
    assert_eq!(json.status.code(), Some(1));
    let hands: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON");
    assert_eq!(hands["hands"][0]["fingers"][2]["fault"]["number"], fault.kind.number());
    assert_eq!(hands["hands"][0]["fingers"][0]["stage"], "running");

    let missing = status(&["status-none"]);
    assert_eq!((missing.status.code(), missing.stdout.len()), (Some(1), 0));
    assert!(text(&missing.stderr).contains("no hand of this user has the name \"status-none\""));

    // Without a name, the tool describes every open hand of this user. Other tests may have open hands too.
    let _second = open("status-second");
    let all = text(&status(&[]).stdout);
    assert!(all.contains("hand status-test") && all.contains("hand status-second"), "{all}");
}

#[test]
fn without_a_terminal_the_monitor_names_status() {
    let output = Command::new(TOOL).arg("monitor").output().expect("the tool runs");
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("use `sun2xp status`"), "{}", text(&output.stderr));
}
