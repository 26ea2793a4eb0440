//! The result as a table or as JSON.

use super::Wanted;
use super::figures::{Figure, figures};
use crate::failure::Failure;
use crate::print::{Cell, Look, Screen, Table, painted};
use serde::Serialize;
use std::io::{self, Write};
use sun2xp::model::configuration::ConfiguredFinger;

/// The figures of a finger, and whether all suffice.
#[derive(Serialize)]
pub struct Report {
    /// Whether every configured part suffices.
    pub pass: bool,
    figures: Vec<Figure>,
}

impl Report {
    pub fn new(finger: &ConfiguredFinger, rate: f64, wanted: &Wanted) -> Result<Self, Failure> {
        let figures = figures(finger, rate, wanted)?;
        Ok(Self { pass: figures.iter().all(|figure| figure.sufficient), figures })
    }

    pub fn write(&self, output: &mut impl Write, screen: &Screen) -> io::Result<()> {
        let mut table = Table::new(["", "quantity", "has", "needs", "unit", "what to change or to look for"]);
        table = table.numeric([2, 3]);
        for figure in &self.figures {
            let mark = match (figure.has, figure.sufficient) {
                (None, _) => Cell::new(Look::Dim, "choose"),
                (_, true) => Cell::new(Look::Good, "good"),
                (_, false) => Cell::new(Look::Bad, "INSUFFICIENT"),
            };
            let number = |value: Option<f64>| value.map(three_digits).unwrap_or_default().into();
            let advice = if figure.has.is_none() || !figure.sufficient { figure.advice } else { "" };
            let (has, needs) = (number(figure.has), number(figure.needs));
            table.row([mark, figure.what.into(), has, needs, figure.unit.into(), advice.into()]);
        }
        let (look, word) = if self.pass { (Look::Good, "pass") } else { (Look::Bad, "fail") };
        writeln!(output, "{}{}", table.text(screen), painted(screen, look, word))
    }
}

/// Returns a positive number with at least three significant digits.
fn three_digits(value: f64) -> String {
    let magnitude = value.abs().max(1e-9).log10().floor() as i32;
    let decimals = usize::try_from(2 - magnitude).unwrap_or(0);
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::three_digits;

    #[test]
    fn numbers_have_three_significant_digits() {
        let shown = [0.123_45, 1.0, 59.98, 123.4, 20_160.0].map(three_digits);
        assert_eq!(shown, ["0.123", "1.00", "60.0", "123", "20160"]);
    }
}
