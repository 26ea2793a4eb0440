//! One finger as a physical system: joints, tendons, motors, and a surface that the tip can touch.

mod by_hand;

use super::amplifier::Amplifier;
use super::contact;
use super::gauge_filter::GaugeFilter;
use super::holding_hand::HoldingHand;
use super::joint_friction::stop_by_friction;
use super::joint_stops::JointStops;
use super::motors::Motors;
use super::stribeck::Stribeck;
use super::tendon::{ElasticTendons, TendonTensions};
use crate::model::configuration::ConfiguredFinger;
use crate::model::configuration::Surface;
use crate::model::physics::STEP;
use crate::model::{LinkDynamics, Links, TendonsError};
use nalgebra::{Matrix3, Vector3, Vector4};

/// Default length of one [`Plant::step`] in simulated time, s.
pub const PLANT_STEP_SECONDS: f64 = STEP;

/// Joint rate at which the excess of the static friction over the Coulomb friction has fallen to 1/e, rad/s.
const STRIBECK_RATE: f64 = 0.05;

/// One finger. The joint angles theta, the motor angles and their rates are integrated by the semi-implicit Euler
/// method.
///
/// The rotors are locked until [`Plant::release_brake`]: a hand is braked at its homing pretension until its board
/// receives commands.
#[derive(Clone, Debug)]
pub struct Plant {
    links: Links,
    dynamics: LinkDynamics,
    stops: JointStops,
    tendons: ElasticTendons,
    motors: Motors,
    amplifier: Amplifier,
    gauge_filter: Option<GaugeFilter>,
    joint_viscous: Vector3<f64>,
    /// Coulomb friction of the joints, N m.
    joint_coulomb: Vector3<f64>,
    joint_stribeck: Stribeck,
    /// Length of a step, s.
    step: f64,

    theta: Vector3<f64>,
    theta_dot: Vector3<f64>,
    motor: Vector4<f64>,
    motor_dot: Vector4<f64>,
    braked: bool,
    jammed: [bool; 4],
    external_force: Vector3<f64>,
    /// Force of an object that the tip shares with other fingers, N, in the finger's frame.
    object_force: Option<Vector3<f64>>,
    held: Option<HoldingHand>,
    surface: Option<Surface>,
    /// The weight that hangs on each tendon between its gauge and the finger, N.
    hung: Vector4<f64>,
}

impl Plant {
    /// Constructs a finger at its start pose: at rest, at homing pretension, and braked. The gravity is in m/s^2 in the
    /// finger's frame.
    pub fn new(finger: &ConfiguredFinger, gravity_in_finger_frame: Vector3<f64>) -> Result<Self, TendonsError> {
        let simulation = &finger.simulation;
        let theta = Vector3::from(simulation.start_degrees.map(f64::to_radians));
        let tendons = ElasticTendons::new(finger, &theta)?;
        let motor = tendons.motor_angles_at(&theta);
        let [link_0, link_1, link_2, tip] = simulation.masses;
        Ok(Self {
            links: finger.links(),
            dynamics: LinkDynamics::new(
                finger.links(),
                [link_0, link_1, link_2, tip + simulation.held_mass],
                simulation.link_radii,
                gravity_in_finger_frame,
            ),
            stops: JointStops::new(finger),
            motors: Motors::new(finger),
            amplifier: Amplifier::new(finger, PLANT_STEP_SECONDS),
            gauge_filter: GaugeFilter::new(simulation.gauge_bandwidth, tendons.tensions(&theta, &motor).gauge),
            joint_viscous: simulation.joint_viscous_friction.into(),
            joint_coulomb: simulation.joint_coulomb_friction.into(),
            joint_stribeck: Stribeck::new(simulation.stiction_ratio, STRIBECK_RATE),
            step: PLANT_STEP_SECONDS,
            theta,
            theta_dot: Vector3::zeros(),
            motor,
            motor_dot: Vector4::zeros(),
            braked: true,
            jammed: [false; 4],
            external_force: Vector3::zeros(),
            object_force: None,
            held: None,
            surface: simulation.surface,
            hung: Vector4::zeros(),
            tendons,
        })
    }

