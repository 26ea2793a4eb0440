//! Gains of gauges, friction of joints and motors, stiffness of tendons.

use super::balance::{Balance, SWING};
use super::findings::{Findings, Identified};
use super::instruments::Instruments;
use super::joint_friction::JointFriction;
use super::joint_lead::JointLead;
use super::motor_friction::MotorFriction;
use super::obstacle::Obstacle;
use super::pressing::Pressing;
use super::step::{Progress, Sample, Step, Stepped};
use super::stop_search::StopSearch;
use super::take_up::TakeUp;
use super::tendon_stiffness::TendonStiffness;
use crate::control::signals::Activity;
use crate::model::configuration::{ConfiguredFinger, GaugeReference};
use nalgebra::Vector3;
use std::ops::ControlFlow::{Break, Continue};

/// How much further than its range a joint is led in search of its lower stop, rad.
const BEYOND: f64 = 0.17;
/// How near to where it began a joint is brought back, rad.
const NEAR: f64 = 0.05;
/// Torque on every joint with which gauges are compared, N cm: wrong ones turn the joints.
const BALANCING: f64 = 10.0;
/// Room that a joint keeps to its stops then, beyond its swing, rad.
const ROOM: f64 = 0.1;
/// A joint that pulls at its limit for so long on its way back is blocked, s.
const BLOCKED: f64 = 0.5;

#[derive(Clone, Debug)]
pub(super) struct Identification {
    torque: f64,
    speed: f64,
    stops: (Vector3<f64>, Vector3<f64>),
    reference: GaugeReference,
    /// Where it began, rad.
    start: Vector3<f64>,
    stop: Vector3<f64>,
    joint_coulomb: Vector3<f64>,
    joint_viscous: Vector3<f64>,
    phase: Phase,
}

// No heap in the servo: the largest phase takes its room.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug)]
enum Phase {
    Tighten(TakeUp),
    Balance { lead: JointLead, balance: Balance },
    Seek { lead: JointLead, joint: usize, search: StopSearch },
    Swing { lead: JointLead, friction: JointFriction, joint: usize },
    Press { pressing: Pressing, stiffness: TendonStiffness, friction: MotorFriction },
    Return { lead: JointLead, joint: usize, strained: f64, found: Identified },
}

