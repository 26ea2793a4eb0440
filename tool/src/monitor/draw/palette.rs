//! The colours of the terminal views. They are those of the terminal's palette. Every colour also has a word or a sign,
//! so that nothing depends on colours alone.

use ratatui::style::{Color, Modifier, Style};

/// The styles by meaning.
#[derive(Clone, Copy, Debug)]
pub struct Palette {
    /// Titles.
    pub title: Style,
    /// Less important than its surroundings.
    pub dim: Style,
    /// A measured value in a bar.
    pub measured: Style,
    /// A wanted value: a set point or a wanted tension.
    pub wanted: Style,
    /// As it should be.
    pub good: Style,
    /// Could be better.
    pub warning: Style,
    /// Wrong.
    pub bad: Style,
    /// Chosen by the person.
    pub selected: Style,
}

impl Palette {
    /// The palette for a terminal with colours.
    pub fn coloured() -> Self {
        let bold = Style::new().add_modifier(Modifier::BOLD);
        Self {
            // The titles of a frame would otherwise get the colour of the frame.
            title: bold.fg(Color::Reset),
            dim: Style::new().fg(Color::DarkGray),
            measured: Style::new().fg(Color::Cyan),
            wanted: bold.fg(Color::Magenta),
            good: Style::new().fg(Color::Green),
            warning: Style::new().fg(Color::Yellow),
            bad: bold.fg(Color::Red),
            selected: bold.fg(Color::Blue),
        }
    }

    /// The palette without colours, for NO_COLOR.
    pub fn plain() -> Self {
        let (bold, plain) = (Style::new().add_modifier(Modifier::BOLD), Style::new());
        Self {
            title: bold,
            dim: Style::new().add_modifier(Modifier::DIM),
            measured: plain,
            wanted: bold,
            good: plain,
            warning: bold,
            bad: Style::new().add_modifier(Modifier::BOLD | Modifier::REVERSED),
            selected: bold,
        }
    }
}
