//! One finger in detail.

use super::bars;
use super::finger::{no_cycle, stage_style, stage_word};
use super::palette::Palette;
use super::rows::Rows;
use crate::monitor::finger_state::FingerState;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, BorderType, Padding, Paragraph};
use sun2xp::telemetry::Sample;

/// Height of the panel with its frame. The values need 13 lines, the frame takes two, and one line is spare.
pub const HEIGHT: u16 = 16;

/// Width of the numbers at the right.
const NUMBERS: u16 = 37;

/// Largest width of a bar.
const LONGEST_BAR: usize = 60;

/// Width of the texts beside the bars.
const BESIDE: usize = 26;

/// Draws the panel.
pub fn draw(frame: &mut Frame, area: Rect, palette: &Palette, finger: &FingerState) {
    let title = Line::from(vec![
        Span::styled(format!(" finger {} in detail ", finger.finger), palette.selected),
        Span::styled(format!("{} ", stage_word(finger)), stage_style(palette, finger)),
    ]);
    let block = Block::bordered().border_type(BorderType::Thick).border_style(palette.selected).title(title);
    let block = if area.width > 90 { block.padding(Padding::horizontal(1)) } else { block };
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let Some(sample) = &finger.sample else {
        frame.render_widget(Paragraph::new(no_cycle(palette, finger)), inner);
        return;
    };
    let numbers = if inner.width > NUMBERS + 34 { NUMBERS } else { 0 };
    let bars = Constraint::Max((LONGEST_BAR + BESIDE) as u16 + 4);
    let [left, _, right] = Layout::horizontal([bars, Constraint::Length(1), Constraint::Length(numbers)]).areas(inner);
    let lines = bar_rows(palette, finger, sample, left.width.into()).fitting(left.height.into());
    frame.render_widget(Paragraph::new(lines), left);
    if numbers > 0 {
        let lines = number_rows(palette, finger, sample).fitting(right.height.into());
        frame.render_widget(Paragraph::new(lines), right);
    }
}

fn bar_rows(palette: &Palette, finger: &FingerState, sample: &Sample, width: usize) -> Rows {
    let bar = width.saturating_sub(BESIDE).clamp(8, LONGEST_BAR);
    let mut rows = Rows::default();
    rows.push(3, Line::styled(format!("{:width$} measured     wanted", "joints", width = bar + 4), palette.dim));
    for joint in 0..3 {
        let limits = [finger.joint_minimum_degrees[joint], finger.joint_maximum_degrees[joint]];
        let (measured, wanted) =
            (sample.joints[joint].to_degrees(), sample.joint_set_point.map(|angles| angles[joint].to_degrees()));
        let mut spans = vec![Span::raw(format!("J{joint} "))];
        spans.extend(bars::joint(palette, bar, limits, measured, wanted));
        spans.push(Span::raw(format!(" {measured:8.2}")));
        let wanted = wanted.map_or("-".into(), |wanted| format!("{wanted:.2}"));
        spans.push(Span::styled(format!(" {wanted:>10}"), palette.wanted));
        spans.push(Span::styled(" °", palette.dim));
        rows.push(0, spans);
    }
    let bounds = format!("tensions {:.0} to {:.0} N", finger.tension_minimum, finger.tension_maximum);
    rows.push(2, Line::styled(bounds, palette.dim));
    for tendon in 0..4 {
        let limits = [finger.tension_minimum, finger.tension_maximum];
        let (measured, wanted) = (sample.tensions[tendon], sample.desired_tensions[tendon]);
        let mut spans = vec![Span::raw(format!("T{} ", tendon + 1))];
        spans.extend(bars::tension(palette, bar, limits, measured, wanted));
        spans.push(Span::raw(format!(" {measured:8.2}")));
        spans.push(Span::styled(format!(" {wanted:10.2}"), palette.wanted));
        spans.push(Span::styled(" N", palette.dim));
        rows.push(0, spans);
    }
    let motors: String = sample.motor_torques.iter().map(|torque| format!("{torque:8.3}")).collect();
    rows.push(1, labelled(palette, "motors", format!("{motors} N cm")));
    let joints: String = sample.joint_torques.iter().map(|torque| format!("{torque:8.2}")).collect();
    rows.push(1, labelled(palette, "joints", format!("{joints} N cm")));
    let scales = format!("Kx {:.0} %, torque {:.0} %", sample.stiffness_scale * 100.0, sample.torque_scale * 100.0);
    rows.push(4, labelled(palette, "applied", format!("  {scales}")));
    let counts =
        format!("  {}, {} recoveries, {} late replies", finger.cycle, finger.recoveries, finger.losses.late_replies);
    rows.push(5, labelled(palette, "cycle", counts));
    rows
}

fn labelled(palette: &Palette, label: &str, text: String) -> Line<'static> {
    Line::from(vec![Span::styled(format!("{label:8}"), palette.dim), Span::raw(text)])
}

fn number_rows(palette: &Palette, finger: &FingerState, sample: &Sample) -> Rows {
    let mut rows = Rows::default();
    rows.push(1, Line::styled(format!("{:10}{:>8}{:>8}{:>8}", "palm", "x", "y", "z"), palette.dim));
    let mut row = |rank, label: &str, values: [f64; 3], unit: &str| {
        let numbers: String = values.iter().map(|value| format!("{value:8.3}")).collect();
        let spans = vec![
            Span::styled(format!("{label:10}"), palette.dim),
            Span::raw(numbers),
            Span::styled(format!(" {unit}"), palette.dim),
        ];
        rows.push(rank, spans);
    };
    row(0, "tip", sample.tip, "cm");
    if let Some(tip) = sample.tip_set_point {
        row(1, "set point", tip, "cm");
        row(4, "off by", std::array::from_fn(|index| sample.tip[index] - tip[index]), "cm");
    }
    row(0, "tip force", sample.tip_force_in_palm, "N");
    row(2, "contact", finger.contact_force_in_palm, "N");
    if let Some(kx) = &sample.kx {
        rows.push(6, "");
        let title = format!("Kx in the frame of finger {}, N/cm", finger.finger);
        rows.push(3, Line::styled(title, palette.dim));
        for (row, axis) in kx.iter().zip(["x", "y", "z"]) {
            let numbers: String = row.iter().map(|value| format!("{value:8.3}")).collect();
            rows.push(1, vec![Span::styled(format!("{axis:>9} "), palette.dim), Span::raw(numbers)]);
        }
    }
    if sample.touching {
        rows.push(2, Line::styled("touches something", palette.warning));
    }
    rows
}
