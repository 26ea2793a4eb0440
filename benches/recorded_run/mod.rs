//! Records a closed loop of controller and simulated finger that covers the usual and the exceptional states of a
//! finger.

use nalgebra::{Matrix3, Vector3, Vector4};
use std::error::Error;
use sun2xp::control::{Activity, Controller, Feedback, Report, SetPoint, State};
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::plant::{Plant, Sensors};

pub const RATE: f64 = 1000.0;

/// Number of cycles for which each set point is held.
pub const CYCLES_A_SET_POINT: usize = 500;

/// Joint angles, rad, and Kx relative to [`STIFFNESS`].
const SET_POINTS: [([f64; 3], f64); 6] = [
    ([0.3, 0.6, 1.2], 1.0),
    ([-0.4, 0.2, 0.8], 1.0),
    // Beyond the soft limit of joint 2, which pushes back.
    ([0.0, 0.5, -0.3], 1.0),
    ([0.2, 0.9, 1.5], 0.3),
    // Stiffer than the tendons can support. In a cycle, the controller first scales the stiffness down. If the tensions
    // would still be too large, it also scales the torque down.
    ([0.5, 0.3, 0.7], 40.0),
    ([0.0, 0.5, 1.0], 1.0),
];

#[rustfmt::skip]
const STIFFNESS: Matrix3<f64> = Matrix3::new(
    3.0, 0.2, 0.1,
    0.2, 4.0, 0.3,
    0.1, 0.3, 2.0,
);

pub const CYCLES: usize = CYCLES_A_SET_POINT * SET_POINTS.len();

/// Index of the set point during which the fingertip is pushed, and the force, N. The tensions that the configuration
/// permits cannot balance this force.
const PUSHED: usize = 3;
const PUSH: Vector3<f64> = Vector3::new(0.0, 8.0, 25.0);

/// Returns whether the reply of a cycle is lost.
pub fn lost(cycle: usize) -> bool {
    cycle % 97 == 96
}

pub struct Recording {
    finger: ConfiguredFinger,
    pub controller: Controller,
    pub set_points: Vec<SetPoint>,
    activities: Vec<Activity>,
    pub feedback: Vec<Feedback>,
    pub torques: Vec<Vector4<f64>>,
    reports: Vec<Report>,
}

impl Recording {
    pub fn new(finger: ConfiguredFinger) -> Result<Self, Box<dyn Error>> {
        let controller = Controller::new(&finger, RATE).map_err(|unusable| format!("finger.{unusable}"))?;
        let mut plant = Plant::new(&finger, Vector3::zeros())?;
        let mut sensors = Sensors::new(&finger);
        plant.release_brake();
        let set_points: Vec<SetPoint> = SET_POINTS
            .iter()
            .map(|&(joints, stiffness)| SetPoint {
                law: finger.controller.law,
                ..SetPoint::hard_finger(joints.into(), STIFFNESS * stiffness)
            })
            .collect();
        let activities: Vec<Activity> = set_points.iter().copied().map(Activity::Follow).collect();
        let (mut feedback, mut torques, mut reports) = (Vec::new(), Vec::new(), Vec::new());
        let mut read = |plant: &Plant| {
            let (motor_counts, gauge_counts) = sensors.read(plant);
            Feedback { motor_counts, gauge_counts }
        };
        let mut state = None;
        let mut acting = plant.tensions() * 0.0475;
        for cycle in 0..CYCLES {
            let now = read(&plant);
            feedback.push(now);
            let set_point = cycle / CYCLES_A_SET_POINT;
            plant.set_external_force(if set_point == PUSHED { PUSH } else { Vector3::zeros() });
            // The command of the previous cycle acts during this one.
            for _ in 0..10 {
                plant.step((acting * 0.01).into());
            }
            let state = state.get_or_insert_with(|| controller.start(&now));
            let (command, report) = controller.cycle(state, (!lost(cycle)).then_some(&now), &activities[set_point]);
            acting = command.motor_torques;
            torques.push(acting);
            reports.push(report);
        }
        Ok(Self { finger, controller, set_points, activities, feedback, torques, reports })
    }

    /// Repeats the run. `cycle` receives the inputs of each cycle; the feedback is `None` if the reply is lost.
    pub fn repeat(&self, mut cycle: impl FnMut(&Controller, &mut State, Option<&Feedback>, &Activity)) {
        let mut state = self.controller.start(&self.feedback[0]);
        for (number, feedback) in self.feedback.iter().enumerate() {
            let activity = &self.activities[number / CYCLES_A_SET_POINT];
            cycle(&self.controller, &mut state, (!lost(number)).then_some(feedback), activity);
        }
    }

    /// Returns in how many cycles each exceptional state occurred. A comparison of another controller with this
    /// recording is meaningful only if every one of these states occurred.
    pub fn seen(&self) -> String {
        let cycles = |met: fn(&Report) -> bool| self.reports.iter().filter(|report| met(report)).count();
        let (low, high) = self.finger.joint_limits();
        let beyond = self.reports.iter().filter(|report| report.joints.inf(&high).sup(&low) != report.joints).count();
        format!(
            "of {CYCLES} cycles, {} had a scaled stiffness, {} a scaled torque, {beyond} a joint beyond a soft limit, \
             {} no reply",
            cycles(|report| report.stiffness_scale < 1.0),
            cycles(|report| report.torque_scale < 1.0),
            (0..CYCLES).filter(|&cycle| lost(cycle)).count()
        )
    }
}
