//! Provokes faults of fingers, boards and lines, repeatedly. The fingers must recover every time. Afterwards the
//! process must have as many descriptors and threads as before, and its heap may have grown only slightly.

use crate::pauses::name_pauses;
use crate::recoveries::recovers_despite_pauses;
use crate::recovery::{fault, held};
use crate::rig::{START, TARGET, close, goes, on_ports, open, turn, wait_until};
use std::alloc::{GlobalAlloc, Layout, System};
use std::fs::remove_file;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicI64, Ordering};
use std::time::{Duration, Instant};
use sun2xp::hand::Hand;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::Priority;
use sun2xp::simulated::{Defect, LineFault, Pace, SimulatedBoard, SimulatedPort};

/// Number of bytes that are allocated on the heap.
static ALLOCATED: AtomicI64 = AtomicI64::new(0);

struct Counting;

// SAFETY: both functions pass their arguments on to the system's allocator, which satisfies the contract of the trait.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATED.fetch_add(layout.size() as i64, Ordering::Relaxed);
        // SAFETY: the caller satisfies the contract of this same function.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        ALLOCATED.fetch_sub(layout.size() as i64, Ordering::Relaxed);
        // SAFETY: the caller satisfies the contract of this same function.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Permitted growth of the heap, bytes. If recoveries follow each other closely, the black boxes store a few
/// more keyframes.
const COMES_AND_GOES: i64 = 128 * 1024;

#[derive(Debug)]
enum Trouble {
    Finger(Defect),
    Line(LineFault),
    Unplug,
}

const TROUBLES: [Trouble; 18] = [
    Trouble::Finger(Defect::CutTendon(2)),
    Trouble::Finger(Defect::DeadGauge { gauge: 1, count: None }),
    Trouble::Line(LineFault::Drop),
    Trouble::Finger(Defect::SlippingTendon { tendon: 3, grip: 1.0 }),
    Trouble::Finger(Defect::DeadGauge { gauge: 2, count: Some(0) }),
    Trouble::Line(LineFault::Corrupt),
    Trouble::Finger(Defect::DeadGauge { gauge: 4, count: Some(4095) }),
    Trouble::Finger(Defect::DriftingGauge { gauge: 1, speed: 20.0 }),
    Trouble::Unplug,
    Trouble::Finger(Defect::EncoderJump { encoder: 4, counts: 2000 }),
    Trouble::Finger(Defect::JammedMotor(1)),
    Trouble::Finger(Defect::Reset),
    Trouble::Finger(Defect::HotMotor(1)),
    Trouble::Finger(Defect::ZeroLost),
    Trouble::Line(LineFault::Stall),
    Trouble::Finger(Defect::EmergencyStop),
    Trouble::Finger(Defect::Supply),
    Trouble::Finger(Defect::Sensor),
];

/// A simulated board. The hand opens its port through a symbolic link.
struct Bench {
    /// 1 to 3.
    finger: i32,
    port: SimulatedPort,
    link: PathBuf,
}

impl Bench {
    fn new(folder: &Path, number: FingerNumber) -> Self {
        let board = SimulatedBoard::new(&Configuration::default(), &[number]).expect("a board");
        let port = SimulatedPort::start(board, Pace::patient(500.0), Priority { fifo: 20, core: None });
        let bench = Self {
            finger: number.get(),
            port: port.expect("a port"),
            link: folder.join(format!("board-{}", number.index())),
        };
        bench.name();
        bench
    }

    /// Makes the link point to the port.
    fn name(&self) {
        // The first call finds no link to remove.
        let _ = remove_file(&self.link);
        symlink(self.port.path(), &self.link).expect("a link");
    }

    fn inject(&self, trouble: &Trouble) {
        match trouble {
            Trouble::Finger(defect) => {
                assert_eq!(self.port.with_finger(self.finger as u8, |finger| finger.inject(defect)), Some(true));
            }
            Trouble::Line(fault) => self.port.inject(*fault, 1.0, 60_000_000_000, 1),
            Trouble::Unplug => self.port.unplug(),
        }
    }

    fn repair(&self) {
        self.port.with_finger(self.finger as u8, |finger| finger.repair()).expect("the finger");
        self.port.clear();
        if self.port.path().as_os_str().is_empty() {
            self.port.plug_in().expect("a new port");
            self.name();
        }
    }
}

/// Provokes one trouble on each of three moving fingers at the same time. All must recover.
fn recover_from(hand: &Hand, benches: &[Bench], troubles: &[Trouble]) {
    for (bench, trouble) in benches.iter().zip(troubles) {
        bench.inject(trouble);
    }
    let (mut sent, mut there) = (Instant::now(), false);
    wait_until(&format!("faulted by {troubles:?}"), || {
        // A jammed motor is detected only when a command makes it turn.
        if sent.elapsed() > Duration::from_millis(300) {
            (sent, there) = (Instant::now(), !there);
            for bench in benches {
                // Faulted fingers refuse the call.
                let _ = hand.send_position(bench.finger, if there { TARGET } else { START });
            }
        }
        benches.iter().all(|bench| fault(hand, bench.finger).is_some())
    });
    for bench in benches {
        bench.repair();
        recovers_despite_pauses(hand, bench.finger, &[]);
    }
}

/// `SUN2XP_ROUNDS=100 cargo test --test hand_ports nothing_leaks -- --nocapture` runs more rounds.
#[test]
fn every_trouble_is_recovered_from_and_nothing_leaks() {
    let _turn = turn();
    let _rest = name_pauses().rest();
    let rounds = std::env::var("SUN2XP_ROUNDS").map_or(1, |rounds| rounds.parse().expect("a number"));
    let folder = tempfile::tempdir().expect("a folder");
    let benches = FingerNumber::ALL.map(|number| Bench::new(folder.path(), number));
    let links = benches.each_ref().map(|bench| bench.link.to_string_lossy());
    let mut configuration = on_ports(links.each_ref().map(|link| &**link));
    configuration.fingers.iter_mut().for_each(|finger| finger.reconnect = true);
    let hand = open(configuration);
    let all = || TROUBLES.chunks(3).for_each(|troubles| recover_from(&hand, &benches, troubles));
    // The first round makes every allocation that happens only once.
    all();
    // The black boxes are full after two seconds. 1500 cycles at 500 Hz are three seconds.
    let cycles = |finger: i32| hand.report(finger).expect("a report").losses.cycles;
    let full = [1, 2, 3].map(|finger| cycles(finger) + 1500);
    wait_until("run for three seconds", || (1..=3).zip(full).all(|(finger, full)| cycles(finger) > full));
    let before = (held(), ALLOCATED.load(Ordering::Relaxed));
    (0..rounds).for_each(|_| all());
    let after = (held(), ALLOCATED.load(Ordering::Relaxed));
    println!(
        "{} faults recovered from: descriptors and threads {:?}, then {:?}; on the heap {} bytes, then {}",
        rounds * TROUBLES.len(),
        before.0,
        after.0,
        before.1,
        after.1
    );
    assert_eq!(before.0, after.0, "descriptors and threads");
    assert!(after.1 - before.1 < COMES_AND_GOES, "{} bytes more", after.1 - before.1);
    goes(&hand, 1, TARGET);
    close(hand);
}
