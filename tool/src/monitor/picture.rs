//! The screen as a picture: SVG, with the colours of the terminal.

use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};
use std::fmt::Write;

/// Width of a character, pixels.
const WIDTH: f64 = 8.4;

/// Height of a line, pixels.
const HEIGHT: f64 = 18.0;

/// Distance of the base line from the top of a line, pixels.
const BASE: f64 = 14.0;

/// Colour of the background.
const BACKGROUND: &str = "#1e1e1e";

/// Returns the picture of a screen.
pub fn svg(buffer: &Buffer) -> String {
    let (columns, lines) = (usize::from(buffer.area.width), usize::from(buffer.area.height));
    let (width, height) = (columns as f64 * WIDTH, lines as f64 * HEIGHT);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
         viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"DejaVu Sans Mono, Menlo, Consolas, monospace\" \
         font-size=\"14\">\n<rect width=\"100%\" height=\"100%\" fill=\"{BACKGROUND}\"/>\n"
    );
    for (line, cells) in buffer.content.chunks(columns.max(1)).enumerate() {
        let mut column = 0;
        for run in cells.chunk_by(|left, right| look(left) == look(right)) {
            draw(&mut svg, column, line, run);
            column += run.len();
        }
    }
    svg + "</svg>\n"
}

fn look(cell: &Cell) -> (Color, Modifier) {
    (cell.fg, cell.modifier)
}

/// Draws characters with the same look.
fn draw(svg: &mut String, column: usize, line: usize, run: &[Cell]) {
    let text: String = run.iter().map(Cell::symbol).collect();
    let (color, modifier) = run.first().map_or((Color::Reset, Modifier::empty()), look);
    let (mut fill, top) = (hex(color), line as f64 * HEIGHT);
    // Writing to a string cannot fail.
    if modifier.contains(Modifier::REVERSED) {
        let (left, width) = (column as f64 * WIDTH, run.len() as f64 * WIDTH);
        let _ = writeln!(svg, r#"<rect x="{left:.1}" y="{top}" width="{width:.1}" height="{HEIGHT}" fill="{fill}"/>"#);
        fill = BACKGROUND;
    }
    let indent = text.chars().take_while(|character| *character == ' ').count();
    let text = text.trim();
    if text.is_empty() {
        return;
    }
    let bold = if modifier.contains(Modifier::BOLD) { " font-weight=\"bold\"" } else { "" };
    let dim = if modifier.contains(Modifier::DIM) { " opacity=\"0.6\"" } else { "" };
    let (left, length) = ((column + indent) as f64 * WIDTH, text.chars().count() as f64 * WIDTH);
    let escaped = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let base = top + BASE;
    let _ = writeln!(
        svg,
        "<text x=\"{left:.1}\" y=\"{base}\" textLength=\"{length:.1}\" lengthAdjust=\"spacingAndGlyphs\" \
         fill=\"{fill}\"{bold}{dim} xml:space=\"preserve\">{escaped}</text>"
    );
}

fn hex(color: Color) -> &'static str {
    match color {
        Color::Red => "#f07178",
        Color::Green => "#98c379",
        Color::Yellow => "#e5c07b",
        Color::Blue => "#61afef",
        Color::Magenta => "#d19aff",
        Color::Cyan => "#56b6c2",
        Color::DarkGray => "#7f8694",
        _ => "#dcdfe4",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::layout::Rect;
    use ratatui::style::Style;

    #[test]
    fn every_run_of_characters_is_at_its_place() {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 12, 2));
        buffer.set_string(2, 1, "a<b", Style::new().fg(Color::Red).add_modifier(Modifier::BOLD));
        buffer.set_string(6, 1, "c", Style::new().add_modifier(Modifier::REVERSED));
        let svg = svg(&buffer);
        assert!(svg.contains(r##"<text x="16.8" y="32" textLength="25.2""##), "{svg}");
        assert!(svg.contains(r##"fill="#f07178" font-weight="bold""##) && svg.contains(">a&lt;b</text>"), "{svg}");
        assert!(svg.contains(r#"<rect x="50.4" y="18" width="8.4""#) && svg.ends_with("</svg>\n"), "{svg}");
    }
}
