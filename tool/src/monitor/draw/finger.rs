//! A finger as a column.

use super::bars;
use super::palette::Palette;
use super::rows::Rows;
use crate::monitor::finger_state::FingerState;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, BorderType, Padding, Paragraph};
use sun2xp::telemetry::Sample;

/// Smallest inner width at which labels are not abbreviated.
const WIDE: usize = 32;

/// Smallest width at which the frame has an inner margin.
const PADDED: u16 = 38;

/// Smallest inner width at which there is one more space between numbers.
const SPACIOUS: usize = 36;

/// Width of a number with its sign and two decimals.
const NUMBER: usize = 6;

/// Number of lines inside the frame of a compact finger.
pub const COMPACT: u16 = 10;

/// Largest number of lines inside the frame of a finger: 21 for all its values with the empty lines between them, and
/// two empty lines below them.
pub const COMPLETE: u16 = 23;

/// Draws a finger into its column.
pub fn draw(frame: &mut Frame, area: Rect, palette: &Palette, finger: &FingerState, selected: bool) {
    let stage = stage_style(palette, finger);
    let mut title = vec![
        Span::styled(format!(" finger {} ", finger.finger), if selected { palette.selected } else { palette.title }),
        Span::styled(format!("{} ", stage_word(finger)), stage),
    ];
    if finger.sample.as_ref().is_some_and(|sample| sample.touching) {
        title.push(Span::styled("touching ", palette.warning));
    }
    let border = if finger.fault.is_some() {
        palette.bad
    } else if selected {
        palette.selected
    } else {
        palette.dim
    };
    let kind = if selected { BorderType::Thick } else { BorderType::Rounded };
    let block = Block::bordered().border_type(kind).border_style(border).title(Line::from(title));
    let block = if area.width >= PADDED { block.padding(Padding::horizontal(1)) } else { block };
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let lines = match &finger.sample {
        Some(sample) => {
            rows(palette, finger, sample, inner.width.into(), inner.height.into()).fitting(inner.height.into())
        }
        None => no_cycle(palette, finger),
    };
    frame.render_widget(Paragraph::new(lines), inner);
}

/// Returns the lines that are shown in place of the values of a finger until a cycle arrives in which the controller of
/// the finger ran.
pub fn no_cycle(palette: &Palette, finger: &FingerState) -> Vec<Line<'static>> {
    let reason = match finger.known {
        true => ["controller has not run", "since this view began"],
        false => ["no cycle yet", ""],
    };
    reason.map(|line| Line::styled(line, palette.dim)).into()
}

/// Returns the stage in a word that stands out if the finger is faulted.
pub fn stage_word(finger: &FingerState) -> String {
    if finger.fault.is_some() { "FAULTED".into() } else { finger.stage.into() }
}

/// Returns the style of the stage.
pub fn stage_style(palette: &Palette, finger: &FingerState) -> Style {
    match finger.stage {
        _ if finger.fault.is_some() => palette.bad,
        "running" => palette.good,
        "closed" | "waiting" => palette.dim,
        _ => palette.warning,
    }
}

fn rows(palette: &Palette, finger: &FingerState, sample: &Sample, width: usize, height: usize) -> Rows {
    let wide = width >= WIDE;
    let mut rows = Rows::default();
    joints(&mut rows, palette, finger, sample, width);
    rows.push(5, "");
    tensions(&mut rows, palette, finger, sample, width);
    rows.push(5, "");
    let mut numbers = |rank, short, long, values, unit| {
        rows.push(rank, three(palette, if wide { long } else { short }, values, unit, width));
    };
    numbers(3, "tip", "tip", sample.tip, "cm");
    if let Some(tip) = sample.tip_set_point {
        numbers(6, " to", "set point", tip, "cm");
    }
    numbers(2, "F", "tip force", sample.tip_force_in_palm, "N");
    numbers(7, "Fc", "contact", finger.contact_force_in_palm, "N");
    rows.push(8, "");
    if let Some(kx) = &sample.kx {
        stiffness(&mut rows, palette, kx, width, height);
    }
    rows.push(10, three(palette, if wide { "torques" } else { "tau" }, sample.joint_torques, "N cm", width));
    rows.push(9, scales(palette, sample, width));
    rows.push(12, "");
    rows.push(11, history(palette, finger, width));
    rows
}

