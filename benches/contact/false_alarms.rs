//! False alarms in motion through the whole range of the joints.

use crate::cases::Case;
use crate::finger::{Finger, RATE};
use crate::motion::Motion;
use nalgebra::Vector3;
use std::error::Error;
use sun2xp::model::configuration::ConfiguredContact;

/// The fastest joint rates of the set points, rad/s. At an infinite rate, the set point jumps from pose to pose, and
/// the controller follows it as fast as it can. A run spends the same time at each of these speeds.
pub const SPEEDS: [f64; 3] = [1.0, 3.0, f64::INFINITY];

/// The result of a run.
pub struct Alarms {
    pub count: u32,
    /// Fraction of the time for which a contact was reported, with contacts at mechanical stops included.
    pub share: f64,
    /// Time of the first alarm, s.
    pub first: Option<f64>,
}

/// Moves a finger for `seconds`. The finger touches nothing but its mechanical stops.
pub fn count(case: &Case, contact: &ConfiguredContact, seconds: f64, seed: u64) -> Result<Alarms, Box<dyn Error>> {
    let (finger, belief) = case.finger(contact, seed);
    let start = Vector3::from(finger.simulation.start_degrees.map(f64::to_radians));
    let mut run = Finger::new(&finger, &belief, case.gravity)?;
    let mut motion = Motion::new(seed, finger.joint_limits(), start);
    let (mut count, mut touched, mut touching, mut first) = (0, 0, false, None);
    // A joint counts as stopped when it is at most half a degree before its mechanical stop.
    let margin = (finger.simulation.stop_margin_degrees - 0.5).to_radians();
    let (low, high) = finger.joint_limits();
    let (low, high) = (low.add_scalar(-margin), high.add_scalar(margin));
    let cycles = (seconds * RATE) as usize;
    for cycle in 0..cycles {
        let speed = SPEEDS[cycle * SPEEDS.len() / cycles];
        let contact = run.cycle(motion.set_point(speed, 1.0 / RATE)).contact;
        // A contact that is reported while a joint is at its mechanical stop is no false alarm.
        let joints = run.plant.joints();
        let stopped = joints.sup(&low).inf(&high) != joints;
        if contact.touching && !touching && !stopped {
            count += 1;
            first = first.or(Some(cycle as f64 / RATE));
        }
        touching = contact.touching;
        touched += usize::from(touching);
    }
    Ok(Alarms { count, share: touched as f64 / cycles as f64, first })
}
