//! Stages, faults, lost replies and events on a time line.

use super::axis::Axis;
use super::figure::{Figure, Sign, subtitle};
use super::palette::{BLUE, Colour, GREEN, INK, ORANGE, PAPER, PURPLE, SKY, SOFT_INK, VERMILION};
use super::panel::{HEADING, LABEL, Mark, NUMBER, Panel};
use super::svg::{Anchor, Font, Svg, text_width};
use super::{LONGEST_PAUSE, NO_CYCLE, Plot, Selection};
use crate::failure::Failure;
use crate::trace::{Item, Mark as Happened, MarkKind, Row};

/// Height of all rows of a finger together, and height of the space below these rows, pixels. The last constant is the
/// height of the bar in one row, in units of the panel's y axis.
const FINGER: f64 = 132.0;
const GAP: f64 = 54.0;
const ROW: f64 = 0.8;

/// The rows of a finger, from the top.
const ROWS: [(&str, Colour); 4] =
    [("stage", SOFT_INK), ("touching", GREEN), ("saturated", ORANGE), ("lost replies", VERMILION)];

/// The row of the lost replies.
const LOST: usize = 3;

/// Height of a line of the list below the panels, pixels, and the largest number of marks in this list. A mark may have
/// several lines. If there are more than `MOST_MARKS` marks, the list has `MOST_MARKS - 1` of them, and ends with a
/// line that gives the number of those left out.
const LINE: f64 = 23.0;
const MOST_MARKS: usize = 18;

/// Width of a text in the list, pixels, and the largest number of its lines. The texts of faults and warnings may have
/// more than one line.
const TEXT: f64 = 880.0;
const LINES_OF_FAULT: usize = 4;
const LINES_OF_WARNING: usize = 3;

/// A span of time, with its name. It lasts from the beginning of its first cycle to the end of its last cycle, s.
struct Span {
    from: f64,
    to: f64,
    name: String,
}

/// The spans of one finger, in the rows of [`ROWS`].
#[derive(Default)]
struct Lane {
    rows: [Vec<Span>; ROWS.len()],
}

/// What has been collected.
#[derive(Default)]
pub struct Faults {
    rate: f64,
    lanes: [Lane; 3],
    happened: Vec<(f64, Happened)>,
}

impl Plot for Faults {
    fn take(&mut self, item: &Item, seconds: f64) {
        match item {
            Item::Finger(finger) => self.rate = finger.rate,
            Item::Cycle(row) => {
                let index = row.sample.finger.index();
                let period = 1.0 / self.rate;
                self.lanes[index].take(row, seconds, period);
            }
            Item::Mark(mark) => self.happened.push((seconds, mark.clone())),
            Item::Object(..) => {}
        }
    }

