//! Measures timed motion: the table of `docs/motion.md`.
//!
//!     cargo bench --bench motion
//!
//! The default finger runs with its whole servo and its simulated board, in memory and in simulated time. The wanted
//! motion determines one point for each period. The lag is the distance of the true tip from the point for the same
//! period.

#[allow(dead_code)]
#[path = "../../tests/common/finger_on_a_cable.rs"]
mod finger_on_a_cable;

use finger_on_a_cable::{Hooks, ServedFinger, World};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{PI, TAU};
use sun2xp::control::motion::PathExtent;
use sun2xp::control::spatial;
use sun2xp::finger::{Reference, Stage, Validity};
use sun2xp::hand::{PathPose, Pose, plan_path};
use sun2xp::model::configuration::{Configuration, OutOfRange};
use sun2xp::model::{FingerNumber, InverseKinematics};

/// The pose at which the circle begins, rad.
const START: Vector3<f64> = Vector3::new(0.2, 0.6, 1.1);

/// Time in which the speed along the circle rises, and time in which it falls, s.
const RAMP: f64 = 0.5;

const TURNS: f64 = 3.0;

struct Plain;

impl Hooks for Plain {}

/// A finger that holds [`START`] with 3 N/cm.
struct Bench {
    world: World<Plain>,
    served: ServedFinger<World<Plain>>,
    configuration: Configuration,
}

impl Bench {
    fn new(change: impl FnOnce(&mut Configuration)) -> Self {
        let mut configuration = Configuration::default();
        configuration.fingers[0].port = "in memory".into();
        change(&mut configuration);
        let world = World::new(&configuration, Plain);
        let served = ServedFinger::new(&world, &configuration);
        let mut bench = Self { world, served, configuration };
        while bench.served.mailbox.report().stage != Stage::Running {
            bench.served.servo.cycle();
        }
        bench.send(START);
        bench.run(3.0, |_, _| {});
        bench
    }

    fn send(&self, joints: Vector3<f64>) {
        let stiffness = spatial(&(Matrix3::identity() * 3.0));
        let change = |set_point: &mut sun2xp::control::SetPoint| {
            (set_point.joints, set_point.stiffness) = (joints, stiffness);
        };
        self.served.mailbox.send(change).expect("the finger is healthy");
    }

    fn send_path(&self, poses: &[PathPose]) {
        let report = self.served.mailbox.report();
        let plan = plan_path(&self.configuration, FingerNumber::ONE, &report.reference, poses);
        let plan = plan.unwrap_or_else(|error| panic!("{error}"));
        let origin = (report.springs, report.reference.period, Validity::default());
        let sent = self.served.mailbox.send_path(origin, &plan.table(), |set_point| {
            set_point.joints = plan.end();
            Ok::<_, ()>(PathExtent::default())
        });
        assert!(matches!(sent, Ok(Ok(Some(_)))));
    }

    /// Runs for some seconds. `note` gets the reference and the true tip of every period.
    fn run(&mut self, seconds: f64, mut note: impl FnMut(&Reference, Vector3<f64>)) {
        for _ in 0..(seconds * self.configuration.hand.rate) as usize {
            self.served.servo.cycle();
            let mut place = self.world.place();
            let tip = place.cable.board().finger(1).expect("finger 1").plant().tip();
            note(&self.served.mailbox.report().reference, tip);
        }
    }

    fn tip(&self, joints: &Vector3<f64>) -> Vector3<f64> {
        self.configuration.fingers[0].links().tip(joints)
    }

    fn inverse(&self) -> InverseKinematics {
        let finger = &self.configuration.fingers[0];
        InverseKinematics::new(finger.links(), finger.joint_limits())
    }

    fn centre(&self) -> Vector3<f64> {
        self.tip(&START) - Vector3::x()
    }
}

/// Returns how many turns are completed after some seconds. The motion begins and ends at rest. Between its two ramps
/// it makes one turn a second.
fn turns(seconds: f64) -> f64 {
    let ramp = |seconds: f64| 0.5 * (seconds - (PI * seconds / RAMP).sin() * RAMP / PI);
    let length = TURNS + RAMP;
    if seconds < RAMP {
        ramp(seconds)
    } else if seconds > length - RAMP {
        TURNS - ramp((length - seconds).max(0.0))
    } else {
        seconds - 0.5 * RAMP
    }
}

fn on_circle(centre: &Vector3<f64>, turns: f64) -> Vector3<f64> {
    let (sin, cos) = (TAU * turns).sin_cos();
    centre + Vector3::new(cos, sin, 0.0)
}

/// Worst and mean distance of the tip from its wanted place in the same period, cm.
struct Lag {
    worst: f64,
    sum: f64,
    count: f64,
}

impl Lag {
    fn new() -> Self {
        Self { worst: 0.0, sum: 0.0, count: 0.0 }
    }

