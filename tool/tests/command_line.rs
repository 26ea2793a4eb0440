//! The tool as a person meets it: help, completions, exit statuses, and the width and the colours of a terminal.

#[path = "common/terminal.rs"]
mod terminal;

use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use terminal::{bare, on_terminal};

const TOOL: &str = env!("CARGO_BIN_EXE_sun2xp");

fn run(arguments: &[&str]) -> Output {
    Command::new(TOOL).args(arguments).output().expect("the tool runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

/// The names of all commands, from the help.
fn commands() -> Vec<String> {
    let help = text(&run(&["--help"]).stdout);
    let list = help.split_once("Commands:\n").expect("commands").1;
    let names = list.lines().map_while(|line| line.strip_prefix("  "));
    let names = names.filter(|line| !line.starts_with(' ')).filter_map(|line| line.split_whitespace().next());
    names.filter(|&name| name != "help").map(String::from).collect()
}

#[test]
fn the_help_of_every_command_names_its_exit_statuses_and_fits_the_terminal() {
    let commands = commands();
    assert!(commands.iter().any(|name| name == "doctor") && commands.len() >= 7, "{commands:?}");
    for name in commands.iter().map(|name| vec![name.as_str(), "--help"]).chain([vec!["--help"], vec!["-h"]]) {
        let (help, status) = on_terminal(Command::new(TOOL).args(&name), 72, true);
        let help = bare(&help);
        assert_eq!(status, Some(0), "{name:?}");
        let unwrapped = help.replace('\n', " ");
        assert!(unwrapped.contains("Exit status: 0"), "{name:?}: {help}");
        let longest = help.lines().max_by_key(|line| line.chars().count()).unwrap_or_default();
        assert!(longest.chars().count() <= 72, "{name:?}: {longest}");
    }
}

#[test]
fn wrong_usage_has_the_exit_status_2() {
    let wrong: [&[&str]; 8] = [
        &[],
        &["doctr"],
        &["doctor", "--second", "1"],
        &["doctor", "--seconds", "99"],
        &["bound", "--write"],
        &["record", "--seconds", "1e30"],
        &["board", "--order", "shove 1"],
        &["board", "--order", "cut 1 9"],
    ];
    for arguments in wrong {
        let output = run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {output:?}");
        assert!(output.stdout.is_empty() || arguments.contains(&"--order"), "{output:?}");
        assert!(!output.stderr.is_empty(), "{arguments:?}");
    }
    // The usage is right, but the work cannot be done.
    assert_eq!(run(&["replay", "/dev/null"]).status.code(), Some(1));
}

#[test]
fn every_shell_receives_a_script_that_names_all_commands() {
    for shell in ["bash", "zsh", "fish"] {
        let output = run(&["completions", shell]);
        assert!(output.status.success(), "{output:?}");
        let script = text(&output.stdout);
        for name in commands() {
            assert!(script.contains(&name), "{shell} does not know {name}");
        }
        assert!(script.contains("passivity") && script.contains("sun2xp"), "{shell}");
    }
    assert_eq!(run(&["completions", "tcsh"]).status.code(), Some(2));
    assert!(text(&run(&["--version"]).stdout).starts_with("sun2xp "));
}

/// bash itself completes with the script.
#[test]
fn bash_completes_commands_and_options() {
    let folder = tempfile::tempdir().expect("a folder");
    let script = folder.path().join("sun2xp.bash");
    std::fs::write(&script, run(&["completions", "bash"]).stdout).expect("written");
    let complete = |words: &str, index: usize| {
        let asked = format!(
            "source {}; COMP_WORDS=({words}); COMP_CWORD={index}; _sun2xp sun2xp \"${{COMP_WORDS[{index}]}}\" x; echo \
             \"${{COMPREPLY[@]}}\"",
            script.display()
        );
        let output = Command::new("bash").args(["--norc", "-c", &asked]).output().expect("bash runs");
        assert!(output.status.success(), "{output:?}");
        text(&output.stdout).trim().to_owned()
    };
    assert_eq!(complete("sun2xp doc", 1), "doctor");
    assert_eq!(complete("sun2xp bound --pas", 2), "--passivity");
}

#[test]
fn a_terminal_has_colours_and_its_width_is_kept_and_a_pipe_has_neither() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("hand.toml");
    std::fs::write(&file, "[hand]\nrate = 500\n").expect("written");
    let doctor = || {
        let mut command = Command::new(TOOL);
        command.args(["doctor", "--seconds", "0.2", "--config"]).arg(&file);
        command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE");
        command
    };
    let (shown, _) = on_terminal(&mut doctor(), 80, false);
    assert!(shown.contains("\u{1b}[38;5;2mgood\u{1b}"), "{shown:?}");
    let bare = bare(&shown);
    assert!(bare.lines().all(|line| line.chars().count() <= 80), "{bare}");
    // The first finding is about the kernel. If it has advice, the advice wraps in a column of its own.
    let column = bare.lines().next().and_then(|line| line.find("Linux")).expect("the kernel");
    let advice: Vec<&str> = bare.lines().skip(1).take_while(|line| line.starts_with(' ')).collect();
    assert!(advice.iter().all(|line| line.len() > column && line[..column].trim().is_empty()), "{bare}");

    let (plain, _) = on_terminal(doctor().env("NO_COLOR", "1"), 80, false);
    assert!(!plain.contains("\u{1b}[38") && plain.contains("good"), "{plain:?}");
    let piped = text(&doctor().output().expect("the tool runs").stdout);
    assert!(!piped.contains('\u{1b}') && piped.lines().any(|line| line.starts_with("good  ")), "{piped}");
}

#[test]
fn a_terminal_shows_a_bar_that_disappears() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("hand.toml"), "").expect("written");
    let mut command = Command::new(TOOL);
    command.args(["schedule", "--measure", "1", "--config", "hand.toml"]).current_dir(folder.path());
    let (shown, _) = on_terminal(&mut command, 120, true);
    let (bar, result) = shown.split_once("Worst cases").expect("the result");
    assert!(bar.contains("measuring the simulated hand") && bar.contains('━') && bar.contains(" % "), "{bar:?}");
    // The last picture is erased before the result appears.
    assert!(bar.trim_end().ends_with("\u{1b}[2K") || bar.trim_end().ends_with("\u{1b}[1A"), "{bar:?}");
    assert!(result.contains("───") && !result.contains("| thread"), "{result}");
}

