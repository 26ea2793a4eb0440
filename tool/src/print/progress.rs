//! Progress of long work, on standard error: a bar on a terminal, otherwise a line every few seconds.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, Thread};
use std::time::{Duration, Instant};

/// Work that is shorter than this shows no line, except with [`Progress::with_every_name`], where each new name that
/// [`Progress::now`] receives gets a line at once.
const FIRST_LINE: Duration = Duration::from_secs(1);

/// Shortest time between two lines, unless the second one has a new name (see [`Progress::with_every_name`]).
const BETWEEN_LINES: Duration = Duration::from_secs(5);

/// Time between two redraws of the bar. During a long step, the redraws update the remaining time. [`Progress::during`]
/// also counts the time at this interval.
const BETWEEN_REDRAWS: Duration = Duration::from_millis(100);

/// The progress of one piece of work. It disappears from a terminal when it is dropped. All methods may be called from
/// any thread.
pub struct Progress {
    what: String,
    bar: Option<ProgressBar>,
    lines: Mutex<Lines>,
}

/// How far the work has come, and what determines when the next line is printed.
struct Lines {
    began: Instant,
    printed: Option<Instant>,
    done: u64,
    total: u64,
    /// Names what is done now.
    name: String,
    /// Whether every new name gets a line at once.
    named: bool,
    /// Whether `name` is new and must get a line at once.
    renamed: bool,
}

impl Progress {
    /// Begins work that has this number of steps. `what` names the work, for example "finger 1, bounds".
    pub fn new(what: impl Into<String>, total: u64) -> Self {
        let what = what.into();
        let bar = io::stderr().is_terminal().then(|| bar(&what, total));
        Self { what, bar, lines: Mutex::new(Lines::new(total)) }
    }

    /// Where standard error is not a terminal, prints a line at once for each new name that [`Self::now`] receives.
    pub fn with_every_name(self) -> Self {
        self.change(|lines| lines.named = true);
        self
    }

    /// Names what is done now, for example the plant whose bound is searched.
    pub fn now(&self, name: impl Into<String>) {
        let name = name.into();
        self.change(|lines| {
            lines.renamed = lines.named && lines.name != name;
            lines.name = name;
        });
    }

    /// One more step is done.
    pub fn step(&self) {
        self.change(|lines| lines.done += 1);
    }

    /// This number of steps is done.
    pub fn reach(&self, done: u64) {
        self.change(|lines| lines.done = done);
    }

    /// Runs work that takes about `duration`, and shows how much of the time has passed.
    pub fn during<T>(what: impl Into<String>, duration: Duration, work: impl FnOnce() -> T) -> T {
        let progress = Self::new(what, duration.as_millis() as u64);
        let (began, ended) = (Instant::now(), AtomicBool::new(false));
        thread::scope(|scope| {
            let clock = scope.spawn(|| {
                while !ended.load(Ordering::Acquire) {
                    progress.reach(began.elapsed().min(duration).as_millis() as u64);
                    thread::park_timeout(BETWEEN_REDRAWS);
                }
            });
            // The clock also ends if the work panics.
            let _end = End { ended: &ended, clock: clock.thread().clone() };
            work()
        })
    }

    /// Runs `print`, which writes to standard output or standard error. On a terminal, the bar is hidden meanwhile.
    pub fn aside<T>(&self, print: impl FnOnce() -> T) -> T {
        match &self.bar {
            Some(bar) => bar.suspend(print),
            None => print(),
        }
    }

    fn change(&self, change: impl FnOnce(&mut Lines)) {
        // A thread that panicked has left complete values.
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        change(&mut lines);
        match &self.bar {
            Some(bar) => {
                bar.set_position(lines.done);
                bar.set_message(lines.name.clone());
            }
            None => {
                if let Some(line) = lines.due(Instant::now()) {
                    // A failed write, for example because nobody reads standard error, is no reason to stop the work.
                    let _ = writeln!(io::stderr(), "{}: {line}", self.what);
                }
            }
        }
    }
}

/// Ends a clock thread when it is dropped.
struct End<'a> {
    ended: &'a AtomicBool,
    clock: Thread,
}

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Release);
        self.clock.unpark();
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Lines {
    fn new(total: u64) -> Self {
        let name = String::new();
        Self { began: Instant::now(), printed: None, done: 0, total, name, named: false, renamed: false }
    }

    /// Returns the line to print at this instant, if one is due.
    fn due(&mut self, now: Instant) -> Option<String> {
        let due = match self.printed {
            None => self.began + FIRST_LINE,
            Some(printed) => printed + BETWEEN_LINES,
        };
        if !self.renamed && (now < due || self.done >= self.total) {
            return None;
        }
        self.renamed = false;
        self.printed = Some(now);
        let percent = 100 * self.done / self.total.max(1);
        Some(if self.name.is_empty() { format!("{percent} %") } else { format!("{percent} %, {}", self.name) })
    }
}

/// The form of the bar.
const TEMPLATE: &str = "{prefix} {bar:30.cyan/dim} {percent:>3} %  {eta:>4} left  {msg:.dim}";

fn bar(what: &str, total: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr());
    // If the template were not valid, the bar would keep its usual form. A test checks the template.
    if let Ok(style) = ProgressStyle::with_template(TEMPLATE) {
        bar.set_style(style.progress_chars("━╸─"));
    }
    bar.set_prefix(what.to_owned());
    bar.enable_steady_tick(BETWEEN_REDRAWS);
    bar
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pipe_receives_a_line_after_a_second_and_then_every_five_seconds() {
        let mut lines = Lines::new(8);
        let began = lines.began;
        let printed: Vec<(u64, String)> = (0..80)
            .filter_map(|tenth| {
                lines.done = tenth / 10;
                lines.name = if tenth < 30 { String::new() } else { "slow motors".into() };
                lines.due(began + Duration::from_millis(100 * tenth)).map(|line| (tenth, line))
            })
            .collect();
        assert_eq!(printed, [(10, "12 %".into()), (60, "75 %, slow motors".into())]);
        lines.done = 8;
        assert_eq!(lines.due(began + Duration::from_secs(100)), None, "nothing is left to do");
    }

    #[test]
    fn the_bar_contains_what_it_is_told() {
        let bar = bar("finger 1", 4);
        bar.set_draw_target(ProgressDrawTarget::hidden());
        bar.set_position(3);
        assert_eq!((bar.position(), bar.length(), bar.prefix()), (3, Some(4), "finger 1".into()));
        assert!(ProgressStyle::with_template(TEMPLATE).is_ok());
    }
}
