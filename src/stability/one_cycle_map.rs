//! The motion of a finger near a rest, as a linear map of one cycle: plant, controller, and the one cycle of delay
//! between sample and torque.

use super::growth;
use crate::control::{Activity, Controller, Feedback, Law, Measured, Report, SetPoint, State, TensionDistribution};
use crate::model::Tendons;
use crate::model::configuration::{ConfiguredFinger, ConfiguredSimulation, Unusable};
use crate::plant::{PLANT_STEP_SECONDS, Plant, Sensors};
use nalgebra::{DVector, Matrix3, Vector3, Vector4};

/// Time in which the filters and integrals of the controller settle, s.
const SETTLING: f64 = 0.3;

/// Time for which the motion is observed first, s.
const OBSERVED: f64 = 1.0;

/// Time for which the motion is observed again if the first observation is inconclusive, s.
const OBSERVED_LONG: f64 = 4.0;

/// The first observation is conclusive only if the largest modulus is below 1 by more than this.
const SLOW: f64 = 2e-5;

/// Interval between two observations, s. It is long enough to separate the remaining eigenvalues.
const STRIDE: f64 = 0.005;

/// Ratio to its initial size at which a displacement counts as diverged.
const DIVERGED: f64 = 1e3;

/// Fraction of its initial size below which a displacement contains no information, because the finger itself is not at
/// rest to the last bit.
const DECAYED: f64 = 1e-4;

/// Motion of a joint beyond which the finger counts as having left its rest, rad.
const FAR: f64 = 0.1;

/// A finger at rest at `joints`. A force on the tip holds it at `deflection` from the anchor of its spring.
#[derive(Clone, Copy, Debug)]
pub struct Rest {
    /// Joint angles, rad.
    pub joints: Vector3<f64>,
    /// Anchor of the spring minus joint angles, rad. At zero deflection, tendons 1 and 4 both have the tension t_min,
    /// and eq. 20 has a kink there.
    pub deflection: Vector3<f64>,
    /// Kx, N/cm.
    pub stiffness: Matrix3<f64>,
    /// Damping relative to the damping that the controller computes from the stiffness.
    pub damping: f64,
}

/// A finger without Coulomb friction and with exact sensors. Its parameters are equal to those in the configuration of
/// its controller.
///
/// Friction and quantisation are left out because they only add a small persistent motion, or end a motion.
pub struct OneCycleMap {
    finger: ConfiguredFinger,
    tendons: Tendons,
    controller: Controller,
    distribution: TensionDistribution,
    /// Number of plant steps in a cycle.
    steps: usize,
    /// Length of a plant step, s.
    step: f64,
}

impl OneCycleMap {
    /// Constructs the map of a finger with its configured scheme, law and gains at `rate`, Hz. A period is a whole
    /// number of plant steps, none longer than [`PLANT_STEP_SECONDS`].
    ///
    /// # Errors
    /// If no controller can be constructed, returns the key of the value that prevents it, and the reason.
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Result<Self, Unusable> {
        let finger = matching_simulation(finger);
        let tendons = finger.tendons().map_err(|error| Unusable { key: "geometry.r", reason: error.to_string() })?;
        let steps = (1.0 / (rate * PLANT_STEP_SECONDS) - 1e-6).ceil().max(1.0);
        let maximum = Vector4::repeat(finger.tendon.maximum);
        Ok(Self {
            controller: Controller::new(&finger, rate)?,
            distribution: TensionDistribution::new(&tendons, finger.tendon.minimum, maximum)?,
            steps: steps as usize,
            step: 1.0 / (rate * steps),
            tendons,
            finger,
        })
    }

    /// Returns the factor by which the servo scales the stiffness of `rest`, 0 to 1.
    pub fn scale(&self, rest: &Rest) -> f64 {
        let mut finger = self.start(rest, &self.tendons.pretension(self.finger.tendon.minimum));
        self.cycle(&mut finger);
        finger.report.stiffness_scale
    }

    /// Returns the largest modulus of an eigenvalue of the one-cycle map at `rest`. Returns None if the finger leaves
    /// the rest or a tendon becomes slack.
    ///
    /// Two fingers run, one of them with a tiny displacement. Their difference evolves by the linear map alone.
    pub fn largest_eigenvalue(&self, rest: &Rest) -> Option<f64> {
        let links = self.finger.links();
        let jacobian = links.jacobian(&rest.joints);
        let anchored = rest.joints + rest.deflection;
        let away = match self.finger.controller.law {
            Law::Report => jacobian * rest.deflection,
            Law::Exact => links.tip(&anchored) - links.tip(&rest.joints),
        };
        let pull = rest.stiffness * away * self.scale(rest);
        let tensions = self.distribution.distribute(&jacobian.tr_mul(&pull)).tensions;
        let mut finger = self.start(rest, &tensions);
        finger.plant.set_external_force(-pull);
        self.run(&mut finger, SETTLING);

        let modulus = self.watch(rest, &mut finger, OBSERVED)?;
        // Only a longer observation distinguishes such a slow mode from one that grows.
        if modulus < 1.0 - SLOW { Some(modulus) } else { self.watch(rest, &mut finger, OBSERVED_LONG) }
    }

