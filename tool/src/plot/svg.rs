//! A picture as SVG text.

use super::palette::{Colour, PAPER};
use std::fmt::Write;

/// The font families of all texts. The PNG uses the embedded DejaVu Sans. A browser uses the first of these fonts that
/// it has.
const FONT: &str = "DejaVu Sans, Verdana, sans-serif";

/// Mean width of a letter of DejaVu Sans, as a fraction of the font size.
const LETTER: f64 = 0.54;

/// A picture that is being drawn. Coordinates are in pixels, y downward.
pub struct Svg {
    body: String,
    pub width: f64,
    pub height: f64,
    clips: usize,
}

/// The part of a text that lies at the point which is passed to [`Svg::text`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    Start,
    Middle,
    End,
}

/// The look of a text.
#[derive(Clone, Copy, Debug)]
pub struct Font {
    /// Pixels.
    pub size: f64,
    pub colour: Colour,
    pub bold: bool,
    pub anchor: Anchor,
}

/// The look of a line.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    pub colour: Colour,
    /// Pixels.
    pub width: f64,
    pub dashes: Option<&'static str>,
}

impl Stroke {
    pub const fn solid(colour: Colour, width: f64) -> Self {
        Self { colour, width, dashes: None }
    }

    pub const fn dashed(colour: Colour, width: f64) -> Self {
        Self { colour, width, dashes: Some("6 4") }
    }

    fn attributes(&self) -> String {
        let dashes = self.dashes.map_or(String::new(), |dashes| format!(" stroke-dasharray=\"{dashes}\""));
        format!("stroke=\"{}\" stroke-width=\"{}\"{dashes}", self.colour, self.width)
    }
}

impl Svg {
    pub fn new(width: f64, height: f64) -> Self {
        let mut svg = Self { body: String::new(), width, height, clips: 0 };
        svg.rectangle([0.0, 0.0, width, height], PAPER, None);
        svg
    }

    /// A rectangle: left, top, width and height.
    pub fn rectangle(&mut self, [x, y, width, height]: [f64; 4], fill: Colour, stroke: Option<Stroke>) {
        let stroke = stroke.map_or(String::new(), |stroke| format!(" {}", stroke.attributes()));
        self.add(format_args!(
            "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{:.2}\" height=\"{:.2}\" fill=\"{fill}\"{stroke}/>",
            width.max(0.0),
            height.max(0.0)
        ));
    }

    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], stroke: Stroke) {
        self.add(format_args!(
            "<line x1=\"{:.2}\" y1=\"{:.2}\" x2=\"{:.2}\" y2=\"{:.2}\" {}/>",
            from[0],
            from[1],
            to[0],
            to[1],
            stroke.attributes()
        ));
    }

    /// A curve through points. It has a gap at points that are not finite. Programs find the curve by its name, which
    /// is in the attribute `data-name`.
    pub fn curve(&mut self, name: &str, points: impl IntoIterator<Item = [f64; 2]>, stroke: Stroke) {
        let (mut path, mut drawing) = (String::new(), false);
        for [x, y] in points {
            let finite = x.is_finite() && y.is_finite();
            if finite {
                let order = if drawing { 'L' } else { 'M' };
                // Writing to a String does not fail.
                let _ = write!(path, "{order}{x:.2} {y:.2}");
            }
            drawing = finite;
        }
        self.add(format_args!(
            "<path class=\"curve\" data-name=\"{}\" d=\"{path}\" fill=\"none\" stroke-linejoin=\"round\" {}/>",
            escaped(name),
            stroke.attributes()
        ));
    }

    /// A closed area.
    pub fn area(&mut self, points: &[[f64; 2]], fill: Colour, opacity: f64, stroke: Option<Stroke>) {
        let list = points.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect::<Vec<_>>().join(" ");
        let stroke = stroke.map_or(String::new(), |stroke| format!(" {}", stroke.attributes()));
        self.add(format_args!("<polygon points=\"{list}\" fill=\"{fill}\" fill-opacity=\"{opacity}\"{stroke}/>"));
    }

    pub fn circle(&mut self, [x, y]: [f64; 2], radius: f64, fill: Colour) {
        self.add(format_args!("<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius}\" fill=\"{fill}\"/>"));
    }

    /// A text on a base line through a point. `font.anchor` determines whether the text begins, ends or is centred
    /// there.
    pub fn text(&mut self, [x, y]: [f64; 2], text: &str, font: Font) {
        self.turned_text([x, y], text, font, None);
    }

    /// A text that reads upward.
    pub fn upward_text(&mut self, at: [f64; 2], text: &str, font: Font) {
        self.turned_text(at, text, font, Some(-90));
    }

    fn turned_text(&mut self, [x, y]: [f64; 2], text: &str, font: Font, turn: Option<i32>) {
        let anchor = match font.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let bold = if font.bold { " font-weight=\"bold\"" } else { "" };
        let turn = turn.map_or(String::new(), |turn| format!(" transform=\"rotate({turn} {x:.2} {y:.2})\""));
        self.add(format_args!(
            "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{}\" fill=\"{}\" \
             text-anchor=\"{anchor}\"{bold}{turn}>{}</text>",
            font.size,
            font.colour,
            escaped(text)
        ));
    }

    /// Draws `content` so that nothing is visible outside of a rectangle. `data` contains attributes that programs
    /// read.
    pub fn within(&mut self, [x, y, width, height]: [f64; 4], data: &str, content: impl FnOnce(&mut Self)) {
        self.clips += 1;
        let clip = self.clips;
        self.add(format_args!(
            "<clipPath id=\"clip{clip}\"><rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" height=\"{height:.2}\"/>\
             </clipPath>"
        ));
        self.add(format_args!("<g clip-path=\"url(#clip{clip})\" {data}>"));
        content(self);
        self.add(format_args!("</g>"));
    }

    /// Returns the whole document, scaled to a width of `scaled` pixels.
    pub fn finish(self, scaled: f64) -> String {
        let Self { body, width, height, .. } = self;
        let tall = (height * scaled / width).round();
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{scaled}\" height=\"{tall}\" viewBox=\"0 0 {width} \
             {height}\" font-family=\"{FONT}\">\n{body}</svg>\n"
        )
    }

    fn add(&mut self, element: std::fmt::Arguments) {
        // Writing to a String does not fail.
        let _ = writeln!(self.body, "{element}");
    }
}

/// The approximate width of a text, pixels.
pub fn text_width(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * LETTER * size
}

/// Escapes a text for XML.
pub fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for letter in text.chars() {
        match letter {
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            '"' => escaped.push_str("&quot;"),
            // XML does not permit most control characters.
            letter if letter.is_control() => escaped.push(' '),
            letter => escaped.push(letter),
        }
    }
    escaped
}
