//! The watch that measures pauses of the machine, and the failures that the tests excuse because of them.

#[path = "common/attempts.rs"]
mod attempts;
#[allow(dead_code)]
#[path = "common/pauses.rs"]
mod pauses;

use attempts::{Tally, Verdict, attempts};
use pauses::{CarriedByte, Part, PauseWatch};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use serialport::TTYPort;
use std::fs::File;
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

const TOLERATED_PAUSE: Duration = Duration::from_millis(100);

/// A process that ends with the test.
struct Process(Child);

impl Process {
    /// Runs a script in a shell on the first core.
    fn start(script: &str) -> Self {
        let mut command = Command::new("sh");
        command.args(["-c", script]).stdin(Stdio::null());
        let on_first_core = || {
            // SAFETY: a set of cores is plain bits, so all zeros is a valid value. The set outlives the call.
            unsafe {
                let mut cores: libc::cpu_set_t = std::mem::zeroed();
                libc::CPU_SET(0, &mut cores);
                libc::sched_setaffinity(0, size_of::<libc::cpu_set_t>(), &cores);
            }
            Ok(())
        };
        // SAFETY: makes only a system call between fork and exec.
        unsafe { command.pre_exec(on_first_core) };
        Self(command.spawn().expect("a shell"))
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Runs `script` for two seconds, with the scripts `beside` on the same core. Returns how long the process of `script`
/// waited for the core in the worst span of half a second, and a description of the measurements.
fn waited(script: &str, beside: &[&str], meanwhile: impl Fn(u32)) -> (Duration, String) {
    let process = Process::start(script);
    let _others: Vec<_> = beside.iter().map(|script| Process::start(script)).collect();
    let watch = PauseWatch::start();
    watch.also(process.0.id(), Part::Board);
    meanwhile(process.0.id());
    std::thread::sleep(Duration::from_secs(2));
    let waits = watch.end();
    let span = Duration::from_millis(500);
    (waits.of(Part::Board, span), waits.description(span))
}

const SPINS: &str = "while :; do :; done";

#[test]
fn a_process_that_shares_its_core_is_found_waiting_and_one_that_sleeps_or_is_stopped_is_not() {
    // Three processes share a core, so each waits for about two thirds of the time.
    let (shared, measured) = waited(SPINS, &[SPINS, SPINS], |_| {});
    assert!(shared > Duration::from_millis(150), "{measured}");
    for (script, signal) in [("sleep 60", 0), (SPINS, libc::SIGSTOP)] {
        let stop = |process: u32| {
            // SAFETY: the process has not been waited for, so the number is still its own.
            unsafe { libc::kill(process as libc::pid_t, signal) };
        };
        let (idle, measured) = waited(script, &[SPINS, SPINS], stop);
        assert!(idle < Duration::from_millis(150), "{script}: {measured}");
    }
}

#[test]
fn a_byte_that_the_kernel_does_not_carry_counts_as_a_pause() {
    let pair = || TTYPort::pair().expect("a pseudo-terminal");
    let carrier = |byte: Option<CarriedByte>| {
        let watch = PauseWatch::start();
        if let Some(byte) = byte {
            watch.carry(byte);
        }
        std::thread::sleep(Duration::from_millis(500));
        watch.end().of(Part::Carrier, Duration::from_secs(1))
    };
    let ((near, _read_by_nobody), (_silent, far)) = (pair(), pair());
    let lost = carrier(Some(CarriedByte::new(near, far)));
    assert!(lost > Duration::from_millis(250), "{lost:?}");
    let carried = carrier(None);
    assert!(carried < Duration::from_millis(250), "{carried:?}");
}

#[test]
fn nobody_else_can_open_the_terminal_of_the_watch() {
    let byte = CarriedByte::open().expect("a pseudo-terminal");
    let refused = File::open(byte.path().expect("a path")).expect_err("locked");
    assert_eq!(refused.raw_os_error(), Some(libc::EIO), "{refused}");
}

#[test]
fn a_failure_without_a_pause_is_not_excused() {
    let made = std::panic::catch_unwind(|| {
        let mut count = 0;
        attempts("a defect", Duration::from_secs(3600), |_| {
            count += 1;
            // The defect shows in every second attempt.
            if count % 2 == 1 { Err("it shows".to_string()) } else { Ok(()) }
        })
    });
    let measured = *made.expect_err("excused").downcast::<String>().expect("a text");
    assert!(measured.contains("0 excused; it shows. No pause of the machine explains it"), "{measured}");
}

#[test]
fn failures_are_excused_only_as_long_as_the_passed_attempts_outnumber_them() {
    let long = 2 * TOLERATED_PAUSE;
    let judged = |outcomes: &[bool]| {
        let mut tally = Tally::default();
        outcomes.iter().map(|&passed| tally.judge(passed, long, TOLERATED_PAUSE)).collect::<Vec<_>>()
    };
    use Verdict::{Again, Hopeless, Passed};
    assert_eq!(judged(&[true]), [Passed]);
    assert_eq!(judged(&[false, true, true]), [Again, Again, Passed]);
    assert_eq!(judged(&[false, true, false, true, true]), [Again, Again, Again, Again, Passed]);
    assert_eq!(judged(&[false, false, false, false]), [Again, Again, Again, Hopeless]);
    assert_eq!(Tally::default().judge(false, TOLERATED_PAUSE / 2, TOLERATED_PAUSE), Verdict::Failed);
}

/// A defect shows in half of the attempts. On a machine that never pauses, nearly half of the runs must fail because of
/// it. On a machine that always pauses for long enough to excuse a failure, at least a quarter of the runs must fail.
#[test]
fn a_defect_that_shows_in_half_of_the_attempts_does_not_stay_green() {
    let mut random = Pcg64::seed_from_u64(1);
    for (paused, least) in [(Duration::ZERO, 4_500), (2 * TOLERATED_PAUSE, 2_500)] {
        let failed = (0..10_000).filter(|_| {
            let mut tally = Tally::default();
            loop {
                match tally.judge(random.next_u32() % 2 == 0, paused, TOLERATED_PAUSE) {
                    Verdict::Again => {}
                    verdict => return verdict != Verdict::Passed,
                }
            }
        });
        let failed = failed.count();
        assert!(failed > least, "{failed} of 10 000 runs fail on a machine that pauses for {paused:?}");
    }
}
