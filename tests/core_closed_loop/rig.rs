//! The controller and the simulated finger in one loop, with the one cycle of delay that input and output cost.

use nalgebra::{Vector3, Vector4};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use sun2xp::control::monitors::{Symptom, Watch};
use sun2xp::control::{Activity, Controller, Feedback, MotorCommand, Report, SetPoint, State};
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant, Sensors};

/// A finger counts as settled within this distance of its target, rad.
pub const SETTLED: f64 = 0.02;

pub struct Loop {
    pub plant: Plant,
    pub rate: f64,
    sensors: Sensors,
    controller: Controller,
    /// The controller that is replaced in the next cycle.
    previous: Option<Controller>,
    state: State,
    /// Gravity that a planner has set, m/s^2.
    pub set_gravity: Option<Vector3<f64>>,
    command: MotorCommand,
    /// Fraction of the replies that are lost, and the random numbers that select them.
    loss: f64,
    random: Pcg64,
    /// Smallest commanded and true tensions since the last [`Loop::forget`], N.
    pub least_commanded: f64,
    pub least_true: f64,
    /// Largest change of a motor's command from one cycle to the next, N at the tendon.
    pub largest_jump: f64,
    pub report: Report,
    /// The state of the monitors.
    watch: Watch,
    unwatched: u32,
    /// Whether a false alarm fails the test.
    pub watched: bool,
    /// Alarms that the test provokes and the monitors may raise.
    pub right_alarms: &'static [Symptom],
}

impl Loop {
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Self {
        Self::with_belief(finger, finger, rate)
    }

    /// A finger whose controller has other parameters than the finger.
    pub fn with_belief(finger: &ConfiguredFinger, belief: &ConfiguredFinger, rate: f64) -> Self {
        Self::in_gravity(finger, belief, &Vector3::zeros(), rate)
    }

    /// Does the same as [`Loop::with_belief`], with gravity in the finger's frame, m/s^2, which the controller knows.
    pub fn in_gravity(finger: &ConfiguredFinger, belief: &ConfiguredFinger, gravity: &Vector3<f64>, rate: f64) -> Self {
        let plant = Plant::new(finger, *gravity).unwrap();
        let mut sensors = Sensors::new(finger);
        let controller = Controller::in_gravity(belief, gravity, rate).unwrap();
        let state = controller.start(&read(&mut sensors, &plant));
        let signs = Vector4::from(finger.motor.sign.map(f64::from));
        let motor_torques = plant.tensions().component_mul(&signs) * 0.0475;
        let mut it = Self {
            plant,
            rate,
            sensors,
            controller,
            previous: None,
            state,
            set_gravity: None,
            command: MotorCommand { motor_torques },
            loss: 0.0,
            random: Pcg64::seed_from_u64(5),
            least_commanded: 0.0,
            least_true: 0.0,
            largest_jump: 0.0,
            report: Report::default(),
            watch: Watch::default(),
            unwatched: 0,
            watched: true,
            right_alarms: &[],
        };
        it.forget();
        it.plant.release_brake();
        it
    }

    /// Restarts the controller with the finger in its present state.
    pub fn restart(mut self) -> Self {
        self.state = self.controller.start(&read(&mut self.sensors, &self.plant));
        self.command = MotorCommand { motor_torques: self.plant.tensions() * 0.0475 };
        self.forget();
        self
    }

    /// Replaces the controller and lets the new one take over smoothly.
    pub fn adjust(&mut self, belief: &ConfiguredFinger) {
        let controller = Controller::new(belief, self.rate).unwrap();
        self.previous = Some(std::mem::replace(&mut self.controller, controller));
        self.watch.adjusted();
    }

    /// Replaces the controller. The new one does not take over from the old one, so the command may jump.
    pub fn replace(&mut self, belief: &ConfiguredFinger) {
        self.controller = Controller::new(belief, self.rate).unwrap();
        self.watch.adjusted();
    }

    /// Loses this fraction of the replies from now on.
    pub fn lose(&mut self, loss: f64) {
        self.loss = loss;
    }

    /// Resets the minima and maxima.
    pub fn forget(&mut self) {
        (self.least_commanded, self.least_true, self.largest_jump) = (f64::INFINITY, f64::INFINITY, 0.0);
    }

