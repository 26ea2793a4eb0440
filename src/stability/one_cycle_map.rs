//! The motion of a finger near an equilibrium ([`Rest`]), as a linear map of one cycle: plant, controller, and the one
//! cycle of delay between sample and torque.

use super::plant_set::Variant;
use super::recurrence::{growth, growth_besides_drift};
use super::rest::{Pull, Rest, Support};
use crate::control::{Activity, Controller, Feedback, Measured, Report, State, TensionDistribution};
use crate::model::configuration::{ConfiguredFinger, ConfiguredSimulation, Unusable};
use crate::model::{Links, Tendons};
use crate::plant::{PLANT_STEP_SECONDS, Plant, Sensors};
use nalgebra::{DVector, Vector3, Vector4};
use std::f64::consts::PI;

/// Time in which the filters and integrals of the controller settle, s.
const SETTLING: f64 = 0.3;

/// Time for which the motion is observed first, s.
const OBSERVED: f64 = 1.0;

/// Time for which the motion is observed again if the first observation is inconclusive, s.
const OBSERVED_LONG: f64 = 4.0;

/// The first observation is conclusive only if the largest modulus is below 1 by more than this.
const SLOW: f64 = 2e-5;

/// Interval between two samples of the motion, s. It is long enough to separate the eigenvalues of the slow modes.
const STRIDE: f64 = 0.005;

/// A displacement counts as diverged when it is this many times its initial size.
const DIVERGED: f64 = 1e3;

/// A displacement below this fraction of its initial size contains no information, because the finger itself is not at
/// rest to the last bit.
const DECAYED: f64 = 1e-4;

/// Displacements of the motors, rad. They are so small that the tip stays in contact with a wall.
const DISPLACED: [f64; 4] = [3e-6, -2e-6, 1e-6, 4e-6];

/// Largest motion of a joint after the finger has settled, rad. A finger that moves farther counts as having left its
/// rest.
const FAR: f64 = 0.1;

/// A motion in a direction without stiffness counts as a drift, and not as a mode of the loop, if its time constant is
/// longer than this, s. If the plant differs from the model, small torques remain in these directions.
const DRIFT: f64 = 0.3;

/// Time after which an amplifier has reached a constant command, in time constants of its lag.
const AMPLIFIED: f64 = 20.0;

/// Amplitude w of the joint rates, rad/s, for which the damper of [`OneCycleMap`] is computed. The damper stands for
/// the joint friction of a finger that touches a wall. A joint of a finger of 10 cm has this rate when the tip vibrates
/// by 50 um rms at 250 Hz, a usual frequency for stiff walls.
const VIBRATION: f64 = 1.0;

/// A finger without Coulomb friction and with exact sensors. Its parameters are equal to those in the configuration of
/// its controller, apart from what a [`Variant`] changes.
///
/// If the finger touches a wall, the configured Coulomb friction F of a joint acts as the damper 4 F / (pi w). At an
/// amplitude w of the joint rate, this damper dissipates as much as the friction. A wall of hundreds of N/cm has no
/// damping, and lets the finger vibrate at frequencies that no controller of 1000 Hz can damp. Only friction ends such
/// a vibration.
///
/// Apart from this damper, Coulomb friction is left out, and so is quantisation, because they only add a small
/// persistent motion, or end a motion.
pub struct OneCycleMap {
    finger: ConfiguredFinger,
    /// Damper that stands for the friction of the joints at a wall, N m s/rad.
    damper_at_wall: [f64; 3],
    pub(super) links: Links,
    tendons: Tendons,
    controller: Controller,
    distribution: TensionDistribution,
    /// Number of plant steps in a cycle.
    pub(super) steps: usize,
    /// Length of a plant step, s.
    pub(super) step: f64,
    /// Of every `loss_interval` cycles, the last one loses its reply. With a `loss_interval` of 0, no reply is lost.
    loss_interval: usize,
}

impl OneCycleMap {
    /// Constructs the map of a finger with its configured scheme and gains at `rate`, Hz. A period is a whole number of
    /// plant steps, none longer than [`PLANT_STEP_SECONDS`].
    ///
    /// # Errors
    /// If no controller can be constructed, returns the key of the value that prevents it, and the reason.
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Result<Self, Unusable> {
        Self::of_variant(finger, rate, &Variant::NOMINAL)
    }

