//! How long the machine kept threads from running, by the kernel's account.
//!
//! A test in real time can fail because the machine paused it. Such a failure is excused only where the pause was measured. The kernel
//! counts for every thread how long it was ready to run and had no core (`/proc/PID/task/TID/schedstat`). A thread that sleeps, waits for
//! bytes or was stopped by a signal is not ready, so a defect of that kind is no pause.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Display};
use std::fs::{self, File};
use std::os::unix::fs::FileExt;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// How often the kernel's account is read.
const INTERVAL: Duration = Duration::from_millis(5);

/// After so many readings new threads are looked for.
const READINGS_A_LOOK: u32 = 10;

/// Threads that take the same part in the way from servo to finger and back. One of them at a time can delay a byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// Servo threads of the library.
    Servo,
    /// Whatever plays a board: threads of this process, other processes, an emulator.
    Board,
    /// Workers of the kernel, which carry the bytes of pseudo-terminals. The watch itself counts as one, because they are not seen from
    /// a container, and it waits for a core as they do.
    Carrier,
    /// The whole machine: a guest that its host did not run.
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

/// A watch over the threads of a hand and its boards.
pub struct PauseWatch {
    processes: Arc<Mutex<Vec<(u32, Part)>>>,
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<Waits>>,
}

impl PauseWatch {
    /// Watches the servo and board threads of this process, and the kernel's workers.
    pub fn start() -> Self {
        let (processes, ended) = (Arc::<Mutex<Vec<_>>>::default(), Arc::<AtomicBool>::default());
        let thread = {
            let (processes, ended) = (processes.clone(), ended.clone());
            std::thread::spawn(move || watch(&processes, &ended))
        };
        Self { processes, ended, thread: Some(thread) }
    }

    /// Watches another process too: of a planner the servo threads, else all threads.
    pub fn also(&self, process: u32, part: Part) {
        self.processes.lock().unwrap_or_else(PoisonError::into_inner).push((process, part));
    }

    /// What has been measured.
    pub fn end(mut self) -> Waits {
        self.ended.store(true, Relaxed);
        self.thread.take().expect("it ends once").join().expect("the watch does not panic")
    }
}

impl Drop for PauseWatch {
    fn drop(&mut self) {
        // A test that fails ends its watch.
        self.ended.store(true, Relaxed);
    }
}

/// A thread's account.
struct Account {
    part: Part,
    file: File,
    /// What was read last, ns.
    waited: u64,
}

impl Account {
    fn open(part: Part, folder: &str) -> Option<Self> {
        let mut account = Self { part, file: File::open(format!("{folder}/schedstat")).ok()?, waited: 0 };
        account.news()?;
        Some(account)
    }

    /// For how long the thread has waited for a core since the last time. None where it has ended.
    fn news(&mut self) -> Option<Duration> {
        let mut text = [0; 80];
        let length = self.file.read_at(&mut text, 0).ok()?;
        // Time on a core, time waiting for one, number of time slices.
        let waited = std::str::from_utf8(&text[..length]).ok()?.split_whitespace().nth(1)?.parse().ok()?;
        Some(Duration::from_nanos(waited - std::mem::replace(&mut self.waited, waited)))
    }
}

fn watch(processes: &Mutex<Vec<(u32, Part)>>, ended: &AtomicBool) -> Waits {
    let begun = Instant::now();
    let mut own = Account::open(Part::Carrier, "/proc/thread-self");
    let mut threads = Threads::default();
    let mut waits = Waits::default();
    let mut readings = 0;
    while !ended.load(Relaxed) {
        if readings % READINGS_A_LOOK == 0 {
            threads.look(&processes.lock().unwrap_or_else(PoisonError::into_inner));
        }
        readings += 1;
        let before = Instant::now();
        std::thread::sleep(INTERVAL);
        let late = before.elapsed().saturating_sub(INTERVAL);
        let at = begun.elapsed();
        let waited = own.as_mut().and_then(Account::news).unwrap_or_default();
        waits.note(at, 0, Part::Carrier, waited);
        // A thread that has a core and does not run is paused with the whole machine.
        waits.note(at, 0, Part::Machine, late.saturating_sub(waited));
        threads.accounts.retain(|&thread, account| {
            let news = account.news();
            waits.note(at, thread, account.part, news.unwrap_or_default());
            news.is_some()
        });
    }
    waits.lasted = begun.elapsed();
    waits
}

