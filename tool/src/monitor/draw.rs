//! Draws the view into a terminal of any size. Drawing does not change the view.

mod bars;
mod detail;
mod events;
mod faults;
mod finger;
mod help;
mod palette;
mod rows;
mod timing;

pub use palette::Palette;

use super::state::HandState;
use super::view::{Link, View};
use super::words::{span, wrap};
use crate::jog;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph};

/// Smallest width of three fingers side by side.
const SIDE_BY_SIDE: u16 = 75;

/// Height of the frame around a finger.
const FRAME: u16 = 2;

/// Smallest useful height of events and timing.
const BOTTOM: u16 = 4;

/// Largest useful height of events and timing.
const BOTTOM_COMPLETE: u16 = 16;

/// Draws the view.
pub fn draw(frame: &mut Frame, view: &View, palette: &Palette) {
    let area = frame.area();
    if area.width < 20 || area.height < 5 {
        frame.render_widget("too small", area);
        return;
    }
    let footer = footer(view, palette, area.width.into());
    let jog = jog::panel::lines(view, palette, area.width.into());
    let [top, body, jog_area, bottom] = Layout::vertical([
        Constraint::Length(1),
        Constraint::Min(0),
        Constraint::Length(jog.len() as u16),
        Constraint::Length(footer.len() as u16),
    ])
    .areas(area);
    frame.render_widget(title(view, palette, area.width.into()), top);
    frame.render_widget(Paragraph::new(jog), jog_area);
    frame.render_widget(Paragraph::new(footer), bottom);
    match view.shown() {
        _ if view.help => help::draw(frame, body, palette, view.jog.is_some()),
        Some((hand, time)) => draw_hand(frame, body, view, palette, hand, time),
        None => {
            let (Link::Waiting(reason) | Link::Ended(reason)) = &view.link else { return };
            let lines = wrap(reason, usize::from(body.width).saturating_sub(4));
            let block = Block::bordered().border_style(palette.dim).title(" waiting for a hand ");
            frame.render_widget(Paragraph::new(lines.join("\n")).block(block), body);
        }
    }
}

fn draw_hand(frame: &mut Frame, area: Rect, view: &View, palette: &Palette, hand: &HandState, time: u64) {
    // Faults get their height first. Their texts scroll if they do not fit.
    let faults = faults::lines(palette, hand, area.width.into());
    let least = if area.height > 12 { 5 } else { 0 };
    let fault_height = (faults.len() as u16).min(area.height - least);
    let [upper, fault_area, lower] = split(area, view, fault_height);
    match view.selected.and_then(|number| hand.finger(number)) {
        Some(finger) if upper.height < FRAME + finger::COMPACT + detail::HEIGHT => {
            detail::draw(frame, upper, palette, finger);
        }
        Some(finger) => {
            let [fingers, below] =
                Layout::vertical([Constraint::Min(0), Constraint::Length(detail::HEIGHT)]).areas(upper);
            draw_fingers(frame, fingers, view, palette, hand);
            detail::draw(frame, below, palette, finger);
        }
        None => draw_fingers(frame, upper, view, palette, hand),
    }
    faults::draw(frame, fault_area, palette, faults, view);
    if lower.height == 0 {
        return;
    }
    let [left, right] = if area.width >= SIDE_BY_SIDE {
        let width = (area.width * 2 / 5).clamp(30, 60);
        Layout::horizontal([Constraint::Min(0), Constraint::Length(width)]).areas(lower)
    } else {
        let height = if lower.height < 2 * BOTTOM { 0 } else { lower.height / 2 };
        Layout::vertical([Constraint::Min(0), Constraint::Length(height)]).areas(lower)
    };
    events::draw(frame, left, palette, hand, time);
    timing::draw(frame, right, palette, hand);
}

/// Divides the height: fingers, faults, and events with timing.
fn split(area: Rect, view: &View, faults: u16) -> [Rect; 3] {
    let room = area.height - faults;
    // A narrow terminal may have no room for all fingers. Then one more line has the names of all fingers.
    let compact = FRAME + finger::COMPACT + u16::from(area.width < SIDE_BY_SIDE);
    // The panel with the detail is below the fingers where there is room for both, and otherwise in their place.
    let (least, complete) = match view.selected {
        None => (compact, FRAME + finger::COMPLETE),
        Some(_) if room >= compact + detail::HEIGHT + BOTTOM => {
            (compact + detail::HEIGHT, FRAME + finger::COMPLETE + detail::HEIGHT)
        }
        Some(_) => (detail::HEIGHT, detail::HEIGHT),
    };
    let fingers = match room.checked_sub(least).filter(|&bottom| bottom >= BOTTOM) {
        Some(bottom) => (room - bottom.min(BOTTOM_COMPLETE)).min(complete),
        None => room,
    };
    Layout::vertical([Constraint::Length(fingers), Constraint::Length(faults), Constraint::Min(0)]).areas(area)
}

