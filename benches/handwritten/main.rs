//! Compares one complete servo step with the same arithmetic in handwritten C (`step.c`, -O3).
//!
//!     cargo bench --bench handwritten
//!
//! First a closed loop is run and recorded. In every cycle of the recorded run, the motor torques of both steps must
//! agree within 1e-9 of the largest torque. Then the two steps repeat the run alternately. The measured computation
//! takes the counts of the encoders and gauges, and yields the motor torques and the report. Neither step computes
//! statistics. The library's step also estimates the contact force, and the handwritten step does not.

mod agreement;
mod by_hand;
mod parameters;
#[path = "../recorded_run/mod.rs"]
mod recorded_run;

use agreement::{apart, larger};
use by_hand::{ByHand, PlainFeedback, PlainReport, PlainSetPoint, PlainState, Step};
use parameters::{Gains, Parameters};
use recorded_run::{CYCLES, CYCLES_A_SET_POINT, RATE, Recording, lost};
use std::error::Error;
use std::hint::black_box;
use sun2xp::model::configuration::{ConfiguredFinger, Law, Scheme};

/// Number of times that each side repeats the recorded run.
const ROUNDS: usize = 301;

fn main() -> Result<(), Box<dyn Error>> {
    let by_hand = ByHand::compile()?;
    println!("| scheme | this library | handwritten C | ratio |\n|---|---|---|---|");
    for (scheme, name, step) in
        [(Scheme::Figure9, "Figure 9", by_hand.figure9), (Scheme::Figure10, "Figure 10", by_hand.figure10)]
    {
        let gains = Gains::new(scheme);
        let mut finger = ConfiguredFinger::default();
        finger.controller.scheme = Some(scheme);
        finger.controller.law = Law::Report;
        gains.configure(&mut finger);
        let parameters = Parameters::new(&finger, &gains, RATE)?;
        let recording = Recording::new(finger)?;
        let plain = Plain::new(&recording, &parameters, by_hand.start, step);
        plain.check(&recording)?;
        let (ours, theirs) = time(&recording, &plain);
        println!("| {name} | {ours:.1} ns | {theirs:.1} ns | {:.3} |", ours / theirs);
    }
    println!("\nMedians of {ROUNDS} runs of {} cycles each, alternating; {}, {}.", CYCLES, rustc(), by_hand.compiler);
    Ok(())
}

fn rustc() -> String {
    let version = std::process::Command::new("rustc").arg("--version").output();
    version.map_or("rustc".into(), |output| String::from_utf8_lossy(&output.stdout).trim().into())
}

/// The recorded run in the structures of `step.c`.
struct Plain<'a> {
    parameters: &'a Parameters,
    start: by_hand::Start,
    step: Step,
    feedback: Vec<PlainFeedback>,
    set_points: Vec<PlainSetPoint>,
}

impl<'a> Plain<'a> {
    fn new(recording: &Recording, parameters: &'a Parameters, start: by_hand::Start, step: Step) -> Self {
        let feedback = recording.feedback.iter().map(PlainFeedback::from).collect();
        Self {
            parameters,
            start,
            step,
            feedback,
            set_points: recording.set_points.iter().map(PlainSetPoint::from).collect(),
        }
    }

    /// Runs every cycle, and passes its number and its motor torques to `see`.
    fn run(&self, lost: impl Fn(usize) -> bool, mut see: impl FnMut(usize, &[f64; 4])) {
        let (mut state, mut torques, mut report) = (PlainState::default(), [0.0; 4], PlainReport::default());
        // SAFETY: all structures have the layout of step.c, and are alive.
        unsafe { (self.start)(self.parameters, &mut state, &self.feedback[0]) };
        for (cycle, feedback) in self.feedback.iter().enumerate() {
            let set_point = &self.set_points[cycle / CYCLES_A_SET_POINT];
            let feedback = if lost(cycle) { std::ptr::null() } else { feedback };
            // SAFETY: as above. In step.c a null pointer stands for a lost reply.
            unsafe { (self.step)(self.parameters, &mut state, feedback, set_point, &mut torques, &mut report) };
            see(cycle, black_box(&torques));
        }
        black_box(&report);
    }

    fn check(&self, recording: &Recording) -> Result<(), String> {
        let mut worst: f64 = 0.0;
        self.run(lost, |cycle, torques| {
            worst = larger(worst, apart(torques, &recording.torques[cycle].into()));
        });
        if worst.is_nan() || worst > 1e-9 {
            return Err(format!("the torques differ by {worst:e} of the largest one: one of the two steps is wrong"));
        }
        eprintln!("the torques agree within {worst:.1e}; {}", recording.seen());
        Ok(())
    }
}

/// Returns the CPU time of this thread, ns. Other work on the machine does not count.
fn thread_time() -> u64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: `time` is writable, and the clock exists on every Linux.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    time.tv_sec as u64 * 1_000_000_000 + time.tv_nsec as u64
}

/// Returns the time of one step in the library, and the time of one step in the handwritten C, ns.
fn time(recording: &Recording, plain: &Plain) -> (f64, f64) {
    let per_step = |begun: u64| (thread_time() - begun) as f64 / CYCLES as f64;
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        let begun = thread_time();
        recording.repeat(|controller, state, feedback, activity| {
            black_box(controller.cycle(state, feedback, activity));
        });
        ours.push(per_step(begun));
        let begun = thread_time();
        plain.run(lost, |_, _| {});
        theirs.push(per_step(begun));
    }
    (median(ours), median(theirs))
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
