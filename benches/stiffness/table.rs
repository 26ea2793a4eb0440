//! The table: measured columns as Markdown.

use crate::cases::{Case, Friction};
use crate::{contact, motion, robustness, statics};
use std::fmt::Write;
use std::path::Path;
use std::{fs, io};

/// What was measured for one controller at one rate.
pub struct Column {
    name: String,
    cells: Vec<(&'static str, String)>,
}

const BEGIN: &str = "<!-- table: begin -->\n";
const END: &str = "<!-- table: end -->";

impl Column {
    pub fn measure(case: &Case) -> Self {
        let percent = |part: f64| format!("{:.2} %", 100.0 * part);
        let mut cells = Vec::new();
        let mut add = |row, cell: String| {
            eprintln!("  {row}: {cell}");
            cells.push((row, cell));
        };
        let stiff = [3.0, case.bound()];
        add("apparent stiffness, worst direction, 1 mm, no friction", percent(statics::apparent_stiffness(case)));
        add("slope of a 2 mm, 3 s triangular force loop, friction, Kx 3 and bound", percent(statics::triangle(case)));
        add(
            "pushed from rest by Kx 2 mm, friction, Kx 3 and bound",
            percent(statics::pushed_from_rest(case, Friction::Default, &stiff, 0.2)),
        );
        add(
            "pushed from rest by Kx 1 mm, harsh friction, Kx 3",
            percent(statics::pushed_from_rest(case, Friction::Harsh, &[3.0], 0.1)),
        );
        let step = motion::steps(case, Friction::Default, 3.0, 0.0);
        add(
            "5 mm step at Kx 3: worst and median time to 5 %, overshoot",
            format!("{:.0} / {:.0} ms, {:.1} %", 1e3 * step.worst, 1e3 * step.median, 100.0 * step.overshoot),
        );
        let (error, least) = motion::reach(case);
        add(
            "30 mm reach in 200 ms: error after 100 ms, least tension",
            format!("{:.2} mm, {least:.2} N", 10.0 * error),
        );
        let hard = motion::steps(case, Friction::Default, case.bound(), 0.0);
        add(
            "5 mm step at the bound: least true and commanded tension",
            format!("{:.2} / {:.2} N", hard.least_true, hard.least_commanded),
        );
        for (row, stiffness) in [
            ("against walls of 30, 100, 300 N/cm, Kx 3: poses not at rest, residual motion", 3.0),
            ("the same at the bound", case.bound()),
        ] {
            let (unstable, motion) = contact::against_a_wall(case, stiffness);
            add(row, format!("{unstable} of {}, {:.4} mm rms", case.poses, 10.0 * motion));
        }
        let (excess, angle) = contact::over_limit(case);
        add("over-limit torque against a stop: above t_max, turned by", format!("{excess:+.2} N, {angle:.3} degrees"));
        add(
            "motor constants off by 20 %: error of 1 mm",
            percent(robustness::believing_otherwise(case, robustness::motor_constants)),
        );
        add(
            "tendon stiffness off by 10 %: error of 1 mm",
            percent(robustness::believing_otherwise(case, robustness::tendon_stiffness)),
        );
        add(
            "tendon stiffness known to 2 %: error of 1 mm",
            percent(robustness::believing_otherwise(case, robustness::calibrated)),
        );
        let lossy = motion::steps(case, Friction::Default, 3.0, 0.05);
        add(
            "5 % of the replies lost: worst and median time of the 5 mm step, median longer by",
            format!(
                "{:.0} / {:.0} ms, {:+.1} %",
                1e3 * lossy.worst,
                1e3 * lossy.median,
                100.0 * (lossy.median / step.median - 1.0)
            ),
        );
        add("growth of a deviation a cycle (below 1: stable)", format!("{:.4}", robustness::growth(case)));
        Self { name: case.name(), cells }
    }
}

/// One row a measurement, one column a controller and rate.
pub fn markdown(columns: &[Column]) -> String {
    let mut text = String::from("| worst over poses and Kx unless said |");
    for column in columns {
        let _ = write!(text, " {} |", column.name);
    }
    text.push_str("\n|---|");
    text.push_str(&"---|".repeat(columns.len()));
    text.push('\n');
    for (row, (name, _)) in columns[0].cells.iter().enumerate() {
        let _ = write!(text, "| {name} |");
        for column in columns {
            let _ = write!(text, " {} |", column.cells[row].1);
        }
        text.push('\n');
    }
    text
}

/// Puts the table between the two marks in a file.
pub fn replace_in(file: &Path, table: &str) -> io::Result<()> {
    let text = fs::read_to_string(file)?;
    let missing = || io::Error::other("the marks of the table are missing");
    let begin = text.find(BEGIN).ok_or_else(missing)? + BEGIN.len();
    let end = text.find(END).ok_or_else(missing)?;
    fs::write(file, format!("{}{table}{}", &text[..begin], &text[end..]))
}
