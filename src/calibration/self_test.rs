//! Checks the wiring of a calibrated finger within two seconds: each motor moves its own encoder and pulls its own
//! tendon, in the configured directions, and every gauge shows the tension.
//!
//! First each motor alone pulls until an encoder moves. Then the positions of all motors are controlled. All motors
//! wind in until the tendons are tight. Then one motor after the other pulls for some milliseconds. The gauge of the
//! pulling motor shows the pull first, because the links delay the pull at the other gauges. Finally, all motors wind
//! in a little more. The tensions of a finger that nothing touches rise along the null vector of R (eq. 14: tau = R t),
//! whatever the friction of the motors. So the rises of the gauges show whether their scales agree.

mod holding;
mod readings;
mod single_pull;
mod verdict;

use super::findings::Findings;
use super::instruments::Instruments;
use super::step::{Progress, Sample, Step, Stepped};
use crate::control::signals::{Activity, Feedback};
use crate::model::LinkDynamics;
use crate::model::configuration::ConfiguredFinger;
use holding::Holding;
use nalgebra::{Vector3, Vector4};
use readings::Readings;
use single_pull::SinglePull;
use std::ops::ControlFlow::{Break, Continue};
use verdict::judge;

/// Approximate duration of the test, s.
const DURATION: f64 = 1.6;

#[derive(Clone, Debug)]
pub(super) struct SelfTest {
    seconds: f64,
    /// Travel at the beginning, cm.
    start: Option<Vector4<f64>>,
    last: Vector4<f64>,
    phase: Phase,
    /// Pull of each motor that overcomes its configured friction, N.
    friction: Vector4<f64>,
    dynamics: LinkDynamics,
}

// The servo does not use the heap, so the larger variant is not boxed.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug)]
enum Phase {
    /// One motor pulls alone.
    PullingAlone(SinglePull),
    /// All motors are held.
    Holding(Holding),
}

impl SelfTest {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let radius = Vector4::from(finger.geometry.motor_radius);
        let links = &finger.links;
        Self {
            seconds: 0.0,
            start: None,
            last: Vector4::zeros(),
            phase: Phase::PullingAlone(SinglePull::of(0)),
            friction: Vector4::from(finger.friction.motor_coulomb).component_div(&radius),
            dynamics: LinkDynamics::new(finger.links(), links.masses, links.radii, Vector3::zeros()),
        }
    }

    /// Runs one cycle of the current phase.
    pub fn step(&mut self, instruments: &Instruments, sample: &Sample) -> Stepped {
        self.seconds += instruments.period;
        let readings = self.read(instruments, sample.feedback);
        let pulls = match &mut self.phase {
            Phase::PullingAlone(single) => {
                let pulls = single.step(instruments, &readings)?;
                if single.motor() == 4 {
                    self.phase = Phase::Holding(Holding::new(&readings.travel));
                }
                pulls
            }
            Phase::Holding(holding) => match holding.step(instruments, &self.friction, &readings)? {
                Continue(pulls) => pulls,
                Break(responses) => {
                    let travel = readings.travel + self.start.unwrap_or_default();
                    judge(&responses, instruments, &self.dynamics, &travel)?;
                    return Ok(Break(Findings::RightWiring));
                }
            },
        };
        let progress = Progress { step: Step::TryingMotors, part: (self.seconds / DURATION).min(1.0) };
        Ok(Continue((Activity::Turn(pulls.component_mul(&instruments.signed_radius)), progress)))
    }

    fn read(&mut self, instruments: &Instruments, feedback: &Feedback) -> Readings {
        let travel = instruments.travel(feedback);
        let start = *self.start.get_or_insert(travel);
        let travel = travel - start;
        let speed = (travel - self.last) / instruments.period;
        self.last = travel;
        Readings { travel, speed, tensions: instruments.tensions(feedback) }
    }
}
