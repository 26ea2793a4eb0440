//! The worst cases of this machine, measured on the simulated hand.

use super::off_line::Costs;
use crate::failure::Failure;
use crate::print::Progress;
use std::thread::sleep;
use std::time::Duration;
use sun2xp::hand::Hand;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger};
use sun2xp::realtime::{CycleStage, Distribution};
use sun2xp::reflexes::{Condition, MOST_RULES, Reaction, Reflex};

/// Runs a simulated hand for `duration`. Returns the maximum of each time, or its 99.9 % value if `p999` is set.
pub fn measure(configuration: &Configuration, duration: Duration, p999: bool) -> Result<Costs, Failure> {
    let mut simulated = configuration.clone();
    simulated.fingers.iter_mut().for_each(ConfiguredFinger::simulate);
    let hand = Hand::open(simulated)?;
    hand.fingers().members().try_for_each(|finger| busy_with_reflexes(&hand, finger))?;
    hand.fingers().numbers().try_for_each(|finger| hand.reset_timing(finger))?;
    Progress::during("measuring the simulated hand", duration, || sleep(duration));
    let worst = |stage| -> Result<f64, Failure> {
        let part = |timing: Distribution| if p999 { timing.p999 } else { timing.maximum };
        let timings = hand.fingers().numbers().map(|finger| hand.timing(finger, stage).map(part));
        Ok(timings.collect::<Result<Vec<f64>, _>>()?.into_iter().fold(0.0, f64::max))
    };
    Ok(Costs {
        wake_up: worst(CycleStage::WakeUp)?,
        write: worst(CycleStage::Write)?,
        read: worst(CycleStage::Read)? + worst(CycleStage::Decode)?,
        compute: worst(CycleStage::Compute)?,
    })
}

/// Gives a finger as many reflexes as it can have. All of them fire again and again, so one of them reacts in every
/// cycle. The measured computing time thus includes the largest amount of work that reflexes can cause.
fn busy_with_reflexes(hand: &Hand, finger: FingerNumber) -> Result<(), Failure> {
    let reflex = Reflex {
        condition: Condition::ForceAbove(0.0),
        reaction: Reaction::Damp(1.0),
        priority: 0,
        // Shorter than any period.
        refractory: 1e-9,
        inhibition: 0.0,
    };
    for _ in 0..MOST_RULES {
        hand.install_reflex(finger.get(), reflex)?;
    }
    Ok(())
}
