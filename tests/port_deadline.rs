//! A port keeps its deadlines while the machine is so busy that the kernel worker that carries the bytes of a
//! pseudo-terminal cannot run.

#[path = "common/pseudo_terminal.rs"]
mod pseudo_terminal;
#[allow(dead_code)]
#[path = "common/tools.rs"]
mod tools;

use pseudo_terminal::pseudo_terminal;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::fs::File;
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Barrier};
use std::thread;
use std::time::{Duration, Instant};
use sun2xp::board::{Port, Transport};
use sun2xp::realtime::{self, Priority, spawn};

const MS: u64 = 1_000_000;

/// Longest time for which the processors are kept busy. Only after almost a second would the kernel run ordinary
/// threads in spite of the busy real-time threads.
const BUSY_AT_MOST: Duration = Duration::from_millis(400);

/// Opens a port. Returns the board's end of its line too.
fn line() -> (File, Port) {
    let (board_end, path) = pseudo_terminal();
    (File::from(board_end), Port::open(&path, 1_000_000).unwrap_or_else(|error| panic!("{error}")))
}

/// Lets threads of a low real-time priority occupy every processor while `work` runs at a higher priority, for at most
/// [`BUSY_AT_MOST`]. Returns the result of `work`, and whether `work` has ended while the processors were still busy.
fn on_a_busy_machine<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> (T, bool) {
    let processors = thread::available_parallelism().expect("a number").get();
    // No thread is busy before every thread has its priority: a thread that is still ordinary would not run beside busy
    // threads, and would never get its priority.
    let ready = Arc::new(Barrier::new(processors + 1));
    let (ended, too_late) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicBool::new(false)));
    let start = |core| {
        let (ready, ended, too_late) = (ready.clone(), ended.clone(), too_late.clone());
        let busy = spawn("busy", Priority { fifo: 1, core: Some(core) }, move |_| {
            ready.wait();
            let begun = Instant::now();
            while !ended.load(Ordering::SeqCst) {
                if begun.elapsed() > BUSY_AT_MOST {
                    too_late.store(true, Ordering::SeqCst);
                    break;
                }
            }
        });
        busy.expect("a thread")
    };
    let busy: Vec<_> = (0..processors).map(start).collect();
    let working = spawn("working", Priority { fifo: 50, core: None }, move |_| {
        ready.wait();
        thread::sleep(Duration::from_millis(2));
        let result = work();
        ended.store(true, Ordering::SeqCst);
        (result, !too_late.load(Ordering::SeqCst))
    });
    let result = working.expect("a thread").join().expect("no panic");
    busy.into_iter().for_each(|busy| busy.join().expect("no panic"));
    result
}

#[test]
fn a_deadline_is_kept_while_the_kernel_cannot_carry_the_bytes() {
    let permitted = spawn("permitted", Priority { fifo: 1, core: None }, |refusals| refusals.scheduling.is_none());
    if !permitted.expect("a thread").join().expect("no panic") {
        return tools::not_permitted("a busy machine", "this process may not use SCHED_FIFO (run the tests as root)");
    }
    let (mut board_end, mut port) = line();
    for round in 1..=2 {
        let mut buffer = [0; 64];
        let (mut taken, in_time);
        ((board_end, port, buffer, taken), in_time) = on_a_busy_machine(move || {
            board_end.write_all(b"reply").expect("written");
            let taken = port.read_until(&mut buffer, realtime::now() + 5 * MS).expect("no error");
            (board_end, port, buffer, taken)
        });
        assert!(in_time, "round {round}: the read waited for the worker");
        // Normally no byte has arrived yet, because all processors that this process may use were busy. The bytes have
        // arrived if the machine has another processor, on which the worker has run.
        if taken == 0 {
            taken = port.read_until(&mut buffer, realtime::now() + 5000 * MS).expect("no error");
        }
        assert_eq!(&buffer[..taken], b"reply");
    }
}

/// The wait is edge-triggered: if a read left bytes and the next read waited for another event, these bytes would stay
/// until more arrive. The test sends each chunk only after it has read the one before, so no later chunk can hide this.
#[test]
fn no_byte_stays_behind_whatever_the_sizes_of_chunks_and_buffers() {
    let (mut board_end, mut port) = line();
    let mut random = Pcg64::seed_from_u64(7);
    let (mut buffer, mut sent, mut read) = ([0; 5000], 0_u8, 0_u8);
    for _ in 0..5000 {
        // Some chunks are larger than the input buffer of a terminal, which is a ring of 4096 bytes.
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
