//! A free rigid body that fingertips touch, with gravity, friction and a table. Its motion is computed in the palm's
//! frame.

use super::friction_contact::{FrictionContact, Indentation};
use super::object_shape::{CORNERS, Shape};
use crate::model::configuration::{ConfiguredObject, FINGERS};
use crate::model::direction;
use nalgebra::{UnitQuaternion, Vector3};

/// Damping ratio of a contact.
const DAMPING_RATIO: f64 = 0.3;

/// Mass of a fingertip from which the damping of its contact is computed, kg.
const TIP_MASS: f64 = 0.02;

/// Lever of the rolling resistance of a ball on the table, m. The resistance stops a ball that no finger touches.
const ROLLING_LEVER: f64 = 2e-4;

/// The tip of a finger in the palm's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipMotion {
    /// Position, m.
    pub position: Vector3<f64>,
    /// Velocity, m/s.
    pub velocity: Vector3<f64>,
}

/// A plane that does not move.
#[derive(Clone, Copy, Debug)]
struct Table {
    /// Unit normal on the side of the object.
    up: Vector3<f64>,
    /// Height of the plane above the palm's origin, m. It is negative for a table below the palm.
    height: f64,
}

/// The object. Its state is integrated by the semi-implicit Euler method.
#[derive(Clone, Debug)]
pub struct FreeObject {
    shape: Shape,
    mass: f64,
    /// Principal moments of inertia, kg m^2.
    inertia: Vector3<f64>,
    gravity: Vector3<f64>,
    table: Option<Table>,
    position: Vector3<f64>,
    rotation: UnitQuaternion<f64>,
    velocity: Vector3<f64>,
    /// Angular momentum about the centre of mass, kg m^2/s.
    spin: Vector3<f64>,
    at_fingers: [FrictionContact; FINGERS],
    at_table: [FrictionContact; CORNERS],
    /// Forces of the fingers on the object in the last step, N.
    forces: [Vector3<f64>; FINGERS],
}

impl FreeObject {
    /// Constructs an object at rest. The gravity is in the palm's frame, m/s^2.
    pub fn new(configured: &ConfiguredObject, gravity: Vector3<f64>) -> Self {
        let (shape, mass) = (Shape::new(&configured.shape), configured.mass);
        let stiffness = configured.stiffness * 100.0;
        let contact = |mass: f64| {
            FrictionContact::new(stiffness, 2.0 * DAMPING_RATIO * (stiffness * mass).sqrt(), configured.friction)
        };
        let down = direction(&gravity).unwrap_or_else(Vector3::z);
        Self {
            inertia: shape.inertia(mass),
            table: configured.table.map(|distance| Table { up: -down, height: -distance * 0.01 }),
            position: Vector3::from(configured.position) * 0.01,
            rotation: UnitQuaternion::identity(),
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
            at_fingers: [contact(mass * TIP_MASS / (mass + TIP_MASS)); FINGERS],
            at_table: [contact(mass); CORNERS],
            forces: [Vector3::zeros(); FINGERS],
            shape,
            mass,
            gravity,
        }
    }

    /// Advances by one step of `step` seconds. `tips` are the tips of the fingers at the beginning of the step; `None`
    /// is a finger that does not exist. Returns the forces on the tips, N.
    pub fn step(&mut self, tips: &[Option<TipMotion>; FINGERS], step: f64) -> [Vector3<f64>; FINGERS] {
        let rates = self.angular_velocity();
        let (mut force, mut torque) = (self.gravity * self.mass, Vector3::zeros());
        for (finger, tip) in tips.iter().enumerate() {
            let on_tip = tip.map_or_else(Vector3::zeros, |tip| {
                let arm = tip.position - self.position;
                let sliding = tip.velocity - self.velocity - rates.cross(&arm);
                let on_tip = self.at_fingers[finger].advance(self.indented_by(&tip.position), &sliding, step);
                force -= on_tip;
                torque -= arm.cross(&on_tip);
                on_tip
            });
            self.forces[finger] = -on_tip;
        }
        let mut weight_on_table = 0.0;
        if let Some(table) = self.table {
            for (contact, arm) in self.at_table.iter_mut().zip(self.shape.lowest(&self.rotation, &table.up)) {
                let velocity = self.velocity + rates.cross(&arm);
                let on_object = contact.advance(table.indented_by(&(self.position + arm)), &velocity, step);
                force += on_object;
                torque += arm.cross(&on_object);
                weight_on_table += on_object.dot(&table.up);
            }
        }
        self.velocity += force * (step / self.mass);
        self.position += self.velocity * step;
        self.spin += torque * step;
        if let Shape::Ball { .. } = self.shape {
            let resisted = self.spin.norm() - ROLLING_LEVER * weight_on_table * step;
            self.spin = self.spin.cap_magnitude(resisted.max(0.0));
        }
        let turned = UnitQuaternion::new(self.angular_velocity() * step) * self.rotation;
        self.rotation = UnitQuaternion::new_normalize(turned.into_inner());
        self.forces.map(|force| -force)
    }

