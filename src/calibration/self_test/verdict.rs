//! Determines from the responses of the gauges what is wrong.

use super::holding::{LATE, LENGTH, Responses, expected_rise};
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use crate::model::LinkDynamics;
use nalgebra::{Vector3, Vector4};

/// All rises are compared as fractions of the expected rise. The usual rise is the mean of the middle two of the four
/// gauges. A gauge is dead if its rise is less than `DEAD` times the usual rise. A usual rise below `DEAD` counts as
/// `DEAD`, so that dead gauges are also found if most gauges are dead.
const DEAD: f64 = 0.12;
/// For each of two motors, take the response of the other motor's gauge minus the response of its own gauge, both
/// divided by the largest response to this motor. The two gauges count as swapped if the sum of both differences
/// exceeds this value. The sum is at most 2.
const LEADING: f64 = 0.15;
/// A gauge is reported if its rise differs from the usual rise by more than this fraction: its scale is wrong.
const SCALE: f64 = 0.13;
/// Time step of `predicted`, s. It must be short, because the links vibrate at frequencies up to 80 Hz.
const STEP: f64 = 0.000_25;
/// N cm s^2 in one kg m^2.
const CENTIMETRES: f64 = 100.0;
/// The pretensions distinguish two tendons if the logarithm of the ratio of the pretensions exceeds this value in
/// magnitude.
const DIFFERENT: f64 = 0.2;

/// Returns an error that names the first thing that is wrong: a dead gauge, swapped gauges or tendons, a reversed
/// gauge, or a gauge with a wrong scale. `travel` is the travel of the motors from their zeros, cm.
pub(super) fn judge(
    responses: &Responses,
    instruments: &Instruments,
    dynamics: &LinkDynamics,
    travel: &Vector4<f64>,
) -> Result<(), Obstacle> {
    let number = |index: usize| index as u8 + 1;
    let raised = &responses.raised;
    let usual = median(&raised.abs());
    for gauge in 0..4 {
        if raised[gauge].abs() < DEAD * usual.max(DEAD) {
            let newton = raised[gauge] * expected_rise(instruments)[gauge];
            return Err(Obstacle::SilentGauge { gauge: number(gauge), newton });
        }
    }
    if let Some((one, other)) = swapped_pair(&responses.pulses) {
        let (first, second) = (number(one), number(other));
        return Err(match tendons_are_swapped(responses, (one, other), instruments, dynamics, travel) {
            true => Obstacle::SwappedTendons { first, second },
            false => Obstacle::SwappedGauges { first, second },
        });
    }
    if let Some(gauge) = (0..4).find(|&gauge| raised[gauge] < 0.0) {
        return Err(Obstacle::ReversedGauge { gauge: number(gauge) });
    }
    let scales = raised / usual;
    let worst = scales.add_scalar(-1.0).iamax();
    match (scales[worst] - 1.0) * 100.0 {
        percent if percent.abs() > SCALE * 100.0 => Err(Obstacle::GaugeScale { gauge: number(worst), percent }),
        _ => Ok(()),
    }
}

/// The pair of gauges that respond to each other's motor, if this explains the responses much better than the
/// configured wiring does.
fn swapped_pair(responses: &[Vector4<f64>; 4]) -> Option<(usize, usize)> {
    let share = |motor: usize, gauge: usize| responses[motor][gauge].abs() / responses[motor].amax().max(f64::EPSILON);
    let gain =
        |&(one, other): &(usize, usize)| share(one, other) + share(other, one) - share(one, one) - share(other, other);
    let pairs = (0..4).flat_map(|one| (one + 1..4).map(move |other| (one, other)));
    pairs.max_by(|a, b| gain(a).total_cmp(&gain(b))).filter(|pair| gain(pair) > LEADING)
}

