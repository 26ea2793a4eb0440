//! Which encoder counts when a motor turns, in which direction, and how much.

use super::desk::Desk;
use super::machine::Refused;
use super::order::{is_exchange, name_the_missing, repeats};
use super::outcome::Outcome;
use super::person::{Act, Answer};
use super::wrong::Wrong;
use crate::failure::Failure;
use sun2xp::calibration::{Obstacle, Task};

/// Averaging time, s.
const READING: f64 = 0.2;
/// An encoder has moved if it shows more than this part of a turn.
const MOVED: f64 = 0.05;
/// Largest relative error of a turn that a person makes by hand.
const BY_HAND: f64 = 0.15;
/// The usual ratios of the true to the configured counts. They occur if the configuration assumes the wrong number of
/// channels or edges.
const RATIOS: [(u32, u32); 4] = [(1, 2), (2, 1), (1, 4), (4, 1)];

/// The answer of the encoders to one turn of a motor.
struct Turn {
    /// Index of the encoder that counted.
    encoder: usize,
    /// Number of turns, computed with the configured counts of this encoder. It has the sign of the raw count.
    turns: f64,
}

/// Carries out the step `encoders`.
pub fn encoders(desk: &mut Desk) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    let mut order = [0; 4];
    for motor in 1..=4 {
        match turn(desk, motor)? {
            Ok(Turn { encoder, turns }) => {
                desk.person.show(&format!("encoder {}: {turns:+.2} turns", encoder + 1));
                order[motor - 1] = encoder + 1;
                judge(desk, &mut outcome, motor, encoder, turns);
            }
            Err(wrong) => {
                desk.person.show(&wrong.to_string());
                outcome.wrong(wrong);
            }
        }
    }
    let seen = order;
    name_the_missing(&mut outcome, &mut order, Wrong::EncoderDead);
    let unclear = outcome.wrong.iter().any(|wrong| matches!(wrong, Wrong::EncoderUnclear(..)));
    if repeats(seen) || (is_exchange(order) && unclear) {
        // The person may have turned another motor, or two of them.
        outcome.wrong.retain(|wrong| matches!(wrong, Wrong::MotorBlocked(_)));
        outcome.wrong(Wrong::EncodersUnclear(seen));
    } else if is_exchange(order) && outcome.passed() {
        // The cables are exchanged, so the findings about signs and scales belong to other encoders. The step is
        // repeated after the cables have been corrected.
        outcome.wrong.clear();
        name_the_exchange(desk, &mut outcome, order)?;
    }
    if (1..=4).all(|encoder| outcome.wrong.contains(&Wrong::EncoderReversed(encoder)))
        && desk.person.ask(Act::ConfirmDirection)? == Answer::Cannot
    {
        outcome.wrong.retain(|wrong| !matches!(wrong, Wrong::EncoderReversed(_)));
        outcome.wrong(Wrong::TurnedWrongWay);
    }
    if outcome.passed() {
        report(desk, &mut outcome);
    }
    Ok(outcome)
}

fn report(desk: &Desk, outcome: &mut Outcome) {
    let signs = desk.finger.encoder.sign.map(|sign| format!("{sign:+}")).join(" ");
    let counts = desk.finger.encoder.counts_per_revolution.map(|counts| counts.to_string()).join(" ");
    outcome.found(format!("each encoder counts with its motor; signs {signs}, counts per turn {counts}"));
    outcome.about("encoder.sign", "direction in which each encoder counted while its motor was turned by hand");
    outcome.about(
        "encoder.counts_per_revolution",
        "checked with one turn by hand, and multiplied by 1/4, 1/2, 2 or 4 where the old value was wrong",
    );
}

/// Asks for one turn of a motor, and reads which encoder followed.
fn turn(desk: &mut Desk, motor: usize) -> Result<Result<Turn, Wrong>, Failure> {
    let before = desk.read(READING)?.encoders;
    if desk.person.ask(Act::TurnMotor(motor))? == Answer::Cannot {
        return Ok(Err(Wrong::MotorBlocked(motor)));
    }
    let out = desk.read(READING)?.encoders;
    desk.person.ask(Act::TurnMotorBack(motor))?;
    let counts = desk.finger.encoder.counts_per_revolution;
    let turns: [f64; 4] = std::array::from_fn(|encoder| (out[encoder] - before[encoder]) / f64::from(counts[encoder]));
    let first = (0..4).max_by(|&one, &other| turns[one].abs().total_cmp(&turns[other].abs())).unwrap_or(0);
    Ok(match turns[first] {
        few if few.abs() < MOVED => Err(Wrong::EncoderDead(motor)),
        turns => Ok(Turn { encoder: first, turns }),
    })
}

/// Takes sign and scale from a turn that paid the tendon out.
fn judge(desk: &mut Desk, outcome: &mut Outcome, motor: usize, encoder: usize, turns: f64) {
    let number = encoder + 1;
    let configured = &mut desk.finger.encoder;
    let sign = if turns > 0.0 { -1 } else { 1 };
    if sign != configured.sign[encoder] {
        configured.sign[encoder] = sign;
        if sign < 0 {
            outcome.wrong(Wrong::EncoderReversed(number));
        }
    }
    let near = |ratio: f64| (turns.abs() / ratio - 1.0).abs() <= BY_HAND;
    if near(1.0) {
        return;
    }
    let before = configured.counts_per_revolution[encoder];
    match RATIOS.into_iter().find(|&(up, down)| near(f64::from(up) / f64::from(down))) {
        Some((up, down)) => {
            configured.counts_per_revolution[encoder] = before * up / down;
            outcome.wrong(Wrong::EncoderScale(number, before * up / down, before));
        }
        None => outcome.wrong(Wrong::EncoderUnclear(motor, turns.abs())),
    }
}

/// Names what is exchanged: only the encoders, or motors with their encoders. The routine that finds the signs shows
/// which encoder a motor command turns.
fn name_the_exchange(desk: &mut Desk, outcome: &mut Outcome, order: [usize; 4]) -> Result<(), Failure> {
    desk.person.show("The encoders or the motors are swapped. To find out which, each motor turns a little.");
    if !desk.prepare(outcome, Act::HoldStill)? {
        outcome.wrong(Wrong::EncodersUnclear(order));
        return Ok(());
    }
    desk.machine.configure(&desk.finger)?;
    let pushed = desk.machine.carry_out(Task::Signs);
    desk.machine.off();
    match pushed {
        Err(Refused::Obstacle(Obstacle::SwappedMotor { motor, encoder }))
            if order[usize::from(motor) - 1] == usize::from(encoder) =>
        {
            outcome.wrong(Wrong::EncodersExchanged(order));
        }
        // The cables of the motors and of the encoders are exchanged in the same way: a command to motor n turns
        // encoder n.
        Ok(_)
        | Err(Refused::Obstacle(
            Obstacle::NothingTightens { .. } | Obstacle::Swapped { .. } | Obstacle::InconsistentGauge { .. },
        )) => outcome.wrong(Wrong::MotorsAndEncodersExchanged(order)),
        Err(Refused::Obstacle(obstacle)) => {
            outcome.wrong(Wrong::EncodersUnclear(order));
            outcome.wrong(Wrong::Refused(obstacle.to_string()));
        }
        Err(Refused::Failure(failure)) => return Err(failure),
    }
    Ok(())
}
