//! A straight line through measured points.

/// `newton = slope * (count - zero)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// N per count.
    pub slope: f64,
    /// Count at 0 N.
    pub zero: f64,
    /// N rms.
    pub residual: f64,
}

impl Line {
    /// Fits a line to pairs of a count and a force, N, by least squares. Returns `None` for fewer than two different
    /// counts, and for a slope of zero.
    pub fn through(points: &[(f64, f64)]) -> Option<Self> {
        let number = points.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / number;
        let (count, newton) = (mean(|point| point.0), mean(|point| point.1));
        let spread: f64 = points.iter().map(|point| (point.0 - count).powi(2)).sum();
        let joint: f64 = points.iter().map(|point| (point.0 - count) * (point.1 - newton)).sum();
        let slope = joint / spread;
        if !slope.is_finite() || slope == 0.0 {
            return None;
        }
        let zero = count - newton / slope;
        let squares: f64 = points.iter().map(|point| (slope * (point.0 - zero) - point.1).powi(2)).sum();
        Some(Self { slope, zero, residual: (squares / number).sqrt() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_and_its_residual() {
        let line = Line::through(&[(100.0, 0.0), (300.0, 5.0), (500.0, 10.0)]).expect("a line");
        assert!((line.slope - 0.025).abs() < 1e-12 && (line.zero - 100.0).abs() < 1e-9 && line.residual < 1e-12);
        let bent = Line::through(&[(100.0, 0.0), (300.0, 6.0), (500.0, 10.0)]).expect("a line");
        assert!((bent.residual - 0.4714).abs() < 1e-3, "{bent:?}");
        assert_eq!(Line::through(&[(100.0, 0.0), (100.0, 5.0)]), None);
        assert_eq!(Line::through(&[]), None);
    }
}