    /// Sets the length of a step to `seconds`, which must be above 0. Callers use this function if the period of a
    /// controller is not a multiple of [`PLANT_STEP_SECONDS`]. The integration may be unstable with longer steps than
    /// that constant.
    pub fn with_step(self, seconds: f64) -> Self {
        Self { step: seconds, ..self }
    }

    /// Advances by one step. `motor_torques` are the torques that the board commands, N m. A positive torque pulls if
    /// `motor.sign` is +1. The torques are clamped to the limits of the motors.
    pub fn step(&mut self, motor_torques: [f64; 4]) {
        let h = self.step;
        self.tendons.lengthen(&self.theta, &self.motor, h);
        let TendonTensions { motor: at_motors, joint: at_joints, .. } = self.tendons.tensions(&self.theta, &self.motor);

        let force = self.force_on_tip();
        let jacobian = self.links.jacobian(&self.theta) * 0.01;
        let torque = self.tendons.joint_torque(&at_joints)
            + jacobian.tr_mul(&force)
            + self.dynamics.gravity_torque(&self.theta)
            + self.stops.torque(&self.theta, &self.theta_dot)
            + self.held.map_or_else(Vector3::zeros, |hand| hand.torque(&self.theta, &self.theta_dot))
            - self.joint_viscous.component_mul(&self.theta_dot)
            - self.dynamics.coriolis(&self.theta, &self.theta_dot);
        let inverse_inertia = inverse(&self.dynamics.inertia(&self.theta));
        let rates = self.theta_dot + inverse_inertia * torque * h;
        let dry =
            self.joint_coulomb.zip_map(&self.theta_dot, |friction, rate| friction * self.joint_stribeck.factor(rate));
        self.theta_dot = stop_by_friction(rates, &inverse_inertia, &(dry * h));
        self.theta += self.theta_dot * h;

        let torques = self.amplifier.torques(self.motors.limited(&motor_torques.into()), h);
        if !self.braked {
            let pull = self.tendons.radius.component_mul(&at_motors);
            self.motor_dot = self.motors.next_speeds(&self.motor, &self.motor_dot, &torques, &pull, h);
            for motor in (0..4).filter(|&motor| self.jammed[motor]) {
                self.motor_dot[motor] = 0.0;
            }
            self.motor += self.motor_dot * h;
        }
        self.tendons.slide(&self.theta, &self.motor);
        let tensions = self.gauge_filter.as_ref().map(|_| self.tensions());
        if let (Some(filter), Some(tensions)) = (&mut self.gauge_filter, tensions) {
            filter.advance(&tensions, h);
        }
    }

    /// Unlocks the rotors.
    pub fn release_brake(&mut self) {
        self.braked = false;
    }

    /// Returns theta, rad.
    pub fn joints(&self) -> Vector3<f64> {
        self.theta
    }

    /// Returns theta_dot, rad/s.
    pub fn joint_rates(&self) -> Vector3<f64> {
        self.theta_dot
    }

    /// Returns the motor angles, rad. They increase as the tendons are pulled in, and are zero at theta = 0 with the
    /// homing pretension.
    pub fn motor_angles(&self) -> Vector4<f64> {
        self.motor
    }

    /// Returns the motor speeds, rad/s.
    pub fn motor_speeds(&self) -> Vector4<f64> {
        self.motor_dot
    }

    /// Tears a tendon, 0 to 3.
    pub fn cut_tendon(&mut self, tendon: usize) {
        self.tendons.cut(tendon);
    }

    /// Loosens the clamp of a tendon, 0 to 3. From now on the tendon slips at tensions above `grip`, N.
    pub fn loosen_tendon(&mut self, tendon: usize, grip: f64) {
        self.tendons.loosen(tendon, grip);
    }

    /// Blocks a motor, 0 to 3.
    pub fn jam_motor(&mut self, motor: usize) {
        self.jammed[motor] = true;
    }