/// Returns whether the tendons of a swapped pair are swapped, and not their gauges. If the gauges are swapped, each of
/// them shows the rise of the other tendon. The two rises differ unless both tendons have the same pretension. With the
/// same pretension, the pulses show which tendon a motor has pulled: each tendon moves the joints in its own way, and
/// this motion slackens some of the other tendons and stretches others.
fn tendons_are_swapped(
    responses: &Responses,
    (one, other): (usize, usize),
    instruments: &Instruments,
    dynamics: &LinkDynamics,
    travel: &Vector4<f64>,
) -> bool {
    let expected = (instruments.pretension[one] / instruments.pretension[other]).ln();
    if expected.abs() > DIFFERENT {
        // Each rise is already divided by the expected rise. If the tendons are swapped, each gauge still shows the
        // expected rise.
        let shown = (responses.raised[one].abs() / responses.raised[other].abs()).ln();
        return shown.abs() < expected.abs() / 2.0;
    }
    let mut swapped_travel = *travel;
    swapped_travel.swap_rows(one, other);
    let joints = |travel| instruments.joints(travel, &instruments.pretension);
    let (right, swapped) = (joints(travel), joints(&swapped_travel));
    let (mut with_gauges, mut with_tendons) = (0.0, 0.0);
    for (motor, tendon) in [(one, other), (other, one)] {
        let response = &responses.late[motor];
        let mut shown = predicted(instruments, dynamics, &right, motor);
        shown.swap_rows(one, other);
        with_gauges += misfit(response, &shown);
        with_tendons += misfit(response, &predicted(instruments, dynamics, &swapped, tendon));
    }
    with_tendons < with_gauges
}

/// Predicts the mean rises of the tensions in the time of [`Responses::late`], up to a common factor. The motor of
/// `tendon` pulls, and all other motors stand still. `joints` are the joint angles, rad.
fn predicted(instruments: &Instruments, dynamics: &LinkDynamics, joints: &Vector3<f64>, tendon: usize) -> Vector4<f64> {
    let r = &instruments.tendons.r;
    let inverse = (dynamics.inertia(joints) * CENTIMETRES).try_inverse().unwrap_or_default();
    let (mut angles, mut rates, mut sum) = (Vector3::zeros(), Vector3::zeros(), Vector4::zeros());
    let mut seconds = 0.0;
    while seconds < LATE.1 {
        seconds += STEP;
        let mut travel = -(r.transpose() * angles);
        // The motor accelerates during the pulse, and keeps its speed after the pulse.
        travel[tendon] += match seconds < LENGTH {
            true => 0.5 * seconds * seconds,
            false => LENGTH * (seconds - 0.5 * LENGTH),
        };
        let tensions = travel.component_div(&instruments.compliance);
        rates += inverse * (r * tensions) * STEP;
        angles += rates * STEP;
        if seconds > LATE.0 {
            sum += tensions;
        }
    }
    sum
}

/// The squared difference between a response and a prediction that is multiplied by the best-fitting factor.
fn misfit(response: &Vector4<f64>, predicted: &Vector4<f64>) -> f64 {
    let factor = response.dot(predicted) / predicted.norm_squared().max(f64::MIN_POSITIVE);
    (response - predicted * factor).norm_squared()
}

/// The mean of the middle two of four values.
fn median(values: &Vector4<f64>) -> f64 {
    (values.sum() - values.min() - values.max()) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::ConfiguredFinger;

    #[test]
    fn no_gauge_is_right_if_all_are_dead() {
        let finger = ConfiguredFinger::default();
        let instruments = Instruments::new(&finger, 1000.0).expect("usable");
        let (masses, radii) = (finger.links.masses, finger.links.radii);
        let dynamics = LinkDynamics::new(finger.links(), masses, radii, Vector3::zeros());
        let judged = |raised: f64| {
            let responses = Responses { raised: Vector4::repeat(raised), ..Responses::default() };
            judge(&responses, &instruments, &dynamics, &Vector4::zeros())
        };
        // The rise of dead gauges is zero, apart from rounding.
        for raised in [0.0, 1e-15] {
            let found = judged(raised);
            assert!(matches!(found, Err(Obstacle::SilentGauge { gauge: 1, .. })), "{found:?}");
        }
        assert!(judged(1.0).is_ok() && judged(0.3).is_ok(), "a common error of the scales was refused");
    }
}
