//! A panel: a frame with two axes, and what is drawn in it.

use super::axis::Axis;
use super::palette::{Colour, FRAME, GRID, INK, PAPER, SOFT_INK};
use super::svg::{Anchor, Font, Stroke, Svg, text_width};

pub const TITLE: Font = Font { size: 20.0, colour: INK, bold: true, anchor: Anchor::Start };
pub const SUBTITLE: Font = Font { size: 14.0, colour: SOFT_INK, bold: false, anchor: Anchor::Start };
pub const HEADING: Font = Font { size: 15.0, colour: INK, bold: true, anchor: Anchor::Start };
pub const LABEL: Font = Font { size: 13.5, colour: INK, bold: false, anchor: Anchor::Start };
pub const NUMBER: Font = Font { size: 13.0, colour: SOFT_INK, bold: false, anchor: Anchor::Middle };

/// A curve with more points than this for each pixel of the frame's width is thinned. It keeps the lowest and the
/// highest value of every section of about one pixel.
const POINTS_PER_PIXEL: usize = 4;

/// Something in a panel. Coordinates are values of the panel's axes. Radii, strokes and fonts are in pixels.
pub enum Mark {
    Curve {
        name: String,
        points: Vec<[f64; 2]>,
        stroke: Stroke,
    },
    /// A coloured range of y, over the whole width.
    Band {
        low: f64,
        high: f64,
        colour: Colour,
    },
    /// A line over the whole width, with a text at its right end, outside of the frame.
    Level {
        y: f64,
        stroke: Stroke,
        label: String,
    },
    /// A line over the whole height, with a text beside its upper end.
    Moment {
        x: f64,
        stroke: Stroke,
        label: String,
    },
    /// A bar from `x[0]` to `x[1]` and from `y[0]` to `y[1]`.
    Bar {
        x: [f64; 2],
        y: [f64; 2],
        colour: Colour,
    },
    /// A closed area.
    Area {
        points: Vec<[f64; 2]>,
        colour: Colour,
        opacity: f64,
        stroke: Stroke,
    },
    Arrow {
        from: [f64; 2],
        to: [f64; 2],
        stroke: Stroke,
    },
    Dot {
        at: [f64; 2],
        radius: f64,
        colour: Colour,
    },
    Text {
        at: [f64; 2],
        text: String,
        font: Font,
    },
    /// The name of a row, left of the frame. A panel with names of rows has no numbers at its y axis.
    Label {
        at: [f64; 2],
        text: String,
        font: Font,
    },
    /// A number in a dot on the upper edge of the frame, with a line over the whole height.
    Number {
        x: f64,
        number: usize,
        colour: Colour,
    },
}

impl Mark {
    /// Whether the grid is drawn over this.
    fn is_background(&self) -> bool {
        matches!(self, Mark::Band { .. })
    }

    /// Whether parts of this are outside of the frame.
    fn leaves_the_frame(&self) -> bool {
        matches!(self, Mark::Level { .. } | Mark::Label { .. } | Mark::Number { .. })
    }
}

/// A panel.
pub struct Panel {
    pub heading: String,
    /// What follows the heading in smaller letters.
    pub note: String,
    pub x: Axis,
    pub y: Axis,
    /// Empty if a panel below has the same axis.
    pub x_label: String,
    pub y_label: String,
    pub marks: Vec<Mark>,
}

impl Panel {
    /// Draws the panel. `frame` is the left, top, width and height of its frame, pixels. The heading, and the numbers
    /// and labels of the axes, are outside of the frame.
    pub fn draw(&self, svg: &mut Svg, frame: [f64; 4]) {
        let [left, top, width, height] = frame;
        let place = |[x, y]: [f64; 2]| [left + width * self.x.place(x), top + height * (1.0 - self.y.place(y))];
        svg.rectangle(frame, PAPER, None);
        for mark in self.marks.iter().filter(|mark| mark.is_background()) {
            self.draw_mark(svg, frame, mark);
        }
        for (value, text) in self.x.ticks(((width / 60.0) as usize).min(12)) {
            let [x, _] = place([value, self.y.low]);
            svg.line([x, top], [x, top + height], Stroke::solid(GRID, 1.0));
            if !self.x_label.is_empty() {
                svg.text([x, top + height + 19.0], &text, NUMBER);
            }
        }
        let named = self.marks.iter().any(|mark| matches!(mark, Mark::Label { .. }));
        let numbers = if named { Vec::new() } else { self.y.ticks(((height / 34.0) as usize).min(6)) };
        for (value, text) in numbers {
            let [_, y] = place([self.x.low, value]);
            svg.line([left, y], [left + width, y], Stroke::solid(GRID, 1.0));
            svg.text([left - 8.0, y + 4.5], &text, Font { anchor: Anchor::End, ..NUMBER });
        }
        let data = format!(
            "class=\"panel\" data-frame=\"{left:.2} {top:.2} {width:.2} {height:.2}\" data-x=\"{} {}\" data-y=\"{} \
             {}\"",
            self.x.low, self.x.high, self.y.low, self.y.high
        );
        svg.within(frame, &data, |svg| {
            for mark in self.marks.iter().filter(|mark| !mark.is_background() && !mark.leaves_the_frame()) {
                self.draw_mark(svg, frame, mark);
            }
        });
        svg.rectangle(frame, "none", Some(Stroke::solid(FRAME, 1.0)));
        for mark in self.marks.iter().filter(|mark| mark.leaves_the_frame()) {
            self.draw_mark(svg, frame, mark);
        }
        // Numbers on the upper edge need space below the heading.
        let numbered = self.marks.iter().any(|mark| matches!(mark, Mark::Number { .. }));
        let line = top - if numbered { 18.0 } else { 9.0 };
        svg.text([left, line], &self.heading, HEADING);
        let after = left + 1.2 * text_width(&self.heading, HEADING.size) + 12.0;
        svg.text([after, line], &self.note, Font { anchor: Anchor::Start, ..NUMBER });
        let middle = Font { anchor: Anchor::Middle, ..LABEL };
        svg.text([left + width / 2.0, top + height + 40.0], &self.x_label, middle);
        svg.upward_text([left - 58.0, top + height / 2.0], &self.y_label, middle);
    }