/// Draws the fingers side by side, or below each other, or only one of them below a line with the names of all.
fn draw_fingers(frame: &mut Frame, area: Rect, view: &View, palette: &Palette, hand: &HandState) {
    let count = hand.fingers.len() as u16;
    let is_selected =
        |number: i32| view.selected == Some(number) || view.jog.as_ref().is_some_and(|jog| jog.finger == number);
    let areas = if area.width >= SIDE_BY_SIDE || count <= 1 {
        // All columns get the same width, so that the labels are abbreviated in all of them or in none.
        Layout::horizontal(vec![Constraint::Length(area.width / count.max(1)); count.into()]).split(area)
    } else if area.height >= count * (FRAME + finger::COMPACT) {
        Layout::vertical(vec![Constraint::Fill(1); count.into()]).split(area)
    } else {
        let shown = hand.fingers.iter().find(|finger| is_selected(finger.finger)).or(hand.fingers.first());
        let [names, below] = Layout::vertical([Constraint::Length(1), Constraint::Min(0)]).areas(area);
        let mut spans = Vec::new();
        for finger in &hand.fingers {
            let style = finger::stage_style(palette, finger);
            spans.push(Span::styled(format!(" {} {} ", finger.finger, finger::stage_word(finger)), style));
        }
        frame.render_widget(Line::from(spans), names);
        if let Some(finger) = shown {
            finger::draw(frame, below, palette, finger, is_selected(finger.finger));
        }
        return;
    };
    for (finger, area) in hand.fingers.iter().zip(areas.iter()) {
        finger::draw(frame, *area, palette, finger, is_selected(finger.finger));
    }
}

fn title(view: &View, palette: &Palette, width: usize) -> Line<'static> {
    let state = match (&view.link, &view.frozen) {
        (_, Some((_, since))) => {
            let age = span(view.now.saturating_sub(*since) as f64 * 1e-9);
            Span::styled(format!("frozen for {age} "), palette.warning)
        }
        (Link::Live, None) => Span::styled("live ", palette.good),
        (Link::Ended(_), None) => Span::styled("ended ", palette.bad),
        (Link::Waiting(_), None) => Span::styled("waiting ", palette.warning),
    };
    let command = if view.jog.is_some() { " sun2xp jog " } else { " sun2xp monitor " };
    let mut spans = vec![Span::styled(command, palette.title)];
    let mut used = command.len() + state.content.chars().count();
    if let Some((hand, _)) = view.shown() {
        let kind = if hand.real { "real fingers" } else { "simulated" };
        let parts = [
            hand.name.clone(),
            format!("  {:.0} Hz", hand.rate),
            format!("  {kind}"),
            format!("  process {}", hand.process),
            format!("  library {}", hand.library),
        ];
        for (index, part) in parts.into_iter().enumerate() {
            if used + part.chars().count() < width {
                used += part.chars().count();
                spans.push(Span::styled(part, if index == 0 { palette.selected } else { palette.dim }));
            }
        }
    }
    spans.push(Span::raw(" ".repeat(width.saturating_sub(used))));
    spans.push(state);
    Line::from(spans)
}

/// Returns the lines at the bottom: why the hand has ended, a notice, and the keys.
fn footer(view: &View, palette: &Palette, width: usize) -> Vec<Line<'static>> {
    let mut lines = Vec::new();
    let inner = width.saturating_sub(2);
    if let Link::Ended(reason) = &view.link {
        let text = format!("{reason}. This view waits for the next hand; q quits");
        lines.extend(wrap(&text, inner).into_iter().map(|line| Line::styled(format!(" {line}"), palette.warning)));
    }
    if let Some(notice) = view.notice() {
        lines.extend(wrap(notice, inner).into_iter().map(|line| Line::styled(format!(" {line}"), palette.title)));
    }
    let keys: &[(&str, &str)] = match &view.jog {
        None => &[("q", "quit"), ("?", "help"), ("space", "freeze"), ("1 2 3 tab", "finger"), ("s", "snapshot")],
        Some(_) => &[("SPACE", "EMERGENCY STOP"), ("q", "quit"), ("?", "all keys"), ("1 2 3 tab", "finger")],
    };
    let mut spans = Vec::new();
    let mut used = 0;
    for (key, effect) in keys {
        let needed = key.len() + effect.len() + 3;
        if used + needed <= width + 1 {
            used += needed;
            spans.push(Span::styled(format!(" {key} "), palette.selected));
            spans.push(Span::styled(format!("{effect} "), palette.dim));
        }
    }
    lines.push(Line::from(spans));
    lines
}

#[cfg(test)]
mod tests;
