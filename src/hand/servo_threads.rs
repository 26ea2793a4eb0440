//! Starts the servo threads, as real-time as they can and have to be.

use crate::board::Port;
use crate::finger::{ServedPort, Servo};
use crate::hand::HandError;
use crate::hand::missing_permissions::{MissingPermission, missing_permissions};
use crate::hand::notice::print_notice;
use crate::hand::opening::Line;
use crate::model::configuration::{Configuration, FINGERS, PeriodClock, RealTime};
use crate::realtime::{LockedStack, MonotonicClock, Priority, RealtimeRefusals, Schedule, now, spawn, touch_stack};
use crossbeam_channel::{Receiver, Sender, bounded};
use std::collections::BTreeMap;
use std::thread::JoinHandle;

/// The servo of one thread.
pub(super) type PortServo = Servo<Port, MonotonicClock>;

/// The first cycle begins so long after every thread is ready, ns.
const HEAD_START: u64 = 2_000_000;

/// What the servo threads were given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Given {
    /// All run under SCHED_FIFO.
    pub scheduling: bool,
    /// The system has refused that to one of them.
    pub refused: bool,
    /// All have their memory locked.
    pub memory: bool,
    /// All run on the cores that are configured.
    pub core: bool,
}

/// Starts a servo thread for all lines of one number, each. They are put into `servos`, to be joined, also where this
/// fails: then none has begun its first cycle.
///
/// # Errors
/// The system refuses a thread; or real time is enforced, and is not permitted.
pub(super) fn start(
    configuration: &Configuration,
    lines: Vec<Line>,
    servos: &mut Vec<JoinHandle<PortServo>>,
) -> Result<Given, HandError> {
    let real_time = configuration.hand.real_time;
    let shares = by_thread(lines);
    let numbers: Vec<u8> = shares.keys().copied().collect();
    let (report, hear) = bounded(numbers.len());
    let (begin, begun) = bounded(numbers.len());
    for (place, (thread, ports)) in shares.into_iter().enumerate() {
        let servo = port_servo(configuration, ports, place, numbers.len());
        let (report, begun) = (report.clone(), begun.clone());
        let name = format!("sun2xp servo {thread}");
        let handle = spawn(&name, priority(configuration, thread), move |refusals| {
            run(servo, refusals, real_time, &report, &begun)
        });
        servos.push(handle.map_err(|source| HandError::System { doing: "start a servo thread", source })?);
    }
    // Our own sender would keep the channel open where a thread died before it could report.
    drop(report);
    let missing = missing_permissions(hear.iter().take(numbers.len()).collect());
    let given = Given::of(configuration, &numbers, &missing);
    accept(missing, real_time)?;
    let first = now() + HEAD_START;
    for _ in &numbers {
        // The channel has room for the message to a thread that died.
        let _ = begin.send(first);
    }
    Ok(given)
}

/// The numbers of the threads, rising, with the ports that each one serves.
fn by_thread(lines: Vec<Line>) -> BTreeMap<u8, Vec<ServedPort<Port>>> {
    let mut ports: BTreeMap<u8, Vec<ServedPort<Port>>> = BTreeMap::new();
    for line in lines {
        ports.entry(line.thread).or_default().push(line.port);
    }
    ports
}

/// The servo of the thread at `place` among `threads`.
fn port_servo(configuration: &Configuration, ports: Vec<ServedPort<Port>>, place: usize, threads: usize) -> PortServo {
    let period = configuration.hand.period();
    let servo = Servo::new(MonotonicClock, Schedule::staggered(0, period, place, threads), ports);
    match configuration.hand.clock {
        PeriodClock::Board => servo.following_board(),
        PeriodClock::Host => servo,
    }
}

/// The life of a servo thread: it prepares its memory, reports what the system refused, waits for its first cycle and
/// runs.
fn run(
    mut servo: PortServo,
    mut refusals: RealtimeRefusals,
    real_time: RealTime,
    report: &Sender<RealtimeRefusals>,
    begun: &Receiver<u64>,
) -> PortServo {
    touch_stack();
    let mut locked = None;
    if real_time != RealTime::Ignore {
        let stack = LockedStack::lock().map(|stack| locked = Some(stack));
        refusals.memory = stack.and_then(|()| servo.memory().lock()).err();
    }
    // The caller of `start` waits for this report. If it has given up, it does not say when to begin either.
    let _ = report.send(refusals);
    if let Ok(first) = begun.recv() {
        servo = servo.later(first);
        servo.run();
    }
    drop(locked);
    servo
}

impl Given {
    fn of(configuration: &Configuration, threads: &[u8], missing: &[MissingPermission]) -> Self {
        let tried = configuration.hand.real_time != RealTime::Ignore;
        let lacks = |kind: fn(&MissingPermission) -> bool| missing.iter().any(kind);
        let refused = tried && lacks(|missing| matches!(missing, MissingPermission::Scheduling(_)));
        Self {
            scheduling: tried && !refused && threads.iter().all(|&thread| priority(configuration, thread).fifo > 0),
            refused,
            memory: tried && !lacks(|missing| matches!(missing, MissingPermission::Memory(_))),
            core: !lacks(|missing| matches!(missing, MissingPermission::Core(_)))
                && (tried || configuration.fingers.iter().all(|finger| finger.core.is_none())),
        }
    }
}

/// Refuses what is missing where real time is enforced, and warns of it otherwise.
fn accept(missing: Vec<MissingPermission>, real_time: RealTime) -> Result<(), HandError> {
    for missing in missing {
        match real_time {
            RealTime::Enforce => return Err(HandError::NotRealTime { missing }),
            RealTime::Try | RealTime::Ignore => {
                print_notice(&format!("{missing}. The hand runs without it, and cycles may be late"))
            }
        }
    }
    Ok(())
}

/// The priority and core of a servo thread, 1 to 3.
pub fn priority(configuration: &Configuration, thread: u8) -> Priority {
    if configuration.hand.real_time == RealTime::Ignore {
        return Priority::default();
    }
    let own = (0..FINGERS).find(|&index| configuration.thread(index) == thread);
    // Fingers that share a thread have the same priority and core: the configuration was checked.
    let finger = own.map(|index| &configuration.fingers[index]);
    finger.map_or_else(Priority::default, |finger| Priority { fifo: finger.priority, core: finger.core })
}
