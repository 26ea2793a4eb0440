//! A figure: title, legend, and panels in rows and columns.

use super::Selection;
use super::palette::Colour;
use super::panel::{LABEL, Panel, SUBTITLE, TITLE};
use super::svg::{Stroke, Svg, text_width};

/// Width of every figure, pixels. A picture of another width is scaled.
const WIDTH: f64 = 1200.0;

/// Margins of the figure, pixels. The left margin holds the numbers and labels of y, the top margin the title and the
/// legend, and the bottom margin the numbers and labels of x.
const LEFT: f64 = 86.0;
const RIGHT: f64 = 30.0;
const TOP: f64 = 134.0;
const BOTTOM: f64 = 62.0;

/// Space between panels, pixels.
const BETWEEN_COLUMNS: f64 = 92.0;
const BETWEEN_ROWS: f64 = 44.0;

/// A symbol in the legend.
pub enum Sign {
    Line(Stroke),
    Area(Colour),
    Dot(Colour),
}

/// A figure that is being drawn.
pub struct Figure {
    svg: Svg,
    right: f64,
}

impl Figure {
    /// A figure for panels of this total height.
    pub fn new(title: &str, subtitle: &str, legend: &[(Sign, String)], panels_height: f64) -> Self {
        let mut svg = Svg::new(WIDTH, TOP + panels_height + BOTTOM);
        svg.text([28.0, 38.0], title, TITLE);
        svg.text([28.0, 62.0], subtitle, SUBTITLE);
        let mut x = LEFT;
        for (sign, text) in legend {
            let y = 90.0;
            match sign {
                Sign::Line(stroke) => {
                    svg.line([x, y], [x + 32.0, y], Stroke { width: stroke.width.max(2.0), ..*stroke })
                }
                Sign::Area(colour) => svg.rectangle([x, y - 7.0, 32.0, 14.0], colour, None),
                Sign::Dot(colour) => svg.circle([x + 6.0, y], 5.5, colour),
            }
            let wide = if matches!(sign, Sign::Dot(_)) { 18.0 } else { 40.0 };
            svg.text([x + wide, y + 4.5], text, LABEL);
            x += wide + text_width(text, LABEL.size) + 28.0;
        }
        Self { svg, right: RIGHT }
    }

    /// Makes the right margin wider by this number of pixels, for text beside the panels.
    pub fn with_space_at_the_right(mut self, pixels: f64) -> Self {
        self.right = RIGHT + pixels;
        self
    }

    /// Draws panels in rows, each of this height. The frames of a row have equal widths.
    pub fn grid(&mut self, rows: &[Vec<Panel>], height: f64) {
        for (row, panels) in rows.iter().enumerate() {
            let columns = panels.len().max(1) as f64;
            let gaps = (columns - 1.0) * (BETWEEN_COLUMNS + self.right - RIGHT);
            let width = (WIDTH - LEFT - self.right - gaps) / columns;
            for (column, panel) in panels.iter().enumerate() {
                let left = LEFT + column as f64 * (width + BETWEEN_COLUMNS + self.right - RIGHT);
                let top = TOP + row as f64 * (height + BETWEEN_ROWS);
                panel.draw(&mut self.svg, [left, top, width, height]);
            }
        }
    }

    /// Draws one panel whose top edge is `top` pixels below the place where the first row of panels would begin.
    pub fn place(&mut self, panel: &Panel, top: f64, height: f64) {
        panel.draw(&mut self.svg, [LEFT, TOP + top, WIDTH - LEFT - self.right, height]);
    }

    /// Returns the picture, for drawing outside the panels, and the top left corner of the panels, pixels.
    pub fn canvas(&mut self) -> (&mut Svg, [f64; 2]) {
        (&mut self.svg, [LEFT, TOP])
    }

    /// The height of this number of rows.
    pub fn height_of(rows: usize, height: f64) -> f64 {
        rows as f64 * height + rows.saturating_sub(1) as f64 * BETWEEN_ROWS
    }

    /// The document, scaled to a width.
    pub fn finish(self, width: f64) -> String {
        self.svg.finish(width)
    }
}

/// The line below the title. It names the finger, the rate and the recording.
pub fn subtitle(selection: &Selection, rate: f64, more: &str) -> String {
    let finger = selection.finger.map_or("all fingers".to_owned(), |finger| format!("finger {finger}"));
    let gap = if more.is_empty() { "" } else { "  \u{b7}  " };
    format!("{finger}  \u{b7}  {rate} Hz  \u{b7}  {}{gap}{more}", selection.name)
}
