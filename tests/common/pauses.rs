//! Measures how long the machine kept threads from running, from the kernel's accounting.
//!
//! A real-time test can fail because the machine paused it. Such a failure is excused only if the pause was measured.
//! The kernel counts for every thread how long it was ready to run but had no core (`/proc/PID/task/TID/schedstat`). A
//! thread that sleeps, waits for bytes or was stopped by a signal is not ready, so a defect that has this effect does
//! not count as a pause. The watch also measures how long the kernel takes to carry a byte through a pseudo-terminal.

#[path = "carried_byte.rs"]
mod carried_byte;
#[path = "waits.rs"]
mod waits;

pub use carried_byte::CarriedByte;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::os::unix::fs::FileExt;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
pub use waits::{Part, Waits};

/// Period of reading the accounts.
const INTERVAL: Duration = Duration::from_millis(5);

/// New threads are searched for after this many readings.
const READINGS_PER_SEARCH: u32 = 10;

/// Watches the threads of a hand and its boards.
pub struct PauseWatch {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

/// State that the watch shares with its users.
#[derive(Default)]
struct Shared {
    /// Other watched processes.
    processes: Mutex<Vec<(u32, Part)>>,
    waits: Mutex<Waits>,
    threads: Mutex<Threads>,
    ended: AtomicBool,
}

impl Shared {
    fn processes(&self) -> MutexGuard<'_, Vec<(u32, Part)>> {
        self.processes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn waits(&self) -> MutexGuard<'_, Waits> {
        self.waits.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn threads(&self) -> MutexGuard<'_, Threads> {
        self.threads.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl PauseWatch {
    /// Watches the servo and board threads of this process and the kernel's workers.
    pub fn start() -> Self {
        let shared = Arc::new(Shared::default());
        let watching = shared.clone();
        Self { shared, thread: Some(std::thread::spawn(move || watch(&watching))) }
    }

    /// Watches another process too: the servo and board threads of a planner, or all threads of any other process.
    pub fn also(&self, process: u32, part: Part) {
        self.shared.processes().push((process, part));
    }

    /// Measures this pseudo-terminal instead of the watch's own one.
    pub fn carry(&self, byte: CarriedByte) {
        self.shared.threads().carried = Some(byte);
    }

    /// Discards the measurements, and closes the descriptors of the watch except the account of its own thread. The
    /// watch rests until the guard is dropped. Tests that count the resources of the process need this.
    pub fn rest(&self) -> Rest<'_> {
        let mut threads = self.shared.threads();
        *threads = Threads::default();
        *self.shared.waits() = Waits::default();
        Rest { _threads: threads }
    }

    /// Ends the watch and returns the measurements.
    pub fn end(mut self) -> Waits {
        self.shared.ended.store(true, Relaxed);
        self.thread.take().expect("it ends once").join().expect("the watch does not panic");
        std::mem::take(&mut self.shared.waits())
    }
}

impl Drop for PauseWatch {
    fn drop(&mut self) {
        // A failing test must end its watch too.
        self.shared.ended.store(true, Relaxed);
    }
}

/// The watch rests while this guard exists: it cannot read the accounts.
pub struct Rest<'a> {
    _threads: MutexGuard<'a, Threads>,
}

/// Makes every later failure in this process report for how long the machine kept threads from running. The report is
/// about the worst `SPAN` of the last 30 s.
pub fn name_pauses() -> &'static PauseWatch {
    static WATCH: OnceLock<PauseWatch> = OnceLock::new();
    WATCH.get_or_init(|| {
        let watch = PauseWatch::start();
        let (shared, report) = (watch.shared.clone(), std::panic::take_hook());
        std::panic::set_hook(Box::new(move |panic| {
            report(panic);
            eprintln!("{}", shared.waits().last(BEFORE_A_FAILURE).description(SPAN));
        }));
        watch
    })
}

/// A failure report covers the pauses within this time before the failure.
const BEFORE_A_FAILURE: Duration = Duration::from_secs(30);

/// Length of the time spans in which a failure report adds up the pauses. It reports the span with the largest total. A
/// span is a little shorter than the default `hand.watchdog_ms`, 18 ms, after which a board stops its finger.
const SPAN: Duration = Duration::from_millis(15);