    fn draw(&self, selection: &Selection) -> Result<Figure, Failure> {
        let present: Vec<(usize, &Lane)> =
            self.lanes.iter().enumerate().filter(|(_, lane)| !lane.rows[0].is_empty()).collect();
        let spans = || present.iter().flat_map(|(_, lane)| &lane.rows[0]);
        let (begin, end) =
            spans().fold((f64::INFINITY, 0f64), |(begin, end), span| (begin.min(span.from), end.max(span.to)));
        if present.is_empty() {
            return Err(NO_CYCLE.into());
        }
        let listed = self.listed();
        let left_out = self.happened.len() - listed.len();
        let texts: Vec<Vec<String>> = listed.iter().map(|(_, mark)| lines(mark)).collect();
        let lines = (texts.iter().map(Vec::len).sum::<usize>() + usize::from(left_out > 0)) as f64;
        let lanes = present.len() as f64 * (FINGER + GAP) - GAP;
        let kinds = [MarkKind::Fault, MarkKind::Warning, MarkKind::Gap, MarkKind::Event, MarkKind::Stage];
        let kinds = kinds.into_iter().filter(|&kind| listed.iter().any(|(_, mark)| mark.kind == kind));
        let legend: Vec<(Sign, String)> = kinds.map(|kind| (Sign::Dot(colour(kind)), kind.name().into())).collect();
        let only = if let [(index, _)] = present[..] { Some(index as i32 + 1) } else { None };
        let subtitle = subtitle(&Selection { finger: only, ..selection.clone() }, self.rate, "");
        let height = lanes + 86.0 + lines * LINE;
        let mut figure = Figure::new("What happened", &subtitle, &legend, height - 40.0);
        figure = figure.with_space_at_the_right(8.0);
        let time = Axis::linear(begin, end.max(begin + 1e-3));
        for (place, (index, lane)) in present.iter().enumerate() {
            let last = place + 1 == present.len();
            let numbered = listed.iter().enumerate().map(|(number, (at, mark))| (number + 1, *at, mark));
            let own = numbered.filter(|(_, _, mark)| mark.finger.is_none_or(|finger| finger == *index as i32 + 1));
            let panel = lane.panel(*index + 1, time, last, &own.collect::<Vec<_>>());
            figure.place(&panel, 10.0 + place as f64 * (FINGER + GAP), FINGER);
        }
        let (svg, [left, top]) = figure.canvas();
        list(svg, [left, top + lanes + 84.0], &listed, &texts, left_out);
        Ok(figure)
    }
}

impl Faults {
    /// The marks of the list, in chronological order: all, or the most serious ones if there are too many.
    fn listed(&self) -> Vec<(f64, &Happened)> {
        let mut listed: Vec<(f64, &Happened)> = self.happened.iter().map(|(time, mark)| (*time, mark)).collect();
        if listed.len() > MOST_MARKS {
            // Of equally serious marks, the first ones stay.
            listed.sort_by(|one, other| other.1.kind.cmp(&one.1.kind).then(one.0.total_cmp(&other.0)));
            listed.truncate(MOST_MARKS - 1);
        }
        listed.sort_by(|one, other| one.0.total_cmp(&other.0));
        listed
    }
}

impl Lane {
    fn take(&mut self, row: &Row, seconds: f64, period: f64) {
        let sample = &row.sample;
        let limited = sample.computed && sample.torque_scale < 1.0;
        let stage = sample.stage_name();
        let states = [
            Some(stage.as_str()),
            sample.touching.then_some(""),
            limited.then_some(""),
            row.feedback.is_none().then_some(""),
        ];
        for (index, (spans, state)) in self.rows.iter_mut().zip(states).enumerate() {
            let Some(name) = state else { continue };
            // A span of lost replies ends at the first reply that arrives. The tolerance of half a period is necessary,
            // because periods differ a little from their nominal length. Other spans continue after short pauses.
            let near = if index < LOST { LONGEST_PAUSE } else { 0.5 * period };
            match spans.last_mut().filter(|last| last.name == name && seconds - last.to < near) {
                Some(last) => last.to = seconds + period,
                None => spans.push(Span { from: seconds, to: seconds + period, name: name.into() }),
            }
        }
    }

    fn panel(&self, finger: usize, time: Axis, last: bool, marks: &[(usize, f64, &&Happened)]) -> Panel {
        let rows = ROWS.len() as f64;
        let mut drawn = Vec::new();
        for (index, (spans, (name, colour))) in self.rows.iter().zip(ROWS).enumerate() {
            let middle = rows - index as f64 - 0.5;
            let y = [middle - ROW / 2.0, middle + ROW / 2.0];
            for span in spans {
                let colour = if index == 0 { stage_colour(&span.name) } else { colour };
                drawn.push(Mark::Bar { x: [span.from, span.to], y, colour });
            }
            for span in spans.iter().filter(|span| index == 0 && !span.name.is_empty()) {
                // The name is drawn if the bar is long enough for it.
                let wide = (span.to - span.from) / (time.high - time.low) * 1050.0;
                if text_width(&span.name, LABEL.size) + 12.0 < wide {
                    let at = [span.from + 8.0 / 1050.0 * (time.high - time.low), middle - 0.14];
                    drawn.push(Mark::Text {
                        at,
                        text: span.name.clone(),
                        font: Font { colour: PAPER, bold: true, ..LABEL },
                    });
                }
            }
            let at = [time.low, middle - 0.14];
            let font = Font { anchor: Anchor::End, ..NUMBER };
            drawn.push(Mark::Label { at, text: name.into(), font });
        }
        for (number, at, mark) in marks {
            drawn.push(Mark::Number { x: *at, number: *number, colour: colour(mark.kind) });
        }
        Panel {
            heading: format!("finger {finger}"),
            note: String::new(),
            x: time,
            y: Axis { low: 0.0, high: rows, logarithmic: false },
            x_label: if last { "time, s".into() } else { String::new() },
            y_label: String::new(),
            marks: drawn,
        }
    }
}

