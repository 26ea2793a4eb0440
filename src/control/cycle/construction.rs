//! Construction of a finger's controller from its configuration.

use super::Controller;
use crate::control::contact::ContactObserver;
use crate::control::culprit::with_culprit;
use crate::control::monitors::Monitors;
use crate::control::motors::motor_heating::MotorHeating;
use crate::control::motors::motor_torque::MotorTorque;
use crate::control::number_checks::positive;
use crate::control::sensing::joint_positions::JointPositions;
use crate::control::sensing::sensors::SensorScales;
use crate::control::spring::admissible_stiffness::AdmissibleStiffness;
use crate::control::spring::gravity_compensation::GravityCompensation;
use crate::control::spring::joint_stiffness::JointStiffness;
use crate::control::spring::slew::Slew;
use crate::control::spring::soft_limits::SoftLimits;
use crate::control::spring::spring_transition::SpringTransition;
use crate::control::state_feedback::{Numbers, StateFeedback};
use crate::control::take_up::slack::SlackTakeUp;
use crate::control::take_up::tightening::Tightening;
use crate::control::tendons::gains::Gains;
use crate::control::tendons::low_pass::LowPass;
use crate::control::tendons::tendon_controller::TendonController;
use crate::control::tendons::tension_distribution::TensionDistribution;
use crate::model::Tendons;
use crate::model::configuration::{ConfiguredFinger, Scheme, Unusable};
use nalgebra::{Vector3, Vector4};

/// Fraction of t_min from which a tendon counts as tight.
const TIGHT: f64 = 0.8;

/// The reason to refuse a configuration in which a joint would have no stiffness. A matrix `geometry.r` whose rank is
/// below 3 is refused for another reason.
const NO_STIFFNESS: &str = "gives at least one joint no stiffness: set every entry to a number above 0";

impl Controller {
    /// Constructs the controller of `finger` at `rate`, Hz, without gravity. Gains that are not configured follow from
    /// the rate. If the controller cannot use the values, returns an error that names the key to correct.
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Result<Self, Unusable> {
        Self::in_gravity(finger, &Vector3::zeros(), rate)
    }

    /// Constructs a controller of `finger` that compensates `gravity`, m/s^2 in the finger's frame, until
    /// [`Controller::approach_gravity`] changes it. In all other respects, the controller equals the one that
    /// [`Controller::new`] constructs.
    pub fn in_gravity(finger: &ConfiguredFinger, gravity: &Vector3<f64>, rate: f64) -> Result<Self, Unusable> {
        let construct = |finger: &ConfiguredFinger| Self::construct(finger, gravity, rate, None);
        construct(finger).map_err(|refusal| with_culprit(refusal, finger, &|changed| construct(changed).is_ok()))
    }

    /// Constructs a controller without gravity whose state feedback has the parameters `numbers`. `cargo bench --bench
    /// stiffness` uses this function to search for the best parameters.
    pub fn with_numbers(finger: &ConfiguredFinger, rate: f64, numbers: &Numbers) -> Result<Self, Unusable> {
        Self::construct(finger, &Vector3::zeros(), rate, Some(*numbers))
    }

    fn construct(
        finger: &ConfiguredFinger,
        gravity: &Vector3<f64>,
        rate: f64,
        numbers: Option<Numbers>,
    ) -> Result<Self, Unusable> {
        positive("rate", &[rate])?;
        let tendons = finger.tendons().map_err(|error| Unusable { key: "geometry.r", reason: error.to_string() })?;
        let gains = Gains::new(&finger.controller, rate)?;
        let motor_torque = MotorTorque::new(finger, &tendons)?;
        // The tension limit includes the motor's limit. Clamping the motor torques instead would change the direction
        // of the joint torque.
        let strongest = motor_torque.limit.map(|limit| limit.min(finger.tendon.maximum));
        let scheme = finger.controller.scheme(rate);
        let state_feedback = match scheme {
            Scheme::StateFeedback => {
                let numbers = numbers.map_or_else(|| Numbers::new(&finger.controller, rate), Ok)?;
                Some(StateFeedback::new(finger, &numbers, &tendons, &strongest, gains.set_point_speed, rate)?)
            }
            Scheme::Figure9 | Scheme::Figure10 | Scheme::Figure11 => None,
        };
        // The reserves keep the tensions within their bounds despite the variation by dither, noise and friction.
        let lower_reserve = state_feedback.as_ref().map_or(0.0, |law| law.lower_reserve);
        let upper_reserve = state_feedback.as_ref().map_or(Vector4::zeros(), |law| law.upper_reserve);
        let dither_period = state_feedback.as_ref().map_or(0.0, StateFeedback::dither_period);
        positive("motor.continuous_torque", &finger.motor.continuous_torque)?;
        positive("motor.thermal_time", &[finger.motor.thermal_time])?;
        let soft = || Unusable { key: "tendon.stiffness", reason: NO_STIFFNESS.into() };
        check_continuous_torque(finger, &motor_torque, &tendons, state_feedback.as_ref())?;
        let admissible = AdmissibleStiffness::new(finger, &tendons, rate).ok_or_else(soft)?;
        Ok(Self {
            spring_transition: SpringTransition::new(rate),
            soft_limits: SoftLimits::new(finger, &admissible.of_joints()),
            admissible,
            gravity: GravityCompensation::new(finger, gravity, rate),
            heating: MotorHeating::new(finger, motor_torque.limit, &tendons.radius, rate),
            contact: ContactObserver::new(finger, &tendons, rate),
            monitors: Monitors::new(finger, &tendons, rate, dither_period),
            period: 1.0 / rate,
            sensors: SensorScales::new(finger)?,
            speed_filter: LowPass::new(gains.speed_filter, rate),
            stretch_filter: LowPass::new(gains.stretch_filter, rate),
            joint_positions: JointPositions::new(finger, &tendons)?,
            slack: SlackTakeUp::new(finger, &tendons, rate),
            tightening: Tightening::new(finger.links(), &tendons, finger.tendon.minimum, rate),
            slew: Slew::new(gains.set_point_speed, rate),
            joint_stiffness: JointStiffness::new(finger.links(), gains.rate_time),
            distribution: TensionDistribution::new(
                &tendons,
                finger.tendon.minimum + lower_reserve,
                strongest - upper_reserve,
            )?,
            tendons: TendonController::new(scheme, &gains, rate),
            motor_torque,
            motor_damping: gains.motor_damping,
            state_feedback,
            radius: tendons.radius * 0.01,
            tight: TIGHT * finger.tendon.minimum,
        })
    }
}