/// A person may start the program with nohup and then close the terminal. The program must continue.
#[test]
fn an_ignored_signal_stays_ignored() {
    let script = "trap '' HUP; exec \"$0\" monitor no-such-hand --web";
    let mut program =
        Command::new("sh").args(["-c", script, TOOL]).stdout(Stdio::piped()).spawn().expect("the shell runs");
    let status = format!("/proc/{}/status", program.id());
    let mask = |name: &str| {
        let text = std::fs::read_to_string(&status).expect("a running program");
        let mask = text.lines().find_map(|line| line.strip_prefix(name)).expect("a mask").trim().to_owned();
        u64::from_str_radix(&mask, 16).expect("a mask")
    };
    let bit = |signal: i32| 1u64 << (signal - 1);
    let begun = Instant::now();
    // SIGTERM is the last signal for which the program installs a handler.
    while mask("SigCgt:") & bit(libc::SIGTERM) == 0 {
        assert!(begun.elapsed() < Duration::from_secs(60), "the program does not watch its signals");
        sleep(Duration::from_millis(5));
    }
    let (caught, ignored) = (mask("SigCgt:"), mask("SigIgn:"));
    program.kill().expect("killed");
    program.wait().expect("ended");
    assert_eq!((caught & bit(libc::SIGHUP), ignored & bit(libc::SIGHUP)), (0, 1), "{caught:x} {ignored:x}");
}

/// Nobody reads standard error.
#[test]
fn an_exit_status_does_not_depend_on_the_reader_of_the_message() {
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let status = Command::new(TOOL).args(["replay", "/dev/null"]).stderr(writer).status().expect("the tool runs");
    assert_eq!(status.code(), Some(1));
}

#[test]
fn a_reader_that_ends_early_is_no_failure_to_report() {
    let ended =
        Command::new("bash").args(["-c", "\"$0\" completions zsh | head -n 1", TOOL]).output().expect("bash runs");
    assert_eq!(text(&ended.stdout).lines().next(), Some("#compdef sun2xp"));
    assert!(!text(&ended.stderr).contains("Broken pipe"), "{ended:?}");
}
