//! Sums up the times for which threads waited for a core, and finds the span with the longest waits.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::time::Duration;

/// The role of a thread on the path from servo to finger and back. At any time, only one thread of a role can delay a
/// byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// Servo threads of the library.
    Servo,
    /// Threads of a board: in this process, in another process, or of an emulator.
    Board,
    /// Workers of the kernel, which carry the bytes of pseudo-terminals. The thread that measures the waits counts as a
    /// worker, because a container hides the workers, and this thread waits for a core as they do.
    Carrier,
    /// The whole machine, for example a virtual machine that its host did not run.
    Machine,
}

impl Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Servo => "a servo",
            Self::Board => "a board",
            Self::Carrier => "a carrier of bytes",
            Self::Machine => "the whole machine",
        })
    }
}

/// A wait for a core, measured at one reading of the kernel's accounting.
#[derive(Clone, Copy)]
struct Wait {
    /// Time of the reading, since the start.
    at: Duration,
    thread: u32,
    part: Part,
    /// Length of the wait.
    time: Duration,
}

/// How long threads waited for a core, and when.
#[derive(Default)]
pub struct Waits {
    noted: Vec<Wait>,
    /// Duration of the measurements.
    pub lasted: Duration,
}

impl Waits {
    /// Adds a wait that was just read.
    pub fn note(&mut self, thread: u32, part: Part, time: Duration) {
        if !time.is_zero() {
            self.noted.push(Wait { at: self.lasted, thread, part, time });
        }
    }

    /// The measurements of the last `seconds`.
    pub fn last(&self, seconds: Duration) -> Self {
        let recent = |wait: &Wait| wait.at + seconds >= self.lasted;
        Self { noted: self.noted.iter().copied().filter(recent).collect(), lasted: seconds.min(self.lasted) }
    }

    /// The largest sum of waits within any `span`. For each role, the sum contains the total wait of the thread that
    /// waited longest. These waits are added, because the roles can delay a byte one after the other. A wait that began
    /// before the span counts in full.
    pub fn most_within(&self, span: Duration) -> Duration {
        self.worst(span).values().sum()
    }

    /// The part of [`Self::most_within`] that the threads with the role `part` contribute.
    pub fn of(&self, part: Part, span: Duration) -> Duration {
        self.worst(span).get(&part).copied().unwrap_or_default()
    }

    /// For each role, the total wait of the thread that waited longest, within the `span` in which the sum of these
    /// waits is largest.
    fn worst(&self, span: Duration) -> BTreeMap<Part, Duration> {
        let mut threads = BTreeMap::<(Part, u32), Duration>::new();
        let mut worst = BTreeMap::new();
        let mut first = 0;
        for (index, wait) in self.noted.iter().enumerate() {
            *threads.entry((wait.part, wait.thread)).or_default() += wait.time;
            if self.noted.get(index + 1).is_some_and(|next| next.at == wait.at) {
                continue;
            }
            while self.noted[first].at + span < wait.at {
                let gone = self.noted[first];
                *threads.entry((gone.part, gone.thread)).or_default() -= gone.time;
                first += 1;
            }
            let mut parts = BTreeMap::new();
            for ((part, _), &time) in &threads {
                let longest: &mut Duration = parts.entry(*part).or_default();
                *longest = time.max(*longest);
            }
            if parts.values().sum::<Duration>() > worst.values().sum::<Duration>() {
                worst = parts;
            }
        }
        worst
    }

    /// Describes the measurements for a person.
    pub fn description(&self, span: Duration) -> String {
        let milliseconds = |time: Duration| format!("{:.1} ms", 1e3 * time.as_secs_f64());
        let worst = self.worst(span);
        let parts: Vec<_> = worst.iter().map(|(part, time)| format!("{part} {}", milliseconds(*time))).collect();
        format!(
            "in the worst {} of the {:.1} s that were measured, threads waited for a core for {} in total ({})",
            milliseconds(span),
            self.lasted.as_secs_f64(),
            milliseconds(worst.values().sum()),
            parts.join(", ")
        )
    }
}
