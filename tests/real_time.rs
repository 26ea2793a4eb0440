//! Tests the key `real_time`, also in processes whose limits are too small for real-time operation.
#![allow(unsafe_code)]

#[allow(dead_code)]
mod c;

use c::{Bench, STRICT, c_compiler};
use std::os::unix::process::CommandExt;
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use std::{fs, io, thread};
use sun2xp::finger::FaultKind;
use sun2xp::hand::{Hand, MissingPermission};
use sun2xp::model::configuration::{Configuration, RATES, RealTime};

#[test]
fn real_time_that_is_ignored_gives_no_warning() {
    // A thread without real-time priority shares the processors with all other threads of the machine. The bench
    // therefore keeps other tests from running, and the rate is low.
    let _turn = Bench::new();
    let mut configuration = Configuration::default();
    (configuration.hand.real_time, configuration.hand.rate) = (RealTime::Ignore, 500.0);
    let hand = Hand::open(configuration).expect("the simulated hand");
    let warned = hand.fault(1).expect("the finger is open").warning.map(|warning| warning.kind);
    assert_ne!(warned, Some(FaultKind::RealtimeRefused), "nothing was refused");
    let status = hand.status(1).expect("status");
    assert_eq!((status.realtime, status.memory_locked, status.on_core), (false, false, true));
}

const CAP_IPC_LOCK: libc::c_ulong = 14;
const CAP_SYS_NICE: libc::c_ulong = 23;

type Right = (libc::__rlimit_resource_t, libc::c_ulong);

/// Runs `opens.c`, which opens and closes the hand, without this right. Returns exit status, standard output and
/// standard error.
fn opened_without(right: Right, configuration: &str) -> (Option<i32>, String, String) {
    run_without(right, configuration, "opens.c")
}

fn run_without(right: Right, configuration: &str, program: &str) -> (Option<i32>, String, String) {
    let bench = Bench::new();
    fs::write(bench.path().join("named.toml"), configuration).expect("a configuration file");
    let mut command = Command::new(bench.build(c_compiler(), STRICT, &[program]));
    let give_up = move || {
        let (limit, capability) = right;
        let nothing = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
        // SAFETY: system calls on plain values. A process without the capability cannot drop it, and need not.
        unsafe {
            libc::setrlimit(limit, &nothing);
            libc::prctl(libc::PR_CAPBSET_DROP, capability, 0, 0, 0);
        }
        Ok(())
    };
    // SAFETY: makes only system calls between fork and exec.
    unsafe { command.pre_exec(give_up) };
    let run = bench.run(command);
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (run.status.code(), text(&run.stdout), text(&run.stderr))
}

#[test]
fn a_planner_without_memlock_gets_its_hand_and_a_message() {
    let right = (libc::RLIMIT_MEMLOCK, CAP_IPC_LOCK);
    let (status, _, printed) = opened_without(right, "[hand]\nrate = 500\n");
    assert_eq!(status, Some(0), "{printed}");
    let lines: Vec<_> = printed.lines().filter(|line| line.contains("memory cannot be locked")).collect();
    assert!(lines.len() == 1 && lines[0].contains("memlock"), "{printed}");

    let (status, output, printed) = opened_without(right, "[hand]\nrate = 500\nreal_time = \"ignore\"\n");
    assert_eq!(status, Some(0), "{output}{printed}");
    assert!(!printed.contains("locked"), "{printed}");
}

/// The message names one amount for all rates. The hand opens at the highest rate, which needs the most memory.
#[test]
fn the_memlock_limit_of_the_message_suffices_at_every_rate() {
    let message = MissingPermission::Memory(io::Error::from_raw_os_error(libc::ENOMEM)).to_string();
    let amount = message.split_once("raise the memlock limit to ").and_then(|(_, rest)| rest.split_once(" MiB"));
    let amount = amount.and_then(|(amount, _)| amount.parse::<usize>().ok());
    let bytes = amount.unwrap_or_else(|| panic!("no amount: {message}")) << 20;
    // No other test locks memory of this process. This one waits for its turn, because it needs the processors.
    let _turn = Bench::new();
    let before = locked();
    if !may_lock(bytes) {
        return c::not_permitted("locked memory", &format!("this process may not lock {bytes} bytes"));
    }
    let mut configuration = Configuration::default();
    configuration.hand.rate = *RATES.end();
    let most = most_locked_while(|| Hand::open(configuration)) - before;
    assert!(most <= bytes, "{most} bytes are locked, but: {message}");
    // In an earlier version, the message named 8 MiB. If 8 MiB sufficed, this test would prove nothing.
    assert!(most > 8 << 20, "only {most} bytes are locked");
}

/// The locked memory of this process, bytes (VmLck). The memlock limit applies to this sum.
fn locked() -> usize {
    let status = fs::read_to_string("/proc/self/status").expect("the status of this process");
    let locked = status.lines().find_map(|line| line.strip_prefix("VmLck:")?.strip_suffix("kB")?.trim().parse().ok());
    locked.map(|kilobytes: usize| kilobytes << 10).expect("a size")
}

fn may_lock(bytes: usize) -> bool {
    let memory = vec![0u8; bytes];
    // SAFETY: locking does not change the contents. Nothing else in these pages is locked.
    unsafe { libc::mlock(memory.as_ptr().cast(), bytes) == 0 && libc::munlock(memory.as_ptr().cast(), bytes) == 0 }
}

/// Returns the most memory that is locked while a hand opens, bytes. The servos lock their memory before their first
/// cycle. Afterwards a busy machine may cause a fault at the highest rate, so the test does not need the hand to open.
fn most_locked_while<T>(open: impl FnOnce() -> T) -> usize {
    let opened = AtomicBool::new(false);
    thread::scope(|scope| {
        let watching = scope.spawn(|| {
            let mut most = 0;
            while !opened.load(Ordering::Relaxed) {
                most = most.max(locked());
                thread::sleep(Duration::from_millis(1));
            }
            most
        });
        let hand = open();
        let at_the_end = locked();
        opened.store(true, Ordering::Relaxed);
        drop(hand);
        at_the_end.max(watching.join().expect("no panic"))
    })
}

#[test]
fn a_planner_without_rtprio_gets_a_warning_from_sun2xp_fault() {
    let (status, output, printed) =
        run_without((libc::RLIMIT_RTPRIO, CAP_SYS_NICE), "[hand]\nrate = 500\n", "realtime_refused.c");
    assert_eq!(status, Some(0), "{output}{printed}");
}

#[test]
fn enforced_real_time_is_available_or_refused_with_the_remedy() {
    let enforce = "[hand]\nreal_time = \"enforce\"\n";
    let (status, output, _) = opened_without((libc::RLIMIT_RTPRIO, CAP_SYS_NICE), enforce);
    assert_eq!(status, Some(2), "{output}");
    assert!(
        output.contains("OpenHand: real-time operation is not permitted: ") && output.contains("rtprio"),
        "{output}"
    );

    let (status, output, _) = opened_without((libc::RLIMIT_MEMLOCK, CAP_IPC_LOCK), enforce);
    assert_eq!(status, Some(2), "{output}");
    // If the process may not use SCHED_FIFO either, the refusal gives that reason instead.
    assert!(output.contains("memlock") || output.contains("rtprio"), "{output}");

    let (status, output, _) =
        opened_without((libc::RLIMIT_CORE, CAP_IPC_LOCK), &format!("{enforce}[finger]\ncore = 1023\n"));
    assert_eq!(status, Some(2), "{output}");
    assert!(output.contains("finger.core") || output.contains("rtprio"), "{output}");
}
