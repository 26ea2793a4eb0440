//! Determines the stiffness of every tendon from motor travel against tension.
//!
//! The motor travel of every tendon is x_i = R_i^T theta + c_i t_i + d_i t_i^2 + h_i s_i t_i + const. R_i are the
//! moment arms of tendon i, theta the joint angles, and t_i is the tension at the gauge. c_i is the compliance, and d_i
//! its change with the tension. h_i is an additional compliance: on the motor's side of the conduit, friction makes the
//! tension larger or smaller than at the gauge. s_i is the direction in which the tendon last slid, -1 to 1. The
//! product of the four equations with the null vector n of R contains no motion of the joints, and gives one equation
//! for each sample. Its coefficients can be separated if the four tensions vary independently. They do so only while
//! joint torques act, so something must hold the finger. A term in proportion to the time absorbs creep.

use super::least_squares::LeastSquares;
use super::winding::Winding;
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::Sample;
use crate::model::Part;
use nalgebra::{SVector, Vector4};

/// Plausible range of the stiffness of a tendon, N/cm.
const SOFTEST: f64 = 10.0;
const STIFFEST: f64 = 1e5;
/// Upper end of the range of tensions in which the controller works, as a fraction of t_max. The lower end is t_min.
const WORKING: f64 = 0.42;
/// Largest tension at which the stiffness is measured, as a fraction of t_max.
const MEASURED: f64 = 0.6;
/// Relative uncertainty of every stiffness. On the simulated finger the identified stiffness is accurate to 0.2 %, but
/// no real tendon stretches exactly as this model predicts.
pub(super) const UNCERTAIN: f64 = 0.02;
/// Tensions are divided by this value, N, so that all coefficients have similar sizes.
const SCALE: f64 = 10.0;

#[derive(Clone, Copy, Debug)]
pub(super) struct TendonStiffness {
    fit: LeastSquares<14>,
    null: Vector4<f64>,
    winding: Winding,
    /// Travel of the first sample, cm. The fit uses only differences from this travel, because large values would
    /// lose digits.
    first: Option<Vector4<f64>>,
    seconds: f64,
}

/// The elasticity of all four tendons.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StiffnessFound {
    /// Mean stiffness in the range of tensions in which the controller works, N/cm.
    pub stiffness: Vector4<f64>,
    /// Sum of `UNCERTAIN`, `unexplained` and the largest relative difference between the local compliance, which
    /// depends on the tension, and the mean compliance, which is the inverse of `stiffness`. At most 1.
    pub tolerance: f64,
    /// Part of the travel that the model does not explain, cm rms.
    pub residual: f64,
    /// `residual` as a fraction of the stretch over the range of tensions in which the controller works.
    pub unexplained: f64,
    /// Largest fraction by which the friction of a conduit makes the mean tension along its tendon differ from the
    /// tension at the gauge.
    pub rubbing: f64,
    /// `linear` is c, cm/N. `curved` is d, cm/N^2. `friction` is h, cm/N.
    linear: Vector4<f64>,
    curved: Vector4<f64>,
    friction: Vector4<f64>,
}

impl StiffnessFound {
    /// Returns the stretch, cm, at the tensions `tensions`, N. `winding` are the directions in which the tendons slid.
    pub fn stretch(&self, tensions: &Vector4<f64>, winding: &Vector4<f64>) -> Vector4<f64> {
        let per_newton = self.linear + self.curved.component_mul(tensions) + self.friction.component_mul(winding);
        per_newton.component_mul(tensions)
    }
}

impl TendonStiffness {
    pub fn new(instruments: &Instruments) -> Self {
        // The last column of Q (that of the ghost joint, see `Tendons`) spans the null space of R.
        let null = instruments.tendons.q.column(3).into_owned().normalize();
        Self { fit: LeastSquares::new(), null, winding: Winding::default(), first: None, seconds: 0.0 }
    }

    /// Updates the directions in which the tendons slide, and adds the sample to the fit if `under_way` is true.
    /// `conduit` is the friction of conduits as a fraction of the tension.
    pub fn add(&mut self, instruments: &Instruments, sample: &Sample, conduit: &Vector4<f64>, under_way: bool) {
        let travel = instruments.travel(sample.feedback);
        let tensions = instruments.tensions(sample.feedback);
        self.winding.follow(&travel, &tensions, conduit, &instruments.compliance);
        if !under_way {
            return;
        }
        let first = *self.first.get_or_insert(travel);
        self.seconds += instruments.period;
        let scaled = tensions / SCALE;
        let mut x = SVector::<f64, 14>::zeros();
        for tendon in 0..4 {
            let linear = self.null[tendon] * scaled[tendon];
            x[tendon] = linear;
            x[4 + tendon] = linear * scaled[tendon];
            x[8 + tendon] = linear * self.winding.friction[tendon];
        }
        (x[12], x[13]) = (self.seconds, 1.0);
        self.fit.add(&x, self.null.dot(&(travel - first)));
    }

    pub fn solve(&self, instruments: &Instruments) -> Result<StiffnessFound, Obstacle> {
        let what = "the stiffness in N/cm";
        let (found, residual) = self.fit.solve().ok_or(Obstacle::Implausible {
            part: Part::Finger,
            what: "the stiffness of the tendons",
            value: f64::NAN,
        })?;
        let linear = found.fixed_rows::<4>(0) / SCALE;
        let curved = found.fixed_rows::<4>(4) / (SCALE * SCALE);
        let (least, most) = (instruments.minimum, WORKING * instruments.maximum);
        let compliance = linear + curved * (least + most);
        let stiffness = compliance.map(f64::recip);
        if let Some(index) = stiffness.iter().position(|k| !(SOFTEST..=STIFFEST).contains(k)) {
            return Err(Obstacle::Implausible { part: Part::tendon(index), what, value: stiffness[index] });
        }
        let off = |tension: f64| {
            let local = linear + curved * (2.0 * tension);
            local.zip_map(&compliance, |local, mean| (local / mean - 1.0).abs()).max()
        };
        let unexplained = residual / (compliance.min() * (most - least));
        let tolerance = UNCERTAIN + off(least).max(off(MEASURED * instruments.maximum)) + unexplained;
        let friction = found.fixed_rows::<4>(8) / SCALE;
        let rubbing = friction.component_div(&compliance).amax();
        let tolerance = tolerance.min(1.0);
        Ok(StiffnessFound { stiffness, tolerance, residual, unexplained, rubbing, linear, curved, friction })
    }
}
