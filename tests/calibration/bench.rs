//! A finger and a controller, under the control of a calibration. The parameters of the controller may differ from the
//! parameters of the finger.

use nalgebra::{Vector3, Vector4};
use sun2xp::calibration::{Calibration, Findings, Obstacle, Sample, Step, Task, Verdict};
use sun2xp::control::{Activity, Controller, Feedback, MotorCommand, Report, SetPoint, State};
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant, Sensors};
use sun2xp::simulated::Wiring;

pub struct Bench {
    pub plant: Plant,
    /// The configuration that calibration and controller use. It may differ from the true finger.
    pub belief: ConfiguredFinger,
    rate: f64,
    gravity: Vector3<f64>,
    pub sensors: Sensors,
    controller: Controller,
    state: State,
    command: MotorCommand,
    /// What the finger does at present.
    activity: Activity,
    pub report: Report,
    /// A gauge that always shows the same count.
    pub dead_gauge: Option<(usize, u16)>,
    /// `gauge_at[n]` is the gauge that is plugged in at connector n of the board, 0 to 3.
    pub gauge_at: [usize; 4],
    /// `motor_at[n]` is the connector of the board at which motor n is plugged in, 0 to 3.
    pub motor_at: [usize; 4],
    /// What the board reports about its counts: whether their zero is valid.
    pub zero_valid: bool,
    /// The cables between board and finger.
    pub wiring: Wiring,
    /// Duration of the last routine, s.
    pub seconds: f64,
    /// Largest true tension, N.
    pub largest_tension: f64,
}

impl Bench {
    pub fn new(truth: &ConfiguredFinger, belief: &ConfiguredFinger, rate: f64) -> Self {
        Self::in_gravity(truth, belief, Vector3::zeros(), rate)
    }

    /// Does the same as [`Bench::new`], with gravity, m/s^2 in the finger's frame.
    pub fn in_gravity(truth: &ConfiguredFinger, belief: &ConfiguredFinger, gravity: Vector3<f64>, rate: f64) -> Self {
        let mut plant = Plant::new(truth, gravity).unwrap();
        let mut sensors = Sensors::new(truth);
        let controller = Controller::in_gravity(belief, &gravity, rate).unwrap();
        let state = controller.start(&read(&mut sensors, &plant));
        plant.release_brake();
        Self {
            plant,
            belief: belief.clone(),
            rate,
            gravity,
            sensors,
            controller,
            state,
            command: MotorCommand::default(),
            activity: Activity::Turn(Vector4::zeros()),
            report: Report::default(),
            dead_gauge: None,
            gauge_at: [0, 1, 2, 3],
            motor_at: [0, 1, 2, 3],
            zero_valid: true,
            wiring: Wiring::default(),
            seconds: 0.0,
            largest_tension: 0.0,
        }
    }

    fn feedback(&mut self) -> Feedback {
        let mut feedback = read(&mut self.sensors, &self.plant);
        (feedback.motor_counts, feedback.gauge_counts) =
            self.wiring.counts((feedback.motor_counts, feedback.gauge_counts));
        feedback.gauge_counts = self.gauge_at.map(|gauge| feedback.gauge_counts[gauge]);
        if let Some((gauge, count)) = self.dead_gauge {
            feedback.gauge_counts[gauge] = count;
        }
        feedback
    }

    /// `previous` is the controller that another one replaces in this cycle.
    fn advance(&mut self, feedback: &Feedback, previous: Option<&Controller>) {
        let steps = (1.0 / (self.rate * PLANT_STEP_SECONDS)).round() as usize;
        for _ in 0..steps {
            let torques = self.motor_at.map(|motor| self.command.motor_torques[motor] * 0.01);
            self.plant.step(self.wiring.torques(torques));
            self.largest_tension = self.largest_tension.max(self.plant.tensions().max());
        }
        // The tests compare maxima, which skip NaN. Without this check, a finger that has diverged to NaN would pass.
        let (joints, tensions) = (self.plant.joints(), self.plant.tensions());
        assert!(joints.iter().chain(tensions.iter()).all(|value| value.is_finite()), "{joints} {tensions}");
        let (state, feedback, activity) = (&mut self.state, Some(feedback), &self.activity);
        (self.command, self.report) = match previous {
            None => self.controller.cycle(state, feedback, activity),
            Some(previous) => self.controller.take_over(previous, state, feedback, activity),
        };
        let torques = self.command.motor_torques;
        assert!(torques.iter().all(|torque| torque.is_finite()), "{torques}");
    }

