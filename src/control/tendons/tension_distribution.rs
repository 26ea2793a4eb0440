//! The block R^-1 of Figure 9 of the report: tensions that produce the joint torque (eqs. 18-20), within a lower and an
//! upper bound.

use crate::model::Tendons;
use crate::model::configuration::Unusable;
use nalgebra::{Matrix4, Matrix4x3, Vector3, Vector4};

/// Tensions that produce a joint torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistributedTensions {
    /// Tensions, N, each within the bounds, with R `tensions` = `scale` tau.
    pub tensions: Vector4<f64>,
    /// The largest fraction of the torque that the bounds permit, 0 to 1.
    pub scale: f64,
}

/// t = Q (tau, tau_g) with the joint torques tau and the smallest torque tau_g of the ghost joint that keeps t >=
/// t_min. If t would exceed t_max, tau is scaled down.
#[derive(Clone, Debug)]
pub struct TensionDistribution {
    /// Q_i of eq. 17: joint torque, N cm, to tension, N.
    from_torque: Matrix4x3<f64>,
    /// q_i4 of eq. 17, positive.
    ghost: Vector4<f64>,
    /// 1 / q_i4.
    inverse_ghost: Vector4<f64>,
    /// q_i4 / q_j4, dimensionless.
    ratio: Matrix4<f64>,
    /// t_min q_i4 / q_j4, N: the tension of tendon i while tendon j is at t_min and the joint torque is zero.
    idle: Matrix4<f64>,
    /// Tensions at zero joint torque, N.
    at_rest: Vector4<f64>,
    minimum: f64,
    maximum: Vector4<f64>,
}

/// The distribution with the upper bounds of one cycle.
pub struct BoundedDistribution<'a> {
    of: &'a TensionDistribution,
    maximum: Vector4<f64>,
}

impl TensionDistribution {
    /// Constructs the distribution from bounds in N: `minimum` for all tendons, and `maximum` for each, which includes
    /// the limit of its motor. Returns an error unless every maximum is finite and above the tension that its tendon
    /// has at zero joint torque.
    pub fn new(tendons: &Tendons, minimum: f64, maximum: Vector4<f64>) -> Result<Self, Unusable> {
        crate::control::number_checks::positive("tendon.minimum", &[minimum])?;
        let at_rest = tendons.pretension(minimum);
        let too_low = |&tendon: &usize| !maximum[tendon].is_finite() || maximum[tendon] <= at_rest[tendon];
        if let Some(tendon) = (0..4).find(too_low) {
            let reason = format!(
                "is too low: tendon {} may have at most {:.2} N, and already has {:.2} N at zero joint torque (state \
                 feedback keeps a margin to both bounds of the tension, which lowers the first value and raises the \
                 second). Raise tendon.maximum or motor.torque_limit, or lower tendon.minimum",
                tendon + 1,
                maximum[tendon],
                at_rest[tendon]
            );
            return Err(Unusable { key: "tendon.maximum", reason });
        }
        let ghost: Vector4<f64> = tendons.q.column(3).into_owned();
        let ratio = Matrix4::from_fn(|i, j| ghost[i] / ghost[j]);
        let idle = ratio * minimum;
        Ok(Self {
            from_torque: tendons.q.fixed_columns::<3>(0).into_owned(),
            ghost,
            inverse_ghost: ghost.map(f64::recip),
            ratio,
            at_rest: Vector4::from_fn(|i, _| idle.row(i).max()),
            idle,
            minimum,
            maximum,
        })
    }

    /// Returns the distribution in which no tension exceeds `limit`, N, which is the tension that the motor of each
    /// tendon can give now. A limit below the tension at zero joint torque is raised to that tension. The distribution
    /// then permits no torque that would raise the tension further.
    #[inline]
    pub fn below(&self, limit: &Vector4<f64>) -> BoundedDistribution<'_> {
        BoundedDistribution { of: self, maximum: self.maximum.inf(limit).sup(&self.at_rest) }
    }

    /// Returns [`BoundedDistribution::distribute`] with the full upper bounds.
    pub fn distribute(&self, torques: &Vector3<f64>) -> DistributedTensions {
        self.below(&self.maximum).distribute(torques)
    }
}

impl BoundedDistribution<'_> {
    /// Returns the smallest tensions, in the sense of eq. 20, for the joint torque tau, N cm.
    ///
    /// For each tendon j there is a tau_g that puts tendon j at t_min. Tendon i then has the tension
    /// s (A_i - A_j q_i4/q_j4) + t_min q_i4/q_j4. Here s is the scale, and A = Q (tau, 0). Eq. 20 selects the largest
    /// of these tau_g, which gives tendon i the largest of these tensions. So the tension above must be at most t_max
    /// for every pair i, j. These conditions bound s.
    #[inline]
    pub fn distribute(&self, torques: &Vector3<f64>) -> DistributedTensions {
        let Self { of, maximum } = self;
        let wanted = of.from_torque * torques;
        let mut scale: f64 = 1.0;
        for i in 0..4 {
            // The condition of a tendon with itself always holds: its maximum is not below its minimum.
            for j in (0..4).filter(|&j| j != i) {
                let added = wanted[i] - of.ratio[(i, j)] * wanted[j];
                // The headroom is not negative, because no bound is below the tensions at rest.
                let headroom = maximum[i] - of.idle[(i, j)];
                if added * scale > headroom {
                    scale = headroom / added;
                }
            }
        }
        let wanted = wanted * scale;
        let ghost_torque = (Vector4::repeat(of.minimum) - wanted).component_mul(&of.inverse_ghost).max();
        // By eq. 20 one tendon is at t_min. Rounding must not put it below.
        let tensions = (wanted + of.ghost * ghost_torque).map(|tension| tension.max(of.minimum));
        DistributedTensions { tensions, scale }
    }
}
