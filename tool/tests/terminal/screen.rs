//! A terminal of tmux, with a server of its own.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use sun2xp::{Fault, Hand};
use tempfile::TempDir;

/// Longest time until something appears on the screen.
const LIMIT: Duration = Duration::from_secs(40);

/// Interval at which the screen is read.
const INTERVAL: Duration = Duration::from_millis(100);

/// A terminal with a shell that runs a command. When the command has ended, the shell prints its status and continues.
pub struct Terminal {
    folder: TempDir,
}

impl Terminal {
    pub fn start(name: &str, (width, height): (u16, u16), command: &str) -> Self {
        let terminal = Self { folder: tempfile::Builder::new().prefix(name).tempdir().expect("a folder") };
        let script = terminal.folder.path().join("script");
        let text = format!("export PIDFILE={}\n{command}\necho status $?\nexec sh\n", terminal.file("pid").display());
        std::fs::write(&script, text).expect("written");
        let (width, height) = (width.to_string(), height.to_string());
        let shell = format!("sh {}", script.display());
        terminal.tmux(&["-f", "/dev/null", "new-session", "-d", "-x", &width, "-y", &height, &shell]);
        terminal
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn tmux(&self, arguments: &[&str]) -> String {
        let mut tmux = Command::new("tmux");
        tmux.arg("-S").arg(self.file("socket")).args(["-u"]).args(arguments);
        tmux.env_remove("TMUX").env_remove("NO_COLOR").env("LC_ALL", "C.UTF-8").env("PS1", "$ ");
        let output = tmux.output().expect("tmux runs");
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    pub fn keys(&self, keys: &[&str]) {
        for key in keys {
            self.tmux(&["send-keys", key]);
        }
    }

    /// Types a line.
    pub fn run(&self, line: &str) {
        self.tmux(&["send-keys", "-l", line]);
        self.keys(&["Enter"]);
    }

    pub fn resize(&self, (width, height): (u16, u16)) {
        self.tmux(&["resize-window", "-x", &width.to_string(), "-y", &height.to_string()]);
    }

    /// Returns the process number that the command has written into `$PIDFILE`.
    pub fn process(&self) -> libc::pid_t {
        let number = std::fs::read_to_string(self.file("pid")).expect("written");
        number.trim().parse().expect("a process number")
    }

    fn wait(&self, what: &str, shows: impl Fn(&str) -> bool) {
        let begun = Instant::now();
        loop {
            let screen = self.tmux(&["capture-pane", "-p"]);
            if shows(&screen) {
                return;
            }
            assert!(begun.elapsed() < LIMIT, "{what} does not appear on the screen:\n{screen}");
            sleep(INTERVAL);
        }
    }

    /// Waits until all parts are on the screen at the same time.
    pub fn until(&self, parts: &[&str]) {
        self.wait(&format!("{parts:?}"), |screen| parts.iter().all(|part| screen.contains(part)));
    }

    /// Waits until a text is on the screen, on any number of lines.
    pub fn until_words(&self, text: &str) {
        let squeeze = |text: &str| text.split_whitespace().collect::<String>();
        self.wait(text, |screen| squeeze(screen).contains(&squeeze(text)));
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        let mut tmux = Command::new("tmux");
        // The server may have ended with its last window.
        let _ = tmux.arg("-S").arg(self.file("socket")).arg("kill-server").output();
    }
}

/// A board with three fingers at a pseudo-terminal.
pub struct Board(Child);

impl Board {
    pub fn start(tool: &str, link: &Path) -> Self {
        let mut board = Command::new(tool);
        board.args(["board", "--patient", "500", "--priority", "20", "--link"]).arg(link);
        let mut board = board.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().expect("the board runs");
        let mut port = String::new();
        BufReader::new(board.stdout.take().expect("a pipe")).read_line(&mut port).expect("its port");
        Self(board)
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Waits until a finger is faulted, and returns the fault.
pub fn fault_of(hand: &Hand, finger: i32) -> Fault {
    let begun = Instant::now();
    loop {
        if let Some(fault) = hand.fault(finger).expect("there").stopped {
            return fault;
        }
        assert!(begun.elapsed() < LIMIT, "finger {finger} does not stop");
        sleep(INTERVAL);
    }
}
