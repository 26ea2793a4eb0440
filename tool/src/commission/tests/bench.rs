//! A finger in memory with wrong wiring.

use crate::commission::machine::Refused;
use std::cell::RefCell;
use std::rc::Rc;
use sun2xp::calibration::{Calibration, Findings, Sample, Task, Verdict};
use sun2xp::control::{Activity, Controller, Feedback, MotorCommand, Report, SetPoint, State};
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::nalgebra::{Vector3, Vector4};
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant, Sensors};

pub const RATE: f64 = 1000.0;

/// How the cables and tendons of a finger are connected. Parts are counted from 0.
#[derive(Clone, Debug)]
pub struct Wiring {
    /// The motor at each driver.
    pub motor_at: [usize; 4],
    /// The motor whose encoder is at each input.
    pub encoder_at: [usize; 4],
    /// The tendon whose gauge is at each input.
    pub gauge_at: [usize; 4],
    /// The tendon on the drum of each motor.
    pub tendon_at: [usize; 4],
    pub dead_encoder: Option<usize>,
    pub dead_motor: Option<usize>,
    pub blocked_motor: Option<usize>,
    pub dead_gauge: Option<usize>,
    /// A gauge, and the rms of its additional noise, counts.
    pub noisy_gauge: Option<(usize, f64)>,
    pub emergency_stop: bool,
    pub no_supply: bool,
}

impl Default for Wiring {
    fn default() -> Self {
        let right = [0, 1, 2, 3];
        Self {
            motor_at: right,
            encoder_at: right,
            gauge_at: right,
            tendon_at: right,
            dead_encoder: None,
            dead_motor: None,
            blocked_motor: None,
            dead_gauge: None,
            noisy_gauge: None,
            emergency_stop: false,
            no_supply: false,
        }
    }
}

/// The finger: its physics, with the values of `truth`, and its controller, with the configuration `belief`.
pub struct World {
    pub plant: Plant,
    pub truth: ConfiguredFinger,
    pub wiring: Wiring,
    sensors: Sensors,
    pub belief: ConfiguredFinger,
    controller: Controller,
    state: State,
    command: MotorCommand,
    pub activity: Activity,
    pub report: Report,
    frozen: Option<i32>,
    random: u64,
    /// The bound of Kx, N/cm. In these tests, the search for the bound returns this value and computes nothing.
    pub bound: f64,
    /// How many of the next readings and routines fail.
    pub lost: (usize, usize),
    /// Largest true tension, N.
    pub largest_tension: f64,
    /// Largest angle of a joint beyond its stops, rad.
    pub beyond_stops: f64,
    /// Largest commanded torque divided by its limit.
    pub largest_torque: f64,
}

impl World {
    pub fn new(truth: &ConfiguredFinger, belief: &ConfiguredFinger, wiring: Wiring) -> Rc<RefCell<Self>> {
        let mut plant = Plant::new(truth, Vector3::zeros()).expect("a plant");
        let mut sensors = Sensors::new(truth);
        let controller = Controller::in_gravity(belief, &Vector3::zeros(), RATE).expect("a controller");
        let (motor_counts, gauge_counts) = sensors.read(&plant);
        let state = controller.start(&Feedback { motor_counts, gauge_counts });
        plant.release_brake();
        if let Some(motor) = wiring.blocked_motor {
            plant.jam_motor(wiring.tendon_at[motor]);
        }
        Rc::new(RefCell::new(Self {
            plant,
            truth: truth.clone(),
            wiring,
            sensors,
            belief: belief.clone(),
            controller,
            state,
            command: MotorCommand::default(),
            activity: Activity::Turn(Vector4::zeros()),
            report: Report::default(),
            frozen: None,
            random: truth.simulation.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1,
            bound: 6.0,
            lost: (0, 0),
            largest_tension: 0.0,
            beyond_stops: f64::NEG_INFINITY,
            largest_torque: 0.0,
        }))
    }

    /// Begins a routine or a reading, which may lose its replies.
    pub fn begin(&mut self, routine: bool) -> Result<(), String> {
        let lost = if routine { &mut self.lost.1 } else { &mut self.lost.0 };
        match *lost {
            0 => Ok(()),
            _ => {
                *lost -= 1;
                Err("the board has sent no measurement".into())
            }
        }
    }

