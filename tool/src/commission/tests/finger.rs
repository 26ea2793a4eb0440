//! The finger in memory as the tool sees it, and the person in front of it.

use super::bench::{RATE, Wiring, World};
use crate::commission::machine::{AtRest, BoardSeen, Bound, Machine, Reading, Refused};
use crate::commission::outcome::Outcome;
use crate::commission::person::{Act, Answer, Person};
use crate::commission::step::Step;
use crate::failure::Failure;
use std::cell::RefCell;
use std::rc::Rc;
use sun2xp::calibration::{Findings, Task};
use sun2xp::control::Feedback;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::nalgebra::{Vector3, Vector4};

/// The finger as the tool sees it.
pub struct Bench(pub Rc<RefCell<World>>);

impl Machine for Bench {
    fn board(&mut self) -> Result<BoardSeen, Failure> {
        let Wiring { emergency_stop, no_supply: supply_fault, .. } = self.0.borrow().wiring;
        let refusal = (emergency_stop || supply_fault).then(|| "the board refuses".into());
        Ok(BoardSeen { name: "a board in memory".into(), refusal, emergency_stop, supply_fault })
    }

    fn configure(&mut self, finger: &ConfiguredFinger) -> Result<(), Failure> {
        let mut world = self.0.borrow_mut();
        if world.belief != *finger {
            world.belief = finger.clone();
            world.restart(finger);
        }
        Ok(())
    }

    fn read(&mut self, seconds: f64) -> Result<Reading, Failure> {
        let mut world = self.0.borrow_mut();
        world.begin(false)?;
        let readings: Vec<Feedback> = (0..(seconds * RATE) as usize)
            .map(|_| {
                world.motors_off(1.0 / RATE);
                world.feedback()
            })
            .collect();
        let mean = |of: &dyn Fn(&Feedback) -> f64| readings.iter().map(of).sum::<f64>() / readings.len() as f64;
        let gauges: [f64; 4] = std::array::from_fn(|gauge| mean(&|reading| f64::from(reading.gauge_counts[gauge])));
        Ok(Reading {
            encoders: std::array::from_fn(|part| mean(&|reading| f64::from(reading.motor_counts[part]))),
            gauges,
            noise: std::array::from_fn(|part| {
                mean(&|reading| (f64::from(reading.gauge_counts[part]) - gauges[part]).powi(2)).sqrt()
            }),
        })
    }

    fn carry_out(&mut self, task: Task) -> Result<Findings, Refused> {
        let mut world = self.0.borrow_mut();
        world.begin(true)?;
        let found = world.calibrate(task)?;
        if task != Task::Signs {
            world.become_spring();
        }
        Ok(found)
    }

    fn at_rest(&mut self) -> Result<AtRest, Failure> {
        let mut world = self.0.borrow_mut();
        let activity = world.activity;
        world.run(1.5, activity);
        let (mut tensions, mut torques, mut force) = (Vector4::zeros(), Vector4::zeros(), Vector3::zeros());
        let mut intended = Vector4::zeros();
        let (mut tip, number) = (Vector3::zeros(), 500.0);
        for _ in 0..500 {
            world.run(1.0 / RATE, activity);
            let report = world.report;
            tensions += report.tensions;
            intended += report.desired_tensions;
            torques += report.motor_torques;
            let links = world.belief.links();
            tip += links.tip(&report.joints);
            let torque = world.belief.r() * report.tensions;
            let jacobian = links.jacobian(&report.joints).transpose();
            force += jacobian.try_inverse().map_or(Vector3::zeros(), |inverse| inverse * torque);
        }
        Ok(AtRest {
            tip: (tip / number).into(),
            force: (force / number).into(),
            tensions: (tensions / number).into(),
            intended: (intended / number).into(),
            torques: (torques / number).into(),
        })
    }

    fn spring(&mut self) -> Result<(), Refused> {
        let mut world = self.0.borrow_mut();
        world.become_spring();
        Ok(())
    }

    fn off(&mut self) {
        self.0.borrow_mut().motors_off(0.2);
    }

    fn bound(&mut self) -> Result<Bound, Failure> {
        let stiffness = self.0.borrow().bound;
        Ok(Bound { stiffness, limit: "a soft tendon, against walls".into() })
    }

    fn computer(&mut self) -> Result<Vec<String>, Failure> {
        Ok(Vec::new())
    }
}

