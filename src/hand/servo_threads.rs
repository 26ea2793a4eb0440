//! Starts the servo threads. They run in real time if the configuration asks for it and the system permits it.

use crate::board::Connection;
use crate::finger::{ServedPort, Servo};
use crate::hand::HandError;
use crate::hand::missing_permissions::{MissingPermission, missing_permissions};
use crate::hand::notice::print_notice;
use crate::hand::opening::Line;
use crate::model::configuration::{Configuration, PeriodClock, RealTime};
use crate::realtime::{LockedStack, MonotonicClock, Priority, RealtimeRefusals, Schedule, now, spawn, touch_stack};
use crossbeam_channel::{Receiver, Sender, bounded};
use std::collections::BTreeMap;
use std::thread::JoinHandle;

/// The servo of one thread.
pub(super) type PortServo = Servo<Connection, MonotonicClock>;

/// Time from the moment when every thread is ready to the first cycle, ns.
const HEAD_START: u64 = 2_000_000;

/// Which real-time properties the servo threads have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct RealtimeState {
    /// Whether all threads run under SCHED_FIFO.
    pub scheduling: bool,
    /// Whether the system refused SCHED_FIFO to a thread.
    pub refused: bool,
    /// Whether all threads have their memory locked.
    pub memory: bool,
    /// Whether all threads run on the configured cores.
    pub core: bool,
}

/// Starts one servo thread for each thread number that occurs in `lines`. The threads are added to `servos` even after
/// a failure, so that the caller can join them. After a failure, no thread has begun its first cycle.
///
/// # Errors
/// Returns an error if the system cannot start a thread, or if real time is enforced but not permitted.
pub(super) fn start(
    configuration: &Configuration,
    lines: Vec<Line>,
    servos: &mut Vec<JoinHandle<PortServo>>,
) -> Result<RealtimeState, HandError> {
    let real_time = configuration.hand.real_time;
    let shares = by_thread(lines);
    let numbers: Vec<u8> = shares.keys().copied().collect();
    let (report, reports) = bounded(numbers.len());
    let (begin, beginning) = bounded(numbers.len());
    for (place, (thread, ports)) in shares.into_iter().enumerate() {
        let servo = port_servo(configuration, ports, place, numbers.len());
        let (report, beginning) = (report.clone(), beginning.clone());
        let name = format!("sun2xp servo {thread}");
        let handle = spawn(&name, priority(configuration, thread), move |refusals| {
            run(servo, refusals, real_time, &report, &beginning)
        });
        servos.push(handle.map_err(|source| HandError::System { doing: "start a servo thread", source })?);
    }
    // This sender would keep the channel open if a thread died before it reported.
    drop(report);
    let missing = missing_permissions(reports.iter().take(numbers.len()).collect());
    let state = RealtimeState::of(configuration, &numbers, &missing);
    accept(missing, real_time)?;
    let first = now() + HEAD_START;
    for _ in &numbers {
        // A thread that has died does not take its message, which then stays in the channel. The channel has room for
        // all messages, so `send` never waits.
        let _ = begin.send(first);
    }
    Ok(state)
}

/// The ports of each servo thread, by thread number.
fn by_thread(lines: Vec<Line>) -> BTreeMap<u8, Vec<ServedPort<Connection>>> {
    let mut ports: BTreeMap<u8, Vec<ServedPort<Connection>>> = BTreeMap::new();
    for line in lines {
        ports.entry(line.thread).or_default().push(line.port);
    }
    ports
}

/// Returns the servo of the thread at `place` among `threads` threads.
fn port_servo(
    configuration: &Configuration,
    ports: Vec<ServedPort<Connection>>,
    place: usize,
    threads: usize,
) -> PortServo {
    let period = configuration.hand.period();
    let servo = Servo::new(MonotonicClock, Schedule::staggered(0, period, place, threads), ports);
    match configuration.hand.clock {
        PeriodClock::Board => servo.following_board(),
        PeriodClock::Host => servo,
    }
}

/// The body of a servo thread: prepares its memory, reports what the system refused, waits for its first cycle and
/// runs.
fn run(
    mut servo: PortServo,
    mut refusals: RealtimeRefusals,
    real_time: RealTime,
    report: &Sender<RealtimeRefusals>,
    beginning: &Receiver<u64>,
) -> PortServo {
    touch_stack();
    let mut locked = None;
    if real_time != RealTime::Ignore {
        let stack = LockedStack::lock().map(|stack| locked = Some(stack));
        refusals.memory = stack.and_then(|()| servo.memory().lock()).err();
    }
    // `start` waits for this report, unless it has already returned an error. After an error `start` does not send the
    // time of the first cycle, so `recv` fails.
    let _ = report.send(refusals);
    if let Ok(first) = beginning.recv() {
        servo = servo.later(first);
        servo.run();
    }
    drop(locked);
    servo
}

impl RealtimeState {
    fn of(configuration: &Configuration, threads: &[u8], missing: &[MissingPermission]) -> Self {
        let tried = configuration.hand.real_time != RealTime::Ignore;
        let lacks = |kind: fn(&MissingPermission) -> bool| missing.iter().any(kind);
        let refused = tried && lacks(|missing| matches!(missing, MissingPermission::Scheduling(_)));
        Self {
            scheduling: tried && !refused && threads.iter().all(|&thread| priority(configuration, thread).fifo > 0),
            refused,
            memory: tried && !lacks(|missing| matches!(missing, MissingPermission::Memory(_))),
            core: !lacks(|missing| matches!(missing, MissingPermission::Core(_)))
                && (tried
                    || configuration.hand.fingers.members().all(|n| configuration.fingers[n.index()].core.is_none())),
        }
    }
}

/// Returns an error for a missing permission if real time is enforced, and prints a notice otherwise.
fn accept(missing: Vec<MissingPermission>, real_time: RealTime) -> Result<(), HandError> {
    for missing in missing {
        match real_time {
            RealTime::Enforce => return Err(HandError::NotRealTime { missing }),
            RealTime::Try | RealTime::Ignore => {
                print_notice(&format!("{missing}. Until then the hand may miss deadlines"))
            }
        }
    }
    Ok(())
}

/// Priority and core of servo thread 1, 2 or 3.
pub fn priority(configuration: &Configuration, thread: u8) -> Priority {
    if configuration.hand.real_time == RealTime::Ignore {
        return Priority::default();
    }
    let own = configuration.hand.fingers.members().find(|&number| configuration.thread(number) == thread);
    // Fingers on one thread have the same priority and core, because the configuration was checked.
    let finger = own.map(|number| &configuration.fingers[number.index()]);
    finger.map_or_else(Priority::default, |finger| Priority { fifo: finger.priority, core: finger.core })
}
