//! Rows in which the tip or a joint meets a rigid obstacle or an elastic wall.

use crate::cases::{Case, Friction, axes};
use crate::closed_loop::ClosedLoop;
use crate::parallel::{each, worst};
use nalgebra::{Matrix3, Vector3};
use sun2xp::control::Law;
use sun2xp::model::configuration::Surface;

/// Stiffness of the walls, N/cm.
pub const WALLS: [f64; 3] = [30.0, 100.0, 300.0];
/// Distance by which the anchor moves toward a wall, cm. The anchor is then 3.5 mm inside the wall.
pub const INTO: f64 = 0.4;
/// Distance of the tip from a wall before the anchor moves, cm.
pub const OFF: f64 = 0.05;

/// The motion of a finger whose anchor was moved into a wall. The times count from this move.
pub struct Residual {
    /// Motion from 1.7 to 2 s, cm rms.
    pub late: f64,
    /// Motion from 0.7 to 1 s, cm rms.
    pub early: f64,
}

/// Moves the anchors of fingers without friction into walls on every side. Returns the number of poses in which a
/// finger does not come to rest within 2 s at one or more of the walls, and the largest residual motion, cm rms.
pub fn against_walls(case: &Case, stiffness: f64) -> (usize, f64) {
    let of_pose = each(&case.poses(), |_, pose| {
        let runs = WALLS.iter().flat_map(|&wall| axes().map(move |outward| (wall, outward)));
        runs.filter_map(|(wall, outward)| into_wall(case, pose, stiffness, wall, &outward)).collect::<Vec<_>>()
    });
    let restless = of_pose.iter().filter(|residuals| residuals.iter().any(Residual::lasts)).count();
    (restless, worst(of_pose.iter().flatten().map(|residual| residual.late)))
}

impl Residual {
    /// Returns whether the motion grows, or is larger than the motion that the noise of the gauges causes.
    pub fn lasts(&self) -> bool {
        const NOISE: f64 = 0.005;
        const PERCEPTIBLE: f64 = 0.001;
        self.late.is_nan() || self.late > NOISE || (self.late > PERCEPTIBLE && self.late > 1.5 * self.early)
    }
}

/// Moves the anchor into a wall, and returns the motion of the finger. Returns `None` if the place of the anchor inside
/// the wall is out of the finger's reach.
fn into_wall(case: &Case, pose: &Vector3<f64>, stiffness: f64, wall: f64, outward: &Vector3<f64>) -> Option<Residual> {
    let mut finger = ClosedLoop::at(case, pose, Friction::None, &(Matrix3::identity() * stiffness));
    let tip = finger.anchor();
    finger.plant.set_surface(Some(wall_off(&tip, outward, wall)));
    if !finger.move_anchor(&(tip - outward * INTO)) {
        return None;
    }
    finger.run(0.7);
    let early = residual(&finger.tips(0.3));
    finger.run(0.7);
    Some(Residual { early, late: residual(&finger.tips(0.3)) })
}

pub fn wall_off(tip: &Vector3<f64>, outward: &Vector3<f64>, stiffness: f64) -> Surface {
    Surface::Wall { point: (tip - outward * OFF).into(), normal: (*outward).into(), stiffness }
}

/// Returns the root mean square of the distance from the mean.
pub fn residual(tips: &[Vector3<f64>]) -> f64 {
    let mean = tips.iter().sum::<Vector3<f64>>() / tips.len() as f64;
    (tips.iter().map(|tip| (tip - mean).norm_squared()).sum::<f64>() / tips.len() as f64).sqrt()
}

/// The result of a torque beyond the limits.
pub struct OverLimit {
    /// Largest true tension after the finger has come to rest, minus t_max, N.
    pub excess: f64,
    /// Largest true tension before the finger has come to rest, minus t_max, N.
    pub excess_on_the_way: f64,
    /// Angle between the mean joint torque of the true tensions and the mean joint torque that the law required,
    /// degrees.
    pub turned: f64,
    /// The largest fraction of the required torque that the limits permitted in a cycle. 1 means that the limits had no
    /// effect.
    pub scale: f64,
}

/// Commands a set point far beyond the mechanical stop of joint 1, with the report's law. The law then
/// requires more torque against the stop than the tension limits permit.
pub fn over_limit(case: &Case) -> OverLimit {
    let all = each(&case.poses(), |_, pose| {
        let mut pose = *pose;
        pose[1] = 100f64.to_radians();
        let mut finger = ClosedLoop::at(case, &pose, Friction::Default, &(Matrix3::identity() * case.bound()));
        finger.set_point.law = Law::Report;
        finger.set_point.joints[1] += 2.0;
        // Joint 0 swings slowly while the tension limits take away most of the required torque, so this run is long.
        finger.run(3.0);
        let most_on_the_way = finger.most_true;
        finger.reset_extremes();
        let r = finger.finger.tendons().expect("the default finger").r;
        let cycles = finger.cycles(0.5);
        let (mut asked, mut given, mut scale) = (Vector3::zeros(), Vector3::zeros(), 0.0);
        for _ in 0..cycles {
            finger.cycle();
            asked += finger.report.joint_torques;
            given += r * finger.plant.tensions();
            scale = finger.report.torque_scale.max(scale);
        }
        OverLimit {
            excess: finger.most_true - finger.finger.tendon.maximum,
            excess_on_the_way: most_on_the_way - finger.finger.tendon.maximum,
            turned: asked.angle(&given).to_degrees(),
            scale,
        }
    });
    OverLimit {
        excess: worst(all.iter().map(|one| one.excess)),
        excess_on_the_way: worst(all.iter().map(|one| one.excess_on_the_way)),
        turned: worst(all.iter().map(|one| one.turned)),
        scale: worst(all.iter().map(|one| one.scale)),
    }
}
