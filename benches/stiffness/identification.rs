//! Runs the identification routine on a finger that differs from its configuration. Users run the same routine before
//! they use a hand.

use crate::cases::{Case, Friction, stiffen};
use nalgebra::Vector3;
use sun2xp::calibration::{Calibration, Obstacle, Sample, Task, Verdict};
use sun2xp::control::{Activity, Controller, Feedback, MotorCommand, Report, State};
use sun2xp::model::configuration::{ConfiguredFinger, ZeroingMethod};
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant, Sensors};

/// Identifies a finger whose true tendons have `ratio` times the configured stiffness. Returns the identified stiffness
/// of each tendon, N/cm. The finger has the default friction, and its sensors return whole counts.
pub fn tendon_stiffness(case: &Case, ratio: &[f64; 4]) -> Result<[f64; 4], Obstacle> {
    let pose = Vector3::from(ConfiguredFinger::default().simulation.start_degrees.map(f64::to_radians));
    let mut truth = case.finger(&pose, Friction::Default);
    stiffen(&mut truth, ratio);
    identified(case, &truth).map(|found| found.tendon.stiffness)
}

/// Zeros the gauges of a finger and identifies it. Returns its configuration with the findings. The zeros of the
/// encoders in `truth` are correct, and are kept.
pub fn identified(case: &Case, truth: &ConfiguredFinger) -> Result<ConfiguredFinger, Obstacle> {
    let mut belief = truth.clone();
    belief.zeroing.method = Some(ZeroingMethod::Kept);
    let mut finger = UnknownFinger::new(case, truth);
    for task in [Task::Zero, Task::Identify] {
        finger.run(task, &mut belief)?;
    }
    belief.zeroing.method = truth.zeroing.method;
    Ok(belief)
}

/// A finger that differs from its configuration.
struct UnknownFinger {
    rate: f64,
    plant: Plant,
    sensors: Sensors,
    command: MotorCommand,
}

impl UnknownFinger {
    fn new(case: &Case, truth: &ConfiguredFinger) -> Self {
        let mut plant = Plant::new(truth, Vector3::zeros()).expect("the default finger");
        plant.release_brake();
        Self { rate: case.rate, plant, sensors: Sensors::new(truth), command: MotorCommand::default() }
    }

    fn read(&mut self) -> Feedback {
        let (motor_counts, gauge_counts) = self.sensors.read(&self.plant);
        Feedback { motor_counts, gauge_counts }
    }

    /// Runs one cycle of the controller, and the physics for one period.
    fn advance(
        &mut self,
        controller: &Controller,
        state: &mut State,
        feedback: &Feedback,
        activity: &Activity,
    ) -> Report {
        for _ in 0..(1.0 / (self.rate * PLANT_STEP_SECONDS)).round() as usize {
            self.plant.step((self.command.motor_torques * 0.01).into());
        }
        let (command, report) = controller.cycle(state, Some(feedback), activity);
        self.command = command;
        report
    }

    /// Runs a routine, and puts its findings into the configuration `belief`.
    fn run(&mut self, task: Task, belief: &mut ConfiguredFinger) -> Result<(), Obstacle> {
        let controlled = Calibration::controlled(belief, self.rate);
        let controller = Controller::new(&controlled, self.rate).expect("the default controller");
        let mut state = controller.start(&self.read());
        // A finger that is not under tension after 10 s is left to the routine, which tightens the tendons itself.
        for cycle in 0..(10.0 * self.rate) as usize {
            let feedback = self.read();
            let report = self.advance(&controller, &mut state, &feedback, &Activity::TakeUpSlack);
            if report.under_tension && cycle as f64 > 0.3 * self.rate {
                break;
            }
        }
        let mut calibration = Calibration::new(task, belief, self.rate).expect("the default finger");
        let mut report = Report::default();
        // In its first cycles, zeroing returns no activity. In these cycles the finger continues to take up slack.
        let mut newest = Activity::TakeUpSlack;
        loop {
            let feedback = self.read();
            let sample = Sample { feedback: &feedback, report: &report, zero_valid: true };
            let (activity, verdict) = calibration.cycle(&sample);
            match verdict {
                Verdict::InProgress(_) => {
                    newest = activity.unwrap_or(newest);
                    report = self.advance(&controller, &mut state, &feedback, &newest);
                }
                Verdict::Found(findings) => {
                    findings.apply(belief);
                    return Ok(());
                }
                Verdict::Refused(obstacle) => return Err(obstacle),
            }
        }
    }
}
