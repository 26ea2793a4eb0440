//! Damping of a spring with several dimensions that acts on a given inertia.

use crate::control::eigenvalues::eigenvalues;
use nalgebra::Matrix3;

/// D = 2 zeta (W # (K + f^2 W)) + lag sym(H W^-1 K).
///
/// K is the stiffness of the spring, W the inertia on which it acts, and H the inertia of the links alone. sym is the
/// symmetric part.
///
/// W # K = W (W^-1 K)^(1/2) is the geometric mean. Without f and lag, D gives every mode of the pair (W, K) the damping
/// ratio zeta; in one dimension D is 2 zeta sqrt(W K). Because of the lowest frequency f, a finger is also damped if it
/// has no stiffness, or if K does not have full rank. The tensions lag behind the desired ones by `lag`. The share H
/// W^-1 of the spring's torque acts on the links. The second term compensates the lag of that share.
#[derive(Clone, Debug)]
pub(crate) struct DampingDesign {
    /// zeta: damping ratio.
    pub ratio: f64,
    /// f: lowest frequency for which the damping is designed, rad/s.
    pub least_frequency: f64,
    /// Lag of the tensions, s.
    pub lag: f64,
}

impl DampingDesign {
    /// Returns D, N m s/rad. W is the inertia on which the spring acts, and H is the inertia of the links alone, both
    /// in kg m^2. K is in N m/rad. `relative` scales zeta.
    pub fn damping(
        &self,
        inertia: &Matrix3<f64>,
        links: &Matrix3<f64>,
        k_theta: &Matrix3<f64>,
        relative: f64,
    ) -> Matrix3<f64> {
        let inverse = inverse(inertia);
        let floor = self.least_frequency * self.least_frequency;
        let mean = inertia * square_root(&(inverse * k_theta + Matrix3::identity() * floor));
        let lagging = links * inverse * k_theta;
        mean * (2.0 * self.ratio * relative) + (lagging + lagging.transpose()) * (0.5 * self.lag)
    }
}

/// Returns the inverse of a positive definite matrix, such as an inertia.
fn inverse(matrix: &Matrix3<f64>) -> Matrix3<f64> {
    let [a, b, c] = [0, 1, 2].map(|index| matrix.column(index).into_owned());
    Matrix3::from_rows(&[b.cross(&c).transpose(), c.cross(&a).transpose(), a.cross(&b).transpose()])
        / a.dot(&b.cross(&c))
}

/// Returns the square root of a matrix with positive eigenvalues, by the theorem of Cayley and Hamilton. The
/// computation has no iteration, so it always takes the same time.
fn square_root(matrix: &Matrix3<f64>) -> Matrix3<f64> {
    let square = matrix * matrix;
    let [a, b, c] = eigenvalues(matrix);
    let root = |eigenvalue: f64| eigenvalue.max(0.0).sqrt();
    let (a, b, c) = (root(a), root(b), root(c));
    let (sum, pairs, product) = (a + b + c, a * b + b * c + c * a, a * b * c);
    (matrix * (sum * sum - pairs) - square + Matrix3::identity() * (sum * product)) / (sum * pairs - product)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn definite() -> impl Strategy<Value = Matrix3<f64>> {
        (prop::array::uniform9(-1.0..1.0f64), 0.01..1.0f64).prop_map(|(entries, least)| {
            let factor = Matrix3::from_row_slice(&entries);
            factor * factor.transpose() + Matrix3::identity() * least
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

        #[test]
        fn the_root_squared_is_the_matrix(a in definite(), b in definite()) {
            let matrix = inverse(&a) * b;
            let root = square_root(&matrix);
            prop_assert!((root * root - matrix).amax() < 1e-6 * matrix.amax(), "{root}{matrix}");
        }

        /// With H = 0 and f = 0, D is 2 zeta times the geometric mean of W and K: D W^-1 D = 4 zeta^2 K.
        #[test]
        fn every_mode_has_the_same_ratio(w in definite(), k in definite(), zeta in 0.1..1.0f64) {
            let design = DampingDesign { ratio: zeta, least_frequency: 0.0, lag: 1.0 };
            let damping = design.damping(&w, &Matrix3::zeros(), &k, 1.0);
            let squared = damping * inverse(&w) * damping;
            let condition = 1.0 + w.amax() * inverse(&w).amax();
            prop_assert!((squared - k * (4.0 * zeta * zeta)).amax() < 1e-6 * condition * k.amax());
            prop_assert!((damping - damping.transpose()).amax() < 1e-6 * (1.0 + inverse(&w).amax()) * damping.amax());
        }
    }
}
