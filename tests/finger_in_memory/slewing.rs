//! Tests of the motion of the anchor (rest position) of the finger's spring toward a set point: the reported reference
//! while the speed is limited, a path that begins during the motion, and a short interpolation.

use crate::motion::{Track, joints, send};
use crate::rig::{Bench, TARGET};
use nalgebra::Vector3;
use sun2xp::finger::Stage;
use sun2xp::model::configuration::Scheme;

#[test]
fn a_slewing_anchor_is_reported_with_its_rates() {
    for scheme in [Scheme::Figure9, Scheme::Figure10, Scheme::Figure11] {
        let mut bench = Bench::with(|configuration| {
            configuration.fingers.iter_mut().for_each(|finger| finger.controller.scheme = Some(scheme));
        });
        bench.opens();
        bench.goes(TARGET);
        bench.mailbox.send(|set_point| set_point.joints = TARGET + Vector3::new(0.2, 0.1, 0.0)).expect("not faulted");
        let mut track = Track(Vec::new());
        track.run(&mut bench, 600);
        let mut fastest = 0.0f64;
        for pair in track.0.windows(2) {
            let slope = (pair[1].joints - pair[0].joints) * 1000.0;
            let rates = pair[0].motion.rates;
            // The set point takes effect in one of these periods. The rates of the period before it are still zero.
            assert!((slope - rates).amax() < 1e-9 || rates == Vector3::zeros(), "{scheme:?}: {rates} and {slope}");
            fastest = fastest.max(rates.amax());
        }
        assert!(fastest > 1.0, "{scheme:?}: {fastest} rad/s");
        let last = track.0.last().expect("600 periods");
        assert!(last.motion.rates.amax() == 0.0, "{scheme:?}: {last:?}");
    }
}

/// If a path of 30 s were one polynomial that begins with the acceleration of the anchor, it would lead far beyond the
/// joint limits. The finger therefore first brakes to rest.
#[test]
fn a_slow_path_begins_smoothly_while_the_finger_settles() {
    for cycles in [5, 20, 50, 100] {
        let mut bench = Bench::new();
        bench.opens();
        bench.goes(TARGET);
        let step = TARGET + Vector3::new(0.1, -0.1, 0.05);
        bench.mailbox.send(|set_point| set_point.joints = step).expect("not faulted");
        bench.cycles(cycles);
        send(&bench, &[joints(30.0, [0.4, 0.9, 1.2])]);
        let mut track = Track(Vec::new());
        track.run(&mut bench, 1000);
        track.is_smooth([0.3, 40.0, 12_000.0]);
        let farthest = track.0.iter().map(|reference| (reference.joints - TARGET).amax()).fold(0.0, f64::max);
        assert!(farthest < 0.3, "{cycles}: {farthest} rad");
    }
}

/// The acceleration and the jerk of an interpolated set point are fed forward. The motion to the set point has several
/// steps, each of which lasts three times `interpolate_ms`. With the default largest tension of 60 N, steps of 3 ms or
/// 6 ms would cause the fault OVER_TENSION. An `interpolate_ms` below 10 ms therefore acts as 10 ms.
#[test]
fn a_far_set_point_with_a_short_interpolation_does_not_overload_the_tendons() {
    for interpolate_ms in [1.0, 2.0] {
        let mut bench = Bench::with(|is| is.fingers[0].motion.interpolate_ms = Some(interpolate_ms));
        bench.goes(TARGET);
        let far = TARGET + Vector3::new(0.0, 0.3, 0.0);
        bench.mailbox.send(|set_point| set_point.joints = far).expect("not faulted");
        for _ in 0..300 {
            bench.cycles(1);
            let report = bench.report();
            let tension = report.cycle.tensions.max();
            assert!(report.stage == Stage::Running && tension < 40.0, "{interpolate_ms} ms: {tension} N");
        }
        bench.goes(far);
    }
}