fn colour(kind: MarkKind) -> Colour {
    match kind {
        MarkKind::Fault => VERMILION,
        MarkKind::Warning => ORANGE,
        MarkKind::Gap => INK,
        MarkKind::Event => BLUE,
        MarkKind::Stage => SOFT_INK,
    }
}

fn stage_colour(stage: &str) -> Colour {
    match stage {
        "running" => BLUE,
        "opening" => SKY,
        "calibrating" => PURPLE,
        "faulted" => VERMILION,
        _ => SOFT_INK,
    }
}

/// Breaks the text of a mark at spaces into lines of the list. If the text needs more lines than the list gives it, the
/// last line ends with an ellipsis.
fn lines(mark: &Happened) -> Vec<String> {
    let (most, bold) = match mark.kind {
        MarkKind::Fault => (LINES_OF_FAULT, 1.15),
        MarkKind::Warning => (LINES_OF_WARNING, 1.0),
        _ => (1, 1.0),
    };
    let fits = |line: &str| bold * text_width(line, LABEL.size) <= TEXT;
    let mut lines = vec![String::new()];
    for word in mark.text.split_whitespace() {
        let last = lines.last_mut().map(std::mem::take).unwrap_or_default();
        let longer = if last.is_empty() { word.to_owned() } else { format!("{last} {word}") };
        let index = lines.len() - 1;
        if last.is_empty() || fits(&longer) {
            lines[index] = longer;
        } else if lines.len() < most {
            lines[index] = last;
            lines.push(word.to_owned());
        } else {
            lines[index] = format!("{last} …");
            break;
        }
    }
    lines
}

/// Writes the numbered list of what happened.
fn list(svg: &mut Svg, [left, top]: [f64; 2], listed: &[(f64, &Happened)], texts: &[Vec<String>], left_out: usize) {
    if listed.is_empty() {
        svg.text([left, top], "No events, warnings or faults.", LABEL);
        return;
    }
    let mut y = top;
    for (number, (time, mark)) in listed.iter().enumerate() {
        svg.circle([left + 9.0, y - 4.5], 9.0, colour(mark.kind));
        let inside = Font { colour: PAPER, anchor: Anchor::Middle, bold: true, size: 11.5 };
        svg.text([left + 9.0, y - 0.5], &(number + 1).to_string(), inside);
        svg.text([left + 100.0, y], &format!("{:.3} s", time.max(0.0)), Font { anchor: Anchor::End, ..LABEL });
        let finger = mark.finger.map_or("hand".to_owned(), |finger| format!("finger {finger}"));
        svg.text([left + 118.0, y], &finger, Font { colour: SOFT_INK, ..LABEL });
        for line in &texts[number] {
            svg.text([left + 186.0, y], line, Font { bold: mark.kind == MarkKind::Fault, ..LABEL });
            y += LINE;
        }
    }
    if left_out > 0 {
        let text = format!("{left_out} less serious or later entries are not listed: sun2xp export writes all");
        svg.text([left + 118.0, y], &text, Font { bold: false, colour: SOFT_INK, ..HEADING });
    }
}