    /// Constructs the map of [`OneCycleMap::new`] for a plant that differs from the controller's model.
    ///
    /// # Errors
    /// If no controller can be constructed, returns the key of the value that prevents it, and the reason.
    pub fn of_variant(finger: &ConfiguredFinger, rate: f64, variant: &Variant) -> Result<Self, Unusable> {
        let damper_at_wall = finger.friction.joint_coulomb.map(|friction| 0.01 * friction * 4.0 / (PI * VIBRATION));
        let mut finger = matching_simulation(finger);
        variant.apply(&mut finger.simulation, rate);
        let tendons = finger.tendons().map_err(|error| Unusable { key: "geometry.r", reason: error.to_string() })?;
        let steps = (1.0 / (rate * PLANT_STEP_SECONDS) - 1e-6).ceil().max(1.0);
        let maximum = Vector4::repeat(finger.tendon.maximum);
        Ok(Self {
            controller: Controller::new(&finger, rate)?,
            distribution: TensionDistribution::new(&tendons, finger.tendon.minimum, maximum)?,
            steps: steps as usize,
            step: 1.0 / (rate * steps),
            loss_interval: variant.loss_interval,
            links: finger.links(),
            damper_at_wall,
            tendons,
            finger,
        })
    }

    /// Returns the factor by which the servo scales the stiffness of `rest`, 0 to 1.
    pub fn scale(&self, rest: &Rest) -> f64 {
        let mut finger = self.start(rest, &self.tendons.pretension(self.finger.tendon.minimum), Support::default());
        self.cycle(&mut finger);
        finger.report.stiffness_scale
    }

    /// Returns the force with which the spring of `rest` pulls the tip, N.
    pub fn pull(&self, rest: &Rest) -> Vector3<f64> {
        rest.pull(&self.links, self.scale(rest)).force
    }

    /// Returns the largest modulus of an eigenvalue of the one-cycle map at `rest`. Returns None if the finger leaves
    /// `rest` or a tendon becomes slack. If replies are lost, the eigenvalue belongs to the map over a loss interval of
    /// n cycles, and the result is the n-th root of its modulus. If the contact leaves directions without stiffness,
    /// slow motions in these directions do not count.
    ///
    /// Two fingers run, one of them with a tiny displacement. Their difference evolves by the linear map alone.
    pub fn largest_eigenvalue(&self, rest: &Rest) -> Option<f64> {
        let mut finger = self.settled(rest);
        let free_directions = rest.dimensions() < 3;
        let modulus = self.watch(&mut finger, OBSERVED, free_directions)?;
        // If the modulus is near 1, only a longer observation distinguishes a slow mode from one that grows.
        if modulus < 1.0 - SLOW { Some(modulus) } else { self.watch(&mut finger, OBSERVED_LONG, free_directions) }
    }

    /// Returns a finger at `rest` under its load, after the filters and integrals have settled.
    pub(super) fn settled(&self, rest: &Rest) -> Moving {
        let Pull { torques, force } = rest.pull(&self.links, self.scale(rest));
        let tensions = self.distribution.distribute(&torques).tensions;
        let mut finger = self.start(rest, &tensions, rest.support(&self.links, &force));
        self.run(&mut finger, self.cycles(SETTLING));
        finger
    }

