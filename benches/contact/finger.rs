//! A finger in a closed loop with its controller, in simulated time, without the serial line between them.

use nalgebra::{Matrix3, Vector3, Vector4};
use std::error::Error;
use sun2xp::control::{Activity, Controller, Feedback, Report, SetPoint, State};
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant, Sensors};

pub const RATE: f64 = 1000.0;

/// Kx of every set point, N/cm.
const STIFFNESS: f64 = 3.0;

pub struct Finger {
    pub plant: Plant,
    pub sensors: Sensors,
    controller: Controller,
    state: State,
    /// Motor torques that act during the next cycle, N cm.
    acting: Vector4<f64>,
}

impl Finger {
    /// Constructs a finger at rest, whose motors hold the initial tensions. `belief` is the configuration of its
    /// controller. `gravity` is in m/s^2, in the finger's frame.
    pub fn new(
        finger: &ConfiguredFinger,
        belief: &ConfiguredFinger,
        gravity: Vector3<f64>,
    ) -> Result<Self, Box<dyn Error>> {
        let controller = Controller::in_gravity(belief, &gravity, RATE).map_err(|unusable| unusable.reason)?;
        let mut plant = Plant::new(finger, gravity)?;
        let mut sensors = Sensors::new(finger);
        plant.release_brake();
        let (motor_counts, gauge_counts) = sensors.read(&plant);
        let state = controller.start(&Feedback { motor_counts, gauge_counts });
        let acting = plant.tensions().component_mul(&Vector4::from(finger.geometry.motor_radius));
        Ok(Self { plant, sensors, controller, state, acting })
    }

    /// Runs one cycle toward these joint angles, rad. The command of the previous cycle acts during the cycle.
    pub fn cycle(&mut self, joints: Vector3<f64>) -> Report {
        let (motor_counts, gauge_counts) = self.sensors.read(&self.plant);
        let feedback = Feedback { motor_counts, gauge_counts };
        for _ in 0..(1.0 / RATE / PLANT_STEP_SECONDS).round() as usize {
            self.plant.step((self.acting * 0.01).into());
        }
        let activity = Activity::Follow(SetPoint::hard_finger(joints, Matrix3::identity() * STIFFNESS));
        let (command, report) = self.controller.cycle(&mut self.state, Some(&feedback), &activity);
        self.acting = command.motor_torques;
        report
    }
}
