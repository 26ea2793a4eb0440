//! Stiffness of the tendons and friction of the finger.

use super::desk::Desk;
use super::machine::Refused;
use super::outcome::Outcome;
use super::person::Act;
use super::wrong::Wrong;
use super::zeros::zero;
use crate::failure::Failure;
use sun2xp::calibration::{Findings, Identified, Task};

/// A motor is reported if its torque deviates by more than this fraction from the commanded torque.
const TORQUE: f64 = 0.15;
/// A gauge is reported if its gain, relative to the other gauges, deviates by more than this fraction from the gain
/// that was found with weights.
const GAIN: f64 = 0.05;

/// Carries out the step `tendons`.
pub fn tendons(desk: &mut Desk) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    if !desk.prepare(&mut outcome, Act::LetGo)? {
        return Ok(outcome);
    }
    desk.machine.configure(&desk.finger)?;
    let found = match desk.machine.carry_out(Task::Identify) {
        Ok(Findings::Identified(found)) => found,
        Ok(other) => {
            return Err(
                format!("the identification returned {other:?}. This is a defect of sun2xp: please report it").into()
            );
        }
        Err(Refused::Obstacle(obstacle)) => {
            outcome.wrong(Wrong::Refused(obstacle.to_string()));
            return Ok(outcome);
        }
        Err(Refused::Failure(failure)) => return Err(failure),
    };
    Findings::Identified(found).apply(&mut desk.finger);
    report(&mut outcome, &found);
    let vitals = &mut desk.vitals;
    vitals.tendon_stiffness = Some(found.tendon_stiffness.into());
    vitals.motor_friction = Some(found.motor_coulomb.into());
    vitals.conduit_friction = Some(found.conduit.into());
    vitals.pulley_friction = Some(found.pulley.into());
    vitals.joint_friction = Some(found.joint_coulomb.into());
    vitals.motor_ratio = Some(found.motor_ratio.into());
    vitals.newton_per_count = Some(desk.finger.gauge.newton_per_count);
    vitals.residual = Some(found.travel_residual);
    // The person has let go already, and must hold the finger again only if it is zeroed at a pose.
    desk.person.show("The zeros depend on the stretch of the tendons, which is known now: the finger is zeroed again.");
    zero(desk, &mut outcome, false)?;
    Ok(outcome)
}

fn report(outcome: &mut Outcome, found: &Identified) {
    let list = |values: &[f64], digits: usize| {
        values.iter().map(|value| format!("{value:.digits$}")).collect::<Vec<_>>().join(" ")
    };
    outcome.found(format!(
        "tendon stiffness {} N/cm, residual of the motor travel {:.1} um rms",
        list(found.tendon_stiffness.as_slice(), 0),
        found.travel_residual * 1e4
    ));
    let residual = found.travel_residual * 1e4;
    outcome.about("tendon.stiffness", format!("by identification, residual of the motor travel {residual:.1} um rms"));
    outcome.about(
        "gauge.newton_per_count",
        format!("by identification; new scale / previous scale: {}", list(found.gauge_gain.as_slice(), 3)),
    );
    for key in ["friction.motor_coulomb", "friction.conduit", "friction.pulley", "friction.joint_coulomb"] {
        outcome.about(key, "by identification, in both directions of motion");
    }
    outcome.found(format!("friction of the motors {} N cm", list(found.motor_coulomb.as_slice(), 3)));
    outcome.found(format!(
        "friction of conduits {} and of pulleys {} (ratios), of joints {} N cm",
        list(found.conduit.as_slice(), 3),
        list(found.pulley.as_slice(), 3),
        list(found.joint_coulomb.as_slice(), 3)
    ));
    outcome.found(format!("gauge gains, new / before: {}", list(found.gauge_gain.as_slice(), 3)));
    outcome.found(format!("torque of the motors, true / commanded: {}", list(found.motor_ratio.as_slice(), 2)));
    for motor in 0..4 {
        if (found.motor_ratio[motor] - 1.0).abs() > TORQUE {
            outcome.wrong(Wrong::MotorTorque(motor + 1, found.motor_ratio[motor]));
        }
        if (found.gauge_gain[motor] - 1.0).abs() > GAIN {
            outcome.wrong(Wrong::GaugeScale(motor + 1, 1.0 / found.gauge_gain[motor]));
        }
    }
    if let Some(inertia) = found.rotor_inertia {
        let inertia = list((inertia * 1e7).as_slice(), 2);
        outcome.found(format!(
            "the measured inertia of the rotors, {inertia} times 1e-7 kg m^2, differs from motor.inertia and is stored"
        ));
    }
    if found.moment_arms.is_some() {
        outcome.found("the moment arms differ from geometry.r: the measured ones are stored");
    }
}