/// Checks that the motors, with their continuous torque, can hold the tensions of a finger at rest against friction.
/// Otherwise the motors of a finger that does nothing would overheat. Only state feedback is checked here: it holds
/// tensions above the pretension. [`ConfiguredFinger::check`] checks the pretension.
fn check_continuous_torque(
    finger: &ConfiguredFinger,
    motor_torque: &MotorTorque,
    tendons: &Tendons,
    law: Option<&StateFeedback>,
) -> Result<(), Unusable> {
    let Some(law) = law else { return Ok(()) };
    let at_rest = tendons.pretension(finger.tendon.minimum + law.lower_reserve);
    let held = motor_torque.tensions(&Vector4::from(finger.motor.continuous_torque).component_div(&tendons.radius));
    let Some(motor) = (0..4).find(|&motor| held[motor] < at_rest[motor]) else { return Ok(()) };
    let reason = format!(
        "is too low: against friction, motor {} can hold only {:.2} N in its tendon, but state feedback needs \
         {:.2} N in this tendon even at zero joint torque: raise motor.continuous_torque, or lower tendon.minimum",
        motor + 1,
        held[motor],
        at_rest[motor]
    );
    Err(Unusable { key: "motor.continuous_torque", reason })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_continuous_torque_must_hold_the_tensions_of_a_finger_at_rest() {
        let mut finger = ConfiguredFinger::default();
        finger.motor.continuous_torque = [0.56; 4];
        assert_eq!(finger.check(), Ok(()));
        let refused = Controller::new(&finger, 1000.0).map(|_| ()).map_err(|unusable| unusable.key);
        assert_eq!(refused, Err("motor.continuous_torque"));
        finger.controller.scheme = Some(Scheme::Figure10);
        assert!(Controller::new(&finger, 1000.0).is_ok());
    }

    #[test]
    fn a_refusal_names_the_key_to_correct() {
        let refused = |change: fn(&mut ConfiguredFinger)| {
            let mut finger = ConfiguredFinger::default();
            change(&mut finger);
            Controller::new(&finger, 1000.0).map(|_| ()).map_err(|unusable| unusable.key)
        };
        assert_eq!(refused(|finger| finger.tendon.maximum = 10.0), Err("tendon.maximum"));
        assert_eq!(refused(|finger| finger.motor.viscous_friction = [1.0; 4]), Err("motor.viscous_friction"));
        assert_eq!(refused(|finger| finger.friction.joint_coulomb = [20.0; 3]), Err("friction.joint_coulomb"));
        let weak_motors = |finger: &mut ConfiguredFinger| {
            (finger.friction.motor_coulomb, finger.friction.conduit) = ([0.0; 4], [0.0; 4]);
            finger.motor.torque_limit = [0.43; 4];
        };
        assert_eq!(refused(weak_motors), Err("motor.torque_limit"));
    }

    #[test]
    fn tendons_without_stiffness_are_refused_with_a_remedy_for_their_own_key() {
        let mut finger = ConfiguredFinger::default();
        finger.controller.scheme = Some(Scheme::Figure10);
        finger.tendon.stiffness = [0.0; 4];
        let refused = Controller::new(&finger, 1000.0).map(|_| ()).expect_err("no stiffness");
        assert_eq!(refused.key, "tendon.stiffness");
        assert!(refused.reason.ends_with(": set every entry to a number above 0"), "{}", refused.reason);
    }
}
