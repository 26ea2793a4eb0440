//! Directions of the motors, and which motor pulls which tendon.

use super::desk::Desk;
use super::machine::Refused;
use super::outcome::Outcome;
use super::person::Act;
use super::wrong::Wrong;
use crate::failure::Failure;
use sun2xp::calibration::{Findings, Obstacle, Task};

/// Carries out the step `motors`. The steps before have checked encoders and gauges, so a contradiction usually
/// concerns the motors or the tendons.
pub fn motors(desk: &mut Desk) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    if !desk.prepare(&mut outcome, Act::HoldStill)? {
        return Ok(outcome);
    }
    desk.machine.configure(&desk.finger)?;
    match desk.machine.carry_out(Task::Signs) {
        Ok(found) => adopt(desk, &mut outcome, &found),
        Err(Refused::Obstacle(obstacle)) => outcome.wrong(named(&obstacle)),
        Err(Refused::Failure(failure)) => return Err(failure),
    }
    Ok(outcome)
}

fn adopt(desk: &mut Desk, outcome: &mut Outcome, found: &Findings) {
    let Findings::Signs(signs) = found else { return };
    for motor in 0..4 {
        if signs.motor[motor] < 0 && desk.finger.motor.sign[motor] > 0 {
            outcome.wrong(Wrong::MotorReversed(motor + 1));
        }
        let by_weight: i8 = if desk.finger.gauge.newton_per_count[motor] < 0.0 { -1 } else { 1 };
        if signs.gauge[motor] != by_weight {
            outcome.wrong(Wrong::Refused(format!(
                "the sign of gauge {} is now opposite to the sign that the step \"gauges\" found: its wires, its \
                 amplifier or gauge.newton_per_count was changed since then, or the weights did not hang as that step \
                 asked. Leave with q, and start the tool again with --step gauges",
                motor + 1
            )));
        }
        if signs.encoder[motor] != desk.finger.encoder.sign[motor] {
            outcome.wrong(Wrong::Refused(format!(
                "the sign of encoder {0} is now opposite to the sign that the step \"encoders\" found: its channels or \
                 encoder.sign were changed since then, tendon {0} is wound on its drum the other way round now, or \
                 motor {0} was turned the wrong way in that step. Leave with q, and start the tool again with --step \
                 encoders",
                motor + 1
            )));
        }
    }
    found.apply(&mut desk.finger);
    let list = |signs: [i8; 4]| signs.map(|sign| format!("{sign:+}")).join(" ");
    outcome.about("motor.sign", "direction in which each motor pulls its tendon");
    outcome.found(format!("each motor turns its own encoder and pulls its own tendon; signs {}", list(signs.motor)));
}

/// The cause of a refusal, given that encoders and gauges were checked by hand.
fn named(obstacle: &Obstacle) -> Wrong {
    match *obstacle {
        Obstacle::SwappedMotor { motor, encoder } => exchanged(Wrong::MotorsExchanged, motor, encoder),
        Obstacle::Swapped { motor, gauge } => exchanged(Wrong::TendonsExchanged, motor, gauge),
        Obstacle::MotorStuck { motor } => Wrong::MotorDead(motor.into()),
        Obstacle::NothingTightens { motor } => Wrong::TendonLoose(motor.into()),
        ref other => Wrong::Refused(other.to_string()),
    }
}

fn exchanged(wrong: fn(usize, usize) -> Wrong, one: u8, other: u8) -> Wrong {
    wrong(one.min(other).into(), one.max(other).into())
}