    fn watch(&self, rest: &Rest, finger: &mut Moving, seconds: f64) -> Option<f64> {
        let mut displaced = finger.clone();
        for (motor, angle) in [3e-5, -2e-5, 1e-5, 4e-5].into_iter().enumerate() {
            displaced.plant.turn_motor(motor, angle);
        }
        let mut differences: Vec<DVector<f64>> = Vec::new();
        for _ in 0..(seconds / STRIDE) as usize {
            self.run(finger, STRIDE);
            self.run(&mut displaced, STRIDE);
            let (a, b) = (&finger.plant, &displaced.plant);
            if a.tensions().min() <= 0.0 || (a.joints() - rest.joints).amax() > FAR {
                return None;
            }
            // The factors make the channels comparable for a transmission ratio of 1 to 20 and modes at 30 rad/s.
            let joints = (a.joints() - b.joints()) * 20.0;
            let rates = (a.joint_rates() - b.joint_rates()) * 0.7;
            let motors = a.motor_angles() - b.motor_angles();
            let difference = DVector::from_iterator(10, joints.iter().chain(&rates).chain(&motors).copied());
            let grown = differences.first().map_or(1.0, |first| difference.norm() / first.norm());
            differences.push(difference);
            if !(DECAYED..DIVERGED).contains(&grown) {
                break;
            }
        }
        Some(growth(&differences).powf(1.0 / self.cycles(STRIDE) as f64))
    }

    /// Returns a finger at rest with these tensions, N, before its first cycle.
    fn start(&self, rest: &Rest, tensions: &Vector4<f64>) -> Moving {
        let mut finger = self.finger.clone();
        finger.simulation.start_degrees = rest.joints.map(f64::to_degrees).into();
        let mut plant = Plant::new(&finger, Vector3::zeros())
            .expect("the controller was constructed with these tendons")
            .with_step(self.step);
        plant.release_brake();
        let stretch = (tensions - plant.tensions()).component_div(&Vector4::from(finger.simulation.tendon_stiffness));
        for motor in 0..4 {
            plant.turn_motor(motor, stretch[motor] / self.tendons.radius[motor]);
        }
        let (motor_counts, gauge_counts) = Sensors::new(&finger).read(&plant);
        let hard_finger = SetPoint::hard_finger(rest.joints + rest.deflection, rest.stiffness);
        Moving {
            torques: tensions.component_mul(&self.tendons.radius),
            plant,
            state: self.controller.start(&Feedback { motor_counts, gauge_counts }),
            activity: Activity::Follow(SetPoint { law: finger.controller.law, damping: rest.damping, ..hard_finger }),
            report: Report::default(),
        }
    }

    fn cycles(&self, seconds: f64) -> usize {
        (seconds / (self.steps as f64 * self.step)).round().max(1.0) as usize
    }

    fn run(&self, finger: &mut Moving, seconds: f64) {
        (0..self.cycles(seconds)).for_each(|_| self.cycle(finger));
    }

    fn cycle(&self, finger: &mut Moving) {
        let plant = &mut finger.plant;
        let measured = Measured { motor_angles: plant.motor_angles(), tensions: plant.tensions() };
        // The command of the previous cycle acts during this one.
        (0..self.steps).for_each(|_| plant.step((finger.torques * 0.01).into()));
        let (command, report) = self.controller.cycle_measured(&mut finger.state, Some(&measured), &finger.activity);
        finger.torques = command.motor_torques;
        finger.report = report;
    }
}

#[derive(Clone)]
struct Moving {
    plant: Plant,
    state: State,
    activity: Activity,
    /// The command that acts next, N cm.
    torques: Vector4<f64>,
    report: Report,
}

/// Returns a configuration whose simulated finger equals the controller's model, without Coulomb friction and noise.
/// The controller's friction is zero too. The speed of set points is practically unlimited.
fn matching_simulation(finger: &ConfiguredFinger) -> ConfiguredFinger {
    let mut finger = finger.clone();
    finger.motor.sign = [1; 4];
    finger.controller.set_point_speed = Some(1e3);
    finger.friction.motor_coulomb = [0.0; 4];
    finger.friction.conduit = [0.0; 4];
    finger.friction.joint_coulomb = [0.0; 3];
    finger.simulation = ConfiguredSimulation {
        masses: finger.links.masses,
        link_radii: finger.links.radii,
        tendon_stiffness: finger.tendon.stiffness,
        rotor_inertia: finger.motor.inertia,
        motor_viscous_friction: finger.motor.viscous_friction,
        joint_viscous_friction: finger.friction.joint_viscous.map(|friction| friction * 0.01),
        joint_coulomb_friction: [0.0; 3],
        motor_coulomb_friction: [0.0; 4],
        shaft_friction: 0.0,
        gauge_noise: 0.0,
        stop_margin_degrees: finger.simulation.stop_margin_degrees,
        ..ConfiguredSimulation::default()
    };
    finger
}
