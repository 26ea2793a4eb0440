//! Determines the stiffness of every tendon from motor travel against tension.
//!
//! The motor travel of every tendon is x_i = R_i^T theta + t_i / k_i + const. Multiplication by the null vector n of R
//! eliminates any motion of the joints: n . x = sum n_i t_i / k_i + const. This is one equation per sample with four
//! unknown compliances. They can be separated if the four tensions vary independently. The tensions vary independently
//! only with joint torques, so something must hold the finger.

use super::least_squares::LeastSquares;
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::Sample;
use crate::model::Part;
use nalgebra::{SVector, Vector4};

/// Plausible range of the stiffness of a tendon, N/cm.
const SOFTEST: f64 = 10.0;
const STIFFEST: f64 = 1e5;

#[derive(Clone, Copy, Debug)]
pub(super) struct TendonStiffness {
    fit: LeastSquares<5>,
    null: Vector4<f64>,
    /// Travel of the first sample, cm. The fit uses only differences from this travel, because large values would
    /// lose digits.
    first: Option<Vector4<f64>>,
}

impl TendonStiffness {
    pub fn new(instruments: &Instruments) -> Self {
        // The ghost column of Q spans the null space of R.
        let null = instruments.tendons.q.column(3).into_owned().normalize();
        Self { fit: LeastSquares::new(), null, first: None }
    }

    pub fn add(&mut self, instruments: &Instruments, sample: &Sample) {
        let travel = instruments.travel(sample.feedback);
        let first = *self.first.get_or_insert(travel);
        let weighted = self.null.component_mul(&instruments.tensions(sample.feedback));
        let [a, b, c, d]: [f64; 4] = weighted.into();
        self.fit.add(&SVector::from([a, b, c, d, 1.0]), self.null.dot(&(travel - first)));
    }

    /// Returns the stiffnesses, N/cm, and the rms residual of the travel, cm.
    pub fn solve(&self) -> Result<(Vector4<f64>, f64), Obstacle> {
        let what = "the stiffness, N/cm,";
        let (found, residual) = self.fit.solve().ok_or(Obstacle::Implausible {
            part: Part::Finger,
            what: "the stiffness of the tendons, N/cm,",
            value: f64::NAN,
        })?;
        let stiffness = found.fixed_rows::<4>(0).map(f64::recip);
        match stiffness.iter().position(|k| !(SOFTEST..=STIFFEST).contains(k)) {
            Some(index) => Err(Obstacle::Implausible { part: Part::tendon(index), what, value: stiffness[index] }),
            None => Ok((stiffness, residual)),
        }
    }
}