    fn watch(&self, finger: &mut Moving, seconds: f64, free_directions: bool) -> Option<f64> {
        let mut displaced = finger.clone();
        for (motor, angle) in DISPLACED.into_iter().enumerate() {
            displaced.plant.turn_motor(motor, angle);
        }
        // With lost replies, single cycles have different maps, but all whole loss intervals have the same map.
        let stride = if self.loss_interval == 0 { self.cycles(STRIDE) } else { self.loss_interval };
        let began = finger.plant.joints();
        let mut differences: Vec<DVector<f64>> = Vec::new();
        for _ in 0..self.cycles(seconds) / stride {
            self.run(finger, stride);
            self.run(&mut displaced, stride);
            let (a, b) = (&finger.plant, &displaced.plant);
            if a.tensions().min() <= 0.0 || (a.joints() - began).amax() > FAR {
                return None;
            }
            // The factors 20 and 0.7 make the channels comparable: a motor turns about 20 times as far as a joint, and
            // the modes are near 30 rad/s.
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
        let elapsed = stride as f64 * self.period();
        let factor =
            if free_directions { growth_besides_drift(&differences, elapsed / DRIFT) } else { growth(&differences) };
        Some(factor.powf(1.0 / stride as f64))
    }

    /// Returns a finger at rest with these tensions, N, before its first cycle.
    fn start(&self, rest: &Rest, tensions: &Vector4<f64>, support: Support) -> Moving {
        let mut finger = self.finger.clone();
        finger.simulation.start_degrees = rest.joints.map(f64::to_degrees).into();
        if support.wall.is_some() {
            for (viscous, damper) in finger.simulation.joint_viscous_friction.iter_mut().zip(self.damper_at_wall) {
                *viscous += damper;
            }
        }
        let mut plant = Plant::new(&finger, Vector3::zeros())
            .expect("the controller was constructed with these tendons")
            .with_step(self.step);
        plant.set_surface(support.wall);
        plant.set_external_force(support.load);
        let stretch = (tensions - plant.tensions()).component_div(&Vector4::from(finger.simulation.tendon_stiffness));
        for motor in 0..4 {
            plant.turn_motor(motor, stretch[motor] / self.tendons.radius[motor]);
        }
        let torques = tensions.component_mul(&self.tendons.radius);
        // The amplifiers reach these torques before the rotors are free.
        let lag = (finger.simulation.command_delay_ms + AMPLIFIED * finger.simulation.amplifier_lag_ms) * 1e-3;
        (0..(lag / self.step).ceil() as usize).for_each(|_| plant.step((torques * 0.01).into()));
        plant.release_brake();
        let (motor_counts, gauge_counts) = Sensors::new(&finger).read(&plant);
        Moving {
            torques,
            plant,
            state: self.controller.start(&Feedback { motor_counts, gauge_counts }),
            activity: Activity::Follow(rest.set_point()),
            report: Report::default(),
            load: support.load,
            cycles: 0,
        }
    }

    /// Returns the number of cycles in a time.
    pub(super) fn cycles(&self, seconds: f64) -> usize {
        (seconds / self.period()).round().max(1.0) as usize
    }

    fn period(&self) -> f64 {
        self.steps as f64 * self.step
    }

    pub(super) fn run(&self, finger: &mut Moving, cycles: usize) {
        (0..cycles).for_each(|_| self.cycle(finger));
    }

    fn cycle(&self, finger: &mut Moving) {
        self.cycle_with(finger, |_, plant, torques| plant.step(torques));
    }

    /// Runs one cycle. `step` makes each plant step. It receives the number of the step in the cycle, the plant, and
    /// the motor torques, N m.
    pub(super) fn cycle_with(&self, finger: &mut Moving, mut step: impl FnMut(usize, &mut Plant, [f64; 4])) {
        let plant = &mut finger.plant;
        let measured = Measured { motor_angles: plant.motor_angles(), tensions: plant.tensions() };
        // The command of the previous cycle acts during this one.
        let torques = (finger.torques * 0.01).into();
        (0..self.steps).for_each(|number| step(number, plant, torques));
        finger.cycles += 1;
        let lost = finger.cycles.is_multiple_of(self.loss_interval);
        let measured = (!lost).then_some(&measured);
        let (command, report) = self.controller.cycle_measured(&mut finger.state, measured, &finger.activity);
        finger.torques = command.motor_torques;
        finger.report = report;
    }
}

/// A simulated finger in motion, with the state of its controller.
#[derive(Clone)]
pub(super) struct Moving {
    pub plant: Plant,
    state: State,
    activity: Activity,
    /// The command that acts next, N cm.
    torques: Vector4<f64>,
    report: Report,
    /// The constant force at the tip, N.
    pub load: Vector3<f64>,
    /// Number of cycles since the start.
    cycles: usize,
}

/// Returns a configuration whose simulated finger equals the controller's model, without Coulomb friction and noise.
/// The controller's Coulomb, conduit and pulley friction is zero too. The speed of set points is practically unlimited.
fn matching_simulation(finger: &ConfiguredFinger) -> ConfiguredFinger {
    let mut finger = finger.clone();
    finger.motor.sign = [1; 4];
    finger.controller.set_point_speed = Some(1e3);
    finger.friction.motor_coulomb = [0.0; 4];
    finger.friction.conduit = [0.0; 4];
    // The dither of the tensions depends on the time. Its commanded amplitude depends on the amplitude that is measured
    // in the tensions. A linear map cannot have either dependence.
    finger.controller.tension_dither = Some(0.0);
    finger.friction.pulley = [0.0; 4];
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
