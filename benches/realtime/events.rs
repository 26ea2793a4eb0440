//! Measures whether events delay the servos: the wake-up latency of three servos without events, with 10 000 events a
//! second that nobody waits for, and with a planner's thread that waits for them.

use crate::Failure;
use crate::attempts::Attempts;
use crate::fingers::{Finger, reach};
use crate::percentiles::{Percentiles, median, ratio};
use crate::turns::Turns;
use crate::under_control::under_control;
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;
use sun2xp::finger::events::{EventKind, EventWriter, Occurrence, event_log};
use sun2xp::finger::{Mailbox, Servo};
use sun2xp::hand::EventQueue;
use sun2xp::model::configuration::{Configuration, FINGERS};
use sun2xp::model::{FingerNumber, Part};
use sun2xp::realtime::{Clock, EventCount, MonotonicClock, Pages, Priority, SharedPages, spawn};

/// What happens during a measurement.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Quiet,
    Written,
    Awaited,
}

const KINDS: [(Kind, &str); 3] = [
    (Kind::Quiet, "no events"),
    (Kind::Written, "10 000 events a second"),
    (Kind::Awaited, "10 000 events a second, and a thread that waits for them"),
];

/// Period of the servos, ns.
const PERIOD: u64 = 1_000_000;

/// Priorities as in a hand.
const PRIORITY: u8 = 80;
const BOARD_PRIORITY: u8 = 20;

/// Time until the fingers are under control. The measurement begins after this time.
const START: Duration = Duration::from_millis(500);

/// A clock that records how late each period begins, ns.
#[derive(Clone, Default)]
struct RecordingClock(Rc<RefCell<Vec<u64>>>);

impl Clock for RecordingClock {
    fn now(&self) -> u64 {
        MonotonicClock.now()
    }

    fn sleep_until(&self, deadline: u64) {
        MonotonicClock.sleep_until(deadline);
        let late = MonotonicClock.now().saturating_sub(deadline);
        let mut late_times = self.0.borrow_mut();
        // A servo must not allocate, so times beyond the reserved capacity are not recorded.
        if late_times.len() < late_times.capacity() {
            late_times.push(late);
        }
    }
}

/// Wake-up latencies of the fingers, and the number of events that the waiting thread got and lost.
type Turn = (Vec<Percentiles>, u64, u64);

pub fn run(turns: &Turns) -> Result<(), Failure> {
    let mut rows = [const { Vec::new() }; 3];
    let (mut taken, mut lost, mut attempts) = (0, 0, Attempts::default());
    for _ in 0..turns.repeats {
        for ((kind, name), row) in KINDS.into_iter().zip(&mut rows) {
            let measured = attempts.measure(name, || turn(kind, turns.seconds));
            let Some((wake_ups, taken_now, lost_now)) = measured else { continue };
            row.extend(wake_ups);
            (taken, lost) = (taken + taken_now, lost + lost_now);
        }
    }
    print_table(&rows);
    let made = rows.map(|row| row.len() / FINGERS);
    let [quiet, written, awaited] = made;
    println!(
        "\nMedians over three fingers and all measurements of {} s: {quiet} measurements for the first row, {written} \
         for the second and {awaited} for the third. {attempts}. The waiting thread got {:.0} events a second, and \
         lost {lost}.\n",
        turns.seconds,
        taken as f64 / (awaited as u64 * turns.seconds).max(1) as f64
    );
    Ok(attempts.check(KINDS.map(|(_, name)| name).into_iter().zip(made))?)
}

fn print_table(rows: &[Vec<Percentiles>; KINDS.len()]) {
    println!("| | median | 99 % | 99.9 % | 99.9 % relative to no events (goal: at most 1.1) |\n|---|---|---|---|---|");
    let of = |row: &[Percentiles], part: fn(&Percentiles) -> f64| median(row.iter().map(part));
    let quiet = of(&rows[0], |wake| wake.p999);
    for ((_, name), row) in KINDS.iter().zip(rows) {
        if row.is_empty() {
            println!("| {name} | not measured, because every measurement failed or was skipped | | | |");
            continue;
        }
        let (middle, p99, p999) = (of(row, |wake| wake.median), of(row, |wake| wake.p99), of(row, |wake| wake.p999));
        println!("| {name} | {middle:.1} us | {p99:.1} us | {p999:.1} us | {} |", ratio(p999, quiet));
    }
}

