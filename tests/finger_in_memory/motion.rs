//! Paths that the whole servo follows: their smoothness, their limits, their replay and their stiffness.

use crate::rig::{Bench, TARGET};
use nalgebra::{Matrix3, Vector3};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;
use sun2xp::control::motion::PathExtent;
use sun2xp::control::{Activity, SetPoint, spatial};
use sun2xp::finger::{CycleRecord, FingerReport, Recording, Reference, Replaced, Stage, Validity};
use sun2xp::hand::{PathError, PathPose, Plan, Pose, plan_path};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;

pub fn configuration() -> Configuration {
    let mut configuration = Configuration::default();
    configuration.fingers[0].port = "in memory".into();
    configuration
}

pub fn plan(reference: &Reference, poses: &[PathPose]) -> Plan {
    plan_path(&configuration(), FingerNumber::ONE, reference, poses).unwrap_or_else(|error| panic!("{error}"))
}

/// Sends a path as the hand does, from the reference of the newest report.
pub fn send(bench: &Bench, poses: &[PathPose]) {
    let report = bench.report();
    deliver(bench, &report, &plan(&report.reference, poses));
}

/// Does the same as [`send`], unless the path is refused. Returns whether it was sent.
pub fn send_if_possible(bench: &Bench, poses: &[PathPose]) -> bool {
    let report = bench.report();
    let plan = plan_path(&configuration(), FingerNumber::ONE, &report.reference, poses);
    plan.map(|plan| deliver(bench, &report, &plan)).is_ok()
}

/// Sends a path that was computed for the reference of `report`.
fn deliver(bench: &Bench, report: &FingerReport, plan: &Plan) {
    let end = plan.end();
    let sent = bench.mailbox.send_path(
        (report.springs, report.reference.period, Validity::default()),
        &plan.table(),
        |set_point| {
            set_point.joints = end;
            Ok::<_, ()>(PathExtent::default())
        },
    );
    assert!(matches!(sent, Ok(Ok(Some(_)))), "{sent:?}");
}

pub fn joints(time: f64, joints: [f64; 3]) -> PathPose {
    PathPose { time, pose: Pose::Joints(joints), stiffness: None }
}

/// Tip positions on a circle of 1 cm radius, with one turn a second. The motion begins and ends gently at `centre` + x.
fn circle(centre: &Vector3<f64>, turns: f64) -> Vec<PathPose> {
    let ramp = 0.5;
    let length = turns + ramp;
    let angle = |time: f64| {
        // The speed rises and falls along a cosine.
        let phase = |time: f64| 0.5 * (time - (TAU * 0.5 * time / ramp).sin() * ramp / (TAU * 0.5));
        if time < ramp {
            TAU * phase(time)
        } else if time < length - ramp {
            TAU * (time - 0.5 * ramp)
        } else {
            TAU * (turns - phase(length - time))
        }
    };
    let count = (length * 20.0).round() as usize;
    (1..=count)
        .map(|index| {
            let time = length * index as f64 / count as f64;
            let (sin, cos) = angle(time).sin_cos();
            let tip = centre + Vector3::new(cos, sin, 0.0);
            PathPose { time, pose: Pose::Tip(tip.into()), stiffness: None }
        })
        .collect()
}

/// The servo's reference in consecutive periods.
pub struct Track(pub Vec<Reference>);

impl Track {
    /// Runs periods and notes the reference of each.
    pub fn run(&mut self, bench: &mut Bench, periods: usize) {
        for _ in 0..periods {
            bench.cycles(1);
            self.0.push(bench.report().reference);
        }
    }

    /// Checks that every derivative of the reference is the slope of the next lower derivative. The check fails if a
    /// derivative jumps by more than these values in a cycle: rates rad/s, accelerations rad/s^2, jerk rad/s^3.
    pub fn is_smooth(&self, [rates, accelerations, jerk]: [f64; 3]) {
        for (index, pair) in self.0.windows(2).enumerate() {
            let (one, next) = (&pair[0], &pair[1]);
            let slope = |from: Vector3<f64>, to: Vector3<f64>| (to - from) * 1000.0;
            let mean = |from: Vector3<f64>, to: Vector3<f64>| (to + from) * 0.5;
            let (motion, later) = (&one.motion, &next.motion);
            let jump = (slope(one.joints, next.joints) - mean(motion.rates, later.rates)).amax();
            assert!(jump < rates, "rate {jump} in period {index}: {one:?} {next:?}");
            let jump = (slope(motion.rates, later.rates) - mean(motion.accelerations, later.accelerations)).amax();
            assert!(jump < accelerations, "acceleration {jump} in period {index}: {one:?} {next:?}");
            let jump = (slope(motion.accelerations, later.accelerations) - mean(motion.jerk, later.jerk)).amax();
            assert!(jump < jerk, "jerk {jump} in period {index}: {one:?} {next:?}");
        }
    }

