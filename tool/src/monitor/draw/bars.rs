//! Draws a joint angle or a tension as a bar in one line, and values as columns in several lines.

use super::palette::Palette;
use ratatui::text::Span;

/// Fraction of t_min below which a tendon counts as slack. At or above this fraction, the controller counts a
/// tendon as tight.
const SLACK: f64 = 0.8;

/// Characters of which 0 to 8 eighths are filled from the left.
const EIGHTHS: [char; 9] = [' ', '▏', '▎', '▍', '▌', '▋', '▊', '▉', '█'];

/// Characters of which 0 to 8 eighths are filled from the bottom.
const HEIGHTS: [char; 9] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// A joint within its limits: the thick line goes from zero to the measured angle (●), and ◆ is the set point.
pub fn joint(
    palette: &Palette,
    width: usize,
    limits: [f64; 2],
    measured: f64,
    set_point: Option<f64>,
) -> Vec<Span<'static>> {
    let [low, high] = limits;
    let cells = width.saturating_sub(2).max(1);
    let place = |angle: f64| {
        let part = (angle - low) / (high - low).max(f64::MIN_POSITIVE);
        // NaN is at the left end.
        (part.clamp(0.0, 1.0) * (cells - 1) as f64).round() as usize
    };
    let (at, zero) = (place(measured), place(0.0));
    let wanted = set_point.map(place);
    let mut spans = vec![Span::styled("├", palette.dim)];
    for cell in 0..cells {
        spans.push(if cell == at {
            let beyond = measured < low || measured > high;
            Span::styled("●", if beyond { palette.bad } else { palette.measured })
        } else if wanted == Some(cell) {
            Span::styled("◆", palette.wanted)
        } else if (cell > at.min(zero) && cell < at.max(zero)) || (cell == zero && at != zero) {
            Span::styled("━", palette.measured)
        } else {
            Span::styled("─", palette.dim)
        });
    }
    spans.push(Span::styled("┤", palette.dim));
    spans
}

/// A tension between t_min and t_max. The bar is the measured tension, and ┃ is the wanted one.
pub fn tension(palette: &Palette, width: usize, limits: [f64; 2], measured: f64, wanted: f64) -> Vec<Span<'static>> {
    let [low, high] = limits;
    let cells = width.saturating_sub(2).max(1);
    let part = |tension: f64| ((tension - low) / (high - low).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    let slack = measured < SLACK * low;
    let style = if slack || measured > high { palette.bad } else { palette.good };
    let eighths = (part(measured) * 8.0 * cells as f64).round() as usize;
    let marker = ((part(wanted) * cells as f64) as usize).min(cells - 1);
    let mut spans = vec![if slack { Span::styled("‹", palette.bad) } else { Span::styled("│", palette.dim) }];
    for cell in 0..cells {
        let filled = eighths.saturating_sub(8 * cell).min(8);
        spans.push(if cell == marker {
            Span::styled("┃", palette.wanted)
        } else if filled == 0 {
            Span::styled("·", palette.dim)
        } else {
            Span::styled(EIGHTHS[filled].to_string(), style)
        });
    }
    spans.push(if measured > high { Span::styled("›", palette.bad) } else { Span::styled("│", palette.dim) });
    spans
}

/// Columns of the given heights, 0 to 1, each `width` characters wide, in `lines` lines from top to bottom.
pub fn columns(heights: &[f64], width: usize, lines: usize) -> Vec<String> {
    let eighths: Vec<usize> = heights
        .iter()
        .map(|&height| {
            let all = 8.0 * lines as f64;
            // A value above zero is visible.
            if height > 0.0 { (height.min(1.0) * all).round().max(1.0) as usize } else { 0 }
        })
        .collect();
    let line = |line: usize| -> String {
        let below = 8 * (lines - 1 - line);
        eighths
            .iter()
            .flat_map(|&eighths| std::iter::repeat_n(HEIGHTS[eighths.saturating_sub(below).min(8)], width))
            .collect()
    };
    (0..lines).map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(spans: &[Span]) -> String {
        spans.iter().map(|span| span.content.as_ref()).collect()
    }

    #[test]
    fn a_joint_is_between_its_limits() {
        let palette = Palette::plain();
        let bar = |measured, set_point| text(&joint(&palette, 13, [-50.0, 50.0], measured, set_point));
        assert_eq!(bar(0.0, None), "├─────●─────┤");
        assert_eq!(bar(30.0, Some(40.0)), "├─────━━━●◆─┤");
        assert_eq!(bar(-90.0, Some(0.0)), "├●━━━━◆─────┤");
        assert_eq!(bar(f64::NAN, None).chars().count(), 13);
    }

    #[test]
    fn a_tension_is_between_its_bounds_and_a_slack_tendon_is_marked() {
        let palette = Palette::plain();
        let bar = |measured, wanted| text(&tension(&palette, 12, [5.0, 55.0], measured, wanted));
        assert_eq!(bar(30.0, 52.0), "│█████····┃│");
        assert_eq!(bar(3.0, 5.0), "‹┃·········│");
        assert_eq!(bar(60.0, 30.0), "│█████┃████›");
        assert_eq!(bar(f64::NAN, f64::NAN).chars().count(), 12);
    }

    #[test]
    fn columns_show_every_value_above_zero() {
        assert_eq!(columns(&[0.0, 1e-6, 0.5, 1.0], 1, 2), ["   █", " ▁██"]);
        assert_eq!(columns(&[1.0, 0.0], 2, 1), ["██  "]);
    }
}
