//! Lines of text that compete for room: if the room does not suffice for all of them, the less important ones are left
//! out.

use ratatui::text::Line;

/// Lines from top to bottom, each with its rank. Rank 0 is the most important.
#[derive(Debug, Default)]
pub struct Rows(Vec<(u8, Line<'static>)>);

impl Rows {
    /// Appends a line.
    pub fn push(&mut self, rank: u8, line: impl Into<Line<'static>>) {
        self.0.push((rank, line.into()));
    }

    /// Returns as many lines as there is room for, in their order. Of lines with the same rank, the last are left out.
    pub fn fitting(self, room: usize) -> Vec<Line<'static>> {
        let mut order: Vec<usize> = (0..self.0.len()).collect();
        order.sort_by_key(|&index| self.0[index].0);
        order.truncate(room);
        let lines = self.0.into_iter().enumerate();
        lines.filter(|(index, _)| order.contains(index)).map(|(_, (_, line))| line).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_important_lines_stay_in_their_order() {
        let mut rows = Rows::default();
        for (rank, text) in [(2, "a"), (0, "b"), (1, "c"), (1, "d")] {
            rows.push(rank, text);
        }
        let texts: Vec<String> = rows.fitting(2).iter().map(Line::to_string).collect();
        assert_eq!(texts, ["b", "c"]);
    }
}
