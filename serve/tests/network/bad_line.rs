//! Lines that lose packets or delay them: no wrong set point is applied, the set points are applied in order, and the
//! motion stays smooth.

use super::line::{Direction, Line};
use super::observer::has_stiffness;
use super::outage::{CATCH_MS, Rig};
use super::permitted_line;
use super::planner::{INTERVAL, Motion, RAMP_BEGIN, RAMP_STEP, RAMP_STEPS, STIFF};
use super::shaper::Conditions;
use crate::attempts::attempts;
use crate::pauses::{Part, PauseWatch};
use std::collections::VecDeque;
use std::time::Duration;
use sun2xp::Stage;
use sun2xp::telemetry::Sample;

/// Longest time of a ramp. The planner needs 7 s on a good line.
const RAMP_TIME: Duration = Duration::from_secs(30);

/// Longest time until the finger is at the beginning of the ramp.
const BEGINS: Duration = Duration::from_secs(10);

/// Bound of the velocity of a finger, rad/s. The ramp moves at 0.1 rad/s. A pause of the line can last 1 s before the
/// hand goes to its end state, after which the velocity is not measured. So after a pause, the next set point is at
/// most 0.1 rad ahead of the finger. The finger then moves as after any step of a local planner: its velocity is less
/// than 30/s times the step.
const LARGEST_VELOCITY: f64 = 3.1;

/// While the machine pauses the simulated finger, the set point moves on, and the finger then makes a step. A pause
/// shorter than this leads to a step of less than 0.01 rad.
const TOLERATED_PAUSE: Duration = Duration::from_millis(100);

/// Time over which a velocity is measured, ns. The velocity over a single cycle would mostly show the resolution of the
/// encoders.
const WINDOW: u64 = 20_000_000;

/// What the telemetry of the hand has shown of finger 1.
#[derive(Debug, Default)]
struct Seen {
    /// The set points of joint 1 while the finger followed the planner, one for each cycle, rad.
    set_points: Vec<f64>,
    /// Largest velocity over a window before the end state, rad/s.
    velocity: f64,
    /// The times, ns, and the joint angles, rad, of the cycles in the newest window.
    recent: VecDeque<(u64, [f64; 3])>,
    /// How often the finger was caught: held softly, because the newest Target was too old.
    caught: usize,
    /// Whether the last set point of the ramp is in force.
    arrived: bool,
    /// Whether the finger has gone to its end state.
    ended: bool,
    /// Whether the finger followed the planner in the newest cycle.
    follows: bool,
}

impl Seen {
    /// Notes a cycle. Returns whether the ramp is over.
    fn note(&mut self, sample: &Sample) -> bool {
        self.ended = sample.stage != Stage::Running;
        if !self.ended {
            self.recent.push_back((sample.began, sample.joints));
        }
        while let Some((began, joints)) = self.recent.front().filter(|one| sample.began - one.0 >= WINDOW) {
            let time = (sample.began - began) as f64 * 1e-9;
            let moved = (0..3).map(|joint| (sample.joints[joint] - joints[joint]).abs()).fold(0.0, f64::max);
            self.velocity = self.velocity.max(moved / time);
            self.recent.pop_front();
        }
        let follows = has_stiffness(sample, STIFF);
        self.caught += usize::from(self.follows && !follows);
        self.follows = follows;
        if let (true, Some(set_point)) = (follows, sample.joint_set_point) {
            self.set_points.push(set_point[1]);
            let last = RAMP_BEGIN + RAMP_STEP * f64::from(RAMP_STEPS);
            self.arrived = (set_point[1] - last).abs() < 1e-9;
        }
        self.arrived || self.ended
    }
}

