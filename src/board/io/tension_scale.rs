//! Conversion of tensions in N to the gauge counts of the board protocol.

/// Default step of the tensions, N. It is about a fifth of the step of a 12-bit converter for 100 N.
pub const DEFAULT_TENSION_UNIT: f64 = 0.005;

/// The count at zero tension. Tensions may be negative, because an unloaded gauge is noisy and drifts.
pub const ZERO_COUNT: u16 = 8192;

/// The conversion from N to counts. The last count at each end of the range is not used, because the monitors regard
/// it as the end of a converter's range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TensionScale {
    newton_per_count: f64,
}

impl TensionScale {
    /// Creates the scale with this step, N. Returns `None` if the step is not a positive number.
    pub fn new(newton_per_count: f64) -> Option<Self> {
        (newton_per_count.is_finite() && newton_per_count > 0.0).then_some(Self { newton_per_count })
    }

    /// Returns the count of a tension, N, or `None` if no count stands for it.
    pub fn count(self, newton: f64) -> Option<u16> {
        let count = (newton / self.newton_per_count).round() + f64::from(ZERO_COUNT);
        // The comparison is false for NaN.
        (1.0..f64::from(u16::MAX)).contains(&count).then_some(count as u16)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tension_has_a_count_within_half_a_step_or_none() {
        let scale = TensionScale::new(0.005).expect("a step");
        let newton = |count: u16| (f64::from(count) - f64::from(ZERO_COUNT)) * 0.005;
        for tension in [-40.9, -0.003, 0.0, 0.0024, 5.0, 60.001, 100.0, 286.7] {
            let count = scale.count(tension).expect("within the range");
            assert!((newton(count) - tension).abs() <= 0.0025 + 1e-9, "{tension} N is count {count}");
        }
        for tension in [-41.0, 286.8, 1e300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(scale.count(tension), None, "{tension} N");
        }
        assert_eq!((scale.count(-40.955), scale.count(286.71)), (Some(1), Some(u16::MAX - 1)), "the ends of the range");
    }

    #[test]
    fn the_pages_give_the_range() {
        let scale = TensionScale::new(1.0).expect("a step");
        let (lowest, highest) = (-8191.0, 57_342.0);
        assert_eq!((scale.count(lowest), scale.count(highest)), (Some(1), Some(u16::MAX - 1)));
        assert_eq!((scale.count(lowest - 1.0), scale.count(highest + 1.0)), (None, None));
        let manual = include_str!("../../capi/io_calls.rs");
        assert!(manual.contains("-8191 to 57342 times io->tension_unit"), "the C manual");
        let pages = [include_str!("finger_io.rs"), include_str!("../../../docs/other-hardware.md")];
        assert!(pages.iter().all(|page| page.contains("-8191 to 57 342 steps")));
    }

    #[test]
    fn a_step_is_a_positive_number() {
        for step in [0.0, -0.005, f64::NAN, f64::INFINITY] {
            assert_eq!(TensionScale::new(step), None, "{step}");
        }
    }
}
