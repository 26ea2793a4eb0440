//! Implements [`Machine`] for a finger at its port.

use super::machine::{AtRest, BoardSeen, Bound, Machine, Reading, Refused};
use crate::calibrate::with_progress;
use crate::failure::Failure;
use crate::{bound, doctor};
use std::thread::sleep;
use std::time::{Duration, Instant};
use sun2xp::board::protocol::{Reason, Status};
use sun2xp::board::{Link, LinkError, Terms};
use sun2xp::calibration::{Findings, Task};
use sun2xp::hand::{Fingers, Hand, HandError, SimulatedHand, find_boards, ports};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{BoardNumber, Configuration, ConfiguredFinger, EndState};
use sun2xp::realtime::now;

/// Longest time that the handshake with the board takes, ns.
const HANDSHAKE_TIMEOUT: u64 = 1_500_000_000;
/// Time over which the measurements of a finger at rest are averaged, and interval of their samples.
const RESTING: Duration = Duration::from_millis(600);
const SAMPLING: Duration = Duration::from_millis(5);
/// Settling time before the measurements of a finger at rest.
const SETTLING: Duration = Duration::from_millis(1500);
const NO_MEASUREMENT: &str = "the board has sent no measurement: check its power and its cable";
/// Duration of the examination of the computer.
const EXAMINATION: Duration = Duration::from_secs(3);

/// One finger of a configured hand. The hand is open only while it is needed.
pub struct HandMachine {
    configuration: Configuration,
    finger: FingerNumber,
    hand: Option<Hand>,
}

impl HandMachine {
    /// The other fingers of the hand are left alone.
    pub fn new(mut configuration: Configuration, finger: FingerNumber) -> Self {
        configuration.hand.fingers = Fingers::one(finger);
        Self { configuration, finger, hand: None }
    }

    /// Returns the configuration with which the finger is opened. A closed finger releases its motors, whatever the
    /// configured end state is: the person relies on [`Machine::off`] when asked to turn motors by hand.
    fn released(&self) -> Configuration {
        let mut configuration = self.configuration.clone();
        configuration.hand.end_state = EndState::Release;
        configuration
    }

    /// Returns the open hand. If the hand is closed, this opens it with the motors off.
    fn opened(&mut self) -> Result<&Hand, HandError> {
        let hand = match self.hand.take() {
            Some(hand) => hand,
            None => Hand::open_limp(self.released(), None, Fingers::ALL)?,
        };
        Ok(self.hand.insert(hand))
    }

    fn run(&mut self, task: Task) -> Result<Findings, Refused> {
        let finger = self.finger.get();
        let hand = self.opened()?;
        let found = with_progress(hand, finger, task, "turning the motors");
        let calibrated = hand.calibrated(finger)?;
        let found = found.map_err(refused)?;
        // `calibrated` has the port at which the board was found. The configuration keeps its own port.
        let configured = &mut self.configuration.fingers[self.finger.index()];
        *configured = ConfiguredFinger { port: configured.port.clone(), ..calibrated };
        Ok(found)
    }
}

fn refused(error: HandError) -> Refused {
    match error {
        HandError::Calibration { obstacle, .. } | HandError::WrongWiring { obstacle, .. } => {
            Refused::Obstacle(obstacle)
        }
        error => error.into(),
    }
}

impl Machine for HandMachine {
    fn board(&mut self) -> Result<BoardSeen, Failure> {
        self.off();
        let index = self.finger.index();
        let fingers = Fingers::one(self.finger);
        let mut configuration = self.configuration.clone();
        find_boards(&mut configuration, fingers)?;
        let configured = &configuration.fingers[index];
        let simulated = SimulatedHand::start(&configuration, fingers)?;
        let found = ports(&configuration, fingers, &simulated);
        let (port, _) = found.first().expect("the hand has this finger");
        let mut link = Link::open(port, configured.baud)?;
        let terms = Terms::new(&configuration.hand, configured);
        let address = configuration.address(self.finger);
        match link.shake_hands(address, &terms, now() + HANDSHAKE_TIMEOUT) {
            Ok((identity, _)) => {
                let number = BoardNumber(identity.unique_number);
                let [major, minor, patch] = identity.firmware.0;
                let name = format!("board {number} with firmware {major}.{minor}.{patch}, address {address}");
                Ok(BoardSeen { name, ..BoardSeen::default() })
            }
            Err(LinkError::Refused { address, refused }) if refused.reason == Reason::Fault => {
                let faults = Status(refused.detail);
                Ok(BoardSeen {
                    name: String::new(),
                    emergency_stop: faults.has(Status::EMERGENCY_STOP),
                    supply_fault: faults.has(Status::SUPPLY_FAULT),
                    refusal: Some(LinkError::Refused { address, refused }.to_string()),
                })
            }
            Err(error) => Err(error.into()),
        }
    }

    fn configure(&mut self, finger: &ConfiguredFinger) -> Result<(), Failure> {
        if self.configuration.fingers[self.finger.index()] != *finger {
            self.off();
            self.configuration.fingers[self.finger.index()] = finger.clone();
        }
        Ok(())
    }