    /// A number between -1 and 1.
    pub fn chance(&mut self) -> f64 {
        self.random = self.random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.random >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn feedback(&mut self) -> Feedback {
        let (counts, gauges) = self.sensors.read(&self.plant);
        let wiring = self.wiring.clone();
        let mut feedback = Feedback {
            motor_counts: wiring.encoder_at.map(|motor| counts[wiring.tendon_at[motor]]),
            gauge_counts: wiring.gauge_at.map(|tendon| gauges[tendon]),
        };
        if let Some(encoder) = wiring.dead_encoder {
            feedback.motor_counts[encoder] = *self.frozen.get_or_insert(feedback.motor_counts[encoder]);
        }
        if let Some(gauge) = wiring.dead_gauge {
            feedback.gauge_counts[gauge] = 700;
        }
        if let Some((gauge, noise)) = wiring.noisy_gauge {
            let noise = self.chance() * noise * 3f64.sqrt();
            feedback.gauge_counts[gauge] = (f64::from(feedback.gauge_counts[gauge]) + noise).clamp(0.0, 4095.0) as u16;
        }
        feedback
    }

    fn advance(&mut self, feedback: &Feedback, previous: Option<&Controller>) {
        let (lower, upper) = self.truth.stops();
        for _ in 0..(1.0 / (RATE * PLANT_STEP_SECONDS)).round() as usize {
            let mut torques = [0.0; 4];
            for driver in 0..4 {
                let motor = self.wiring.motor_at[driver];
                if self.wiring.dead_motor != Some(motor) {
                    torques[self.wiring.tendon_at[motor]] = self.command.motor_torques[driver] * 0.01;
                }
            }
            self.plant.step(torques);
            self.largest_tension = self.largest_tension.max(self.plant.tensions().max());
            let beyond = (self.plant.joints() - upper).sup(&(lower - self.plant.joints())).max();
            self.beyond_stops = self.beyond_stops.max(beyond);
        }
        // The tests compare maxima, which skip NaN. So a finger that has diverged to NaN would pass.
        let (joints, tensions) = (self.plant.joints(), self.plant.tensions());
        assert!(joints.iter().chain(tensions.iter()).all(|value| value.is_finite()), "{joints} {tensions}");
        let limit = Vector4::from(self.belief.motor.torque_limit);
        let part = self.command.motor_torques.abs().component_div(&limit).max();
        self.largest_torque = self.largest_torque.max(part);
        let (state, feedback, activity) = (&mut self.state, Some(feedback), &self.activity);
        (self.command, self.report) = match previous {
            None => self.controller.cycle(state, feedback, activity),
            Some(previous) => self.controller.take_over(previous, state, feedback, activity),
        };
    }

    pub fn run(&mut self, seconds: f64, activity: Activity) {
        self.activity = activity;
        for _ in 0..(seconds * RATE) as usize {
            let feedback = self.feedback();
            self.advance(&feedback, None);
        }
    }

    pub fn motors_off(&mut self, seconds: f64) {
        self.run(seconds, Activity::Turn(Vector4::zeros()));
    }

    pub fn restart(&mut self, finger: &ConfiguredFinger) {
        self.controller = Controller::in_gravity(finger, &Vector3::zeros(), RATE).expect("a controller");
        let feedback = self.feedback();
        self.state = self.controller.start(&feedback);
    }

    /// Makes the finger the spring that `belief` describes.
    pub fn become_spring(&mut self) {
        let belief = self.belief.clone();
        self.restart(&belief);
        self.run(1.0, Activity::TakeUpSlack);
        let joints = self.report.joints;
        self.run(0.5, Activity::Follow(SetPoint::hard_finger(joints, belief.initial_stiffness())));
    }

    pub fn calibrate(&mut self, task: Task) -> Result<Findings, Refused> {
        let mut calibration = Calibration::new(task, &self.belief, RATE).map_err(|error| error.reason)?;
        let controlled = Calibration::controlled(&self.belief, RATE);
        let mut own = Some(Controller::in_gravity(&controlled, &Vector3::zeros(), RATE).map_err(|error| error.reason)?);
        loop {
            let feedback = self.feedback();
            let report = self.report;
            let sample = Sample { feedback: &feedback, report: &report, zero_valid: true };
            let (activity, verdict) = calibration.cycle(&sample);
            match verdict {
                Verdict::InProgress(_) => {}
                Verdict::Found(findings) => {
                    findings.apply(&mut self.belief);
                    return Ok(findings);
                }
                Verdict::Refused(obstacle) => {
                    self.motors_off(0.05);
                    return Err(Refused::Obstacle(obstacle));
                }
            }
            let mut previous = None;
            if let Some(activity) = activity {
                self.activity = activity;
                previous = own.take().map(|own| std::mem::replace(&mut self.controller, own));
            }
            self.advance(&feedback, previous.as_ref());
        }
    }

    /// Largest difference between the true joint angles and those of the controller, rad.
    pub fn joint_error(&self) -> f64 {
        (self.plant.joints() - self.report.joints).amax()
    }
}
