//! Faults and warnings with causes and remedies, in full.

use super::palette::Palette;
use crate::monitor::state::HandState;
use crate::monitor::view::View;
use crate::monitor::words::wrap;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

/// Returns the lines of all faults and warnings. If there are no faults and no warnings, returns no lines. Fingers with
/// the same text share its lines.
pub fn lines(palette: &Palette, hand: &HandState, width: usize) -> Vec<Line<'static>> {
    let mut texts: Vec<(String, String, Style)> = Vec::new();
    let mut add = |finger: i32, kind: &str, number: u8, text: &str, style: Style| {
        let text = format!("{kind} {number}: {text}.");
        match texts.iter_mut().find(|(_, known, _)| *known == text) {
            Some((fingers, _, _)) => *fingers = format!("{fingers}, {finger}").replacen("finger ", "fingers ", 1),
            None => texts.push((format!("finger {finger}"), text, style)),
        }
    };
    for state in &hand.fingers {
        if let Some(fault) = &state.fault {
            add(state.finger, "fault", fault.number, &fault.text, palette.bad);
        }
    }
    for state in &hand.fingers {
        if let Some(warning) = &state.warning {
            add(state.finger, "warning", warning.number, &warning.text, palette.warning);
        }
    }
    let mut lines = Vec::new();
    for (fingers, text, style) in texts {
        for (index, line) in wrap(&format!("{fingers}, {text}"), width.saturating_sub(3)).into_iter().enumerate() {
            // The first line has the fault, in a colour that attracts attention. The other lines have cause and remedy.
            // They have no colour, because they must be easy to read.
            let sign = if index == 0 { "! " } else { "  " };
            lines.push(Line::styled(format!(" {sign}{line}"), if index == 0 { style } else { Style::new() }));
        }
    }
    lines
}

/// Draws the lines. If there is no room for all of them, the view's keys scroll them, and the last line names the keys.
pub fn draw(frame: &mut Frame, area: Rect, palette: &Palette, mut lines: Vec<Line<'static>>, view: &View) {
    let room = usize::from(area.height);
    if lines.len() > room && room > 0 {
        let hidden = lines.len() - (room - 1);
        let scroll = view.scroll.min(hidden);
        lines.drain(..scroll);
        lines.truncate(room - 1);
        // In jog the arrows move the hand.
        let keys = if view.jog.is_some() { "keys { and }" } else { "up and down keys" };
        let text = format!("   {} more lines above, {} below: {keys}", scroll, hidden - scroll);
        lines.push(Line::styled(text, palette.warning));
    }
    frame.render_widget(Paragraph::new(lines), area);
}
