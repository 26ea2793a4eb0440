//! Dither of the tensions that causes no joint torque. It keeps the tendons sliding in their conduits and on their
//! pulleys.
//!
//! At a tension t at the gauge, the friction p of a pulley permits any tension between t / (1 + p) and t (1 + p) at the
//! joint, depending on the last direction of sliding. The gauge does not measure the difference. If t oscillates by
//! more than p t, the tendon slides in both directions in every period, and the mean tension at the joint equals that
//! at the gauge. The oscillation is along the null vector n of R, so that it does not move the joints.

use super::dither_burst::{DitherBurst, DitherBurstState};
use super::dither_scale::{DitherScale, DitherScaleState};
use super::numbers::Numbers;
use nalgebra::{Matrix3, Vector2, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// Largest amplitude as a fraction of each tension, so that no tendon becomes slack.
const LARGEST: f64 = 0.4;

/// Tension below which a tendon is almost slack, as a fraction of t_min. The commanded amplitude then falls quickly.
const LOW: f64 = 0.4;
/// A burst, the large dither after a fast motion ([`DitherBurst`]), suspends the adjustment of the command until the
/// envelope of the burst is below this value.
const ENDED: f64 = 0.02;

/// Factor on the amplitude of a burst if the pulley friction raises the wanted dither above
/// [`Numbers::tension_dither`]. With less pulley friction, a larger burst would delay the end of a step.
const RUBBING_BURST: f64 = 2.0;

/// Factor per cycle of an amplitude that falls quickly.
const FALLING: f64 = 0.97;

/// Time constant of the filter that measures the amplitude, s.
const MEASURING: f64 = 0.05;
/// Time constant with which the amplitude is adjusted, s.
const ADJUSTING: f64 = 0.25;
/// Range of the adjustment.
const SCALES: [f64; 2] = [0.2, 3.0];

/// Largest result of [`TensionDither::reserve`], as a fraction of its `minimum`.
const MOST_RESERVE: f64 = 1.5;
/// The reserve raises no tension above this fraction of the largest permitted one while the joint torque is zero.
const RESERVED: f64 = 0.4;

/// The tensions b n sin(omega t). b is the smallest amplitude that reaches the wanted fraction of the tension in every
/// tendon.
///
/// Friction, inertia and delay of the motors change the amplitude that a command causes. So the amplitude is measured,
/// and the command is adjusted until the measured amplitude is the wanted one.
#[derive(Clone, Debug)]
pub(crate) struct TensionDither {
    /// n: unit vector of the tensions that cause no joint torque.
    common: Vector4<f64>,
    /// 1 / n.
    inverse_common: Vector4<f64>,
    /// Wanted amplitude of each tendon as a fraction of its tension, divided by n.
    part: Vector4<f64>,
    /// Like `part`, but for the smallest amplitude to which [`DitherScale`] may reduce the wanted one.
    least: Vector4<f64>,
    /// Largest tension of each tendon, N.
    most: Vector4<f64>,
    /// Tension below which the amplitude falls quickly, N.
    low: f64,
    /// The dither of a burst lowers no desired tension to less than this, N.
    lowest: f64,
    measuring: f64,
    adjusting: f64,
    /// See [`Numbers::dither_reserve`].
    reserve: f64,
    /// Largest b, N. See [`Numbers::dither_rise`].
    risen: f64,
    burst: DitherBurst,
    /// Set only if the pulley friction raises the wanted dither above [`Numbers::tension_dither`].
    scaling: Option<DitherScale>,
    /// Largest b of a burst, N. The limit [`TensionDither::risen`] does not apply to it. If this b grew with the
    /// tensions, the dither of loaded fingers would make tendons slack at hard walls.
    burst_amplitude: f64,
}

/// The measured amplitude and its adjustment.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct TensionDitherState {
    /// Components of the measured oscillation along n, in phase with the command and a quarter period ahead, N.
    measured: Vector2<f64>,
    /// Commanded amplitude divided by the wanted one.
    scale: f64,
    #[serde(default)]
    burst: DitherBurstState,
    #[serde(default)]
    scaling: DitherScaleState,
}

