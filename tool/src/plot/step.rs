//! The step response: joints and tip against their set points.

use super::axis::Axis;
use super::figure::{Figure, Sign, subtitle};
use super::palette::{BLUE, INK};
use super::panel::{Mark, Panel};
use super::svg::Stroke;
use super::{LONGEST_PAUSE, NOT_CONTROLLED, Plot, Selection};
use crate::failure::Failure;
use crate::trace::Item;

const MEASURED: Stroke = Stroke::solid(BLUE, 1.8);
const SET_POINT: Stroke = Stroke::dashed(INK, 1.4);

/// Height of a panel, pixels.
const HEIGHT: f64 = 190.0;

/// A recording that is longer than this, s, is drawn only around its largest step.
const LONG: f64 = 5.0;
/// Times at which the drawing of a recording longer than [`LONG`] begins and ends, s. The largest step is at 0.
const AROUND: (f64, f64) = (-0.2, 1.3);

/// A step of the set point is at least this large, degrees.
const SMALLEST: f64 = 0.5;

/// A joint has settled when its distance from the set point stays within this fraction of the step for the time
/// [`STAYS`], s. Later deviations, for example when somebody pushes the finger, do not count.
const SETTLED: f64 = 0.05;
const STAYS: f64 = 0.2;

/// One cycle: time, and measured value and set point of three joints, degrees, and of three axes, cm.
struct Point {
    time: f64,
    values: [[f64; 2]; 6],
}

/// The collected cycles.
#[derive(Default)]
pub struct Step {
    rate: f64,
    points: Vec<Point>,
}

impl Plot for Step {
    fn take(&mut self, item: &Item, seconds: f64) {
        match item {
            Item::Finger(finger) => self.rate = finger.rate,
            Item::Cycle(row) if row.sample.computed => {
                let sample = &row.sample;
                let none = [f64::NAN; 3];
                let (set_point, tip) = (sample.joint_set_point.unwrap_or(none), sample.tip_set_point.unwrap_or(none));
                let joint = |axis: usize| [sample.joints[axis], set_point[axis]].map(f64::to_degrees);
                let axis = |axis: usize| [sample.tip[axis], tip[axis]];
                if self.points.last().is_some_and(|last| seconds - last.time > LONGEST_PAUSE) {
                    self.points.push(Point { time: seconds, values: [[f64::NAN; 2]; 6] });
                }
                let values = [joint(0), joint(1), joint(2), axis(0), axis(1), axis(2)];
                self.points.push(Point { time: seconds, values });
            }
            Item::Cycle(_) | Item::Mark(_) | Item::Object(..) => {}
        }
    }

    fn draw(&self, selection: &Selection) -> Result<Figure, Failure> {
        let points = self.shown(selection);
        let (Some(first), Some(last)) = (points.first(), points.last()) else {
            return Err(NOT_CONTROLLED.into());
        };
        let time = Axis::linear(first.time, last.time.max(first.time + 1e-3));
        let panel = |index: usize| {
            let (joint, number) = (index < 3, index % 3);
            let curve = |which: usize| points.iter().map(|point| [point.time, point.values[index][which]]).collect();
            let (measured, set_point): (Vec<[f64; 2]>, Vec<[f64; 2]>) = (curve(0), curve(1));
            let name = if joint { format!("joint {number}") } else { format!("tip {}", ["x", "y", "z"][number]) };
            let response = if joint { response(&measured, &set_point) } else { String::new() };
            let values = measured.iter().chain(&set_point).map(|point| point[1]);
            Panel {
                heading: name.clone(),
                note: response,
                x: time,
                y: Axis::around(values, if joint { 2.0 } else { 0.2 }),
                x_label: if number == 2 { "time, s".into() } else { String::new() },
                y_label: if joint { "degrees".into() } else { "cm".into() },
                marks: vec![
                    Mark::Curve { name: format!("{name} set point"), points: set_point, stroke: SET_POINT },
                    Mark::Curve { name, points: measured, stroke: MEASURED },
                ],
            }
        };
        let legend = [(Sign::Line(MEASURED), "measured".into()), (Sign::Line(SET_POINT), "set point".into())];
        let subtitle = subtitle(selection, self.rate, "tip in the palm's frame");
        let mut figure = Figure::new(
            "Joints and fingertip against their set points",
            &subtitle,
            &legend,
            Figure::height_of(3, HEIGHT),
        );
        figure.grid(&[0, 1, 2].map(|row| vec![panel(row), panel(row + 3)]), HEIGHT);
        Ok(figure)
    }
}