    pub fn cycle(&mut self, activity: &Activity) {
        let feedback = read(&mut self.sensors, &self.plant);
        // The command of the previous cycle acts during this one.
        let steps = (1.0 / (self.rate * PLANT_STEP_SECONDS)).round() as usize;
        for _ in 0..steps {
            self.plant.step((self.command.motor_torques * 0.01).into());
            self.least_true = self.least_true.min(self.plant.tensions().min());
        }
        // The tests compare minima and maxima, which skip NaN. Without this check, a finger that has diverged to NaN
        // would pass.
        let (joints, tensions) = (self.plant.joints(), self.plant.tensions());
        assert!(joints.iter().chain(tensions.iter()).all(|value| value.is_finite()), "{joints} {tensions}");
        let lost = (self.random.next_u32() as f64) < self.loss * 4294967296.0;
        let feedback = if lost { None } else { Some(&feedback) };
        if let Some(gravity) = &self.set_gravity {
            self.controller.approach_gravity(&mut self.state, gravity);
        }
        let (command, report) = match self.previous.take() {
            None => self.controller.cycle(&mut self.state, feedback, activity),
            Some(previous) => self.controller.take_over(&previous, &mut self.state, feedback, activity),
        };
        assert!(command.motor_torques.iter().all(|torque| torque.is_finite()), "{}", command.motor_torques);
        self.watch(feedback, activity);
        let jump = (command.motor_torques - self.command.motor_torques).amax() / 0.0475;
        self.largest_jump = self.largest_jump.max(jump);
        self.least_commanded = self.least_commanded.min(report.desired_tensions.min());
        self.command = command;
        self.report = report;
    }

    fn watch(&mut self, feedback: Option<&Feedback>, activity: &Activity) {
        self.unwatched += 1;
        match (feedback, activity) {
            (Some(feedback), Activity::Follow(_)) => {
                let age = f64::from(std::mem::take(&mut self.unwatched));
                let alarms = self.controller.watch(&mut self.watch, &self.state, feedback, age, u16::MAX);
                let fault = alarms.fault.filter(|alarm| !self.right_alarms.contains(&alarm.symptom));
                assert!(fault.is_none() || !self.watched, "a false alarm: {fault:?}, {:?}", self.report);
            }
            (None, Activity::Follow(_)) => {}
            _ => (self.watch, self.unwatched) = (Watch::default(), 0),
        }
    }

    pub fn run(&mut self, seconds: f64, activity: &Activity) {
        for _ in 0..(seconds * self.rate) as usize {
            self.cycle(activity);
        }
    }

    /// Mean joint angles over the given time.
    pub fn mean_joints(&mut self, seconds: f64, activity: &Activity) -> Vector3<f64> {
        let cycles = (seconds * self.rate) as usize;
        let mut sum = Vector3::zeros();
        for _ in 0..cycles {
            self.cycle(activity);
            sum += self.plant.joints();
        }
        sum / cycles as f64
    }
}

fn read(sensors: &mut Sensors, plant: &Plant) -> Feedback {
    let (motor_counts, gauge_counts) = sensors.read(plant);
    Feedback { motor_counts, gauge_counts }
}

/// The fingertip as an isotropic spring, N/cm.
pub fn spring(joints: Vector3<f64>, stiffness: f64) -> Activity {
    Activity::Follow(SetPoint::hard_finger(joints, nalgebra::Matrix3::identity() * stiffness))
}

/// 24 poses, rad. Joint 0 is within -30 to 30 degrees, joint 1 within -10 to 70, and joint 2 within 30 to 100.
pub fn poses() -> Vec<Vector3<f64>> {
    poses_of(24)
}

/// Returns 24 poses in the ranges of [`poses`], from this seed.
pub fn poses_of(seed: u64) -> Vec<Vector3<f64>> {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut within =
        |low: f64, high: f64| (low + (high - low) * f64::from(random.next_u32()) / 4294967296.0).to_radians();
    (0..24).map(|_| Vector3::new(within(-30.0, 30.0), within(-10.0, 70.0), within(30.0, 100.0))).collect()
}

pub fn finger_with(scheme: Scheme) -> ConfiguredFinger {
    let mut finger = ConfiguredFinger::default();
    finger.controller.scheme = Some(scheme);
    finger
}

pub const SCHEMES: [Scheme; 4] = [Scheme::Figure9, Scheme::Figure10, Scheme::Figure11, Scheme::StateFeedback];

/// A finger without gauge noise and without dither of the joints. Both would make the torque jump when the controller
/// is switched. With state feedback, the dither of the tensions remains.
pub fn quiet(scheme: Scheme) -> ConfiguredFinger {
    let mut finger = finger_with(scheme);
    finger.simulation.gauge_noise = 0.0;
    finger.controller.dither = Some(0.0);
    finger
}

/// A finger at `degrees` without Coulomb friction.
pub fn smooth(scheme: Scheme, degrees: [f64; 3]) -> ConfiguredFinger {
    let mut finger = quiet(scheme);
    finger.friction.motor_coulomb = [0.0; 4];
    finger.friction.conduit = [0.0; 4];
    finger.friction.joint_coulomb = [0.0; 3];
    finger.simulation.motor_coulomb_friction = [0.0; 4];
    finger.simulation.shaft_friction = 0.0;
    finger.simulation.joint_coulomb_friction = [0.0; 3];
    finger.simulation.start_degrees = degrees;
    finger
}
