//! A port keeps its deadlines while the machine is so busy that the kernel's worker cannot carry the bytes.
#![allow(unsafe_code, reason = "scheduling, and the raw descriptor of a pseudo-terminal")]

#[allow(dead_code)]
#[path = "common/tools.rs"]
mod tools;

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::fs::File;
use std::io::Write;
use std::os::fd::{AsRawFd, FromRawFd};
use std::path::PathBuf;
use std::sync::Barrier;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};
use sun2xp::board::{Port, Transport};
use sun2xp::realtime;

const MS: u64 = 1_000_000;

/// The processors are kept busy for at most this long. The kernel keeps some of the time for ordinary threads, but only
/// after almost a second.
const BUSY_AT_MOST: Duration = Duration::from_millis(400);

/// Gives the calling thread this SCHED_FIFO priority. Returns whether that is permitted.
fn run_at(priority: libc::c_int) -> bool {
    let parameters = libc::sched_param { sched_priority: priority };
    // SAFETY: the parameters outlive the call.
    unsafe { libc::sched_setscheduler(0, libc::SCHED_FIFO, &parameters) == 0 }
}

/// Binds the calling thread to this processor.
fn run_on(processor: usize) {
    // SAFETY: all zeros are an empty set of processors, and the set outlives the calls.
    unsafe {
        let mut only: libc::cpu_set_t = std::mem::zeroed();
        libc::CPU_SET(processor, &mut only);
        libc::sched_setaffinity(0, size_of_val(&only), &only);
    }
}

/// Opens a pseudo-terminal. Returns the board's end and the path of the host's end.
fn pseudo_terminal() -> (File, PathBuf) {
    let mut name = [0u8; 64];
    // SAFETY: the calls take a new descriptor, and `name` is writable for its length.
    let board_end = unsafe {
        let board_end = libc::posix_openpt(libc::O_RDWR | libc::O_NOCTTY | libc::O_CLOEXEC);
        assert!(board_end >= 0 && libc::grantpt(board_end) == 0 && libc::unlockpt(board_end) == 0);
        assert_eq!(libc::ptsname_r(board_end, name.as_mut_ptr().cast(), name.len()), 0);
        File::from_raw_fd(board_end)
    };
    assert!(board_end.as_raw_fd() > 2);
    let name = std::ffi::CStr::from_bytes_until_nul(&name).expect("a name");
    (board_end, PathBuf::from(name.to_str().expect("text")))
}

/// Lets threads of a low real-time priority occupy every processor while `work` runs at a higher priority, for at most
/// [`BUSY_AT_MOST`]. Returns the result of `work`, and whether `work` has ended while the processors were still busy.
fn on_a_busy_machine<T: Send>(work: impl FnOnce() -> T + Send) -> (T, bool) {
    let processors = thread::available_parallelism().expect("a number").get();
    // Every thread has its priority before the first one is busy. An ordinary thread would not run any more.
    let (ready, ended, too_late) = (Barrier::new(processors + 1), AtomicBool::new(false), AtomicBool::new(false));
    thread::scope(|scope| {
        for processor in 0..processors {
            let (ready, ended, too_late) = (&ready, &ended, &too_late);
            scope.spawn(move || {
                run_on(processor);
                assert!(run_at(1), "permitted before");
                ready.wait();
                let begun = Instant::now();
                while !ended.load(Ordering::SeqCst) {
                    if begun.elapsed() > BUSY_AT_MOST {
                        too_late.store(true, Ordering::SeqCst);
                        break;
                    }
                }
            });
        }
        let working = scope.spawn(|| {
            assert!(run_at(50), "permitted before");
            ready.wait();
            thread::sleep(Duration::from_millis(2));
            let result = work();
            ended.store(true, Ordering::SeqCst);
            (result, !too_late.load(Ordering::SeqCst))
        });
        working.join().expect("no panic")
    })
}

#[test]
fn a_deadline_is_kept_while_the_kernel_cannot_carry_the_bytes() {
    if !thread::spawn(|| run_at(1)).join().expect("no panic") {
        return tools::not_permitted("a busy machine", "this process may not use SCHED_FIFO (run the tests as root)");
    }
    let (mut board_end, path) = pseudo_terminal();
    let mut port = Port::open(&path, 1_000_000).unwrap_or_else(|error| panic!("{error}"));
    let mut buffer = [0; 64];
    for round in 1..=2 {
        let (taken, in_time) = on_a_busy_machine(|| {
            board_end.write_all(b"reply").expect("written");
            port.read_until(&mut buffer, realtime::now() + 5 * MS).expect("no error")
        });
        assert!(in_time, "round {round}: the read waited for the worker");
        // If this process may use only some of the processors, the worker may have carried the bytes on another one.
        let taken = match taken {
            0 => port.read_until(&mut buffer, realtime::now() + 5000 * MS).expect("no error"),
            taken => taken,
        };
        assert_eq!(&buffer[..taken], b"reply");
    }
}

/// The wait is edge-triggered: if a read left bytes and the next read waited for another event, these bytes would stay
/// until more arrive. Each chunk is therefore sent only after all bytes of the one before were read.
#[test]
fn no_byte_stays_behind_whatever_the_sizes_of_chunks_and_buffers() {
    let (mut board_end, path) = pseudo_terminal();
    let mut port = Port::open(&path, 1_000_000).unwrap_or_else(|error| panic!("{error}"));
    let mut random = Pcg64::seed_from_u64(7);
    let (mut buffer, mut sent, mut read) = ([0; 5000], 0_u8, 0_u8);
    for _ in 0..5000 {
        // The input buffer of a terminal is a ring of 4096 bytes.
        let chunk: Vec<u8> = (0..random.next_u32() % 4999 + 1).map(|place| sent.wrapping_add(place as u8)).collect();
        sent = sent.wrapping_add(chunk.len() as u8);
        board_end.write_all(&chunk).expect("written");
        let mut left = chunk.len();
        while left > 0 {
            let size = 1 + random.next_u32() as usize % buffer.len();
            let taken = port.read_until(&mut buffer[..size], realtime::now() + 20_000 * MS).expect("no error");
            assert!(taken > 0, "{left} of {} bytes stay behind", chunk.len());
            for &byte in &buffer[..taken] {
                assert_eq!(byte, read);
                read = read.wrapping_add(1);
            }
            left -= taken;
        }
        assert_eq!(port.read_until(&mut buffer, 0).expect("no error"), 0, "nothing is left");
    }
}