/// The person at the bench. The person turns motors by one turn with an error of up to 6 %, hangs the weights that
/// `hung` returns, and may repair the wiring.
pub struct Helper {
    pub world: Rc<RefCell<World>>,
    /// What the tool has shown at the end of each step.
    pub outcomes: Vec<(Step, Outcome)>,
    pub step: Step,
    /// Whether the person repairs what a step has found.
    pub repairs: bool,
    /// The part that the tool asks for, and the wrong part that the person turns or loads instead.
    pub instead: Option<(usize, usize)>,
    /// Whether the person holds the finger in its pose when asked.
    pub holds: bool,
    /// How often the person wants to try again.
    pub patience: usize,
    /// Whether the person says that the motors were turned the right way.
    pub right_way: bool,
    /// The weight, N, that the person really hangs when the tool asks for a weight, N.
    pub hung: fn(f64) -> f64,
    /// Whether the supply stays off when the person releases the emergency stop.
    pub loses_supply: bool,
    /// What the person cannot do.
    pub cannot: Option<fn(Act) -> bool>,
    /// What the person was asked after failures.
    pub questions: Vec<String>,
    /// What the person was asked to do.
    pub acts: Vec<Act>,
    turned: f64,
}

impl Helper {
    pub fn new(world: &Rc<RefCell<World>>) -> Self {
        Self {
            world: world.clone(),
            outcomes: Vec::new(),
            step: Step::Board,
            repairs: false,
            instead: None,
            holds: true,
            patience: 0,
            right_way: true,
            hung: |newton| newton,
            loses_supply: false,
            cannot: None,
            questions: Vec::new(),
            acts: Vec::new(),
            turned: 0.0,
        }
    }
}

impl Person for Helper {
    fn begin(&mut self, step: Step, _: &ConfiguredFinger) -> Result<(), Failure> {
        self.step = step;
        Ok(())
    }

    fn ask(&mut self, act: Act) -> Result<Answer, Failure> {
        self.acts.push(act);
        if self.cannot.is_some_and(|cannot| cannot(act)) {
            return Ok(Answer::Cannot);
        }
        let mut world = self.world.borrow_mut();
        let instead = self.instead;
        let mistaken = |part: usize| match instead {
            Some((asked, taken)) if asked == part => taken,
            _ => part,
        };
        match act {
            Act::PressEmergencyStop => world.wiring.emergency_stop = true,
            Act::ReleaseEmergencyStop => {
                (world.wiring.emergency_stop, world.wiring.no_supply) = (false, self.loses_supply);
            }
            Act::ConfirmDirection if !self.right_way => return Ok(Answer::Cannot),
            Act::ConfirmDirection => {}
            Act::TurnMotor(motor) if world.wiring.blocked_motor == Some(motor - 1) => return Ok(Answer::Cannot),
            Act::TurnMotor(motor) => {
                let motor = mistaken(motor);
                self.turned = std::f64::consts::TAU * (1.0 + 0.06 * world.chance());
                let tendon = world.wiring.tendon_at[motor - 1];
                world.plant.turn_motor(tendon, -self.turned);
            }
            Act::TurnMotorBack(motor) => {
                let motor = mistaken(motor);
                let tendon = world.wiring.tendon_at[motor - 1];
                world.plant.turn_motor(tendon, self.turned);
            }
            Act::Loosen => (0..4).for_each(|motor| world.plant.turn_motor(motor, -3.0)),
            Act::Hang(tendon, newton) => world.plant.hang(mistaken(tendon) - 1, (self.hung)(newton)),
            Act::Unhang(tendon) => world.plant.hang(mistaken(tendon) - 1, 0.0),
            Act::HoldStill => {
                world.plant.take_up_by_hand();
                let joints = world.plant.joints();
                world.plant.hold(joints);
            }
            Act::HoldPose(_) if !self.holds => {}
            Act::HoldPose(degrees) => {
                // A person moves the finger slowly.
                let (from, to) = (world.plant.joints(), Vector3::from(degrees.map(f64::to_radians)));
                for step in 1..=100 {
                    world.plant.hold(from + (to - from) * f64::from(step) / 100.0);
                    world.motors_off(0.02);
                }
                world.plant.take_up_by_hand();
            }
            Act::LetGo => world.plant.release(),
            Act::Push => world.plant.set_external_force(Vector3::new(1.0, 0.8, -0.6)),
            Act::EndPush => world.plant.set_external_force(Vector3::zeros()),
        }
        Ok(Answer::Done)
    }

    fn show(&mut self, _: &str) {}

    fn conclude(&mut self, outcome: &Outcome) {
        self.outcomes.push((self.step, outcome.clone()));
    }

    fn again(&mut self, question: &str) -> Result<bool, Failure> {
        self.questions.push(question.into());
        if self.repairs {
            self.world.borrow_mut().wiring = Wiring::default();
        }
        let patient = self.patience > 0;
        self.patience = self.patience.saturating_sub(1);
        Ok(std::mem::take(&mut self.repairs) || patient)
    }
}
