//! Measures the stiffness of the finger as a spring, while the person pushes the tip.

use super::desk::Desk;
use super::machine::Refused;
use super::outcome::Outcome;
use super::person::Act;
use super::wrong::Wrong;
use crate::failure::Failure;
use sun2xp::nalgebra::Vector3;

/// Shortest push, cm.
const PUSHED: f64 = 0.1;
/// Largest relative difference between the measured and the sent stiffness.
const STIFFNESS: f64 = 0.2;
/// Largest distance between the position of the tip before the push and its position after the push has ended, cm.
const RETURN: f64 = 0.15;

/// Carries out the step `spring`.
pub fn spring(desk: &mut Desk) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    desk.machine.configure(&desk.finger)?;
    match desk.machine.spring() {
        Ok(()) => {}
        Err(Refused::Obstacle(obstacle)) => {
            outcome.wrong(Wrong::Refused(obstacle.to_string()));
            return Ok(outcome);
        }
        Err(Refused::Failure(failure)) => return Err(failure),
    }
    let rest = desk.machine.at_rest()?;
    desk.person.ask(Act::Push)?;
    let pushed = desk.machine.at_rest()?;
    desk.person.ask(Act::EndPush)?;
    let back = desk.machine.at_rest()?;
    let way = Vector3::from(pushed.tip) - Vector3::from(rest.tip);
    if way.norm() < PUSHED {
        outcome.wrong(Wrong::NotPushed);
        return Ok(outcome);
    }
    // The tip presses against the person's finger. The force of the tip is opposite to the displacement `way`.
    let force = Vector3::from(rest.force) - Vector3::from(pushed.force);
    let stiffness = force.dot(&way) / way.norm_squared();
    let sent = (desk.finger.initial_stiffness() * way).dot(&way) / way.norm_squared();
    let residual = (Vector3::from(back.tip) - Vector3::from(rest.tip)).norm();
    outcome.found(format!(
        "the tip gave way by {:.1} mm under {:.2} N: {stiffness:.2} N/cm, and {sent:.2} N/cm were sent",
        way.norm() * 10.0,
        force.norm()
    ));
    outcome.found(format!("the tip came to rest {:.2} mm from its position before the push", residual * 10.0));
    if (stiffness / sent - 1.0).abs() > STIFFNESS {
        outcome.wrong(Wrong::SpringStiffness(stiffness, sent));
    }
    if residual > RETURN {
        outcome.wrong(Wrong::SpringReturn(residual * 10.0));
    }
    Ok(outcome)
}