impl TensionDither {
    /// Constructs the dither. `common` is n. `pulley` is the friction of the pulleys. `torques` has, for each joint,
    /// the sum of the magnitudes of the torques of the four tendons at the pretension, N cm. `lowest` and `most`
    /// are the members with these names, and `minimum` is t_min, N.
    pub fn new(
        common: Vector4<f64>,
        numbers: &Numbers,
        (pulley, torques): (&Vector4<f64>, &Vector3<f64>),
        (lowest, most): (f64, Vector4<f64>),
        minimum: f64,
        rate: f64,
    ) -> Self {
        let inverse_common = common.map(f64::recip);
        let least = numbers.tension_dither.min(LARGEST);
        let wanted =
            |friction: f64| if least > 0.0 { (numbers.pulley_excess * friction).clamp(least, LARGEST) } else { 0.0 };
        let part = pulley.map(wanted).component_mul(&inverse_common);
        // Tensions without joint torque are proportional to n, and the lowest of them is t_min.
        let pretension = minimum / common.min();
        let unloaded = part.component_mul(&common).max() * pretension;
        let rubs = numbers.pulley_excess * pulley.max() > least;
        let burst_part = if rubs { RUBBING_BURST * numbers.dither_burst } else { numbers.dither_burst };
        Self {
            common,
            inverse_common,
            part,
            least: inverse_common * least,
            risen: if rubs { f64::INFINITY } else { numbers.dither_rise * unloaded },
            most,
            low: LOW * minimum,
            lowest,
            measuring: 1.0 / (MEASURING * rate),
            adjusting: 1.0 / (ADJUSTING * rate),
            reserve: numbers.dither_reserve,
            burst: DitherBurst::new(torques, rate),
            scaling: rubs.then(|| DitherScale::new(torques, rate)),
            burst_amplitude: if least > 0.0 { burst_part * pretension } else { 0.0 },
        }
    }

    /// Returns by how much the lowest desired tension must be raised to make room for the dither, N. `minimum` is this
    /// tension before it is raised, and `maximum` is the largest permitted tension of each tendon, N.
    pub fn reserve(&self, minimum: f64, maximum: &Vector4<f64>) -> f64 {
        let amplitude = self.part.component_mul(&self.common).max();
        // Tensions without joint torque are proportional to n.
        let fits = RESERVED * maximum.component_div(&self.common).min() * self.common.min() - minimum;
        ((self.reserve * amplitude).min(MOST_RESERVE) * minimum).min(fits).max(0.0)
    }

    pub fn start(&self) -> TensionDitherState {
        TensionDitherState {
            measured: Vector2::zeros(),
            scale: 1.0,
            burst: DitherBurstState::default(),
            scaling: DitherScaleState::default(),
        }
    }

    /// Returns the largest b with which no tension changes by more than `room`, N.
    fn within(&self, room: &Vector4<f64>) -> f64 {
        room.component_mul(&self.inverse_common).min()
    }

