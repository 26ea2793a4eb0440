//! Starts the servo threads, as real-time as they can and have to be.

use crate::board::Port;
use crate::finger::Servo;
use crate::hand::HandError;
use crate::hand::announcement::say;
use crate::hand::missing::{Missing, missing};
use crate::hand::opening::Line;
use crate::model::configuration::{Configuration, FINGERS, PeriodClock, RealTime};
use crate::realtime::{LockedStack, MonotonicClock, Priority, Realtime, Schedule, now, spawn, touch_stack};
use crossbeam_channel::bounded;
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

/// Starts a servo thread for all lines of one number, each. They are put into `servos`, to be joined, also where this fails: then
/// none has begun its first cycle.
///
/// # Errors
/// The system refuses a thread; or real time is enforced, and cannot be had.
pub(super) fn start(
    configuration: &Configuration,
    lines: Vec<Line>,
    servos: &mut Vec<JoinHandle<PortServo>>,
) -> Result<Given, HandError> {
    let period = configuration.hand.period();
    let real_time = configuration.hand.real_time;
    let mut threads: Vec<u8> = lines.iter().map(|line| line.thread).collect();
    threads.sort_unstable();
    threads.dedup();
    let mut lines: Vec<Option<Line>> = lines.into_iter().map(Some).collect();
    let (told, hear) = bounded(threads.len());
    let (begin, begun) = bounded(threads.len());
    for (place, &thread) in threads.iter().enumerate() {
        let own = lines.iter_mut().filter(|line| line.as_ref().is_some_and(|line| line.thread == thread));
        let ports = own.filter_map(Option::take).map(|line| line.port).collect();
        let schedule = Schedule::staggered(0, period, place, threads.len());
        let mut servo = Servo::new(MonotonicClock, schedule, ports);
        if configuration.hand.clock == PeriodClock::Board {
            servo = servo.following_board();
        }
        let (told, begun) = (told.clone(), begun.clone());
        let handle = spawn(&format!("sun2xp servo {thread}"), priority(configuration, thread), move |mut had| {
            touch_stack();
            let mut locked = None;
            if real_time != RealTime::Ignore {
                let stack = LockedStack::lock().map(|stack| locked = Some(stack));
                had.memory = stack.and_then(|()| servo.memory().lock()).err();
            }
            // Whoever starts the threads waits for this; has it given up meanwhile, it will not say when to begin either.
            let _ = told.send(had);
            if let Ok(first) = begun.recv() {
                servo = servo.later(first);
                servo.run();
            }
            drop(locked);
            servo
        });
        servos.push(handle.map_err(|source| HandError::System { doing: "start a servo thread", source })?);
    }
    // Ours would keep the channel open where a thread died before it could tell.
    drop(told);
    let had: Vec<Realtime> = hear.iter().take(threads.len()).collect();
    let missing = missing(had);
    let tried = real_time != RealTime::Ignore;
    let refused = tried && missing.iter().any(|missing| matches!(missing, Missing::Scheduling(_)));
    let given = Given {
        scheduling: tried && !refused && threads.iter().all(|&thread| priority(configuration, thread).fifo > 0),
        refused,
        memory: tried && !missing.iter().any(|missing| matches!(missing, Missing::Memory(_))),
        core: !missing.iter().any(|missing| matches!(missing, Missing::Core(_)))
            && (tried || configuration.fingers.iter().all(|finger| finger.core.is_none())),
    };
    for missing in missing {
        match real_time {
            RealTime::Enforce => return Err(HandError::NotRealTime { missing }),
            RealTime::Try | RealTime::Ignore => {
                say(&format!("{missing}. The hand runs without it, and cycles may be late"))
            }
        }
    }
    let first = now() + HEAD_START;
    for _ in &threads {
        // A thread that died needs no beginning: there is room for its message.
        let _ = begin.send(first);
    }
    Ok(given)
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
