//! The servo loop must not allocate, and neither may the thread that collects its reports. An allocator counts their
//! requests.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Duration;
use sun2xp::events::Event;
use sun2xp::groups::FingerCommand;
use sun2xp::hand::{Hand, PathPose, Pose};
use sun2xp::model::configuration::Configuration;
use sun2xp::motion::Validity;

static BY_SERVOS: AtomicU64 = AtomicU64::new(0);
static BY_REPORTS: AtomicU64 = AtomicU64::new(0);
static BY_OTHERS: AtomicU64 = AtomicU64::new(0);

/// Number of events.
static EVENTS: AtomicU64 = AtomicU64::new(0);

struct Counting;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn count() {
    let mut name = [0u8; 16];
    // SAFETY: PR_GET_NAME writes at most 16 bytes.
    unsafe { libc::prctl(libc::PR_GET_NAME, name.as_mut_ptr()) };
    let counter = match &name {
        name if name.starts_with(b"sun2xp servo") => &BY_SERVOS,
        name if name.starts_with(b"sun2xp reports") => &BY_REPORTS,
        _ => &BY_OTHERS,
    };
    counter.fetch_add(1, Relaxed);
}

// SAFETY: every call is passed to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(block, layout, size) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // A release may take the allocator's lock, so it counts too.
        count();
        unsafe { System.dealloc(block, layout) }
    }
}

/// Opens a hand whose tensions cross a bound in every motion of finger 1.
fn open() -> Hand {
    let mut configuration = Configuration::default();
    configuration.fingers[0].events.tension_above = Some(7.0);
    Hand::open(configuration).expect("the simulated hand")
}

fn note(_: &Event, _: u64) {
    EVENTS.fetch_add(1, Relaxed);
}

/// Sends groups until finger 1 has run `end` cycles in total. A group waits in the servo until the period in which it
/// takes effect. Returns the number of groups that the hand has taken.
fn send_groups(hand: &Hand, end: u64) -> usize {
    let mut taken = 0;
    for step in 0u32.. {
        let angle = 0.2 + 0.1 * f64::from(step % 7);
        let commands = [1, 2, 3].map(|finger| FingerCommand::new(finger).joints([0.0, 0.5, angle]));
        // A refusal means that groups are sent faster than they take effect.
        taken += usize::from(hand.send_group(&commands).is_ok());
        if hand.report(1).expect("a report").losses.cycles >= end {
            break;
        }
        std::thread::yield_now();
    }
    taken
}

/// Sends paths until finger 1 has run `end` cycles in total. Each path replaces the one that is running. Returns the
/// number of paths that the hand has taken.
fn send_paths(hand: &Hand, end: u64) -> usize {
    let mut taken = 0;
    for step in 0u32.. {
        let joints = [0.1, 0.5, 1.0 + 0.1 * f64::from(step % 7)];
        let pose = |time| PathPose { time, pose: Pose::Joints(joints), stiffness: None };
        // A path that begins while the finger moves may be too fast. The hand then refuses it.
        taken += usize::from(hand.send_path(1, &[pose(0.5), pose(0.9)], None).is_ok());
        let _ = hand.keep_valid(1, Validity::hold_after(Some(Duration::from_secs(1))));
        if hand.report(1).expect("a report").losses.cycles >= end {
            break;
        }
        std::thread::yield_now();
    }
    taken
}

#[test]
fn a_servo_thread_allocates_nothing_while_it_runs() {
    let hand = open();
    // The thread of the listener waits for events, so the servos wake it.
    let _listener = hand.on_event(note).expect("a thread");
    assert!(BY_SERVOS.load(Relaxed) > 0, "starting a thread allocates: the counter must see it");
    let before = BY_SERVOS.load(Relaxed);
    // This part begins with empty black boxes and lasts until they are full. Storing a record must never allocate: when
    // memory has run out, an allocation would end the process.
    let reports_before = BY_REPORTS.load(Relaxed);
    assert!(reports_before > 0, "the counter must see the thread that collects reports");
    let cycles = |finger| hand.report(finger).expect("a report").losses.cycles;
    let end = cycles(1) + 3000;
    let mut others = BY_OTHERS.load(Relaxed);
    for step in 0u32.. {
        // Sends commands and reads reports without a pause, changing pose and stiffness.
        let angle = 1.0 + 0.1 * f64::from(step % 7);
        hand.send_position(1, [0.1, 0.5, angle]).expect("sent");
        hand.send_stiffness(1, [[angle, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 2.0]]).expect("sent");
        hand.position(1).expect("position");
        if cycles(1) >= end {
            break;
        }
        std::thread::yield_now();
    }
    assert_eq!(BY_SERVOS.load(Relaxed), before, "allocations in the servo threads");
    assert_eq!(BY_REPORTS.load(Relaxed), reports_before, "allocations in the thread that collects reports");
    others = BY_OTHERS.load(Relaxed) - others;
    assert!(others < 100, "the planner's calls allocate: {others}");
    let groups = send_groups(&hand, cycles(1) + 200);
    assert_eq!(BY_SERVOS.load(Relaxed), before, "allocations in the servo threads while groups are sent");
    assert!(groups > 10, "only {groups} groups were taken");
    let paths = send_paths(&hand, cycles(1) + 500);
    assert!(paths > 10, "only {paths} paths were taken");
    assert_eq!(BY_SERVOS.load(Relaxed), before, "allocations in the servo threads while paths are sent");
    // The planner makes a new controller, and the servo only copies it.
    let end = cycles(1) + 200;
    for step in 0u32.. {
        hand.adjust(1, &format!("tendon.minimum = {}", 5 + step % 3)).expect("adjusted");
        if cycles(1) >= end {
            break;
        }
        std::thread::yield_now();
    }
    assert_eq!(BY_SERVOS.load(Relaxed), before, "allocations in the servo threads while a finger is adjusted");
    assert!(cycles(2) > 500 && cycles(3) > 500, "all fingers ran");

    // A servo must not allocate while its finger is calibrated and the finger's controller is replaced.
    hand.adjust(2, "zeroing.method = \"pose\"").expect("adjusted");
    hand.zero(2, |_| {}).expect("zeroed");
    assert_eq!(BY_SERVOS.load(Relaxed), before, "allocations in the servo threads, calibrating");
    assert!(EVENTS.load(Relaxed) > 10, "there were events: {}", EVENTS.load(Relaxed));
}