    /// Repairs all tendons and motors.
    pub fn repair(&mut self) {
        self.tendons.restore();
        self.jammed = [false; 4];
    }

    /// Returns the tendon tensions at the gauges, N.
    pub fn tensions(&self) -> Vector4<f64> {
        self.tendons.tensions(&self.theta, &self.motor).gauge
    }

    /// Returns the tendon tensions at the joints, N. They differ from those at the gauges by the friction of pulleys.
    pub fn joint_tensions(&self) -> Vector4<f64> {
        self.tendons.tensions(&self.theta, &self.motor).joint
    }

    /// Returns the tensions that the gauge amplifiers pass on, N: those at the gauges, after the amplifiers' low-pass,
    /// plus the weights of [`Plant::hang`].
    pub fn filtered_tensions(&self) -> Vector4<f64> {
        self.gauge_filter.as_ref().map_or_else(|| self.tensions(), |filter| filter.shown) + self.hung
    }

    /// Returns the position of the fingertip in the finger's frame, cm.
    pub fn tip(&self) -> Vector3<f64> {
        self.links.tip(&self.theta)
    }

    /// Returns the velocity of the fingertip in the finger's frame, cm/s.
    pub fn tip_velocity(&self) -> Vector3<f64> {
        self.links.jacobian(&self.theta) * self.theta_dot
    }

    /// Returns the link lengths.
    pub fn links(&self) -> Links {
        self.links
    }

    /// Sets gravity in the finger's frame, m/s^2.
    pub fn set_gravity(&mut self, gravity: Vector3<f64>) {
        self.dynamics.set_gravity(gravity);
    }

    /// Applies a constant force to the fingertip, N, in the finger's frame.
    pub fn set_external_force(&mut self, force: Vector3<f64>) {
        self.external_force = force;
    }

    /// Applies the force of an object to the fingertip, N, in the finger's frame, until the next call.
    pub fn set_object_force(&mut self, force: Vector3<f64>) {
        self.object_force = Some(force);
    }

    /// Places a surface in reach of the fingertip, or removes it.
    pub fn set_surface(&mut self, surface: Option<Surface>) {
        self.surface = surface;
    }

    /// Returns the force of the surface on the fingertip, N, in the finger's frame.
    pub fn contact_force(&self) -> Vector3<f64> {
        self.surface.map_or_else(Vector3::zeros, |surface| contact::force(&surface, &self.tip()))
    }

    /// Returns the force of everything that touches the fingertip, N, in the finger's frame.
    pub fn force_on_tip(&self) -> Vector3<f64> {
        let force = self.external_force + self.contact_force();
        self.object_force.map_or(force, |by_object| force + by_object)
    }

    /// Returns the energy of the moving parts, tendons, stops, holding hand, surface and gravity, J.
    pub fn energy(&self) -> f64 {
        self.dynamics.energy(&self.theta, &self.theta_dot)
            + self.motors.energy(&self.motor_dot)
            + self.tendons.energy(&self.theta, &self.motor)
            + self.stops.energy(&self.theta)
            + self.held.map_or(0.0, |hand| hand.energy(&self.theta))
            + self.surface.map_or(0.0, |surface| contact::energy(&surface, &self.tip()))
    }

    /// Returns the kinetic part of [`Plant::energy`], J.
    pub fn kinetic_energy(&self) -> f64 {
        self.dynamics.kinetic_energy(&self.theta, &self.theta_dot) + self.motors.energy(&self.motor_dot)
    }
}

/// Returns the inverse of an inertia matrix. Joint 0 is decoupled, so the inverse has a 1 x 1 and a 2 x 2 block. The
/// inverse exists because the masses are positive.
fn inverse(h: &Matrix3<f64>) -> Matrix3<f64> {
    let determinant = h[(1, 1)] * h[(2, 2)] - h[(1, 2)] * h[(1, 2)];
    let off = -h[(1, 2)] / determinant;
    Matrix3::new(1.0 / h[(0, 0)], 0.0, 0.0, 0.0, h[(2, 2)] / determinant, off, 0.0, off, h[(1, 1)] / determinant)
}