/// The account of a thread.
struct Account {
    part: Part,
    file: File,
    /// The last reading, ns.
    waited: u64,
}

impl Account {
    fn open(part: Part, folder: &str) -> Option<Self> {
        let mut account = Self { part, file: File::open(format!("{folder}/schedstat")).ok()?, waited: 0 };
        account.news()?;
        Some(account)
    }

    /// Returns how long the thread has waited for a core since the last reading, or `None` if it has ended.
    fn news(&mut self) -> Option<Duration> {
        let mut text = [0; 80];
        let length = self.file.read_at(&mut text, 0).ok()?;
        // The fields are the time on a core, the time waiting for one, and the number of time slices.
        let waited = std::str::from_utf8(&text[..length]).ok()?.split_whitespace().nth(1)?.parse().ok()?;
        Some(Duration::from_nanos(waited - std::mem::replace(&mut self.waited, waited)))
    }
}

fn watch(shared: &Shared) {
    let begun = Instant::now();
    let mut own = Account::open(Part::Carrier, "/proc/thread-self");
    let mut readings = 0;
    while !shared.ended.load(Relaxed) {
        if readings % READINGS_PER_SEARCH == 0 {
            shared.threads().look(&shared.processes());
        }
        readings += 1;
        let before = Instant::now();
        let underway = shared.threads().carried.as_mut().map_or(Duration::ZERO, |byte| byte.delay(INTERVAL));
        std::thread::sleep(INTERVAL.saturating_sub(before.elapsed()));
        let late = before.elapsed().saturating_sub(INTERVAL);
        let waited = own.as_mut().and_then(Account::news).unwrap_or_default();
        let mut threads = shared.threads();
        let mut waits = shared.waits();
        waits.lasted = begun.elapsed();
        waits.note(0, Part::Carrier, waited);
        // A thread that has a core but does not run was paused together with the whole machine.
        waits.note(0, Part::Machine, late.saturating_sub(waited));
        // The watch itself can be late to notice that the byte has arrived.
        waits.note(CARRIED_BYTE, Part::Carrier, underway.saturating_sub(late.max(waited)));
        threads.accounts.retain(|&thread, account| {
            let news = account.news();
            waits.note(thread, account.part, news.unwrap_or_default());
            news.is_some()
        });
    }
}

/// Stands for the worker that carries the watch's byte, in place of the number of a thread.
const CARRIED_BYTE: u32 = u32::MAX;

/// The watched threads by number.
#[derive(Default)]
struct Threads {
    accounts: BTreeMap<u32, Account>,
    carried: Option<CarriedByte>,
    /// Processes other than the kernel's unbound workers. They cannot carry the bytes of pseudo-terminals, and are not
    /// examined again.
    others: BTreeSet<u32>,
}

impl Threads {
    fn look(&mut self, processes: &[(u32, Part)]) {
        self.carried = self.carried.take().or_else(CarriedByte::open);
        let of_library = |name: &str| match name {
            "sun2xp board" => Some(Part::Board),
            _ if name.starts_with("sun2xp servo") => Some(Part::Servo),
            _ => None,
        };
        for thread in numbers("/proc/self/task") {
            self.add(thread, &format!("/proc/self/task/{thread}"), of_library);
        }
        for &(process, part) in processes {
            for thread in numbers(&format!("/proc/{process}/task")) {
                let folder = format!("/proc/{process}/task/{thread}");
                match part {
                    Part::Servo => self.add(thread, &folder, of_library),
                    _ => self.add(thread, &folder, |_| Some(part)),
                };
            }
        }
        // Only workers that are bound to no core may carry the bytes of terminals: "kworker/u8:3-events_unbound".
        let carrier = |name: &str| name.starts_with("kworker/u").then_some(Part::Carrier);
        for process in numbers("/proc") {
            if !self.others.contains(&process) && !self.add(process, &format!("/proc/{process}"), carrier) {
                self.others.insert(process);
            }
        }
    }

    /// Adds a thread if its name shows its role. Returns whether the thread is watched now.
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
