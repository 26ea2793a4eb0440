//! Histograms of the wake-ups and of the ends of the cycles, and the wake-ups over time.

use super::axis::Axis;
use super::figure::{Figure, Sign, subtitle};
use super::palette::{BLUE, Colour, GREEN, SOFT_INK, VERMILION};
use super::panel::{Mark, Panel};
use super::svg::Stroke;
use super::{NO_CYCLE, Plot, Selection};
use crate::failure::Failure;
use crate::trace::Item;

/// The curves of the fingers. They differ in colour and in width, so that equal curves do not hide each other.
const CURVES: [Stroke; 3] = [Stroke::solid(BLUE, 3.0), Stroke::solid(VERMILION, 2.0), Stroke::solid(GREEN, 1.2)];

const PERIOD: Stroke = Stroke { dashes: Some("2 3"), ..Stroke::solid(SOFT_INK, 1.4) };

/// Height of the histograms, height of the panel below them, and the vertical space between the histograms and this
/// panel, pixels.
const HISTOGRAM: f64 = 270.0;
const COURSE: f64 = 190.0;
const GAP: f64 = 84.0;

/// Number of bins in a factor of ten.
const BINS: f64 = 20.0;

/// The times of the cycles of one finger. For each cycle: its place on the time axis, s, and the times from its
/// scheduled beginning to its wake-up and to the end of its computation, us.
#[derive(Default)]
struct Times(Vec<(f64, f32, f32)>);

/// The collected times.
#[derive(Default)]
pub struct Timing {
    rate: f64,
    fingers: [Times; 3],
}

impl Plot for Timing {
    fn take(&mut self, item: &Item, seconds: f64) {
        match item {
            Item::Finger(finger) => self.rate = finger.rate,
            Item::Cycle(row) => {
                let index = row.sample.finger.index();
                let time = |time: Option<f64>| time.map_or(f32::NAN, |time| time as f32);
                self.fingers[index].0.push((seconds, time(row.sample.wake_up), time(row.sample.whole)));
            }
            Item::Mark(_) | Item::Object(..) => {}
        }
    }

    fn draw(&self, selection: &Selection) -> Result<Figure, Failure> {
        let present: Vec<(usize, &Times)> =
            self.fingers.iter().enumerate().filter(|(_, times)| !times.0.is_empty()).collect();
        let ends =
            || present.iter().flat_map(|(_, times)| [times.0.first(), times.0.last()]).flatten().map(|one| one.0);
        let (begin, end) = (ends().fold(f64::INFINITY, f64::min), ends().fold(f64::NEG_INFINITY, f64::max));
        if begin > end {
            return Err(NO_CYCLE.into());
        }
        let period = 1e6 / self.rate;
        let legend: Vec<(Sign, String)> = present
            .iter()
            .map(|&(index, _)| (Sign::Line(CURVES[index]), format!("finger {}", index + 1)))
            .chain([(Sign::Line(PERIOD), format!("period, {period:.0} µs"))])
            .collect();
        let height = HISTOGRAM + GAP + COURSE;
        let only = if let [(index, _)] = present[..] { Some(index as i32 + 1) } else { None };
        let selection = &Selection { finger: only, ..selection.clone() };
        let subtitle = subtitle(selection, self.rate, "times since the scheduled beginning of the cycle");
        let mut figure = Figure::new("Timing of the servo", &subtitle, &legend, height);
        let wake_up = histogram("wake-up", &present, |one| one.1, period);
        let whole = histogram("end of the computation", &present, |one| one.2, period);
        figure.grid(&[vec![wake_up, whole]], HISTOGRAM);
        figure.place(&course(&present, Axis::linear(begin, end.max(begin + 1e-3)), period), height - COURSE, COURSE);
        Ok(figure)
    }
}