    fn note(&mut self, distance: f64) {
        self.worst = self.worst.max(distance);
        self.sum += distance;
        self.count += 1.0;
    }

    fn row(&self, what: &str) {
        println!("| {what} | {:.3} mm worst, {:.3} mm mean |", 10.0 * self.worst, 10.0 * self.sum / self.count);
    }
}

/// The circle as a path of tip positions.
fn circle_as_path(rate: f64) {
    let mut bench = Bench::new(|configuration| configuration.hand.rate = rate);
    let centre = bench.centre();
    let length = TURNS + RAMP;
    let poses: Vec<PathPose> = (1..=70)
        .map(|index| {
            let time = length * f64::from(index) / 70.0;
            let pose = Pose::Tip(on_circle(&centre, turns(time)).into());
            PathPose { time, pose, stiffness: None }
        })
        .collect();
    bench.send_path(&poses);
    let (mut lag, mut time) = (Lag::new(), 0.0);
    bench.run(length + 0.2, |_, tip| {
        time += 1.0 / rate;
        lag.note((tip - on_circle(&centre, turns(time.min(length)))).norm());
    });
    lag.row(&format!("circle as a path, {rate} Hz: lag"));
}

/// The circle as set points that a planner sends in every period.
fn circle_as_set_points() {
    let mut bench = Bench::new(|_| {});
    let (centre, inverse) = (bench.centre(), bench.inverse());
    let mut lag = Lag::new();
    for cycle in 1..3500 {
        let wanted = on_circle(&centre, turns(f64::from(cycle) * 1e-3));
        bench.send(inverse.joints(&wanted, &START).expect("within reach"));
        bench.run(1e-3, |_, tip| lag.note((tip - wanted).norm()));
    }
    lag.row("circle as a set point in every period, 1000 Hz: lag");
}

/// The circle as a stream of ten set points a second.
fn stream(interpolate_ms: Option<f64>) {
    let mut bench = Bench::new(|configuration| configuration.fingers[0].motion.interpolate_ms = interpolate_ms);
    let (centre, inverse) = (bench.centre(), bench.inverse());
    let links = bench.configuration.fingers[0].links();
    let mut velocities = Vec::new();
    for step in 1..=40 {
        let wanted = on_circle(&centre, f64::from(step) * 0.1);
        bench.send(inverse.joints(&wanted, &START).expect("within reach"));
        bench.run(0.1, |reference, _| {
            velocities.push(links.jacobian(&reference.joints) * reference.motion.rates);
        });
    }
    let steady = &velocities[1000..];
    let mean = steady.iter().map(|velocity| velocity.norm()).sum::<f64>() / steady.len() as f64;
    let jump = steady.windows(2).map(|pair| (pair[1] - pair[0]).norm()).fold(0.0, f64::max);
    let least = steady.iter().map(|velocity| velocity.norm()).fold(f64::INFINITY, f64::min);
    let most = steady.iter().map(|velocity| velocity.norm()).fold(0.0, f64::max);
    let how = interpolate_ms.map_or("no interpolation".into(), |time| format!("interpolate_ms = {time}"));
    println!(
        "| 10 Hz stream along the circle, {how}: largest change of the velocity from one cycle to the next, and \
         range of the speed | {:.1} %, and {:.0} % to {:.0} % of the mean speed |",
        100.0 * jump / mean,
        100.0 * least / mean,
        100.0 * most / mean
    );
}

/// A motion of all joints to and fro, as fast as the limits of `[finger.motion]` permit.
fn at_the_limits() {
    let mut bench = Bench::new(|configuration| configuration.hand.out_of_range = OutOfRange::Clamp);
    let target = |way: f64| Pose::Joints((START + Vector3::new(-1.0, 1.0, 1.0) * way).into());
    for (way, name) in [(0.1, "0.1 rad"), (0.4, "0.4 rad")] {
        let poses =
            [(0.001, target(way)), (0.002, target(0.0))].map(|(time, pose)| PathPose { time, pose, stiffness: None });
        bench.send_path(&poses);
        let links = bench.configuration.fingers[0].links();
        let (mut lag, mut least, mut rate) = (Lag::new(), f64::INFINITY, 0.0f64);
        for _ in 0..1500 {
            bench.run(1e-3, |reference, tip| {
                lag.note((tip - links.tip(&reference.joints)).norm());
                rate = rate.max(reference.motion.rates.amax());
            });
            least = least.min(bench.served.mailbox.report().cycle.torque_scale);
        }
        lag.row(&format!(
            "all joints by {name} to and fro at the default limits, up to {rate:.1} rad/s, torque never scaled below \
             {:.0} %: lag",
            100.0 * least
        ));
    }
}

fn main() {
    println!("| what | measured |\n|---|---|");
    circle_as_set_points();
    [1000.0, 2000.0, 500.0].into_iter().for_each(circle_as_path);
    stream(None);
    stream(Some(100.0));
    at_the_limits();
}
