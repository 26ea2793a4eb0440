//! Draws the rate, the wake-up delays and the losses of the fingers, and the histogram of the wake-up delays.

use super::bars;
use super::palette::Palette;
use super::rows::Rows;
use crate::monitor::finger_state::FingerState;
use crate::monitor::state::HandState;
use crate::monitor::wake_ups::{CLASSES, EDGES, Histogram, SECONDS};
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Borders, Paragraph};

/// Smallest height inside the panel's borders at which the histogram has more than one line.
const TALL: u16 = 13;

/// Width of the labels.
const LABEL: usize = 10;

/// A wake-up is late if its delay is longer than this part of a period.
const LATE: f64 = 0.5;

/// Draws the panel.
pub fn draw(frame: &mut Frame, area: Rect, palette: &Palette, hand: &HandState) {
    let title = Span::styled(" timing ", palette.title);
    let block = Block::new().borders(Borders::TOP | Borders::LEFT).border_style(palette.dim).title(title);
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let width = usize::from(inner.width);
    let period = 1e6 / hand.rate.max(1.0);
    let late = |time: f64| if time > LATE * period { palette.warning } else { Style::new() };
    let some = |count: u64| if count > 0 { palette.warning } else { Style::new() };
    let mut rows = Rows::default();
    let table = Table { palette, hand, width };
    rows.push(4, table.row("", "", |finger| (format!("F{}", finger.finger), palette.dim)));
    let slow = |rate: f64| if rate < 0.99 * hand.rate { palette.warning } else { Style::new() };
    rows.push(0, table.row("rate", "Hz", |finger| (format!("{:.0}", finger.rate), slow(finger.rate))));
    rows.push(6, table.row("median", "us", |finger| (microseconds(finger.wake_up.median), Style::new())));
    rows.push(5, table.row("99 %", "us", |finger| (microseconds(finger.wake_up.p99), late(finger.wake_up.p99))));
    rows.push(1, table.row("99.9 %", "us", |finger| (microseconds(finger.wake_up.p999), late(finger.wake_up.p999))));
    rows.push(
        3,
        table.row("largest", "us", |finger| (microseconds(finger.wake_up.maximum), late(finger.wake_up.maximum))),
    );
    rows.push(1, table.row("overruns", "", |finger| (count(finger.losses.overruns), some(finger.losses.overruns))));
    rows.push(
        4,
        table.row("no reply", "", |finger| (count(finger.losses.lost_replies), some(finger.losses.lost_replies))),
    );
    rows.push(2, table.row("not seen", "", |finger| (count(finger.lost_samples), some(finger.lost_samples))));
    histogram(&mut rows, palette, hand, inner);
    frame.render_widget(Paragraph::new(rows.fitting(inner.height.into())), inner);
}

struct Table<'a> {
    palette: &'a Palette,
    hand: &'a HandState,
    width: usize,
}

impl Table<'_> {
    /// A label, a value for each finger, and the unit.
    fn row(&self, label: &str, unit: &str, value: impl Fn(&FingerState) -> (String, Style)) -> Line<'static> {
        let column = (self.width.saturating_sub(LABEL + 3) / self.hand.fingers.len().max(1)).clamp(4, 9);
        let mut spans = vec![Span::styled(format!(" {label:<width$}", width = LABEL - 1), self.palette.dim)];
        for finger in &self.hand.fingers {
            let (text, style) = value(finger);
            let padding = column.saturating_sub(text.chars().count());
            spans.push(Span::raw(" ".repeat(padding)));
            spans.push(Span::styled(text, style));
        }
        spans.push(Span::styled(format!(" {unit}"), self.palette.dim));
        Line::from(spans)
    }
}

/// The wake-up delays of all fingers in the last seconds. The heights are logarithmic, so that single late wake-ups are
/// visible.
fn histogram(rows: &mut Rows, palette: &Palette, hand: &HandState, area: Rect) {
    let mut sum = Histogram::default();
    hand.fingers.iter().for_each(|finger| sum.add(&finger.wake_up_histogram));
    let height = |count: u64| (1.0 + count as f64).log10();
    let most = sum.counts.iter().copied().map(height).fold(1.0, f64::max);
    let heights: Vec<f64> = sum.counts.iter().map(|&count| height(count) / most).collect();
    let width = (usize::from(area.width).saturating_sub(2) / CLASSES).clamp(1, 4);
    let tall = area.height >= TALL;
    let lines = if tall { (usize::from(area.height) - 11).clamp(2, 6) } else { 1 };
    let charts = bars::columns(&heights, width, lines);
    if tall {
        rows.push(
            8,
            Line::styled(format!(" wake-ups of {} cycles in {SECONDS} s, logarithmic", sum.total()), palette.dim),
        );
    }
    let last = charts.len() - 1;
    for (index, chart) in charts.into_iter().enumerate() {
        let mut spans = vec![Span::raw(" "), Span::styled(chart, palette.measured)];
        if !tall && index == last && usize::from(area.width) > CLASSES * width + 14 {
            spans.push(Span::styled(" 2 us - 10 ms", palette.dim));
        }
        rows.push(7, spans);
    }
    if tall {
        rows.push(7, Line::styled(format!(" {}", axis(width)), palette.dim));
    }
}

/// The lower edges of some classes, each below the left edge of its column.
fn axis(width: usize) -> String {
    let mut text = String::new();
    for (class, edge) in EDGES.iter().enumerate() {
        let place = (class + 1) * width;
        let label = if *edge < 1000.0 { format!("{edge:.0}us") } else { format!("{:.0}ms", edge / 1000.0) };
        let length = text.chars().count();
        if place > length {
            text += &" ".repeat(place - length);
            text += &label;
        }
    }
    text
}

fn microseconds(time: f64) -> String {
    if time < 9999.5 { format!("{time:.0}") } else { format!("{:.0}k", time / 1000.0) }
}

fn count(count: u64) -> String {
    if count < 10_000 { count.to_string() } else { format!("{:.0}k", count as f64 / 1000.0) }
}