impl Step {
    /// The cycles that are drawn: all, or those around the largest step.
    fn shown(&self, selection: &Selection) -> &[Point] {
        let points = &self.points[..];
        let long = points.first().zip(points.last()).is_some_and(|(first, last)| last.time - first.time > LONG);
        if !long || selection.from.is_some() || selection.to.is_some() {
            return points;
        }
        let size =
            |pair: &[Point]| (0..3).map(|j| (pair[1].values[j][1] - pair[0].values[j][1]).abs()).fold(0.0, f64::max);
        let largest = points.windows(2).max_by(|one, other| size(one).total_cmp(&size(other)));
        match largest.filter(|pair| size(pair) >= SMALLEST) {
            Some(pair) => {
                let step = pair[1].time;
                let begin = points.partition_point(|point| point.time < step + AROUND.0);
                let end = points.partition_point(|point| point.time <= step + AROUND.1);
                &points[begin..end]
            }
            None => points,
        }
    }
}

/// Describes the response of a joint to the only step of its set point. The text is empty if there is no step, if there
/// are several, or if the step is smaller than [`SMALLEST`].
fn response(measured: &[[f64; 2]], set_point: &[[f64; 2]]) -> String {
    let is_step = |pair: &[[f64; 2]]| (pair[1][1] - pair[0][1]).abs() > 1e-9;
    let mut steps = (1..set_point.len()).filter(|&index| is_step(&set_point[index - 1..=index]));
    let (Some(index), None) = (steps.next(), steps.next()) else { return String::new() };
    let ([began, goal], size) = (set_point[index], set_point[index][1] - set_point[index - 1][1]);
    if size.abs() < SMALLEST {
        return String::new();
    }
    let after = || measured[index..].iter().filter(|point| point[1].is_finite());
    let overshoot = after().map(|point| (point[1] - goal) / size).fold(0.0, f64::max);
    let settled = match settling_time(after(), goal, SETTLED * size.abs()) {
        Some(time) => format!("within {:.0} % after {:.2} s", 100.0 * SETTLED, time - began),
        None => format!("not within {:.0} %", 100.0 * SETTLED),
    };
    format!("step of {size:.1}°: {settled}, overshoot {:.0} %", 100.0 * overshoot).replace('-', "\u{2212}")
}

/// The time from which a value stays near its goal for [`STAYS`].
fn settling_time<'a>(points: impl Iterator<Item = &'a [f64; 2]>, goal: f64, near: f64) -> Option<f64> {
    let mut since = None;
    for [time, value] in points {
        if (value - goal).abs() > near {
            since = None;
        } else if time - *since.get_or_insert(*time) >= STAYS {
            return since;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_response_to_one_step_is_described() {
        let time = |index: i32| f64::from(index) * 1e-3;
        let set_point: Vec<[f64; 2]> = (0..1000).map(|i| [time(i), if i < 100 { 10.0 } else { 20.0 }]).collect();
        let measured: Vec<[f64; 2]> = (0..1000)
            .map(|i| {
                [
                    time(i),
                    if i < 100 {
                        10.0
                    } else if i < 300 {
                        21.0
                    } else {
                        20.1
                    },
                ]
            })
            .collect();
        let text = response(&measured, &set_point);
        assert_eq!(text, "step of 10.0°: within 5 % after 0.20 s, overshoot 10 %");
        let unsettled: Vec<[f64; 2]> = (0..1000).map(|i| [time(i), 10.0]).collect();
        assert!(response(&unsettled, &set_point).ends_with("not within 5 %, overshoot 0 %"));
        assert_eq!(response(&measured, &measured), "");
    }
}
