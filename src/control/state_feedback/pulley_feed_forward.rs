//! Feed-forward of the friction of the pulleys. The gauges do not measure this friction.

use super::numbers::Numbers;
use nalgebra::Vector4;

/// The feed-forward is p t (s sat(v / c) + e w), limited to s p t, N. p is the friction of the pulleys as a fraction of
/// the tension t, s is the share of the friction that is fed forward, and e is [`Numbers::creep_slope`].
///
/// v is the speed that a tendon has at the joints if they follow the reference, and c the speed from which the share is
/// fed forward in full. Only configured friction is fed forward: on a finger without this friction, a feed-forward
/// makes steps overshoot.
///
/// w is the observed speed of the tendon, low-pass filtered, while the reference is at rest. A finger that was pushed
/// or has ended a step creeps toward its rest position, because the dither keeps the tendons sliding on the pulleys,
/// whose friction then acts like viscous friction. The second term compensates a part of this viscous friction. It is
/// small, because it is a negative damping if the friction is smaller than configured.
#[derive(Clone, Debug)]
pub(crate) struct PulleyFeedForward {
    /// p s.
    fraction: Vector4<f64>,
    /// 1 / c, s/m.
    per_full_speed: f64,
    /// p e, s/m.
    slope: Vector4<f64>,
    /// Gain per cycle of the low-pass filter.
    gain: f64,
}

impl PulleyFeedForward {
    /// `pulley` is the friction of the pulleys as a fraction of the tension. `rate` is the rate of the servo, Hz.
    /// Returns None if there is nothing to feed forward.
    pub fn new(pulley: &Vector4<f64>, numbers: &Numbers, rate: f64) -> Option<Self> {
        (pulley.max() > 0.0 && numbers.pulley_share > 0.0).then(|| Self {
            fraction: pulley * numbers.pulley_share,
            per_full_speed: numbers.pulley_creep.recip(),
            slope: pulley * numbers.creep_slope,
            gain: -(-numbers.creep_bandwidth / rate).exp_m1(),
        })
    }

    /// Returns the additional tensions at the joints, N. `creep` is w, `reference` is v, and `speeds` are the observed
    /// speeds of the tendons, m/s. `tensions` are in N.
    pub fn tensions(
        &self,
        creep: &mut Vector4<f64>,
        (reference, speeds): (&Vector4<f64>, &Vector4<f64>),
        tensions: &Vector4<f64>,
    ) -> Vector4<f64> {
        let moving = reference * self.per_full_speed;
        // The finger lags a reference that brakes. This lag is not a creep.
        let at_rest = (1.0 - moving.amax()).max(0.0);
        *creep = (*creep + (speeds - *creep) * self.gain) * at_rest;
        Vector4::from_fn(|tendon, _| {
            let most = self.fraction[tendon];
            let along = moving[tendon].clamp(-1.0, 1.0) * most + creep[tendon] * self.slope[tendon];
            along.clamp(-most, most) * tensions[tendon]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::ConfiguredController;

    const RATE: f64 = 1000.0;

    fn law(pulley: [f64; 4]) -> Option<PulleyFeedForward> {
        let tuned = Numbers::new(&ConfiguredController::default(), RATE).expect("usable numbers");
        let numbers = Numbers { pulley_share: 0.5, pulley_creep: 0.004, creep_slope: 20.0, ..tuned };
        PulleyFeedForward::new(&pulley.into(), &numbers, RATE)
    }

    #[test]
    fn the_share_of_the_friction_acts_in_the_direction_of_the_motion() {
        let law = law([0.1, 0.1, 0.1, 0.0]).expect("there is friction");
        let reference = Vector4::new(1.0, -1.0, 0.002, 1.0);
        let mut creep = Vector4::zeros();
        let found = law.tensions(&mut creep, (&reference, &Vector4::repeat(-1.0)), &Vector4::repeat(10.0));
        assert!((found - Vector4::new(0.5, -0.5, 0.25, 0.0)).amax() < 1e-12, "{found}");
        assert_eq!(creep, Vector4::zeros(), "a reference that moves");
        assert!(self::law([0.0; 4]).is_none());
    }

    #[test]
    fn a_part_of_the_friction_of_a_finger_that_creeps_is_compensated() {
        let law = law([0.1, 0.1, 0.1, 0.0]).expect("there is friction");
        let (rest, tensions) = (Vector4::zeros(), Vector4::repeat(10.0));
        let speeds = Vector4::new(0.01, -0.01, 1.0, 0.01);
        let mut creep = Vector4::zeros();
        let first = law.tensions(&mut creep, (&rest, &speeds), &tensions);
        assert!(first.amax() < 0.5, "the filter: {first}");
        let last = (0..1000).map(|_| law.tensions(&mut creep, (&rest, &speeds), &tensions)).last().expect("cycles");
        // 0.1 of 10 N, times 20 s/m, times 0.01 m/s; at most a share of 0.5.
        assert!((last - Vector4::new(0.2, -0.2, 0.5, 0.0)).amax() < 1e-6, "{last}");
    }
}
