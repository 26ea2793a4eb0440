//! Tests that calibration finds the signs of motors, encoders and gauges.

use crate::bench::Bench;
use sun2xp::calibration::{Findings, Task};
use sun2xp::model::configuration::ConfiguredFinger;

#[test]
fn every_sign_is_found_with_tight_and_with_slack_tendons() {
    for rate in [500.0, 1000.0, 2000.0] {
        for pattern in 0..8u8 {
            let sign =
                |seed: u8| std::array::from_fn(|i| if (pattern.wrapping_mul(seed) >> i) & 1 == 1 { -1i8 } else { 1 });
            let mut truth = ConfiguredFinger::default();
            truth.motor.sign = sign(37);
            truth.encoder.sign = sign(91);
            let falling = sign(53);
            for (tendon, sign) in falling.into_iter().enumerate() {
                truth.gauge.newton_per_count[tendon] *= f64::from(sign);
                truth.gauge.zero[tendon] = if sign < 0 { 4000.0 } else { 0.0 };
            }
            let mut bench = Bench::new(&truth, &ConfiguredFinger::default(), rate);
            let before = bench.plant.joints();
            if pattern % 2 == 1 {
                (0..4).for_each(|motor| bench.plant.turn_motor(motor, -1.0 - 0.7 * motor as f64));
            }
            let found = bench.calibrate(Task::Signs);
            let Ok(Findings::Signs(found)) = found else { panic!("{rate} Hz, {pattern}: {found:?}") };
            assert_eq!(found.motor, truth.motor.sign, "{rate} Hz, {pattern}");
            assert_eq!(found.encoder, truth.encoder.sign, "{rate} Hz, {pattern}");
            assert_eq!(found.gauge, falling, "{rate} Hz, {pattern}");
            assert!(bench.largest_tension < 20.0, "{rate} Hz, {pattern}: {}", bench.largest_tension);
            let moved = (bench.plant.joints() - before).amax();
            assert!(moved < 0.6, "{rate} Hz, {pattern}: {moved}");
        }
    }
}
