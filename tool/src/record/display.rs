//! The progress of a recording on standard error: on a terminal one line that is updated, and in a pipe a new line
//! every five seconds.

use super::counts::Counts;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::time::Duration;
use sun2xp::model::ShownPath;

/// Time between two lines in a pipe.
const BETWEEN_LINES: Duration = Duration::from_secs(5);

/// Time between two steps of the spinner on a terminal.
const BETWEEN_STEPS: Duration = Duration::from_millis(500);

/// Shows the progress of a recording. When the display is dropped, the progress disappears from a terminal.
pub struct Display {
    bar: Option<ProgressBar>,
    duration: Option<Duration>,
    next_line: Duration,
}

impl Display {
    /// Begins to show the progress, with the name of the first file.
    pub fn new(file: &Path, duration: Option<Duration>) -> Self {
        let bar = io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
            // The template is a constant and valid. If it were not valid, the bar would keep its usual form.
            if let Ok(style) = ProgressStyle::with_template("{spinner:.red} {prefix:.bold}  {msg}") {
                bar.set_style(style.tick_chars("●○ "));
            }
            bar.enable_steady_tick(BETWEEN_STEPS);
            bar
        });
        let display = Self { bar, duration, next_line: Duration::ZERO };
        display.begin_file(file);
        display
    }

    /// Names the next file.
    pub fn begin_file(&self, file: &Path) {
        match &self.bar {
            Some(bar) => bar.set_prefix(ShownPath(file).to_string()),
            None => self.line(&format!("recording into {}", ShownPath(file))),
        }
    }

    /// Shows what has been recorded.
    pub fn show(&mut self, elapsed: Duration, counts: &Counts, bytes: u64) {
        let of = self.duration.map(|duration| format!(" of {:.0}", duration.as_secs_f64())).unwrap_or_default();
        let megabytes = bytes as f64 * 1e-6;
        let text = format!("{:.0}{of} s, {counts}, {megabytes:.1} MB", elapsed.as_secs_f64().floor());
        match &self.bar {
            Some(bar) => bar.set_message(format!("{text}  (Ctrl-C ends)")),
            None if elapsed >= self.next_line => {
                if !self.next_line.is_zero() {
                    self.line(&text);
                }
                self.next_line += BETWEEN_LINES;
            }
            None => {}
        }
    }

    /// Prints a line above the progress.
    pub fn line(&self, text: &str) {
        // A failed write, for example because nobody reads standard error, is no reason to stop the recording.
        let print = || drop(writeln!(io::stderr(), "sun2xp record: {text}"));
        match &self.bar {
            Some(bar) => bar.suspend(print),
            None => print(),
        }
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        self.bar.iter().for_each(ProgressBar::finish_and_clear);
    }
}
