//! What has changed since the commissioning, and what to do about it.

use crate::commission::Vitals;
use serde::Serialize;
use sun2xp::model::configuration::ConfiguredFinger;

/// Largest change of a gauge zero, N.
const ZERO: f64 = 1.0;
/// Largest change of the zero of an encoder, cm of tendon.
const TRAVEL: f64 = 0.05;
/// Largest relative change of a stiffness.
const STIFFNESS: f64 = 0.1;
/// Largest relative change of a gauge gain.
const GAIN: f64 = 0.05;
/// Largest relative change of a tension at rest.
const TENSION: f64 = 0.25;
/// The noise of a gauge may rise by this factor and in addition by this value, N rms.
const NOISE: (f64, f64) = (2.0, 0.05);
/// Largest rise of the heat of a motor at rest, relative to the heat that it withstands continuously.
const HEAT: f64 = 0.25;
/// Friction may rise by the factor `FRICTION.0` and in addition by a value. This value is `FRICTION.1`, N cm, for
/// motors and joints, and `FRICTION.2` for conduits and pulleys.
const FRICTION: (f64, f64, f64) = (1.5, 0.03, 0.03);

/// A change beyond its limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Complaint {
    /// The kind, for other programs.
    pub kind: &'static str,
    pub part: String,
    pub before: String,
    pub today: String,
    pub advice: &'static str,
}

/// Lists what has changed. A value that is missing on either day is not compared.
pub fn compare(
    before: &Vitals,
    configured: &ConfiguredFinger,
    today: &Vitals,
    found: &ConfiguredFinger,
) -> Vec<Complaint> {
    let mut all = Vec::new();
    zeros(&mut all, before, configured, today);
    stiffnesses(&mut all, before, today);
    frictions(&mut all, before, today);
    gauges_and_tensions(&mut all, before, today, found);
    noise_and_heat(&mut all, (before, configured), (today, found));
    all
}

/// Compares the stiffness of the tendons.
fn stiffnesses(all: &mut Vec<Complaint>, before: &Vitals, today: &Vitals) {
    let values = (before.tendon_stiffness, today.tendon_stiffness);
    let softer = "The tendon ages, frays or slips in its clamp: inspect it, and replace it";
    each(
        all,
        ("tendon_stiffness", "tendon", "N/cm"),
        values,
        |before, today| today < (1.0 - STIFFNESS) * before,
        softer,
    );
    let stiffer = "A tendon becomes stiffer when it is replaced or shortened: commission the finger again: sun2xp \
                   commission --config FILE --finger N --again";
    each(
        all,
        ("stiffer_tendon", "tendon", "N/cm"),
        values,
        |before, today| today > (1.0 + STIFFNESS) * before,
        stiffer,
    );
}

/// Compares the frictions.
fn frictions(all: &mut Vec<Complaint>, before: &Vitals, today: &Vitals) {
    let more = |offset: f64| move |before: f64, today: f64| today > FRICTION.0 * before + offset;
    let rubs = "Lubricate or replace the bearings of the motor; look for a drum that rubs";
    each(
        all,
        ("motor_friction", "friction of motor", "N cm"),
        (before.motor_friction, today.motor_friction),
        more(FRICTION.1),
        rubs,
    );
    let conduit = "Clean, lubricate or replace the conduit of the tendon";
    each(
        all,
        ("conduit_friction", "friction of conduit", ""),
        (before.conduit_friction, today.conduit_friction),
        more(FRICTION.2),
        conduit,
    );
    let pulley = "Clean and lubricate the pulleys of the tendon";
    each(
        all,
        ("pulley_friction", "friction of the pulleys of tendon", ""),
        (before.pulley_friction, today.pulley_friction),
        more(FRICTION.2),
        pulley,
    );
    let joint = "Clean and lubricate the joint";
    each(
        all,
        ("joint_friction", "friction of joint", "N cm"),
        (before.joint_friction, today.joint_friction),
        more(FRICTION.1),
        joint,
    );
}

/// Compares the noise of the gauges, and the heat of the motors at rest.
fn noise_and_heat(
    all: &mut Vec<Complaint>,
    (before, configured): (&Vitals, &ConfiguredFinger),
    (today, found): (&Vitals, &ConfiguredFinger),
) {
    let noisy =
        "Check the cable, the shield and the ground of the gauge, and whether a large current is switched near it";
    each(
        all,
        ("gauge_noise", "noise of gauge", "N rms"),
        (before.gauge_noise, today.gauge_noise),
        |before, today| today > NOISE.0 * before + NOISE.1,
        noisy,
    );
    let hot = "Look for friction, for a joint that something holds, and for a pretension that is too high";
    each(
        all,
        ("motor_heat", "heat at rest, motor", "of the heat at motor.continuous_torque"),
        (heat(before, configured), heat(today, found)),
        |before, today| today > before + HEAT,
        hot,
    );
}

