//! The core and the simulated finger in one loop, with one cycle between sample and torque.

use crate::cases::{Case, Friction};
use nalgebra::{Matrix3, Vector3};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use sun2xp::control::{Activity, Command, Controller, Feedback, InverseKinematics, Law, Report, SetPoint, State};
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant, Sensors};

pub struct ClosedLoop {
    pub plant: Plant,
    pub report: Report,
    /// Smallest true and commanded tensions, largest true one, since [`ClosedLoop::forget`], N.
    pub least_true: f64,
    pub least_commanded: f64,
    pub most_true: f64,
    pub finger: ConfiguredFinger,
    pub rate: f64,
    sensors: Sensors,
    controller: Controller,
    inverse: InverseKinematics,
    state: State,
    command: Command,
    set_point: SetPoint,
    loss: f64,
    random: Pcg64,
}

impl ClosedLoop {
    /// A finger at rest at `pose`, held there by a spring Kx for 0.3 s.
    pub fn at(case: &Case, pose: &Vector3<f64>, friction: Friction, kx: &Matrix3<f64>) -> Self {
        let finger = case.finger(pose, friction);
        Self::with_belief(case, &finger, &finger, pose, kx)
    }

    /// A finger whose controller believes something else of it.
    pub fn with_belief(
        case: &Case,
        finger: &ConfiguredFinger,
        belief: &ConfiguredFinger,
        pose: &Vector3<f64>,
        kx: &Matrix3<f64>,
    ) -> Self {
        let mut plant = Plant::new(finger, Vector3::zeros()).expect("the default finger");
        let mut sensors = Sensors::new(finger);
        let controller = Controller::new(belief, case.rate).expect("the default controller");
        let state = controller.start(&read(&mut sensors, &plant));
        plant.release_brake();
        let motor_torques = plant.tensions() * 0.0475;
        // Exact law: it is the fidelity of the spring that is measured.
        let set_point = SetPoint { law: Law::Exact, ..SetPoint::hard_finger(*pose, *kx) };
        let mut this = Self {
            plant,
            report: Report::default(),
            least_true: f64::INFINITY,
            least_commanded: f64::INFINITY,
            most_true: 0.0,
            inverse: InverseKinematics::new(finger.links(), finger.joint_limits()),
            finger: finger.clone(),
            rate: case.rate,
            sensors,
            controller,
            state,
            command: Command { motor_torques },
            set_point,
            loss: 0.0,
            random: Pcg64::seed_from_u64(case.seed + 7),
        };
        this.run(0.3);
        this.forget();
        this
    }

    /// Where the spring is anchored, cm.
    pub fn anchor(&self) -> Vector3<f64> {
        self.finger.links().tip(&self.set_point.joints)
    }

    /// Anchors the spring elsewhere, cm. It must be within reach.
    pub fn move_anchor(&mut self, tip: &Vector3<f64>) {
        let present = self.set_point.joints;
        self.set_point.joints = self.inverse.joints(tip, &present).expect("the cases stay within reach");
    }

    pub fn push(&mut self, force: Vector3<f64>) {
        self.plant.set_external_force(force);
    }

    /// From now on this part of the replies is lost.
    pub fn lose(&mut self, loss: f64) {
        self.loss = loss;
    }

    pub fn forget(&mut self) {
        (self.least_true, self.least_commanded, self.most_true) = (f64::INFINITY, f64::INFINITY, 0.0);
    }

    pub fn cycle(&mut self) {
        let feedback = read(&mut self.sensors, &self.plant);
        // What the last cycle commanded acts during this one.
        for _ in 0..(1.0 / (self.rate * PLANT_STEP_SECONDS)).round() as usize {
            self.plant.step((self.command.motor_torques * 0.01).into());
            let tensions = self.plant.tensions();
            self.least_true = self.least_true.min(tensions.min());
            self.most_true = self.most_true.max(tensions.max());
        }
        let lost = f64::from(self.random.next_u32()) < self.loss * 4294967296.0;
        let feedback = (!lost).then_some(&feedback);
        let activity = Activity::Follow(self.set_point);
        (self.command, self.report) = self.controller.cycle(&mut self.state, feedback, &activity);
        self.least_commanded = self.least_commanded.min(self.report.desired_tensions.min());
    }

    pub fn run(&mut self, seconds: f64) {
        (0..self.cycles(seconds)).for_each(|_| self.cycle());
    }

    /// Mean of the true tip over so many seconds, cm.
    pub fn mean_tip(&mut self, seconds: f64) -> Vector3<f64> {
        let cycles = self.cycles(seconds);
        let mut sum = Vector3::zeros();
        for _ in 0..cycles {
            self.cycle();
            sum += self.plant.tip();
        }
        sum / cycles as f64
    }

    pub fn cycles(&self, seconds: f64) -> usize {
        (seconds * self.rate).round() as usize
    }
}

fn read(sensors: &mut Sensors, plant: &Plant) -> Feedback {
    let (motor_counts, gauge_counts) = sensors.read(plant);
    Feedback { motor_counts, gauge_counts }
}