    fn draw_mark(&self, svg: &mut Svg, [left, top, width, height]: [f64; 4], mark: &Mark) {
        let place = |[x, y]: [f64; 2]| [left + width * self.x.place(x), top + height * (1.0 - self.y.place(y))];
        match mark {
            Mark::Curve { name, points, stroke } => {
                let most = POINTS_PER_PIXEL * width as usize;
                svg.curve(name, thinned(points, most).into_iter().map(place), *stroke);
            }
            Mark::Band { low, high, colour } => {
                let ([_, y1], [_, y2]) = (place([0.0, *low]), place([0.0, *high]));
                let (y1, y2) = (y1.clamp(top, top + height), y2.clamp(top, top + height));
                svg.rectangle([left, y2, width, y1 - y2], colour, None);
            }
            Mark::Level { y, stroke, label } => {
                let [_, y] = place([0.0, *y]);
                if (top..=top + height).contains(&y) {
                    svg.line([left, y], [left + width, y], *stroke);
                    let font = Font { colour: stroke.colour, anchor: Anchor::Start, ..NUMBER };
                    svg.text([left + width + 6.0, y + 4.5], label, font);
                }
            }
            Mark::Moment { x, stroke, label } => {
                let [x, _] = place([*x, self.y.low]);
                svg.line([x, top], [x, top + height], *stroke);
                svg.text([x + 4.0, top + 14.0], label, Font { colour: stroke.colour, anchor: Anchor::Start, ..NUMBER });
            }
            Mark::Bar { x, y, colour } => {
                let ([x1, y1], [x2, y2]) = (place([x[0], y[0]]), place([x[1], y[1]]));
                svg.rectangle([x1, y2, x2 - x1, y1 - y2], colour, None);
            }
            Mark::Area { points, colour, opacity, stroke } => {
                let points: Vec<[f64; 2]> = points.iter().map(|&point| place(point)).collect();
                svg.area(&points, colour, *opacity, Some(*stroke));
            }
            Mark::Arrow { from, to, stroke } => arrow(svg, place(*from), place(*to), *stroke),
            Mark::Dot { at, radius, colour } => svg.circle(place(*at), *radius, colour),
            Mark::Text { at, text, font } => svg.text(place(*at), text, *font),
            Mark::Label { at, text, font } => svg.text([left - 8.0, place(*at)[1]], text, *font),
            Mark::Number { x, number, colour } => {
                let [x, _] = place([*x, self.y.low]);
                if (left..=left + width).contains(&x) {
                    svg.line([x, top], [x, top + height], Stroke { dashes: Some("3 3"), ..Stroke::solid(colour, 1.3) });
                    svg.circle([x, top], 9.0, colour);
                    let font = Font { size: 11.5, colour: PAPER, bold: true, anchor: Anchor::Middle };
                    svg.text([x, top + 4.0], &number.to_string(), font);
                }
            }
        }
    }
}

fn arrow(svg: &mut Svg, from: [f64; 2], to: [f64; 2], stroke: Stroke) {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = dx.hypot(dy);
    if length < 1.0 {
        return;
    }
    let (ux, uy) = (dx / length, dy / length);
    let head = (4.0 * stroke.width + 4.0).min(length);
    let base = [to[0] - head * ux, to[1] - head * uy];
    let side = 0.45 * head;
    svg.line(from, base, stroke);
    svg.area(
        &[to, [base[0] - side * uy, base[1] + side * ux], [base[0] + side * uy, base[1] - side * ux]],
        stroke.colour,
        1.0,
        None,
    );
}

/// At most about `most` points, with the lowest and the highest value of every section. Gaps stay.
fn thinned(points: &[[f64; 2]], most: usize) -> Vec<[f64; 2]> {
    if points.len() <= most {
        return points.to_vec();
    }
    let section = points.len().div_ceil((most / 4).max(1));
    let mut kept = Vec::new();
    for section in points.chunks(section) {
        let finite = || (0..section.len()).filter(|&index| section[index][1].is_finite());
        let by_value = |&one: &usize, &other: &usize| section[one][1].total_cmp(&section[other][1]);
        let mut indices = vec![0, section.len() - 1];
        indices.extend(finite().min_by(by_value));
        indices.extend(finite().max_by(by_value));
        indices.extend((0..section.len()).find(|&index| !section[index][1].is_finite()));
        indices.sort_unstable();
        indices.dedup();
        kept.extend(indices.into_iter().map(|index| section[index]));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_curve_keeps_its_peaks_and_gaps() {
        let value = |index: usize| match index {
            777_777 => 9.0,
            333_333 => f64::NAN,
            index => (index as f64 * 1e-3).sin(),
        };
        let points: Vec<[f64; 2]> = (0..1_000_000).map(|index| [index as f64, value(index)]).collect();
        let thinned = thinned(&points, 4000);
        assert!(thinned.len() <= 5000 && thinned.contains(&[777_777.0, 9.0]), "{}", thinned.len());
        assert!(thinned.iter().any(|[x, y]| *x == 333_333.0 && y.is_nan()));
        assert!(thinned.windows(2).all(|pair| pair[0][0] < pair[1][0]));
        assert_eq!(super::thinned(&points[..50], 50).len(), 50);
    }
}
