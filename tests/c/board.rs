//! A simulated board in a process of its own.

use super::Bench;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// The program `sun2xp board` behind a port of its own. Dropping it ends the program.
pub struct Board {
    process: Child,
    orders: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Board {
    /// Starts a board with finger 1 and configures the bench for it. The board and the configured watchdog tolerate a
    /// busy machine.
    pub fn start(bench: &Bench) -> Self {
        let mut command = Command::new(super::tool());
        command
            .args(["board", "--finger", "1", "--patient", "1000", "--priority", "20"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped());
        let mut process = command.spawn().expect("the board can be started");
        let orders = process.stdin.take().expect("standard input is a pipe");
        let answers = BufReader::new(process.stdout.take().expect("standard output is a pipe"));
        let mut board = Self { process, orders, answers };
        let configuration = format!(
            "[hand]\nwatchdog_ms = 500\n[finger]\nport = \"simulated\"\n[finger.1]\nport = \"{}\"\n",
            board.answer()
        );
        fs::write(bench.path().join("named.toml"), configuration).expect("a configuration file");
        board
    }

    /// The process number.
    pub fn id(&self) -> u32 {
        self.process.id()
    }

    fn answer(&mut self) -> String {
        let mut line = String::new();
        self.answers.read_line(&mut line).expect("the board answers");
        line.trim().to_string()
    }

    /// The largest true tension, N.
    pub fn tension(&mut self) -> f64 {
        writeln!(self.orders, "state 1").expect("the board reads its input");
        let state = self.answer();
        let (_, tensions) = state.split_once("tensions ").unwrap_or_else(|| panic!("{state}"));
        tensions.split(' ').take(4).map(|tension| tension.parse::<f64>().expect("a number")).fold(0.0, f64::max)
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        // The test may already have ended the process.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
