//! Measures the calls that a planner makes most often. They go through the C entry points to an open simulated hand
//! with running servos.

use divan::{Bencher, black_box};
use std::ffi::{CStr, c_char, c_int, c_void};

// Links the library, which defines the C symbols below.
use sun2xp as _;

unsafe extern "C" {
    fn OpenHand() -> c_int;
    fn CloseHand() -> c_int;
    fn HandError() -> *const c_char;
    fn SendPos(i: c_int, pos: *const f32) -> c_int;
    fn SendKx(i: c_int, kx: *const f32) -> c_int;
    fn SendKxD(i: c_int, kx: *const f64) -> c_int;
    fn GetPos(i: c_int, pos: *mut f32) -> c_int;
    safe fn sun2xp_default_hand() -> *mut c_void;
    fn sun2xp_position(hand: *mut c_void, finger: c_int, position: *mut f64) -> c_int;
    fn sun2xp_set_gravity(hand: *mut c_void, gravity: *const f64) -> c_int;
}

/// Number of attempts to open the hand. Other work on the machine can prevent it from opening in time.
const ATTEMPTS: u32 = 3;

fn main() {
    let mut attempts = 0;
    // SAFETY: the call takes no arguments. Without a configuration file it opens the default simulated hand.
    while unsafe { OpenHand() } != 0 {
        // SAFETY: HandError returns a C string that is valid until this thread's next refused call.
        let reason = unsafe { CStr::from_ptr(HandError()) }.to_string_lossy();
        attempts += 1;
        eprintln!("attempt {attempts} of {ATTEMPTS} to open the simulated hand: {reason}");
        if attempts == ATTEMPTS {
            std::process::exit(1);
        }
    }
    divan::main();
    // SAFETY: the call takes no arguments.
    assert_eq!(unsafe { CloseHand() }, 0, "the simulated hand closes");
}

#[divan::bench]
fn send_pos(bencher: Bencher) {
    let pos = [0.1f32, 0.5, 1.0];
    // SAFETY: `pos` has three values, which the call reads before it returns.
    bencher.bench_local(|| unsafe { SendPos(1, black_box(pos.as_ptr())) });
}

#[divan::bench]
fn get_pos(bencher: Bencher) {
    let mut pos = [0.0f32; 3];
    // SAFETY: `pos` has room for three values, which the call writes before it returns.
    bencher.bench_local(|| unsafe { GetPos(1, black_box(pos.as_mut_ptr())) });
}

/// GetPos with a handle, which is found in the table of hands.
#[divan::bench]
fn position(bencher: Bencher) {
    let mut position = [0.0f64; 3];
    let hand = sun2xp_default_hand();
    // SAFETY: `position` has room for three values, which the call writes before it returns.
    bencher.bench_local(|| unsafe { sun2xp_position(hand, 1, black_box(position.as_mut_ptr())) });
}

/// SendKx checks that Kx is symmetric, has no negative eigenvalue and is within the bound.
#[divan::bench]
fn send_kx(bencher: Bencher) {
    let kx = [3.0f32, 0.2, 0.1, 0.2, 4.0, 0.3, 0.1, 0.3, 2.0];
    // SAFETY: `kx` has nine values, which the call reads before it returns.
    bencher.bench_local(|| unsafe { SendKx(1, black_box(kx.as_ptr())) });
}

#[divan::bench]
fn send_kx_double(bencher: Bencher) {
    let kx = [3.0f64, 0.2, 0.1, 0.2, 4.0, 0.3, 0.1, 0.3, 2.0];
    // SAFETY: `kx` has nine values, which the call reads before it returns.
    bencher.bench_local(|| unsafe { SendKxD(1, black_box(kx.as_ptr())) });
}

/// sun2xp_set_gravity sends gravity to three servos and three simulated fingers. A simulated finger may keep the call
/// waiting while it computes.
#[divan::bench]
fn set_gravity(bencher: Bencher) {
    let gravity = [0.0, 6.0, 7.8];
    let hand = sun2xp_default_hand();
    // SAFETY: `gravity` has three values, which the call reads before it returns.
    bencher.bench_local(|| unsafe { sun2xp_set_gravity(hand, black_box(gravity.as_ptr())) });
}