/// The threads that are watched, by number.
#[derive(Default)]
struct Threads {
    accounts: BTreeMap<u32, Account>,
    /// Processes of the machine that are no carriers.
    others: BTreeSet<u32>,
}

impl Threads {
    fn look(&mut self, processes: &[(u32, Part)]) {
        let of_library = |name: &str| match name {
            "sun2xp board" => Some(Part::Board),
            _ if name.starts_with("sun2xp servo") => Some(Part::Servo),
            _ => None,
        };
        for thread in numbers("/proc/self/task") {
            self.add(thread, &format!("/proc/self/task/{thread}"), of_library);
        }
        for &(process, part) in processes {
            let of_planner = |name: &str| of_library(name).filter(|&other| other == part);
            for thread in numbers(&format!("/proc/{process}/task")) {
                let folder = format!("/proc/{process}/task/{thread}");
                match part {
                    Part::Servo => self.add(thread, &folder, of_planner),
                    _ => self.add(thread, &folder, |_| Some(part)),
                };
            }
        }
        // Workers that may carry the bytes of terminals are bound to no core: "kworker/u8:3-events_unbound".
        let carrier = |name: &str| name.starts_with("kworker/u").then_some(Part::Carrier);
        for process in numbers("/proc") {
            if !self.others.contains(&process) && !self.add(process, &format!("/proc/{process}"), carrier) {
                self.others.insert(process);
            }
        }
    }

    /// Whether the thread is watched: if its name says which part it takes.
    fn add(&mut self, thread: u32, folder: &str, part: impl Fn(&str) -> Option<Part>) -> bool {
        if self.accounts.contains_key(&thread) {
            return true;
        }
        let name = fs::read_to_string(format!("{folder}/comm")).unwrap_or_default();
        let account = part(name.trim_end()).and_then(|part| Account::open(part, folder));
        account.map(|account| self.accounts.insert(thread, account)).is_some()
    }
}

/// The entries of a folder that are numbers.
fn numbers(folder: &str) -> Vec<u32> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok()).collect()
}

/// A wait for a core, read from the account of a thread.
#[derive(Clone, Copy)]
struct Wait {
    /// When it was read, since the start.
    at: Duration,
    thread: u32,
    part: Part,
    /// How long it was.
    time: Duration,
}

/// For how long threads waited for a core, and when.
#[derive(Default)]
pub struct Waits {
    noted: Vec<Wait>,
    lasted: Duration,
}

impl Waits {
    fn note(&mut self, at: Duration, thread: u32, part: Part, time: Duration) {
        if !time.is_zero() {
            self.noted.push(Wait { at, thread, part, time });
        }
    }

    /// The longest time for which the machine kept one servo, one board and one carrier of bytes, one after the other, from running within
    /// any `span`. A wait that began before the span counts whole.
    pub fn most_within(&self, span: Duration) -> Duration {
        self.worst(span).values().sum()
    }

    /// The same of one part alone, within the worst `span` of all.
    #[allow(dead_code, reason = "only the test of the watch asks")]
    pub fn of(&self, part: Part, span: Duration) -> Duration {
        self.worst(span).get(&part).copied().unwrap_or_default()
    }

    /// For each part the longest wait of one of its threads, within the worst `span`.
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
            if parts.values().sum::<Duration>() > worst.values().sum() {
                worst = parts;
            }
        }
        worst
    }

    /// What was measured, for a person.
    pub fn told(&self, span: Duration) -> String {
        let milliseconds = |time: Duration| format!("{:.1} ms", 1e3 * time.as_secs_f64());
        let worst = self.worst(span);
        let parts: Vec<_> = worst.iter().map(|(part, time)| format!("{part} {}", milliseconds(*time))).collect();
        format!(
            "in {:.1} s the machine kept threads from running for at most {} within {} ({})",
            self.lasted.as_secs_f64(),
            milliseconds(worst.values().sum()),
            milliseconds(span),
            parts.join(", ")
        )
    }
}
