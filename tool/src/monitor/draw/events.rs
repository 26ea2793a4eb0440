//! The events of the hand, the newest first.

use super::palette::Palette;
use crate::monitor::state::{EventState, HandState};
use crate::monitor::words::span;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Borders, Paragraph};

/// Largest number of events on a screen.
const MOST: usize = 100;

/// Draws as many events as there is room for. `time` is the time of the picture, ns of the monotonic clock.
pub fn draw(frame: &mut Frame, area: Rect, palette: &Palette, hand: &HandState, time: u64) {
    let block =
        Block::new().borders(Borders::TOP).border_style(palette.dim).title(Span::styled(" events ", palette.title));
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let mut lines: Vec<Line> = Vec::new();
    let age = |event: &EventState| time.saturating_sub(event.monotonic) as f64 * 1e-9;
    let mut newest: Vec<&EventState> = hand.events.iter().take(MOST).collect();
    // Ages are compared in whole seconds. The age of an event that repeats within a second is always 0, so such events
    // keep their order and can be read.
    newest.sort_by_key(|event| age(event) as u64);
    for event in newest.into_iter().take(inner.height.into()) {
        let age = span(age(event));
        let style = match (event.fault, event.warning) {
            (true, _) => palette.bad,
            (_, true) => palette.warning,
            _ => palette.title,
        };
        let (name, rest) = event.text.split_once(", ").unwrap_or((&event.text, ""));
        lines.push(Line::from(vec![
            Span::styled(format!("{age:>8} ago "), palette.dim),
            Span::raw(format!(" {}  ", event.finger)),
            Span::styled(name.to_owned(), style),
            Span::styled(if event.count > 1 { format!(" x{}", event.count) } else { String::new() }, palette.dim),
            Span::raw(format!("  {rest}")),
        ]));
    }
    if lines.is_empty() {
        lines.push(Line::styled(" none since this view was attached", palette.dim));
    }
    frame.render_widget(Paragraph::new(lines), inner);
}