impl Identification {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        Self {
            torque: finger.zeroing.torque,
            speed: finger.zeroing.speed,
            stops: finger.stops(),
            reference: finger.gauge.reference,
            start: Vector3::zeros(),
            stop: Vector3::zeros(),
            joint_coulomb: Vector3::zeros(),
            joint_viscous: Vector3::zeros(),
            phase: Phase::Tighten(TakeUp::new()),
        }
    }

    pub fn step(&mut self, instruments: &mut Instruments, sample: &Sample) -> Stepped {
        let going = |step, part, activity| Ok(Continue((activity, Progress { step, part })));
        match &mut self.phase {
            Phase::Tighten(take_up) => match take_up.step(instruments, sample)? {
                Some(activity) => going(Step::TakingUpSlack, 0.0, activity),
                None => {
                    let lead = JointLead::new(instruments, sample, BALANCING);
                    self.start = lead.joints;
                    let room = SWING + ROOM;
                    let (low, high) = (self.stops.0.add_scalar(room), self.stops.1.add_scalar(-room));
                    let centre = Vector3::from_fn(|joint, _| lead.joints[joint].min(high[joint]).max(low[joint]));
                    self.phase = Phase::Balance { lead, balance: Balance::new(centre) };
                    going(Step::ComparingGauges, 0.0, lead.activity(instruments, sample))
                }
            },
            Phase::Balance { lead, balance } => {
                lead.measure(instruments, sample);
                let found = balance.step(instruments, sample, lead)?;
                let activity = lead.activity(instruments, sample);
                if let Some(gain) = found {
                    instruments.gain = gain;
                    self.phase = self.seek(JointLead::new(instruments, sample, self.torque), 0);
                }
                going(Step::ComparingGauges, 0.02, activity)
            }
            &mut Phase::Seek { ref mut lead, joint, ref mut search } => {
                lead.measure(instruments, sample);
                let met = search.step(instruments, lead, self.speed)?;
                let activity = lead.activity(instruments, sample);
                if let Some(angle) = met {
                    self.stop[joint] = angle;
                    let lead = *lead;
                    self.phase = if joint < 2 { self.seek(lead, joint + 1) } else { self.swing(lead, 0) };
                }
                going(Step::SeekingStops, 0.05 + 0.05 * joint as f64, activity)
            }
            &mut Phase::Swing { ref mut lead, ref mut friction, joint } => {
                lead.measure(instruments, sample);
                let found = friction.step(instruments, sample, lead)?;
                let activity = lead.activity(instruments, sample);
                if let Some((coulomb, viscous)) = found {
                    self.joint_coulomb[joint] = coulomb;
                    self.joint_viscous[joint] = viscous;
                    self.phase = if joint < 2 {
                        let lead = *lead;
                        self.swing(lead, joint + 1)
                    } else {
                        Phase::Press {
                            pressing: Pressing::new(instruments),
                            stiffness: TendonStiffness::new(instruments),
                            friction: MotorFriction::new(),
                        }
                    };
                }
                going(Step::MovingJoints, 0.2 + 0.1 * joint as f64, activity)
            }
            Phase::Press { pressing, stiffness, friction } => {
                if pressing.under_way() {
                    stiffness.add(instruments, sample);
                    friction.add(instruments, sample);
                }
                let part = 0.5 + 0.4 * pressing.part();
                match pressing.step(instruments, &instruments.tensions(sample.feedback)) {
                    Some(tensions) => going(Step::Pressing, part, Activity::Tense(instruments.ask(tensions))),
                    None => {
                        let (tendon_stiffness, travel_residual) = stiffness.solve()?;
                        let [coulomb, conduit, ratio] = friction.solve()?;
                        let found = Identified {
                            tendon_stiffness,
                            travel_residual,
                            gauge_gain: instruments.gain,
                            motor_coulomb: coulomb.component_mul(&instruments.radius),
                            conduit,
                            motor_ratio: ratio.map(f64::recip),
                            joint_coulomb: self.joint_coulomb,
                            joint_viscous: self.joint_viscous,
                        };
                        let found = match self.reference {
                            GaugeReference::Gauges => found,
                            GaugeReference::Motors => found.scaled(ratio.mean()),
                        };
                        let mut lead = JointLead::new(instruments, sample, self.torque);
                        // Still against the stops: led away from there.
                        lead.anchor = lead.joints;
                        let activity = lead.activity(instruments, sample);
                        self.phase = Phase::Return { lead, joint: 0, strained: 0.0, found };
                        going(Step::Returning, 0.9, activity)
                    }
                }
            }
            &mut Phase::Return { ref mut lead, ref mut joint, ref mut strained, found } => {
                lead.measure(instruments, sample);
                lead.advance(*joint, self.start[*joint], self.speed * instruments.period);
                *strained = if lead.strained(*joint) { *strained + instruments.period } else { 0.0 };
                if *strained > BLOCKED {
                    return Err(Obstacle::JointBlocked { joint: *joint as u8 });
                }
                let activity = lead.activity(instruments, sample);
                if (lead.joints[*joint] - self.start[*joint]).abs() < NEAR {
                    if *joint == 2 {
                        return Ok(Break(Findings::Identified(found)));
                    }
                    *joint += 1;
                }
                going(Step::Returning, 0.95, activity)
            }
        }
    }

    fn seek(&self, lead: JointLead, joint: usize) -> Phase {
        Phase::Seek {
            lead,
            joint,
            search: StopSearch::new(joint, -(self.stops.1[joint] - self.stops.0[joint] + BEYOND)),
        }
    }

    fn swing(&self, lead: JointLead, joint: usize) -> Phase {
        Phase::Swing { lead, friction: JointFriction::new(joint, self.stop[joint]), joint }
    }
}
