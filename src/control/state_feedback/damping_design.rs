//! The damping that a spring of several dimensions needs on a given inertia.

use crate::control::eigenvalues::eigenvalues;
use nalgebra::Matrix3;

/// D = 2 zeta (W # (K + f^2 W)) + lag sym(H W^-1 K).
///
/// W # K = W (W^-1 K)^(1/2) is the geometric mean: for one dimension 2 zeta sqrt(W K), and in general the damper that
/// damps every mode of the pair (W, K) with the same ratio zeta. The floor f keeps a finger without stiffness, or with
/// a K that is not of full rank, damped. Tensions follow what is asked of them late by `lag`; what the links feel of
/// the spring, the share H W^-1, needs that much rate in advance.
#[derive(Clone, Debug)]
pub(crate) struct DampingDesign {
    /// zeta.
    pub ratio: f64,
    /// f, rad/s.
    pub least_frequency: f64,
    /// s.
    pub lag: f64,
}

impl DampingDesign {
    /// D, N m s/rad: W, the inertia that the spring feels, and H, that of the links alone, kg m^2; K, N m/rad;
    /// `relative` scales zeta.
    pub fn damping(
        &self,
        felt: &Matrix3<f64>,
        links: &Matrix3<f64>,
        k_theta: &Matrix3<f64>,
        relative: f64,
    ) -> Matrix3<f64> {
        let inverse = inverse(felt);
        let floor = self.least_frequency * self.least_frequency;
        let mean = felt * square_root(&(inverse * k_theta + Matrix3::identity() * floor));
        let lagging = links * inverse * k_theta;
        mean * (2.0 * self.ratio * relative) + (lagging + lagging.transpose()) * (0.5 * self.lag)
    }
}

/// Of a positive definite matrix, which all inertias are.
fn inverse(matrix: &Matrix3<f64>) -> Matrix3<f64> {
    let [a, b, c] = [0, 1, 2].map(|index| matrix.column(index).into_owned());
    Matrix3::from_rows(&[b.cross(&c).transpose(), c.cross(&a).transpose(), a.cross(&b).transpose()])
        / a.dot(&b.cross(&c))
}

/// The root of a matrix with positive eigenvalues, by the theorem of Cayley and Hamilton. No iteration,
/// so it always takes the same time.
fn square_root(matrix: &Matrix3<f64>) -> Matrix3<f64> {
    let square = matrix * matrix;
    let [a, b, c] = eigenvalues(matrix).map(|eigenvalue| eigenvalue.max(0.0).sqrt());
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

        /// With H = 0 and no floor D is the geometric mean: D W^-1 D = 4 zeta^2 K, and the same with W and K exchanged.
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
