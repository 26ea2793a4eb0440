//! The check that Kx is a spring. The hand makes the same check. A call therefore refuses at once what the hand would
//! refuse later.

use nalgebra::Matrix3;

/// The largest asymmetry that counts as a rounding error, relative to the largest entry. It is also the largest
/// magnitude of a negative eigenvalue that counts as a rounding error, relative to the largest magnitude of an
/// eigenvalue.
const ROUNDING: f64 = 1e-3;

/// Why a matrix is not a spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NotASpring {
    /// `Kx[row][column]` and `Kx[column][row]` differ.
    NotSymmetric {
        /// Row of the first such pair.
        row: usize,
        /// Column of the first such pair.
        column: usize,
        /// Difference of the two entries, N/cm.
        difference: f64,
    },
    /// The smallest eigenvalue is negative, N/cm.
    Negative(f64),
}

/// Returns the largest eigenvalue of Kx. The caller has checked that the entries are finite.
pub fn largest_eigenvalue(rows: &[[f64; 3]; 3]) -> Result<f64, NotASpring> {
    let asked = Matrix3::from_fn(|row, column| rows[row][column]);
    let tolerance = ROUNDING * asked.amax();
    for (row, column) in [(0, 1), (0, 2), (1, 2)] {
        let difference = (asked[(row, column)] - asked[(column, row)]).abs();
        if difference > tolerance {
            return Err(NotASpring::NotSymmetric { row, column, difference });
        }
    }
    // The squares of entries below the rounding error of the largest entry could underflow, which gives NaN.
    let negligible = f64::EPSILON * asked.amax();
    let halves = asked * 0.5 + asked.transpose() * 0.5;
    let symmetric = halves.map(|entry| if entry.abs() < negligible { 0.0 } else { entry });
    let eigenvalues = symmetric.symmetric_eigenvalues();
    let (smallest, largest) = (eigenvalues.min(), eigenvalues.max());
    if smallest < -ROUNDING * largest.abs().max(smallest.abs()).min(f64::MAX) {
        return Err(NotASpring::Negative(smallest));
    }
    Ok(largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_eigenvalue_of_a_diagonal_matrix_is_its_largest_entry() {
        let largest = largest_eigenvalue(&[[1.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 2.0]]).expect("a spring");
        assert!((largest - 3.0).abs() < 1e-12, "{largest}");
        assert_eq!(largest_eigenvalue(&[[0.0; 3]; 3]), Ok(0.0));
    }

    #[test]
    fn what_is_not_a_spring_is_refused() {
        let skew = largest_eigenvalue(&[[1.0, 0.5, 0.0], [-0.5, 1.0, 0.0], [0.0, 0.0, 1.0]]);
        assert_eq!(skew, Err(NotASpring::NotSymmetric { row: 0, column: 1, difference: 1.0 }));
        let negative = largest_eigenvalue(&[[1.0, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, 1.0]]);
        assert!(matches!(negative, Err(NotASpring::Negative(smallest)) if (smallest + 0.5).abs() < 1e-12));
    }
}