/// A histogram of the times that `of` selects. Each cycle has one such time. Both axes are logarithmic, so that single
/// late cycles are visible.
fn histogram(name: &str, fingers: &[(usize, &Times)], of: fn(&(f64, f32, f32)) -> f32, period: f64) -> Panel {
    let sorted = fingers.iter().map(|&(index, times)| {
        let mut values: Vec<f32> = times.0.iter().map(of).filter(|time| time.is_finite()).collect();
        values.sort_unstable_by(f32::total_cmp);
        (index, values)
    });
    let sorted: Vec<(usize, Vec<f32>)> = sorted.filter(|(_, values)| !values.is_empty()).collect();
    let smallest = sorted.iter().map(|(_, values)| values[0].max(0.1)).fold(f32::INFINITY, f32::min);
    let largest = sorted.iter().map(|(_, values)| values[values.len() - 1]).fold(period as f32, f32::max);
    let mut marks = vec![Mark::Moment { x: period, stroke: PERIOD, label: String::new() }];
    let mut most = 1;
    for (index, values) in &sorted {
        let bins = bins(values);
        most = bins.iter().map(|&(_, count)| count).fold(most, usize::max);
        let name = format!("{name} {}", index + 1);
        marks.push(Mark::Curve { name, points: outline(&bins), stroke: CURVES[*index] });
    }
    let all: Vec<f32> = {
        let mut all: Vec<f32> = sorted.into_iter().flat_map(|(_, values)| values).collect();
        all.sort_unstable_by(f32::total_cmp);
        all
    };
    let part = |fraction: f64| all.get(((all.len() as f64 * fraction) as usize).min(all.len().saturating_sub(1)));
    let part = |fraction| part(fraction).copied().unwrap_or_default();
    let note = format!("median {:.0}, 99.9 % {:.0}, worst {:.0} µs", part(0.5), part(0.999), part(1.0));
    Panel {
        heading: name.into(),
        note,
        x: Axis::logarithmic(f64::from(smallest.min(period as f32)), f64::from(largest)),
        y: Axis { low: 0.5, ..Axis::logarithmic(1.0, most as f64 * 1.01) },
        x_label: "µs".into(),
        y_label: "cycles".into(),
        marks,
    }
}

/// Counts sorted times in bins that are equally wide on a logarithmic axis. Returns the number and the count of each
/// bin that is not empty.
fn bins(sorted: &[f32]) -> Vec<(i32, usize)> {
    let mut bins: Vec<(i32, usize)> = Vec::new();
    for &time in sorted {
        let bin = (f64::from(time.max(0.1)).log10() * BINS).floor() as i32;
        match bins.last_mut() {
            Some((last, count)) if *last == bin => *count += 1,
            _ => bins.push((bin, 1)),
        }
    }
    bins
}

/// The outline of the bars of a histogram. The lower edge of the panel is at a count of 0.5 cycles. At an empty bin,
/// the outline is below this edge.
fn outline(bins: &[(i32, usize)]) -> Vec<[f64; 2]> {
    const EMPTY: f64 = 0.25;
    let edge = |bin: i32| 10f64.powf(f64::from(bin) / BINS);
    let mut points: Vec<[f64; 2]> = Vec::new();
    for (index, &(bin, count)) in bins.iter().enumerate() {
        if index == 0 || bins[index - 1].0 + 1 < bin {
            points.push([edge(bin), EMPTY]);
        }
        points.extend([[edge(bin), count as f64], [edge(bin + 1), count as f64]]);
        if bins.get(index + 1).is_none_or(|next| next.0 > bin + 1) {
            points.push([edge(bin + 1), EMPTY]);
        }
    }
    points
}

/// The wake-ups over time. The largest value in every pixel column is visible.
fn course(fingers: &[(usize, &Times)], time: Axis, period: f64) -> Panel {
    let mut marks = vec![Mark::Level { y: period, stroke: PERIOD, label: String::new() }];
    let mut largest = 0f32;
    let colours: [Colour; 3] = CURVES.map(|curve| curve.colour);
    for &(index, times) in fingers {
        let points = times.0.iter().map(|&(seconds, wake_up, _)| [seconds, f64::from(wake_up)]).collect();
        largest = times.0.iter().map(|one| one.1).filter(|one| one.is_finite()).fold(largest, f32::max);
        let name = format!("wake-up of finger {}", index + 1);
        marks.push(Mark::Curve { name, points, stroke: Stroke::solid(colours[index], 1.0) });
    }
    Panel {
        heading: "wake-up, cycle by cycle".into(),
        note: String::new(),
        x: time,
        y: Axis::linear(0.0, 1.08 * f64::from(largest.max(1.0))),
        x_label: "time, s".into(),
        y_label: "µs".into(),
        marks,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_time_is_in_its_bin() {
        let sorted = [10.0, 10.5, 11.0, 11.3, 25.0, 1000.0];
        let bins = bins(&sorted);
        assert_eq!(bins.iter().map(|&(_, count)| count).collect::<Vec<_>>(), [3, 1, 1, 1]);
        let outline = outline(&bins);
        // The first two bins are neighbours, so no line goes down between them.
        assert_eq!(outline.iter().filter(|point| point[1] < 0.5).count(), 6);
        assert!(outline.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
    }
}