/// Measures three servos on simulated boards for some seconds.
fn turn(kind: Kind, seconds: u64) -> Result<Turn, Failure> {
    let fingers = reach(&Configuration::default(), PERIOD, BOARD_PRIORITY)?;
    let readers = SharedPages::from(Pages::new(EventCount::default()));
    let (writers, logs): (Vec<EventWriter>, Vec<_>) = FingerNumber::ALL.map(event_log).into_iter().unzip();
    let queue = EventQueue::of_logs(logs, readers.clone(), PERIOD);
    let (ended, taken) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicU64::new(0)));
    let waiting = (kind == Kind::Awaited).then(|| {
        let (ended, taken) = (ended.clone(), taken.clone());
        thread::spawn(move || {
            while !ended.load(Relaxed) {
                taken.fetch_add(u64::from(queue.wait(Some(Duration::from_millis(50))).is_some()), Relaxed);
            }
            queue.lost()
        })
    });
    let (mut servos, mut boards, mut mailboxes) = (Vec::new(), Vec::new(), Vec::<Mailbox>::new());
    let late = Arc::new(Mutex::new(Vec::new()));
    for (finger, writer) in fingers.into_iter().zip(writers) {
        let Finger { mailbox, port, schedule, board, uncollected, .. } = finger;
        boards.push(board);
        mailboxes.push(mailbox);
        let (readers, ended, late) = (readers.clone(), ended.clone(), late.clone());
        let place = servos.len() as u64;
        servos.push(spawn("servo", Priority { fifo: PRIORITY, core: None }, move |_| {
            let clock = RecordingClock::default();
            clock.0.borrow_mut().reserve(((seconds + 2) * 1000) as usize);
            let mut servo = Servo::new(clock.clone(), schedule, vec![port]);
            let mut events = Events { writer, readers, cycle: 0, more: place == 0 };
            while !ended.load(Relaxed) {
                servo.cycle();
                if kind != Kind::Quiet {
                    events.write();
                }
            }
            let measured = clock.0.borrow().iter().skip(START.as_millis() as usize).copied().collect();
            late.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(Percentiles::of(measured));
            drop(uncollected);
        })?);
    }
    thread::sleep(START);
    let before = taken.load(Relaxed);
    thread::sleep(Duration::from_secs(seconds));
    let taken = taken.load(Relaxed) - before;
    let stages: Vec<_> = mailboxes.iter().map(|mailbox| mailbox.report().stage).collect();
    ended.store(true, Relaxed);
    servos
        .into_iter()
        .try_for_each(|servo| servo.join().map_err(|_| "a servo panicked: standard error has its message"))?;
    let lost = waiting.map_or(Ok(0), |thread| {
        thread.join().map_err(|_| "the waiting thread panicked: standard error has its message")
    })?;
    drop((boards, mailboxes));
    let measured = std::mem::take(&mut *late.lock().map_err(|_| "a servo panicked: standard error has its message")?);
    if measured.len() != FINGERS {
        return Err("a servo has measured nothing".into());
    }
    // The servo of a finger that has stopped does less work, so a measurement with such a finger fails.
    (1..).zip(&stages).try_for_each(|(finger, stage)| under_control(finger, stage))?;
    Ok((measured, taken, lost))
}

/// Writes events in a servo thread after each cycle, as the servo itself does. Two of the three threads write three
/// events per cycle and one thread writes four, so that all threads together write 10 000 events a second.
struct Events {
    writer: EventWriter,
    readers: SharedPages<EventCount>,
    cycle: u64,
    more: bool,
}

impl Events {
    fn write(&mut self) {
        self.cycle += 1;
        let now = MonotonicClock.now();
        self.writer.begin_cycle(self.cycle, now);
        for number in 0..3 + u8::from(self.more) {
            let values = [f64::from(number), 0.0, 0.0, 0.0];
            self.writer.write(Occurrence { kind: EventKind::Contact, part: Part::Finger, values });
        }
        self.writer.publish(now + PERIOD);
        self.readers.notify();
    }
}