/// Lets the planner close finger 1 in equal steps over a line that `spoil` has spoiled, and returns what the telemetry
/// has shown.
fn ramp(line: Line, name: &str, catch_ms: u32, watch: &PauseWatch, spoil: impl FnOnce(&Line)) -> Seen {
    let mut rig = Rig::new(line, name, catch_ms);
    watch.also(rig.served.process(), Part::Servo);
    let planner = rig.planner(Motion::Ramp);
    let begun = rig.observer.until(BEGINS, |sample| {
        let near = sample.finger.index() == 0 && (sample.joints[1] - RAMP_BEGIN).abs() < 0.02;
        (near && sample.joint_rates.iter().all(|rate| rate.abs() < 0.1)).then_some(())
    });
    assert!(begun.is_some(), "{name}: the finger is not at the beginning of the ramp");
    spoil(&rig.line);
    let mut seen = Seen::default();
    rig.observer.until(RAMP_TIME, |sample| (sample.finger.index() == 0 && seen.note(sample)).then_some(()));
    drop(planner);
    let Seen { set_points, velocity, caught, arrived, ended, .. } = &seen;
    println!(
        "{name}: {} cycles, caught {caught} times, arrived {arrived}, ended {ended}, at most {velocity:.3} rad/s",
        set_points.len()
    );
    seen
}

/// Checks that the planner has sent every set point that was applied, that the set points are in order, and that the
/// finger moves smoothly.
fn check_order(seen: &Seen) -> Result<(), String> {
    // At the moment at which the line is spoiled, the finger follows the planner. It is caught only when the age of the
    // newest Target reaches `catch_ms`, which is at least 100 ms in these tests.
    if seen.set_points.len() < 20 {
        return Err(format!("only {} cycles followed the planner", seen.set_points.len()));
    }
    if let Some(pair) = seen.set_points.windows(2).find(|pair| pair[1] < pair[0]) {
        return Err(format!("{} follows {}", pair[1], pair[0]));
    }
    let sent = |set_point: &&f64| {
        let steps = (*set_point - RAMP_BEGIN) / RAMP_STEP;
        (steps - steps.round()).abs() < 1e-6 && (0.0..=f64::from(RAMP_STEPS)).contains(&steps.round())
    };
    if let Some(set_point) = seen.set_points.iter().find(|set_point| !sent(set_point)) {
        return Err(format!("{set_point} rad was not sent"));
    }
    if seen.velocity >= LARGEST_VELOCITY {
        return Err(format!("{} rad/s", seen.velocity));
    }
    if seen.arrived || seen.ended { Ok(()) } else { Err("neither arrived nor ended".into()) }
}

/// Checks a ramp over a line that `spoil` has spoiled. `seed` is for the random losses and delays of the line. A pause
/// of the machine excuses a failure.
fn stays_in_order(seed: u64, name: &str, catch_ms: u32, spoil: impl Fn(&Line), arrives: bool) {
    attempts(name, TOLERATED_PAUSE, |watch| {
        let Some(line) = permitted_line(seed) else { return Ok(()) };
        let seen = ramp(line, name, catch_ms, watch, &spoil);
        check_order(&seen)?;
        if arrives && !seen.arrived { Err("the last set point has not arrived".into()) } else { Ok(()) }
    });
}

#[test]
fn a_line_that_loses_packets_applies_no_wrong_set_point() {
    for (name, loss) in [("loss-1", 0.01), ("loss-5", 0.05), ("loss-20", 0.2)] {
        // TCP may pause for longer than a second on such a line. Then the hand goes to its end state.
        stays_in_order(21, name, CATCH_MS, |line| _ = line.set_both(Conditions::losing(loss)), false);
    }
}

#[test]
fn a_line_that_delays_packets_applies_no_wrong_set_point() {
    let jitter = Duration::from_millis(50);
    for (name, reorders) in [("jitter", false), ("reordering", true)] {
        let conditions = Conditions::jittering(jitter, reorders);
        stays_in_order(22, name, CATCH_MS, |line| _ = line.set(Direction::Left, conditions), false);
        // With jitter in both directions, a Target can be 100 ms old when it arrives, because the age includes the
        // delays of both directions. The hand then needs a longer `catch_ms`.
        stays_in_order(23, name, 4 * CATCH_MS, |line| _ = line.set_both(conditions), !reorders);
    }
}

#[test]
fn the_planner_moves_as_slowly_as_the_bound_assumes() {
    assert!((RAMP_STEP / INTERVAL.as_secs_f64() - 0.1).abs() < 1e-12);
}
