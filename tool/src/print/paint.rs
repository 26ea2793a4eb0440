//! The colours of the output. The text itself says what its colour means, so that nothing depends on colours alone.

use super::Screen;
use anstyle::{AnsiColor, Style};

/// How a text is meant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Look {
    /// Ordinary text.
    #[default]
    Plain,
    /// Something is as it should be.
    Good,
    /// Something could be better.
    Warning,
    /// Something is wrong.
    Bad,
    /// Less important than its surroundings.
    Dim,
    /// The title of what follows.
    Title,
}

impl Look {
    /// The style on a terminal. The colours are from the palette of the terminal, which its user has chosen.
    pub(super) fn style(self) -> Style {
        match self {
            Look::Plain => Style::new(),
            Look::Good => AnsiColor::Green.on_default(),
            Look::Warning => AnsiColor::Yellow.on_default(),
            Look::Bad => AnsiColor::Red.on_default().bold(),
            Look::Dim => Style::new().dimmed(),
            Look::Title => Style::new().bold(),
        }
    }
}

/// Returns a text with the escape sequences of its look, or the bare text if the screen has no colours.
pub fn painted(screen: &Screen, look: Look, text: &str) -> String {
    if !screen.coloured || look == Look::Plain {
        return text.to_owned();
    }
    let style = look.style();
    format!("{style}{text}{style:#}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_screen_with_colours_receives_escape_sequences() {
        let screen = |coloured| Screen { width: None, lines: false, coloured };
        assert_eq!(painted(&screen(false), Look::Bad, "fail"), "fail");
        assert_eq!(painted(&screen(true), Look::Plain, "fail"), "fail");
        assert_eq!(painted(&screen(true), Look::Bad, "fail"), "\u{1b}[1m\u{1b}[31mfail\u{1b}[0m");
    }
}