    /// Sets the gravity, m/s^2 in the palm's frame. The table stays where it is.
    pub fn set_gravity(&mut self, gravity: Vector3<f64>) {
        self.gravity = gravity;
    }

    /// Returns the position of the centre of mass, m.
    pub fn position(&self) -> Vector3<f64> {
        self.position
    }

    /// Returns the rotation from the object's frame to the palm's.
    pub fn rotation(&self) -> UnitQuaternion<f64> {
        self.rotation
    }

    /// Returns the velocity of the centre of mass, m/s.
    pub fn velocity(&self) -> Vector3<f64> {
        self.velocity
    }

    /// Returns the velocity of the object's material at `place`, m/s. `place` is in m. Both are in the palm's frame.
    pub fn velocity_at(&self, place: &Vector3<f64>) -> Vector3<f64> {
        self.velocity + self.angular_velocity().cross(&(place - self.position))
    }

    /// Returns the angular velocity, rad/s.
    pub fn angular_velocity(&self) -> Vector3<f64> {
        let in_object = self.rotation.inverse() * self.spin;
        self.rotation * in_object.component_div(&self.inertia)
    }

    /// Returns the forces of the fingers on the object in the last step, N.
    pub fn forces(&self) -> [Vector3<f64>; FINGERS] {
        self.forces
    }

    /// Moves the object to `position`, m, with this velocity, m/s, and angular velocity, rad/s.
    pub fn put(&mut self, position: Vector3<f64>, velocity: Vector3<f64>, angular_velocity: Vector3<f64>) {
        (self.position, self.velocity) = (position, velocity);
        let in_object = self.rotation.inverse() * angular_velocity;
        self.spin = self.rotation * in_object.component_mul(&self.inertia);
    }

    /// Returns the kinetic energy, J.
    pub fn kinetic_energy(&self) -> f64 {
        0.5 * (self.mass * self.velocity.norm_squared() + self.spin.dot(&self.angular_velocity()))
    }

    /// Returns the energy of the motion, of gravity and of the contacts with these tips and with the table, J.
    pub fn energy(&self, tips: &[Option<TipMotion>; FINGERS]) -> f64 {
        let elastic = |contact: &FrictionContact, touched: Option<Indentation>| {
            touched.map_or(0.0, |touched| contact.energy(touched.depth))
        };
        let at_fingers = self.at_fingers.iter().zip(tips).filter_map(|(contact, tip)| Some((contact, tip.as_ref()?)));
        let at_fingers: f64 = at_fingers.map(|(contact, tip)| elastic(contact, self.indented_by(&tip.position))).sum();
        let at_table: f64 = self.table.map_or(0.0, |table| {
            let points = self.shape.lowest(&self.rotation, &table.up);
            self.at_table
                .iter()
                .zip(points)
                .map(|(at, arm)| elastic(at, table.indented_by(&(self.position + arm))))
                .sum()
        });
        self.kinetic_energy() - self.mass * self.gravity.dot(&self.position) + at_fingers + at_table
    }

    fn indented_by(&self, point: &Vector3<f64>) -> Option<Indentation> {
        let touched = self.shape.indented_by(&(self.rotation.inverse() * (point - self.position)))?;
        Some(Indentation { outward: self.rotation * touched.outward, ..touched })
    }
}

impl Table {
    fn indented_by(&self, point: &Vector3<f64>) -> Option<Indentation> {
        let depth = self.height - self.up.dot(point);
        (depth > 0.0).then_some(Indentation { depth, outward: self.up })
    }
}
