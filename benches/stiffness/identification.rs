//! Runs the identification routine on a finger that differs from its configuration. Users run the same routine before
//! they use a hand.

use crate::cases::{Case, Friction, stiffen};
use nalgebra::Vector3;
use sun2xp::calibration::{Calibration, Obstacle, Sample, Task, Verdict};
use sun2xp::control::{Activity, Controller, Feedback, MotorCommand, Report};
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant, Sensors};

/// Identifies a finger whose true tendons are stiffer than configured by the factors `ratio`. Returns the identified
/// stiffness of each tendon, N/cm. The finger has the default friction, and its sensors return whole counts.
pub fn tendon_stiffness(case: &Case, ratio: &[f64; 4]) -> Result<[f64; 4], Obstacle> {
    let pose = Vector3::from(ConfiguredFinger::default().simulation.start_degrees.map(f64::to_radians));
    let mut truth = case.finger(&pose, Friction::Default);
    stiffen(&mut truth, ratio);
    identified(case, &truth).map(|found| found.tendon.stiffness)
}

/// Identifies a finger. Returns its configuration with the findings.
pub fn identified(case: &Case, truth: &ConfiguredFinger) -> Result<ConfiguredFinger, Obstacle> {
    let mut belief = truth.clone();
    let mut plant = Plant::new(truth, Vector3::zeros()).expect("the default finger");
    let mut sensors = Sensors::new(truth);
    let mut read = move |plant: &Plant| {
        let (motor_counts, gauge_counts) = sensors.read(plant);
        Feedback { motor_counts, gauge_counts }
    };
    let controller =
        Controller::new(&Calibration::controlled(&belief, case.rate), case.rate).expect("the default controller");
    let mut state = controller.start(&read(&plant));
    plant.release_brake();
    let mut command = MotorCommand::default();
    let mut advance = |plant: &mut Plant, feedback: &Feedback, activity: &Activity| {
        for _ in 0..(1.0 / (case.rate * PLANT_STEP_SECONDS)).round() as usize {
            plant.step((command.motor_torques * 0.01).into());
        }
        let (next, report) = controller.cycle(&mut state, Some(feedback), activity);
        command = next;
        report
    };
    for _ in 0..(0.3 * case.rate) as usize {
        let feedback = read(&plant);
        advance(&mut plant, &feedback, &Activity::TakeUpSlack);
    }
    let mut calibration = Calibration::new(Task::Identify, &belief, case.rate).expect("the default finger");
    let mut report = Report::default();
    loop {
        let feedback = read(&plant);
        let (activity, verdict) = calibration.cycle(&Sample { feedback: &feedback, report: &report, zero_valid: true });
        match verdict {
            Verdict::InProgress(_) => {
                let activity = activity.expect("identification takes over in its first cycle");
                report = advance(&mut plant, &feedback, &activity);
            }
            Verdict::Found(findings) => {
                findings.apply(&mut belief);
                return Ok(belief);
            }
            Verdict::Refused(obstacle) => return Err(obstacle),
        }
    }
}
