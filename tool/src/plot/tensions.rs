//! Measured and wanted tensions, with their bounds.

use super::axis::Axis;
use super::figure::{Figure, Sign, subtitle};
use super::palette::{BLUE, PERMITTED, SOFT_INK, VERMILION};
use super::panel::{Mark, Panel};
use super::svg::Stroke;
use super::{LONGEST_PAUSE, NOT_CONTROLLED, Plot, Selection};
use crate::failure::Failure;
use crate::trace::Item;

const MEASURED: Stroke = Stroke::solid(BLUE, 1.4);
const WANTED: Stroke = Stroke { dashes: Some("5 3"), ..Stroke::solid(VERMILION, 1.4) };
const BOUND: Stroke = Stroke { dashes: Some("2 3"), ..Stroke::solid(SOFT_INK, 1.2) };

/// Height of a panel, pixels.
const HEIGHT: f64 = 260.0;

/// One cycle: time, measured and wanted tensions.
struct Point {
    time: f64,
    measured: [f64; 4],
    wanted: [f64; 4],
}

/// The collected cycles.
#[derive(Default)]
pub struct Tensions {
    rate: f64,
    points: Vec<Point>,
    /// t_min and t_max of the last cycle.
    bounds: (f64, f64),
}

impl Plot for Tensions {
    fn take(&mut self, item: &Item, seconds: f64) {
        match item {
            Item::Finger(finger) => self.rate = finger.rate,
            Item::Cycle(row) if row.sample.computed => {
                let sample = &row.sample;
                self.bounds = (sample.t_min, sample.t_max);
                let (measured, wanted) = (sample.tensions, sample.desired_tensions);
                if self.points.last().is_some_and(|last| seconds - last.time > LONGEST_PAUSE) {
                    let none = [f64::NAN; 4];
                    self.points.push(Point { time: seconds, measured: none, wanted: none });
                }
                self.points.push(Point { time: seconds, measured, wanted });
            }
            Item::Cycle(_) | Item::Mark(_) | Item::Object(..) => {}
        }
    }

    fn draw(&self, selection: &Selection) -> Result<Figure, Failure> {
        let (Some(first), Some(last)) = (self.points.first(), self.points.last()) else {
            return Err(NOT_CONTROLLED.into());
        };
        let time = Axis::linear(first.time, last.time.max(first.time + 1e-3));
        let (t_min, t_max) = self.bounds;
        let all = || self.points.iter().flat_map(|point| point.measured.into_iter().chain(point.wanted));
        let largest = all().filter(|value| value.is_finite()).fold(1.3 * t_min, f64::max);
        let lowest = all().filter(|value| value.is_finite()).fold(0.0, f64::min);
        // All panels have the same axis, so that the tendons can be compared. The axis does not extend to a distant
        // t_max, because that would flatten the curves.
        let high = if t_max < 2.0 * largest { t_max.max(largest) } else { largest };
        let tension = Axis::linear(lowest, 1.08 * high);
        let panel = |tendon: usize| {
            let curve = |of: fn(&Point) -> &[f64; 4]| -> Vec<[f64; 2]> {
                self.points.iter().map(|point| [point.time, of(point)[tendon]]).collect()
            };
            let number = tendon + 1;
            Panel {
                heading: format!("tendon {number}"),
                note: String::new(),
                x: time,
                y: tension,
                x_label: if tendon < 2 { String::new() } else { "time, s".into() },
                y_label: "tension, N".into(),
                marks: vec![
                    Mark::Band { low: t_min, high: t_max, colour: PERMITTED },
                    Mark::Level { y: t_min, stroke: BOUND, label: "t_min".into() },
                    Mark::Level { y: t_max, stroke: BOUND, label: "t_max".into() },
                    Mark::Curve {
                        name: format!("tension {number}"),
                        points: curve(|point| &point.measured),
                        stroke: MEASURED,
                    },
                    Mark::Curve {
                        name: format!("tension {number} wanted"),
                        points: curve(|point| &point.wanted),
                        stroke: WANTED,
                    },
                ],
            }
        };
        let legend = [
            (Sign::Line(MEASURED), "measured".into()),
            (Sign::Line(WANTED), "wanted".into()),
            (Sign::Area(PERMITTED), format!("permitted: t_min = {t_min} N to t_max = {t_max} N")),
        ];
        let subtitle = subtitle(selection, self.rate, "");
        let mut figure = Figure::new("Tendon tensions", &subtitle, &legend, Figure::height_of(2, HEIGHT));
        figure = figure.with_space_at_the_right(24.0);
        figure.grid(&[vec![panel(0), panel(1)], vec![panel(2), panel(3)]], HEIGHT);
        Ok(figure)
    }
}