/// Estimates the heat of each winding after a long time at rest, relative to the heat that the motor withstands
/// continuously. The heat is proportional to the square of the torque. The rise of the temperature is proportional to
/// the heat.
fn heat(vitals: &Vitals, finger: &ConfiguredFinger) -> Option<[f64; 4]> {
    let torques = vitals.torques?;
    Some(std::array::from_fn(|motor| (torques[motor] / finger.motor.continuous_torque[motor]).powi(2)))
}

/// Compares the scales of the gauges and the tensions at rest.
fn gauges_and_tensions(all: &mut Vec<Complaint>, before: &Vitals, today: &Vitals, found: &ConfiguredFinger) {
    let relative = |limit: f64| move |before: f64, today: f64| (today / before - 1.0).abs() > limit;
    let gauge = "Calibrate the gauge again with weights: sun2xp commission --config FILE --finger N --step gauges";
    let gains = before.newton_per_count.map(|_| found.gauge.newton_per_count);
    each(all, ("gauge_gain", "scale of gauge", "N per count"), (before.newton_per_count, gains), relative(GAIN), gauge);
    let loose = "Look for friction in the path of the tendon; if its tension has fallen, tension it";
    each(all, ("tension", "tension at rest, tendon", "N"), (before.tensions, today.tensions), relative(TENSION), loose);
}

