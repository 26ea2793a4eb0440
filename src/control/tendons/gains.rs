//! Gains of the tendon controllers for a rate.

use crate::control::number_checks::{not_negative, positive};
use crate::control::tendons::tuned_gains::TunedGains;
use crate::model::configuration::{ConfiguredController, Scheme, Unusable};

/// Gains of one scheme. [`ConfiguredController`] documents their meaning and units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gains {
    pub tension_gain: f64,
    pub tension_integral: f64,
    pub motor_damping: f64,
    pub rate_time: f64,
    pub speed_filter: f64,
    pub stretch_filter: f64,
    pub set_point_speed: f64,
    pub adaptation_gain: f64,
}

/// Speed of the set point, rad/s. At this speed a finger settled within 0.02 rad in each of 200 random poses at 3 N/cm,
/// and no tension fell below 1.6 N. This was found with Figures 9 and 10 at 500, 1000 and 2000 Hz. At 1.5 times
/// this speed the finger did not settle in two poses, and a tendon became slack.
const SET_POINT_SPEED: f64 = 2.0;

/// Speed of the set point with state feedback at 1000 Hz and above, rad/s. Below 1000 Hz the speed is proportional to
/// the rate. With state feedback the finger follows the moving set point closely, so the set point may move as fast as
/// the tensions permit.
const STATE_FEEDBACK_SET_POINT_SPEED: f64 = 5.0;

/// Bandwidth of the adaptation of Figure 11, 1/s.
const ADAPTATION_GAIN: f64 = 20.0;

impl Gains {
    /// Returns the configured gains. If the speed of the set point or the gain of the adaptation is not configured, it
    /// comes from the constants above. The other gains that are not configured come from the tuned gains of the scheme.
    pub fn new(configured: &ConfiguredController, rate: f64) -> Result<Self, Unusable> {
        let scheme = configured.scheme(rate);
        let tuned = TunedGains::of(scheme, rate);
        let absent = |key, term: &str| {
            let named = if scheme == Scheme::Figure11 { "figure 11" } else { "figure 9" };
            let reason = format!(
                "is set, but the controller scheme \"{named}\" has no {term} term: leave this key out, or set \
                 controller.scheme = \"figure 10\""
            );
            Err(Unusable { key, reason })
        };
        if matches!(scheme, Scheme::Figure9 | Scheme::Figure11) && configured.tension_gain.is_some() {
            return absent("controller.tension_gain", "proportional");
        }
        if scheme == Scheme::Figure11 && configured.tension_integral.is_some() {
            return absent("controller.tension_integral", "integral");
        }
        let gains = Self {
            tension_gain: configured.tension_gain.unwrap_or(tuned.tension_gain),
            tension_integral: configured.tension_integral.unwrap_or(tuned.tension_integral),
            motor_damping: configured.motor_damping.unwrap_or(tuned.motor_damping),
            rate_time: configured.rate_time.unwrap_or(tuned.rate_time),
            speed_filter: configured.speed_filter.unwrap_or(tuned.speed_filter),
            stretch_filter: configured.stretch_filter.unwrap_or(tuned.stretch_filter),
            set_point_speed: configured.set_point_speed.unwrap_or(match scheme {
                Scheme::StateFeedback => STATE_FEEDBACK_SET_POINT_SPEED * (rate / 1000.0).min(1.0),
                Scheme::Figure9 | Scheme::Figure10 | Scheme::Figure11 => SET_POINT_SPEED,
            }),
            adaptation_gain: configured.adaptation_gain.unwrap_or(ADAPTATION_GAIN),
        };
        not_negative("controller.tension_gain", gains.tension_gain)?;
        not_negative("controller.tension_integral", gains.tension_integral)?;
        not_negative("controller.motor_damping", gains.motor_damping)?;
        not_negative("controller.rate_time", gains.rate_time)?;
        positive("controller.speed_filter", &[gains.speed_filter])?;
        positive("controller.stretch_filter", &[gains.stretch_filter])?;
        positive("controller.set_point_speed", &[gains.set_point_speed])?;
        not_negative("controller.adaptation_gain", gains.adaptation_gain)?;
        Ok(gains)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_that_are_not_configured_follow_from_the_rate() {
        let mut configured = ConfiguredController::default();
        let between = (0.1f64 * 2.0).sqrt();
        for (rate, expected) in
            [(100.0, 0.1), (500.0, 0.1), (5e5f64.sqrt(), between), (1000.0, 2.0), (2000.0, 5.0), (9e3, 5.0)]
        {
            let found = Gains::new(&configured, rate).unwrap().tension_gain;
            assert!((found - expected).abs() < 1e-12, "{rate} Hz: {found}");
        }
        configured.motor_damping = Some(77.0);
        let gains = Gains::new(&configured, 1000.0).unwrap();
        assert_eq!((gains.motor_damping, gains.tension_integral), (77.0, 250.0));
        configured.scheme = Some(Scheme::Figure9);
        assert_eq!(Gains::new(&configured, 1000.0).unwrap().tension_integral, 75.0);
    }

    #[test]
    fn an_unusable_gain_is_refused_with_its_key() {
        let refused = |configured: ConfiguredController| Gains::new(&configured, 1000.0).unwrap_err().key;
        let base = ConfiguredController::default();
        for (scheme, reason) in [
            (Scheme::Figure9, "the controller scheme \"figure 9\" has no proportional term: "),
            (Scheme::Figure11, "the controller scheme \"figure 11\" has no proportional term: "),
        ] {
            let proportional = ConfiguredController { scheme: Some(scheme), tension_gain: Some(1.0), ..base.clone() };
            let unusable = Gains::new(&proportional, 1000.0).unwrap_err();
            assert_eq!(unusable.key, "controller.tension_gain");
            assert!(unusable.reason.contains(reason), "{}", unusable.reason);
        }
        assert_eq!(refused(ConfiguredController { rate_time: Some(f64::NAN), ..base.clone() }), "controller.rate_time");
        assert_eq!(refused(ConfiguredController { stretch_filter: Some(0.0), ..base }), "controller.stretch_filter");
    }
}
