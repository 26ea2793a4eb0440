//! Zeros the encoders and gauges. Then compares the tension of each tendon with the intended tension, while the finger
//! is a spring at rest.

use super::desk::Desk;
use super::machine::Refused;
use super::outcome::Outcome;
use super::person::Act;
use super::wrong::Wrong;
use crate::failure::Failure;
use sun2xp::calibration::{Findings, Obstacle, Task, Zeros};
use sun2xp::model::configuration::ZeroingMethod;

/// Permitted range of the tension at rest divided by the intended tension.
const TAUT: (f64, f64) = (0.75, 1.3);

/// Time for which the noise of the gauges is measured, s.
const READING: f64 = 1.0;

/// Carries out the step `zeros`.
pub fn zeros(desk: &mut Desk) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    // The motors are off, and the finger has not moved yet, so only noise changes the readings of the gauges.
    let noise = desk.read(READING)?.noise;
    let scale = desk.finger.gauge.newton_per_count;
    desk.vitals.gauge_noise = Some(std::array::from_fn(|gauge| noise[gauge] * scale[gauge].abs()));
    if zero(desk, &mut outcome, true)? {
        tautness(desk, &mut outcome)?;
    }
    Ok(outcome)
}

/// Zeros the finger by its method. Returns false if the finger was not zeroed, or if the person cannot do what the tool
/// asks for. If `held` is true, the person possibly still holds the finger.
pub fn zero(desk: &mut Desk, outcome: &mut Outcome, held: bool) -> Result<bool, Failure> {
    let method = desk.finger.zeroing_method();
    let at_pose = method == ZeroingMethod::Pose;
    let act = match at_pose {
        true => Some(Act::HoldPose(desk.finger.zeroing.pose_degrees)),
        false => held.then_some(Act::LetGo),
    };
    // A person may only turn motors that are off.
    desk.machine.off();
    if let Some(act) = act
        && !desk.prepare(outcome, act)?
    {
        return Ok(false);
    }
    desk.machine.configure(&desk.finger)?;
    let zeros = match desk.machine.carry_out(Task::Zero) {
        Ok(Findings::Zeros(zeros)) => zeros,
        Ok(other) => {
            return Err(format!("the zeroing returned {other:?}. This is a defect of sun2xp: please report it").into());
        }
        Err(Refused::Obstacle(obstacle)) => {
            outcome.wrong(match obstacle {
                Obstacle::Moved { .. } | Obstacle::NotHeld { .. } => Wrong::PoseRefused(obstacle.to_string()),
                _ => Wrong::Refused(obstacle.to_string()),
            });
            return Ok(false);
        }
        Err(Refused::Failure(failure)) => return Err(failure),
    };
    note(desk, outcome, &zeros);
    let how = match method {
        ZeroingMethod::Pose => "zeroed in its pose",
        ZeroingMethod::Kept => "kept, because zeroing.method is \"kept\"",
        _ => "zeroed at its stops",
    };
    outcome.about("encoder.zero", how);
    if at_pose {
        desk.person.show("The finger is zeroed and is a spring now.");
        return desk.prepare(outcome, Act::LetGo);
    }
    Ok(true)
}

fn note(desk: &mut Desk, outcome: &mut Outcome, zeros: &Zeros) {
    let before = desk.finger.gauge.zero;
    Findings::Zeros(*zeros).apply(&mut desk.finger);
    let scale = desk.finger.gauge.newton_per_count;
    let drift: [f64; 4] = std::array::from_fn(|gauge| (zeros.gauge[gauge] - before[gauge]) * scale[gauge]);
    let list = |values: &[f64], digits: usize| {
        values.iter().map(|value| format!("{value:+.digits$}")).collect::<Vec<_>>().join(" ")
    };
    outcome.about("gauge.zero", format!("without tension; change since the last zeros: {} N", list(&drift, 2)));
    outcome.found(format!("encoder zeros {:?}", zeros.encoder));
    outcome.found(format!("gauge zeros, change since the last ones: {} N", list(&drift, 2)));
    if let Some(range) = zeros.range_error {
        let degrees = range.map(f64::to_degrees);
        let differences = list(degrees.as_slice(), 2);
        outcome.found(format!("ranges between the stops, measured minus configured: {differences} degrees"));
    }
    desk.vitals.encoder_zero = Some(zeros.encoder);
    desk.vitals.gauge_zero = Some(zeros.gauge);
}

/// Compares the tension of each tendon at rest with the intended one.
fn tautness(desk: &mut Desk, outcome: &mut Outcome) -> Result<(), Failure> {
    let rest = desk.machine.at_rest()?;
    for (tendon, (found, intended)) in (1..).zip(rest.tensions.into_iter().zip(rest.intended)) {
        let part = found / intended;
        outcome.found(format!(
            "tendon {tendon}: {found:.2} N at rest, {:.0} % of the intended {intended:.2} N",
            part * 100.0
        ));
        if !(TAUT.0..=TAUT.1).contains(&part) {
            outcome.wrong(Wrong::TendonTension(tendon, part));
        }
    }
    desk.vitals.tensions = Some(rest.tensions);
    desk.vitals.torques = Some(rest.torques);
    Ok(())
}
