//! The object that the fingers of a simulated hand share, and their contacts with it.
//!
//! Object and fingers advance by the same steps: the contact forces of a step follow from the state of both at its
//! beginning, and act on both with opposite signs. So there is no delay between them, contacts create no energy, and
//! two runs with the same commands are identical.

use crate::model::FingerNumber;
use crate::model::configuration::{Configuration, FINGERS};
use crate::plant::{FreeObject, PLANT_STEP_SECONDS, TipMotion};
use crate::simulated::finger::SimulatedFinger;
use nalgebra::{Isometry3, Vector3};
use serde::{Deserialize, Serialize};

/// The state of the object in the palm's frame.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ObjectState {
    /// Simulated time since the boards started, s.
    pub time: f64,
    /// Position of the centre of mass, cm.
    pub position: [f64; 3],
    /// Rotation matrix from the object's frame to the palm's, row by row. At the start it is the identity.
    pub rotation: [[f64; 3]; 3],
    /// Velocity of the centre of mass, cm/s.
    pub velocity: [f64; 3],
    /// Angular velocity, rad/s.
    pub angular_velocity: [f64; 3],
    /// Force of each finger on the object, N. It is zero for a finger that does not touch the object.
    pub forces: [[f64; 3]; FINGERS],
}

/// An object, and the poses of the fingers' frames in the palm's frame.
#[derive(Clone, Debug)]
pub struct Scene {
    object: FreeObject,
    to_palm: [Isometry3<f64>; FINGERS],
    /// Simulated time, s: the sum of all steps so far.
    time: f64,
}

impl Scene {
    /// Creates the scene of a hand. Returns `None` if no object is configured.
    pub fn new(hand: &Configuration) -> Option<Self> {
        let configured = hand.hand.simulated_object.as_ref()?;
        let object = FreeObject::new(configured, Vector3::from(hand.hand.gravity));
        Some(Self { object, to_palm: FingerNumber::ALL.map(|number| hand.finger_to_palm(number)), time: 0.0 })
    }

    /// Advances the object by one step, and passes the contact forces of this step to the fingers, which have not made
    /// this step yet. A finger that is not among `fingers` does not touch the object.
    pub(super) fn step<'a>(&mut self, fingers: impl Iterator<Item = &'a mut SimulatedFinger>) {
        let mut touching: [Option<&mut SimulatedFinger>; FINGERS] = Default::default();
        for finger in fingers {
            let index = finger.number().index();
            touching[index] = Some(finger);
        }
        let mut tips = [None; FINGERS];
        for ((finger, to_palm), tip) in touching.iter_mut().zip(&self.to_palm).zip(&mut tips) {
            *tip = finger.as_mut().map(|finger| tip_in_palm(finger, to_palm));
        }
        let forces = self.object.step(&tips, PLANT_STEP_SECONDS);
        for (((finger, to_palm), force), tip) in touching.into_iter().zip(&self.to_palm).zip(forces).zip(tips) {
            let (Some(finger), Some(tip)) = (finger, tip) else { continue };
            finger.plant().set_object_force(to_palm.inverse_transform_vector(&force));
            let sliding = (tip.velocity - self.object.velocity_at(&tip.position)) * 100.0;
            finger.set_sliding(to_palm.inverse_transform_vector(&sliding));
        }
        self.time += PLANT_STEP_SECONDS;
    }

    /// Returns the state of the object.
    pub fn state(&self) -> ObjectState {
        let rotation = self.object.rotation().to_rotation_matrix();
        ObjectState {
            time: self.time,
            position: (self.object.position() * 100.0).into(),
            rotation: std::array::from_fn(|row| std::array::from_fn(|column| rotation[(row, column)])),
            velocity: (self.object.velocity() * 100.0).into(),
            angular_velocity: self.object.angular_velocity().into(),
            forces: self.object.forces().map(Into::into),
        }
    }

    /// Returns the object.
    pub fn object(&mut self) -> &mut FreeObject {
        &mut self.object
    }
}

/// Returns the position and the velocity of a finger's tip in the palm's frame, in m and m/s. The finger's frame is in
/// cm.
fn tip_in_palm(finger: &mut SimulatedFinger, to_palm: &Isometry3<f64>) -> TipMotion {
    let plant = finger.plant();
    TipMotion {
        position: to_palm.transform_point(&plant.tip().into()).coords * 0.01,
        velocity: to_palm.transform_vector(&plant.tip_velocity()) * 0.01,
    }
}
