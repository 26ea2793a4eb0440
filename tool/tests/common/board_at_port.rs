//! A simulated board at a pseudo-terminal.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// The program `sun2xp board`. It is killed when this value is dropped.
pub struct Board(Child);

impl Board {
    /// Starts a board with one finger. `link` will lead to its port.
    pub fn start(finger: u8, link: &Path) -> Self {
        let mut board = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
        board.args(["board", "--finger", &finger.to_string(), "--patient", "500", "--priority", "20", "--link"]);
        let mut board = board.arg(link).stdin(Stdio::null()).stdout(Stdio::piped()).spawn().expect("the board runs");
        let mut line = String::new();
        BufReader::new(board.stdout.take().expect("a pipe")).read_line(&mut line).expect("its port");
        Self(board)
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}