    pub fn run(&mut self, seconds: f64, activity: &Activity) {
        self.activity = *activity;
        for _ in 0..(seconds * self.rate) as usize {
            let feedback = self.feedback();
            self.advance(&feedback, None);
        }
    }

    /// The finger continues its activity.
    pub fn go_on(&mut self, seconds: f64) {
        let activity = self.activity;
        self.run(seconds, &activity);
    }

    /// Takes up slack and holds the pose, as after OpenHand.
    pub fn open(mut self) -> Self {
        self.run(0.3, &Activity::TakeUpSlack);
        let stiffness = nalgebra::Matrix3::identity() * 3.0;
        let joints = self.report.joints;
        self.run(0.5, &Activity::Follow(SetPoint::hard_finger(joints, stiffness)));
        self
    }

    /// Runs a routine to its end. If the routine commands the finger, the routine's controller stays in use until
    /// [`Bench::follow_belief`].
    pub fn calibrate(&mut self, task: Task) -> Result<Findings, Obstacle> {
        self.calibrate_with(task, |_, _| {})
    }

    /// Does the same as [`Bench::calibrate`]. Also calls `happen` in every cycle, with the seconds since the beginning
    /// and with the plant.
    pub fn calibrate_with(
        &mut self,
        task: Task,
        mut happen: impl FnMut(f64, &mut Plant),
    ) -> Result<Findings, Obstacle> {
        let mut calibration = Calibration::new(task, &self.belief, self.rate).unwrap();
        let controlled = Calibration::controlled(&self.belief, self.rate);
        let mut own = Some(Controller::in_gravity(&controlled, &self.gravity, self.rate).unwrap());
        self.largest_tension = 0.0;
        let mut last = 0.0;
        for cycle in 0.. {
            self.seconds = cycle as f64 / self.rate;
            happen(self.seconds, &mut self.plant);
            let feedback = self.feedback();
            let report = self.report;
            let sample = Sample { feedback: &feedback, report: &report, zero_valid: self.zero_valid };
            let (activity, verdict) = calibration.cycle(&sample);
            match verdict {
                Verdict::InProgress(progress) => {
                    assert!((0.0..=1.0).contains(&progress.part) && progress.part >= last - 0.3, "{progress:?}");
                    let oscillating = progress.step == Step::OscillatingTensions;
                    assert!(!oscillating || progress.part >= last - 1e-9, "{progress:?} after {last}");
                    last = progress.part;
                }
                Verdict::Found(findings) => {
                    findings.apply(&mut self.belief);
                    return Ok(findings);
                }
                Verdict::Refused(obstacle) => {
                    // If the routine has commanded the finger before, it switches the motors off. Otherwise it gives no
                    // command, and the finger continues under its own controller.
                    let motors_off = Some(Activity::Turn(Vector4::zeros()));
                    assert_eq!(activity, if own.is_none() { motors_off } else { None });
                    return Err(obstacle);
                }
            }
            let mut previous = None;
            if let Some(activity) = activity {
                self.activity = activity;
                previous = own.take().map(|own| std::mem::replace(&mut self.controller, own));
            }
            self.advance(&feedback, previous.as_ref());
        }
        unreachable!("a routine ends by its time limit at the latest")
    }

    /// Replaces the controller by one with the present belief.
    pub fn follow_belief(&mut self) {
        self.controller = Controller::in_gravity(&self.belief, &self.gravity, self.rate).unwrap();
        let feedback = self.feedback();
        self.state = self.controller.start(&feedback);
    }

    /// Replaces the controller by one with the new findings, and makes the finger a spring again.
    pub fn adopt(mut self) -> Self {
        self.follow_belief();
        self.open()
    }
}

fn read(sensors: &mut Sensors, plant: &Plant) -> Feedback {
    let (motor_counts, gauge_counts) = sensors.read(plant);
    Feedback { motor_counts, gauge_counts }
}
