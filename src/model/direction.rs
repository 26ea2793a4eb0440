//! The direction of a vector of any length.

use nalgebra::Vector3;

/// Returns the unit vector along a vector with finite components, or `None` for the zero vector.
///
/// A vector of any length, from the smallest positive number to the largest, has a direction. The squares of its
/// components may be infinite or zero, so the vector is divided by its largest component first.
pub fn direction(vector: &Vector3<f64>) -> Option<Vector3<f64>> {
    let largest = vector.amax();
    // Each component is divided, because the reciprocal of a subnormal number can be infinite.
    (largest > 0.0).then(|| vector.map(|component| component / largest).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_vector_except_zero_has_a_unit_direction() {
        for length in [5e-324, 1e-310, 1e-200, 1.0, 1e200, f64::MAX] {
            let diagonal = Vector3::new(-length, length, length);
            assert!(
                (direction(&diagonal).expect("a direction") - Vector3::new(-1.0, 1.0, 1.0) / 3f64.sqrt()).amax()
                    < 1e-15
            );
        }
        assert_eq!(direction(&Vector3::new(0.0, -0.0, 0.0)), None);
    }
}