/// Compares the values of each part.
fn each<const PARTS: usize>(
    all: &mut Vec<Complaint>,
    (kind, part, unit): (&'static str, &str, &str),
    values: (Option<[f64; PARTS]>, Option<[f64; PARTS]>),
    changed: impl Fn(f64, f64) -> bool,
    advice: &'static str,
) {
    let (Some(before), Some(today)) = values else { return };
    // The joints, of which there are three, are numbered from 0. All other parts are numbered from 1.
    let first = usize::from(PARTS > 3);
    for (number, (before, today)) in (first..).zip(before.into_iter().zip(today)) {
        if changed(before, today) {
            let text = |value: f64| format!("{value:.3} {unit}").trim_end().to_owned();
            let (before, today) = (text(before), text(today));
            all.push(Complaint { kind, part: format!("{part} {number}"), before, today, advice });
        }
    }
}

/// Compares the zeros of gauges and encoders.
fn zeros(all: &mut Vec<Complaint>, before: &Vitals, configured: &ConfiguredFinger, today: &Vitals) {
    if let (Some(before), Some(today)) = (before.gauge_zero, today.gauge_zero) {
        for gauge in 0..4 {
            let newton = (today[gauge] - before[gauge]) * configured.gauge.newton_per_count[gauge];
            if newton.abs() > ZERO {
                let advice = "The gauge was overloaded, is loose or drifts: zero it again (sun2xp commission \
                              --config FILE --finger N --step zeros), and replace it if it keeps drifting";
                let part = format!("zero of gauge {}", gauge + 1);
                let (before, today) = ("0 N".into(), format!("{newton:+.1} N"));
                all.push(Complaint { kind: "gauge_zero", part, before, today, advice });
            }
        }
    }
    let (Some(before), Some(today)) = (before.encoder_zero, today.encoder_zero) else { return };
    for motor in 0..4 {
        let turn = std::f64::consts::TAU / f64::from(configured.encoder.counts_per_revolution[motor]);
        let counts = f64::from(today[motor].wrapping_sub(before[motor])) * f64::from(configured.encoder.sign[motor]);
        let travel = counts * turn * configured.geometry.motor_radius[motor];
        if travel.abs() <= TRAVEL {
            continue;
        }
        // With age a tendon only becomes longer, so its motor winds in farther. After the tendon was shortened, the
        // motor winds in less far. An encoder can slip in either direction.
        let (kind, advice) = match travel > 0.0 {
            true => (
                "longer_tendon",
                "The tendon has become longer, because its knot or clamp slips or because it creeps, or the encoder \
                 slipped: tighten the knot or clamp, check the coupling of the encoder, and zero again (sun2xp \
                 commission --config FILE --finger N --step zeros)",
            ),
            false => (
                "encoder_slip",
                "The encoder slipped or lost counts, or the tendon was replaced or shortened: check the coupling and \
                 cable of the encoder, and zero again (sun2xp commission --config FILE --finger N --step zeros); \
                 after work on the tendon, commission the finger again",
            ),
        };
        let part = format!("zero of encoder {}", motor + 1);
        let (before, today) = ("0 mm".into(), format!("{:+.2} mm of tendon", travel * 10.0));
        all.push(Complaint { kind, part, before, today, advice });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn healthy() -> Vitals {
        Vitals {
            gauge_zero: Some([200.0; 4]),
            newton_per_count: Some([100.0 / 4095.0; 4]),
            encoder_zero: Some([1000; 4]),
            gauge_noise: Some([0.02; 4]),
            tensions: Some([7.5, 13.2, 13.2, 7.5]),
            torques: Some([1.0; 4]),
            tendon_stiffness: Some([300.0; 4]),
            motor_friction: Some([0.07; 4]),
            conduit_friction: Some([0.05; 4]),
            pulley_friction: Some([0.0; 4]),
            joint_friction: Some([0.05; 3]),
            ..Vitals::default()
        }
    }

    fn named(change: impl Fn(&mut Vitals)) -> Vec<(&'static str, String)> {
        let (before, finger) = (healthy(), ConfiguredFinger::default());
        let mut today = before.clone();
        change(&mut today);
        compare(&before, &finger, &today, &finger).into_iter().map(|one| (one.kind, one.part)).collect()
    }

    #[test]
    fn small_changes_are_healthy() {
        assert_eq!(named(|_| {}), []);
        let small = named(|today| {
            (today.gauge_zero, today.encoder_zero) = (Some([215.0; 4]), Some([1100; 4]));
            (today.tendon_stiffness, today.motor_friction) = (Some([285.0; 4]), Some([0.09; 4]));
        });
        assert_eq!(small, []);
    }

    #[test]
    fn a_shortened_tendon_is_a_cause_beside_a_slipped_encoder() {
        let (before, finger) = (healthy(), ConfiguredFinger::default());
        let today = Vitals { encoder_zero: Some([1000, 1000, 1000, 400]), ..healthy() };
        let found = compare(&before, &finger, &today, &finger);
        assert!(found[0].advice.contains("slipped") && found[0].advice.contains("shortened"), "{found:?}");
    }

    #[test]
    fn an_ageing_is_named_with_its_part() {
        let only = |kind, part: &str| vec![(kind, part.to_owned())];
        assert_eq!(
            named(|today| today.gauge_zero = Some([200.0, 200.0, 300.0, 200.0])),
            only("gauge_zero", "zero of gauge 3")
        );
        let soft = named(|today| today.tendon_stiffness = Some([300.0, 240.0, 300.0, 300.0]));
        assert_eq!(soft, only("tendon_stiffness", "tendon 2"));
        let replaced = named(|today| today.tendon_stiffness = Some([300.0, 300.0, 360.0, 300.0]));
        assert_eq!(replaced, only("stiffer_tendon", "tendon 3"));
        let slipped = named(|today| today.encoder_zero = Some([1000, 1000, 1000, 400]));
        assert_eq!(slipped, only("encoder_slip", "zero of encoder 4"));
        let longer = named(|today| today.encoder_zero = Some([1600, 1000, 1000, 1000]));
        assert_eq!(longer, only("longer_tendon", "zero of encoder 1"));
        let rubs = named(|today| today.motor_friction = Some([0.07, 0.07, 0.2, 0.07]));
        assert_eq!(rubs, only("motor_friction", "friction of motor 3"));
        let dry = named(|today| today.conduit_friction = Some([0.05, 0.15, 0.05, 0.05]));
        assert_eq!(dry, only("conduit_friction", "friction of conduit 2"));
        let stiff = named(|today| today.joint_friction = Some([0.05, 0.05, 0.2]));
        assert_eq!(stiff, only("joint_friction", "friction of joint 2"));
        let loose = named(|today| today.tensions = Some([4.0, 13.2, 13.2, 7.5]));
        assert_eq!(loose, only("tension", "tension at rest, tendon 1"));
        let noisy = named(|today| today.gauge_noise = Some([0.02, 0.02, 0.02, 0.2]));
        assert_eq!(noisy, only("gauge_noise", "noise of gauge 4"));
        let hot = named(|today| today.torques = Some([1.0, 1.8, 1.0, 1.0]));
        assert_eq!(hot, only("motor_heat", "heat at rest, motor 2"));
    }
}