    /// Returns the amplitude of each tendon, N. `desired` are the tensions without dither, `now` the present ones, N.
    /// `phase` contains the sine and the cosine of omega t. `rates` are the joint rates of the reference, rad/s,
    /// `sprung` is the joint torque of the spring, N cm, and `k_theta` is its stiffness, N cm/rad.
    pub fn advance(
        &self,
        state: &mut TensionDitherState,
        (desired, now): (&Vector4<f64>, &Vector4<f64>),
        phase: &Vector2<f64>,
        (rates, sprung, k_theta): (&Vector3<f64>, &Vector3<f64>, &Matrix3<f64>),
    ) -> Vector4<f64> {
        let slack = now.min() < self.low;
        let burst = self.burst.advance(&mut state.burst, rates, sprung, slack);
        let mut wanted = self.part.component_mul(desired).max();
        if let Some(scaling) = &self.scaling {
            wanted *= scaling.advance(&mut state.scaling, k_theta, self.burst.touches(sprung));
            wanted = wanted.max(self.least.component_mul(desired).max());
        }
        let room = self.within(&(desired * LARGEST).inf(&(self.most - desired)));
        let wanted = wanted.min(room).min(self.risen);
        if wanted <= 0.0 {
            return Vector4::zeros();
        }
        // The factor 2: the mean of a sin^2(omega t) is a / 2, and the filter below takes this mean.
        let deviation = 2.0 * self.common.dot(&(now - desired));
        state.measured += (phase * deviation - state.measured) * self.measuring;
        if burst < ENDED {
            let missing = 1.0 - state.measured.norm() / wanted;
            // At a wall, the motors with the most friction do not follow. A larger command would make the others turn
            // the joints.
            let most = if self.burst.waits(&state.burst, rates) { 0.0 } else { 1.0 };
            state.scale += missing.max(-1.0).min(most) * self.adjusting;
        }
        let scale = if slack { state.scale * FALLING } else { state.scale };
        state.scale = scale.clamp(SCALES[0], SCALES[1]);
        let amplitude = wanted * state.scale;
        let most = (self.burst_amplitude * state.scale).min(self.within(&desired.add_scalar(-self.lowest))).min(room);
        self.common * (amplitude + (most - amplitude).max(0.0) * burst)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::state_feedback::dither::Dither;
    use crate::model::configuration::{ConfiguredController, ConfiguredFinger};
    use nalgebra::Vector3;

    const RATE: f64 = 1000.0;

    fn home() -> Vector4<f64> {
        ConfiguredFinger::default().tendons().expect("the default tendons").pretension(5.0)
    }

    fn dither(least: f64, pulley: f64) -> TensionDither {
        let configured = ConfiguredController { tension_dither: Some(least), ..ConfiguredController::default() };
        let numbers = Numbers::new(&configured, RATE).expect("usable numbers");
        let (pulley, torques) = (Vector4::repeat(pulley), Vector3::repeat(20.0));
        TensionDither::new(home().normalize(), &numbers, (&pulley, &torques), (5.0, Vector4::repeat(60.0)), 5.0, RATE)
    }

    /// Runs the dither for `time` (s) on tensions that follow it with the gain `response`, with a reference of this
    /// rate, rad/s, and a spring of this torque, N cm. Returns the largest deviations from `desired` at the end, N.
    fn run(
        dither: &TensionDither,
        state: &mut TensionDitherState,
        (desired, response): (&Vector4<f64>, f64),
        (rate, torque): (f64, f64),
        time: f64,
    ) -> Vector4<f64> {
        let phasor = Dither::new(Vector3::zeros(), 40.0, RATE);
        let mut phase = phasor.start();
        let (mut now, mut largest) = (*desired, Vector4::zeros());
        let cycles = (time * RATE) as usize;
        for cycle in 0..cycles {
            phasor.advance(&mut phase);
            let phase = phasor.phase(&phase);
            let firm = Matrix3::from_diagonal_element(40.0);
            let moving = (&Vector3::repeat(rate), &Vector3::repeat(torque), &firm);
            let amplitude = dither.advance(state, (desired, &now), &phase, moving);
            now = desired + amplitude * (response * phase.x);
            if cycle + 100 >= cycles {
                largest = largest.sup(&(now - desired));
            }
        }
        largest
    }

    /// Runs the dither for two seconds at rest.
    fn followed(dither: &TensionDither, desired: &Vector4<f64>, response: f64) -> Vector4<f64> {
        run(dither, &mut dither.start(), (desired, response), (0.0, 0.0), 2.0)
    }

    #[test]
    fn the_measured_amplitude_becomes_the_wanted_one() {
        let desired = home() * 1.5;
        for response in [0.5, 1.0, 2.0] {
            let found = followed(&dither(0.06, 0.0), &desired, response).component_div(&desired);
            assert!(found.iter().all(|part| (part - 0.06).abs() < 0.004), "{response}: {found}");
            let found = followed(&dither(0.06, 0.02), &desired, response).component_div(&desired);
            assert!(found.iter().all(|part| (part - 0.1).abs() < 0.006), "{response}: {found}");
        }
        assert_eq!(followed(&dither(0.0, 0.1), &desired, 1.0), Vector4::zeros());
        // After a fast motion into a wall, the command does not grow.
        let (dither, mut state) = (dither(0.06, 0.0), dither(0.06, 0.0).start());
        run(&dither, &mut state, (&desired, 1.0), (4.0, 50.0), 0.5);
        let found = run(&dither, &mut state, (&desired, 0.5), (0.0, 50.0), 2.0).component_div(&desired);
        assert!(found.max() < 0.04, "{found}");
    }

    #[test]
    fn the_oscillation_causes_no_joint_torque_and_leaves_room_to_both_bounds() {
        let finger = ConfiguredFinger::default();
        let r = finger.tendons().expect("the default tendons").r;
        for (extra, pulley) in [([0.0; 4], 0.1), ([30.0, 0.0, 0.0, 10.0], 0.1), ([50.0, 0.0, 0.0, 0.0], 0.05)] {
            let desired = home() + Vector4::from(extra);
            let found = followed(&dither(0.06, pulley), &desired, 1.0);
            assert!((r * found).amax() < 1e-9 * (1.0 + found.amax()), "{found}");
            assert!((desired - found).min() >= 0.55 * 5.0, "{found}");
            assert!((desired + found).max() <= 60.0 + 1e-9, "{found}");
        }
    }

    #[test]
    fn the_end_of_a_motion_raises_the_amplitude_as_far_as_there_is_room() {
        let after_a_motion = |least, desired: Vector4<f64>| {
            let dither = dither(least, 0.0);
            let mut state = dither.start();
            run(&dither, &mut state, (&desired, 1.0), (4.0, 0.0), 0.5);
            run(&dither, &mut state, (&desired, 1.0), (0.0, 0.0), 0.1).component_div(&home())
        };
        let found = after_a_motion(0.06, home() * 1.5);
        assert!(found.iter().all(|part| (part - 0.35).abs() < 0.02), "{found}");
        let found = after_a_motion(0.06, home() * 1.2);
        assert!(found.max() <= 0.2 + 1e-9, "{found}");
        assert_eq!(after_a_motion(0.0, home() * 1.5), Vector4::zeros());
    }

    #[test]
    fn the_reserve_makes_room_and_fits_below_the_largest_tension() {
        let reserve = |least, pulley, most| dither(least, pulley).reserve(5.0, &Vector4::repeat(most));
        assert!((reserve(0.06, 0.0, 60.0) - 1.6).abs() < 1e-9);
        assert!((reserve(0.06, 0.1, 60.0) - 7.5).abs() < 1e-9);
        assert_eq!((reserve(0.0, 0.1, 60.0), reserve(0.06, 0.1, 20.0)), (0.0, 0.0));
        let pretension = home() * ((5.0 + reserve(0.06, 0.1, 40.0)) / 5.0);
        assert!(pretension.max() <= RESERVED * 40.0 + 1e-9);
    }
}