    fn read(&mut self, seconds: f64) -> Result<Reading, Failure> {
        let finger = self.finger.get();
        let hand = self.opened()?;
        // The first cycles of an open hand have no measurement yet.
        sleep(Duration::from_millis(100));
        let first = hand.record(finger, None)?.newest;
        sleep(Duration::from_secs_f64(seconds));
        // A faulted finger has no new cycles. Without this check, the error would be that measurements are missing, and
        // would not name the fault.
        if let Some(fault) = hand.fault(finger)?.stopped {
            return Err(format!("finger {finger}: {fault}").into());
        }
        let kept = hand.record(finger, None)?;
        if kept.newest <= first {
            return Err(NO_MEASUREMENT.into());
        }
        let first = first.max(kept.oldest);
        // The black box may overwrite the oldest cycles meanwhile.
        let cycles: Vec<_> =
            (first..=kept.newest).filter_map(|cycle| hand.record(finger, Some(cycle)).ok()?.record.feedback).collect();
        let count = cycles.len() as f64;
        if cycles.is_empty() {
            return Err(NO_MEASUREMENT.into());
        }
        let mean = |of: &dyn Fn(usize) -> f64| (0..cycles.len()).map(of).sum::<f64>() / count;
        let encoders = std::array::from_fn(|part| mean(&|cycle| f64::from(cycles[cycle].motor_counts[part])));
        let gauges: [f64; 4] = std::array::from_fn(|part| mean(&|cycle| f64::from(cycles[cycle].gauge_counts[part])));
        let square = |cycle: usize, part: usize| (f64::from(cycles[cycle].gauge_counts[part]) - gauges[part]).powi(2);
        let noise = std::array::from_fn(|part| mean(&|cycle| square(cycle, part)).sqrt());
        Ok(Reading { encoders, gauges, noise })
    }

    fn carry_out(&mut self, task: Task) -> Result<Findings, Refused> {
        self.run(task)
    }

    fn at_rest(&mut self) -> Result<AtRest, Failure> {
        let finger = self.finger.get();
        let hand = self.opened()?;
        sleep(SETTLING);
        let (mut sum, mut count, began) = (AtRest::default(), 0.0, Instant::now());
        let add = |sum: &mut [f64], values: &[f64]| sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        while began.elapsed() < RESTING {
            let tip = hand.fingertip(finger)?;
            add(&mut sum.tip, &tip.tip);
            add(&mut sum.force, &tip.force);
            add(&mut sum.tensions, &tip.tensions);
            let cycle = hand.report(finger)?.cycle;
            add(&mut sum.intended, cycle.desired_tensions.as_slice());
            add(&mut sum.torques, cycle.motor_torques.as_slice());
            count += 1.0;
            sleep(SAMPLING);
        }
        Ok(AtRest {
            tip: sum.tip.map(|value| value / count),
            force: sum.force.map(|value| value / count),
            tensions: sum.tensions.map(|value| value / count),
            intended: sum.intended.map(|value| value / count),
            torques: sum.torques.map(|value| value / count),
        })
    }

    fn spring(&mut self) -> Result<(), Refused> {
        self.off();
        self.hand = Some(Hand::open(self.released()).map_err(refused)?);
        Ok(())
    }

    fn off(&mut self) {
        self.hand = None;
    }

    fn bound(&mut self) -> Result<Bound, Failure> {
        let (stiffness, limit) = bound::of_finger(&self.configuration, self.finger)?;
        Ok(Bound { stiffness, limit })
    }

    fn computer(&mut self) -> Result<Vec<String>, Failure> {
        self.off();
        Ok(doctor::complaints(&self.configuration, EXAMINATION)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sun2xp::realtime::Priority;
    use sun2xp::simulated::{Pace, SimulatedBoard, SimulatedPort};

    #[test]
    fn a_reading_of_a_stopped_finger_names_the_fault() {
        let mut machine = HandMachine::new(Configuration::default(), FingerNumber::ONE);
        machine.read(0.2).expect("read");
        machine.hand.as_ref().expect("open").stop(1).expect("there");
        let error = machine.read(0.2).expect_err("the finger has stopped").to_string();
        assert!(error.starts_with("finger 1: "), "{error}");
    }

    #[test]
    fn the_motors_are_off_although_the_configured_end_state_is_hold() {
        let mut configuration = Configuration::default();
        (configuration.hand.rate, configuration.hand.watchdog_ms) = (500.0, 1000);
        (configuration.hand.end_state, configuration.hand.hold_time_ms) = (EndState::Hold, 60_000);
        let board = SimulatedBoard::new(&configuration, &[FingerNumber::ONE]).expect("a board");
        let port = SimulatedPort::start(board, Pace::patient(500.0), Priority::default()).expect("a port");
        let finger = &mut configuration.fingers[0];
        (finger.port, finger.baud) = (port.path().display().to_string(), 2_000_000);
        let address = configuration.address(FingerNumber::ONE);
        let torque = || port.with_finger(address, |finger| finger.motor_torques().amax()).expect("the board has it");
        let mut machine = HandMachine::new(configuration, FingerNumber::ONE);
        machine.spring().expect("a spring");
        assert!(torque() > 0.0);
        machine.off();
        // The last frame needs some time to reach the board. With the configured end state, the motors would hold for
        // one minute.
        let begun = Instant::now();
        while torque() > 0.0 {
            assert!(begun.elapsed() < Duration::from_secs(10), "the motors hold with {} N cm", torque());
            sleep(SAMPLING);
        }
    }
}
