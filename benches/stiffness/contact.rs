//! Rows in which the tip or a joint meets something that does not give way.

use crate::cases::{Case, Friction, axes};
use crate::closed_loop::ClosedLoop;
use nalgebra::{Matrix3, Vector3};
use sun2xp::model::Surface;

/// How many poses do not come to rest against a wall of 30, 100 or 300 N/cm, pressed by 3.5 mm of spring, without friction to help;
/// and the largest residual motion, cm rms.
pub fn against_a_wall(case: &Case, stiffness: f64) -> (usize, f64) {
    const STILL: f64 = 0.005;
    let (mut unstable, mut largest): (usize, f64) = (0, 0.0);
    for pose in case.poses() {
        let mut worst: f64 = 0.0;
        for wall in [30.0, 100.0, 300.0] {
            for outward in axes() {
                let kx = Matrix3::identity() * stiffness;
                let mut finger = ClosedLoop::at(case, &pose, Friction::None, &kx);
                let tip = finger.anchor();
                let point = (tip - outward * 0.05).into();
                finger.plant.set_surface(Some(Surface::Wall { point, normal: outward.into(), stiffness: wall }));
                // A force on the tip is as good as an anchor within the wall, and needs no pose there.
                finger.push(-outward * (stiffness * 0.4));
                finger.run(1.0);
                let tips: Vec<Vector3<f64>> = (0..finger.cycles(0.3))
                    .map(|_| {
                        finger.cycle();
                        finger.plant.tip()
                    })
                    .collect();
                let mean = tips.iter().sum::<Vector3<f64>>() / tips.len() as f64;
                let variance = tips.iter().map(|tip| (tip - mean).norm_squared()).sum::<f64>() / tips.len() as f64;
                // NaN counts as motion without end.
                worst = if variance.is_nan() { f64::INFINITY } else { worst.max(variance.sqrt()) };
            }
        }
        unstable += usize::from(worst > STILL);
        largest = largest.max(worst);
    }
    (unstable, largest)
}

/// A joint pressed against its stop with more torque than the tendons carry: by how many N the largest true tension exceeds t_max, and
/// the largest angle, degrees, between the joint torque of the commanded tensions and the one that the law asks for.
pub fn over_limit(case: &Case) -> (f64, f64) {
    let (mut excess, mut angle): (f64, f64) = (f64::NEG_INFINITY, 0.0);
    for mut pose in case.poses() {
        pose[1] = 100f64.to_radians();
        let mut finger = ClosedLoop::at(case, &pose, Friction::Default, &(Matrix3::identity() * 3.0));
        let flexing = finger.finger.links().jacobian(&pose).column(1).normalize();
        finger.push(flexing * 40.0);
        finger.run(1.0);
        finger.forget();
        let r = finger.finger.tendons().expect("the default finger").r;
        for _ in 0..finger.cycles(0.2) {
            finger.cycle();
            let (asked, given) = (finger.report.joint_torques, r * finger.report.desired_tensions);
            angle = angle.max(asked.angle(&given).to_degrees());
        }
        excess = excess.max(finger.most_true - finger.finger.tendon.maximum);
    }
    (excess, angle)
}
