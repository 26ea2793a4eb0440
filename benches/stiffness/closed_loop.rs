//! The controller and the simulated finger in one loop, with one cycle between sample and torque.

use crate::cases::{Case, Friction};
use nalgebra::{Matrix3, Vector3, Vector4};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use sun2xp::control::monitors::{Alarm, Watch};
use sun2xp::control::{Activity, Controller, Feedback, Measured, MotorCommand, Report, SetPoint, State};
use sun2xp::model::InverseKinematics;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant, Sensors};

#[derive(Clone)]
pub struct ClosedLoop {
    pub plant: Plant,
    pub report: Report,
    pub set_point: SetPoint,
    /// Smallest true and commanded tension, and largest true tension, since [`ClosedLoop::reset_extremes`], N.
    pub least_true: f64,
    pub least_commanded: f64,
    pub most_true: f64,
    pub finger: ConfiguredFinger,
    pub rate: f64,
    /// The first fault that a monitor reported.
    pub fault: Option<Alarm>,
    watch: Watch,
    sensors: Sensors,
    senses: Senses,
    controller: Controller,
    inverse: InverseKinematics,
    state: State,
    command: MotorCommand,
    loss: f64,
    random: Pcg64,
}

/// A finger that its controller holds at `pose` with the stiffness `kx`. The controller uses the configuration
/// `belief`, which may differ from the true parameters in `finger`.
pub struct Held<'a> {
    pub case: &'a Case,
    pub finger: &'a ConfiguredFinger,
    pub belief: &'a ConfiguredFinger,
    pub pose: &'a Vector3<f64>,
    pub kx: &'a Matrix3<f64>,
    pub senses: Senses,
}

/// How the controller receives the measurements.
#[derive(Clone, Copy, PartialEq)]
pub enum Senses {
    /// In counts, with noise.
    Counts,
    /// Exactly.
    Exact,
}

impl ClosedLoop {
    /// Creates a finger that is measured in counts and whose controller knows its true parameters.
    pub fn at(case: &Case, pose: &Vector3<f64>, friction: Friction, kx: &Matrix3<f64>) -> Self {
        let finger = &case.finger(pose, friction);
        Self::new(&Held { case, finger, belief: finger, pose, kx, senses: Senses::Counts })
    }

    /// Creates a finger that has been held for 0.3 s.
    pub fn new(held: &Held) -> Self {
        let &Held { case, finger, belief, pose, kx, senses } = held;
        let mut plant = Plant::new(finger, Vector3::zeros()).expect("the default finger");
        let mut sensors = Sensors::new(finger);
        let controller = match &case.numbers {
            Some(numbers) => Controller::with_numbers(belief, case.rate, numbers),
            None => Controller::new(belief, case.rate),
        };
        let controller = controller.expect("the default controller");
        let state = controller.start(&read(&mut sensors, &plant));
        plant.release_brake();
        let radius = Vector4::from(finger.geometry.motor_radius);
        let motor_torques = plant.tensions().component_mul(&radius);
        let set_point = SetPoint { law: case.law, ..SetPoint::hard_finger(*pose, *kx) };
        let mut this = Self {
            plant,
            report: Report::default(),
            set_point,
            least_true: f64::INFINITY,
            least_commanded: f64::INFINITY,
            most_true: 0.0,
            inverse: InverseKinematics::new(finger.links(), finger.joint_limits()),
            finger: finger.clone(),
            rate: case.rate,
            fault: None,
            watch: Watch::default(),
            sensors,
            senses,
            controller,
            state,
            command: MotorCommand { motor_torques },
            loss: 0.0,
            random: Pcg64::seed_from_u64(case.seed + 7),
        };
        this.run(0.3);
        this.reset_extremes();
        this
    }

    /// Returns the position of the spring's anchor, cm.
    pub fn anchor(&self) -> Vector3<f64> {
        self.finger.links().tip(&self.set_point.joints)
    }

    /// Moves the spring's anchor to `tip`, cm. Returns whether that is within reach.
    #[must_use]
    pub fn move_anchor(&mut self, tip: &Vector3<f64>) -> bool {
        let present = self.set_point.joints;
        let found = self.inverse.joints(tip, &present);
        self.set_point.joints = *found.as_ref().unwrap_or(&present);
        found.is_ok()
    }

    pub fn push(&mut self, force: Vector3<f64>) {
        self.plant.set_external_force(force);
    }

    /// Loses replies with the probability `loss` from now on.
    pub fn lose(&mut self, loss: f64) {
        self.loss = loss;
    }

    pub fn reset_extremes(&mut self) {
        (self.least_true, self.least_commanded, self.most_true) = (f64::INFINITY, f64::INFINITY, 0.0);
    }

    pub fn cycle(&mut self) {
        let counts = read(&mut self.sensors, &self.plant);
        let values = Measured { motor_angles: self.plant.motor_angles(), tensions: self.plant.tensions() };
        // The command of the previous cycle acts during this one.
        for _ in 0..(1.0 / (self.rate * PLANT_STEP_SECONDS)).round() as usize {
            self.plant.step((self.command.motor_torques * 0.01).into());
            let tensions = self.plant.tensions();
            self.least_true = self.least_true.min(tensions.min());
            self.most_true = self.most_true.max(tensions.max());
        }
        let arrived = f64::from(self.random.next_u32()) >= self.loss * 4294967296.0;
        let activity = Activity::Follow(self.set_point);
        (self.command, self.report) = match self.senses {
            Senses::Counts => self.controller.cycle(&mut self.state, arrived.then_some(&counts), &activity),
            Senses::Exact => self.controller.cycle_measured(&mut self.state, arrived.then_some(&values), &activity),
        };
        if arrived {
            let alarms = self.controller.watch(&mut self.watch, &self.state, &counts, 1.0, 4095);
            self.fault = self.fault.or(alarms.fault);
        }
        self.least_commanded = self.least_commanded.min(self.report.desired_tensions.min());
    }

    pub fn run(&mut self, seconds: f64) {
        (0..self.cycles(seconds)).for_each(|_| self.cycle());
    }

    /// Returns the true position of the tip in every cycle of this time, cm.
    pub fn tips(&mut self, seconds: f64) -> Vec<Vector3<f64>> {
        (0..self.cycles(seconds))
            .map(|_| {
                self.cycle();
                self.plant.tip()
            })
            .collect()
    }

    /// Returns the mean of the true position of the tip over this time, cm.
    pub fn mean_tip(&mut self, seconds: f64) -> Vector3<f64> {
        let tips = self.tips(seconds);
        tips.iter().sum::<Vector3<f64>>() / tips.len() as f64
    }

    pub fn cycles(&self, seconds: f64) -> usize {
        (seconds * self.rate).round() as usize
    }
}

fn read(sensors: &mut Sensors, plant: &Plant) -> Feedback {
    let (motor_counts, gauge_counts) = sensors.read(plant);
    Feedback { motor_counts, gauge_counts }
}
