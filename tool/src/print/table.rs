//! Tables with aligned columns.

use super::{Look, Screen};
use anstyle::{AnsiColor, Color, Effects};
use comfy_table::presets::NOTHING;

use comfy_table::{Attribute, CellAlignment, ContentArrangement, LineStyle};

/// Space between two columns.
const GAP: u16 = 2;

/// One cell of a table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cell {
    text: String,
    look: Look,
}

impl Cell {
    /// A cell with a colour.
    pub fn new(look: Look, text: impl Into<String>) -> Self {
        Self { text: text.into(), look }
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Self {
        Self::new(Look::Plain, text)
    }
}

/// A table. On a terminal the header has a line below it, and cells wrap at the width of the terminal. In a file or a
/// pipe, a row without line feeds is one line of plain text with at least two spaces between its columns.
#[derive(Clone, Debug, Default)]
pub struct Table {
    header: Vec<String>,
    numeric: Vec<usize>,
    rows: Vec<Vec<Cell>>,
}

impl Table {
    /// A table with these titles of its columns.
    pub fn new<const COLUMNS: usize>(header: [&str; COLUMNS]) -> Self {
        Self::titled(header.map(String::from))
    }

    /// A table with any number of columns.
    pub fn titled(header: impl IntoIterator<Item = String>) -> Self {
        Self { header: header.into_iter().collect(), ..Self::default() }
    }

    /// A table without titles.
    pub fn without_header() -> Self {
        Self::default()
    }

    /// Aligns these columns, counted from 0, at their right edge.
    pub fn numeric(mut self, columns: impl IntoIterator<Item = usize>) -> Self {
        self.numeric.extend(columns);
        self
    }

    /// Appends a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = Cell>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Returns the table as text that ends with a line feed. A table without rows is empty.
    pub fn text(&self, screen: &Screen) -> String {
        if self.rows.is_empty() {
            return String::new();
        }
        let mut table = comfy_table::Table::new();
        let rule = LineStyle::none().fill('─').junction('─');
        table.load_style(if screen.lines { NOTHING.header_separator(rule) } else { NOTHING });
        // The table must not examine the output itself: `screen` describes what the output can show, so that tests can
        // choose the screen.
        table.force_no_tty();
        if screen.coloured {
            table.enforce_styling();
            table.style_text_only();
        }
        if let Some(width) = screen.width {
            table.set_content_arrangement(ContentArrangement::Dynamic);
            table.set_width(width.min(u16::MAX.into()) as u16);
        }
        if !self.header.is_empty() {
            table.set_header(self.header.iter().map(|title| cell(title, Look::Title)));
        }
        table.add_rows(self.rows.iter().map(|row| row.iter().map(|one| cell(&one.text, one.look)).collect::<Vec<_>>()));
        let last = table.column_count().saturating_sub(1);
        for (index, column) in table.column_iter_mut().enumerate() {
            column.set_padding((0, if index == last { 0 } else { GAP }));
            if self.numeric.contains(&index) {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        table.lines().map(|line| line.trim_end().to_owned() + "\n").collect()
    }
}

fn cell(text: &str, look: Look) -> comfy_table::Cell {
    let mut cell = comfy_table::Cell::new(text);
    let style = look.style();
    for (effect, attribute) in [(Effects::BOLD, Attribute::Bold), (Effects::DIMMED, Attribute::Dim)] {
        if style.get_effects().contains(effect) {
            cell = cell.add_attribute(attribute);
        }
    }
    match style.get_fg_color() {
        Some(Color::Ansi(AnsiColor::Green)) => cell.fg(comfy_table::Color::DarkGreen),
        Some(Color::Ansi(AnsiColor::Yellow)) => cell.fg(comfy_table::Color::DarkYellow),
        Some(Color::Ansi(AnsiColor::Red)) => cell.fg(comfy_table::Color::DarkRed),
        _ => cell,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Table {
        let mut table = Table::new(["thread", "load", "deadlines"]).numeric([1]);
        table.row(["1".into(), "9.5 %".into(), Cell::new(Look::Good, "met")]);
        table.row(["2".into(), "10.5 %".into(), Cell::new(Look::Bad, "the line is too busy for every finger")]);
        table
    }

    #[test]
    fn a_pipe_receives_one_aligned_line_for_each_row() {
        let plain = Screen { width: None, lines: false, coloured: false };
        let expected = "thread    load  deadlines\n\
                        1        9.5 %  met\n\
                        2       10.5 %  the line is too busy for every finger\n";
        assert_eq!(example().text(&plain), expected);
        assert_eq!(Table::new(["empty"]).text(&plain), "");
    }

    #[test]
    fn a_terminal_has_a_line_below_the_titles_and_its_width_is_kept() {
        let terminal = Screen { width: Some(40), lines: true, coloured: false };
        let text = example().text(&terminal);
        assert!(text.lines().nth(1).is_some_and(|line| line.starts_with("─────")), "{text}");
        assert!(text.lines().count() > 4 && text.lines().all(|line| line.chars().count() <= 40), "{text}");
    }

    #[test]
    fn colours_do_not_shift_columns() {
        let screen = |coloured| Screen { width: None, lines: true, coloured };
        let text = example().text(&screen(true));
        assert!(text.contains("\u{1b}[38;5;2mmet\u{1b}[39m"), "{text:?}");
        let bare = anstream::adapter::strip_str(&text).to_string();
        let bare: String = bare.lines().map(|line| line.trim_end().to_owned() + "\n").collect();
        assert_eq!(bare, example().text(&screen(false)));
    }
}
