//! Reads the table of docs/architecture.md that shows the way of a set point from a call to the wire.

use std::fs;
use std::path::Path;

/// A row of the table.
pub struct Station {
    pub file: String,
    pub function: String,
    /// The shape in which the function passes the set point on.
    pub shape: String,
}

/// Returns the text of the section that contains the table, and the rows of the table.
pub fn read(root: &Path) -> (String, Vec<Station>) {
    let page = fs::read_to_string(root.join("docs/architecture.md")).expect("the page");
    let (_, section) = page.split_once("## The way of a set point").expect("the section");
    let section = section.split("\n## ").next().unwrap_or_default();
    let rows = section.lines().filter(|line| line.starts_with("| ") && !line.starts_with("| |"));
    let stations = rows.enumerate().map(|(index, row)| {
        let cells: Vec<&str> = row.split('|').map(|cell| cell.trim().trim_matches('`')).collect();
        let [_, number, file, function, _, shape, _] = cells[..] else { panic!("not five columns: {row}") };
        assert_eq!(number, (index + 1).to_string(), "{row}");
        Station { file: file.into(), function: function.into(), shape: shape.into() }
    });
    let stations = stations.collect();
    (section.into(), stations)
}