fn joints(rows: &mut Rows, palette: &Palette, finger: &FingerState, sample: &Sample, width: usize) {
    for joint in 0..3 {
        let limits = [finger.joint_minimum_degrees[joint], finger.joint_maximum_degrees[joint]];
        let measured = sample.joints[joint].to_degrees();
        let mut spans = vec![Span::raw(format!("J{joint} "))];
        let set_point = sample.joint_set_point.map(|angles| angles[joint].to_degrees());
        spans.extend(bars::joint(palette, width.saturating_sub(11), limits, measured, set_point));
        spans.push(Span::raw(format!(" {measured:6.1}°")));
        rows.push(1, spans);
    }
}

fn tensions(rows: &mut Rows, palette: &Palette, finger: &FingerState, sample: &Sample, width: usize) {
    for tendon in 0..4 {
        let limits = [finger.tension_minimum, finger.tension_maximum];
        let (measured, wanted) = (sample.tensions[tendon], sample.desired_tensions[tendon]);
        let mut spans = vec![Span::raw(format!("T{} ", tendon + 1))];
        spans.extend(bars::tension(palette, width.saturating_sub(11), limits, measured, wanted));
        spans.push(Span::raw(format!(" {measured:5.1} N")));
        rows.push(1, spans);
    }
}

/// Appends the matrix Kx if there is room for it, and otherwise its diagonal. The label of the diagonal has a plus sign
/// if the matrix has entries off its diagonal.
fn stiffness(rows: &mut Rows, palette: &Palette, kx: &[[f64; 3]; 3], width: usize, height: usize) {
    if height >= usize::from(COMPACT) + 8 {
        for (row, label) in kx.iter().zip(["Kx", "", ""]) {
            rows.push(4, three(palette, label, *row, if label.is_empty() { "" } else { "N/cm" }, width));
        }
    } else {
        let further = (0..3).any(|row| (0..3).any(|column| row != column && kx[row][column].abs() > 5e-3));
        let label = if further { "Kx+" } else { "Kx" };
        rows.push(4, three(palette, label, std::array::from_fn(|index| kx[index][index]), "N/cm", width));
    }
}

fn scales(palette: &Palette, sample: &Sample, width: usize) -> Line<'static> {
    let style = |scale: f64| if scale < 0.995 { palette.warning } else { palette.dim };
    let text = |name: &str, scale: f64| format!("{name} {:.0} %", scale * 100.0);
    let (stiffness, torque) = (sample.stiffness_scale, sample.torque_scale);
    let names = if width >= WIDE { ["stiffness", "torque"] } else { ["K", "tau"] };
    Line::from(vec![
        Span::styled(text(names[0], stiffness), style(stiffness)),
        Span::raw("   "),
        Span::styled(text(names[1], torque), style(torque)),
    ])
}

/// The recent force at the tip. Each column shows 0.1 s, and the history has at most 20 s.
fn history(palette: &Palette, finger: &FingerState, width: usize) -> Line<'static> {
    let room = width.saturating_sub(12);
    let recent: Vec<f64> = finger.force_history.iter().rev().take(room).rev().map(|&(_, force)| force).collect();
    let most = recent.iter().copied().fold(0.5, f64::max);
    let heights: Vec<f64> = recent.iter().map(|force| force / most).collect();
    let chart = bars::columns(&heights, 1, 1).concat();
    Line::from(vec![
        Span::styled("|F| ", palette.dim),
        Span::styled(format!("{chart:>room$}"), palette.measured),
        Span::styled(format!(" {most:5.1} N"), palette.dim),
    ])
}

/// A label and three numbers, with the unit if there is room.
pub fn three(palette: &Palette, label: &str, values: [f64; 3], unit: &str, width: usize) -> Line<'static> {
    let label_width = if width >= WIDE { 10 } else { 3 };
    // Values that are rounded to zero have no minus sign, because the sign would flicker.
    let rounded = values.map(|value| if value.abs() < 0.005 { 0.0 } else { value });
    let number = if width >= SPACIOUS { NUMBER + 1 } else { NUMBER };
    let numbers: String = rounded.iter().map(|value| format!("{value:number$.2}")).collect();
    let mut spans = vec![Span::styled(format!("{label:label_width$}"), palette.dim), Span::raw(numbers)];
    if label_width + 3 * number + 1 + unit.len() <= width {
        spans.push(Span::styled(format!(" {unit}"), palette.dim));
    }
    Line::from(spans)
}