    /// Returns the largest rate, acceleration and jerk.
    fn largest(&self) -> [f64; 3] {
        let most = |of: fn(&Reference) -> f64| self.0.iter().map(of).fold(0.0, f64::max);
        [
            most(|reference| reference.motion.rates.amax()),
            most(|reference| reference.motion.accelerations.amax()),
            most(|reference| reference.motion.jerk.amax()),
        ]
    }
}

#[test]
fn a_tip_follows_a_circle_without_lag() {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    bench.cycles(1000);
    let links = configuration().fingers[0].links();
    let centre = links.tip(&TARGET) - Vector3::x();
    send(&bench, &circle(&centre, 3.0));
    let mut worst = (0.0f64, 0);
    let mut sum = 0.0;
    for cycle in 0..3500 {
        bench.cycles(1);
        let reference = bench.report().reference;
        let tip = bench.with_finger(|finger| finger.plant().tip());
        let error = (tip - links.tip(&reference.joints)).norm();
        sum += error;
        if error > worst.0 {
            worst = (error, cycle);
        }
    }
    println!("worst lag {:.4} cm in cycle {}, mean {:.4}", worst.0, worst.1, sum / 3500.0);
    assert!(worst.0 < 0.02, "{worst:?}");
}

/// Random paths replace each other at random times, also before their ends, and bare set points come between them.
#[test]
fn whatever_replaces_a_path_the_reference_does_not_jump() {
    let mut random = Pcg64::seed_from_u64(5);
    let mut part = || f64::from(random.next_u32()) / 4_294_967_296.0;
    let mut bench = Bench::new();
    bench.goes(TARGET);
    let mut track = Track(Vec::new());
    let (mut accepted, mut refused) = (0, 0);
    for round in 0..60 {
        let mut pose = || [0.8 * part() - 0.4, 0.8 * part() + 0.2, 0.8 * part() + 0.7];
        if round % 5 == 4 {
            let target = Vector3::from(pose());
            bench.mailbox.send(|set_point| set_point.joints = target).expect("not faulted");
        } else {
            let step = if round % 3 == 0 { 0.2 } else { 0.4 };
            let poses: Vec<PathPose> = (1..=4).map(|index| joints(step * f64::from(index), pose())).collect();
            let report = bench.report();
            match plan_path(&configuration(), FingerNumber::ONE, &report.reference, &poses) {
                Ok(plan) => {
                    // The servo takes the path some periods after it was computed.
                    track.run(&mut bench, [0, 1, 2, 50][round % 4]);
                    deliver(&bench, &report, &plan);
                    accepted += 1;
                }
                Err(error) => {
                    assert!(matches!(error, PathError::TooFast { .. } | PathError::BeyondJointLimit { .. }), "{error}");
                    refused += 1;
                }
            }
        }
        let periods = 50 + (900.0 * part()) as usize;
        track.run(&mut bench, periods);
    }
    println!("{accepted} accepted, {refused} refused, largest {:?}", track.largest());
    assert!(accepted > 20 && refused > 0, "{accepted} {refused}");
    // These limits are wide, because a bare set point moves the input of the reference filter at up to 5 rad/s, and the
    // derivatives of this filter lag by half a cycle.
    track.is_smooth([0.3, 40.0, 12_000.0]);
    assert_eq!(bench.stage(), Stage::Running);
}

#[test]
fn a_path_keeps_its_limits_and_passes_its_poses_at_their_times() {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    bench.cycles(500);
    let poses = [joints(0.5, [0.3, 0.7, 1.2]), joints(0.8, [0.0, 0.9, 1.0]), joints(1.5, [-0.2, 0.4, 1.4])];
    send(&bench, &poses);
    let begin = bench.report().reference.period;
    let mut track = Track(Vec::new());
    track.run(&mut bench, 1600);
    for PathPose { time, pose, .. } in poses {
        let Pose::Joints(expected) = pose else { unreachable!("joint angles") };
        let at = track.0.iter().find(|reference| reference.period == begin + (time * 1000.0) as u64).expect("passed");
        assert!((at.joints - Vector3::from(expected)).amax() < 1e-6, "{at:?} {expected:?}");
    }
    let [rate, acceleration, jerk] = track.largest();
    assert!(rate < 5.0 && acceleration < 100.0 && jerk < 5000.0, "{rate} {acceleration} {jerk}");
    track.is_smooth([1e-3, 0.1, 100.0]);
    let report = bench.report();
    assert_eq!(report.set_point.motion, None);
    assert!((report.set_point.joints - Vector3::new(-0.2, 0.4, 1.4)).amax() < 1e-9);
}

/// Paths that replace each other while they run never exceed the limits that each of them was checked against.
#[test]
fn random_paths_stay_within_their_limits() {
    let mut random = Pcg64::seed_from_u64(7);
    let mut part = || f64::from(random.next_u32()) / 4_294_967_296.0;
    let mut bench = Bench::new();
    bench.goes(TARGET);
    bench.cycles(500);
    let (mut track, mut accepted) = (Track(Vec::new()), 0);
    for round in 0..80 {
        let count = 1 + round % 6;
        let step = 0.25 + 0.2 * part();
        let mut pose = || [1.6 * part() - 0.8, 1.8 * part() - 0.3, 1.6 * part() + 0.3];
        let poses: Vec<PathPose> = (1..=count).map(|index| joints(step * f64::from(index), pose())).collect();
        accepted += usize::from(send_if_possible(&bench, &poses));
        let periods = 20 + (700.0 * part()) as usize;
        track.run(&mut bench, periods);
    }
    let [rate, acceleration, jerk] = track.largest();
    println!("{accepted} accepted: {rate} rad/s, {acceleration} rad/s^2, {jerk} rad/s^3");
    assert!(accepted > 15 && accepted < 80, "{accepted}");
    assert!(rate < 5.001 && acceleration < 100.1 && jerk < 5010.0, "{rate} {acceleration} {jerk}");
    let (low, high) = configuration().fingers[0].joint_limits();
    let inside = |reference: &Reference| {
        (0..3).all(|joint| (low[joint] - 2e-4..high[joint] + 2e-4).contains(&reference.joints[joint]))
    };
    assert!(track.0.iter().all(inside));
}

#[test]
fn a_replay_of_a_path_is_exact() {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    let run = |bench: &mut Bench, poses: &[PathPose]| {
        send(bench, poses);
        for _ in 0..8 {
            bench.cycles(100);
            bench.black_box.collect();
        }
    };
    run(&mut bench, &[joints(0.5, [0.3, 0.7, 1.2]), joints(1.0, [0.0, 0.5, 1.0])]);
    run(&mut bench, &[joints(0.4, [0.3, 0.7, 1.2])]);
    let recording = bench.black_box.recording().expect("a recording");
    let moved = |record: &CycleRecord<String>| match record.control.map(|control| control.input.activity) {
        Some(Activity::Follow(set_point)) => set_point.motion.is_some(),
        _ => false,
    };
    let moving = recording.cycles.iter().filter(|record| moved(record)).count();
    assert!((1000..1300).contains(&moving), "{moving}");
    // A file keeps every bit of the motion.
    let mut file = Vec::new();
    recording.write(&mut file).expect("written");
    let recording = Recording::read(&file[..], "the file").unwrap_or_else(|error| panic!("{error}"));
    let replayed = recording.replay().unwrap_or_else(|error| panic!("{error}"));
    assert!(replayed.different == 0 && replayed.cycles >= 1200, "{replayed:?}");
}

#[test]
fn kx_changes_along_a_path_and_a_later_kx_wins() {
    let kx = |stiffness: f64| Some([[stiffness, 0.0, 0.0], [0.0, stiffness, 0.0], [0.0, 0.0, stiffness]]);
    let poses = [
        PathPose { stiffness: kx(1.0), ..joints(0.5, [0.3, 0.7, 1.2]) },
        joints(1.0, [0.2, 0.6, 1.1]),
        PathPose { stiffness: kx(5.0), ..joints(1.5, [0.3, 0.7, 1.2]) },
    ];
    let mut bench = Bench::new();
    bench.goes(TARGET);
    send(&bench, &poses);
    let at = |bench: &mut Bench, period: u64, begin: u64| {
        bench.until("there", |bench| bench.report().reference.period >= begin + period);
        bench.report().set_point.stiffness[(0, 0)]
    };
    let begin = bench.report().reference.period;
    for (period, expected) in [(250, 2.0), (500, 1.0), (1000, 3.0), (1200, 3.8)] {
        let stiffness = at(&mut bench, period, begin);
        assert!((stiffness - expected).abs() < 0.01, "{stiffness} after {period} ms");
    }
    let soften = |set_point: &mut SetPoint| {
        set_point.stiffness = spatial(&(Matrix3::identity() * 2.0));
        Ok::<(), ()>(())
    };
    bench.mailbox.try_send((Replaced::Stiffness, Validity::default()), soften).expect("not faulted").expect("admitted");
    assert!((at(&mut bench, 1250, begin) - 2.0).abs() < 1e-12);
    assert!(bench.report().set_point.motion.is_some(), "the path continues");
    assert!((at(&mut bench, 1700, begin) - 2.0).abs() < 1e-12);
    assert!((bench.report().set_point.joints - Vector3::new(0.3, 0.7, 1.2)).amax() < 1e-9);
}
