//! The table of all measurements and goals, as Markdown.

use crate::cases::{Case, Friction};
use crate::closed_loop::Senses;
use crate::motion::Steps;
use crate::statics::Fidelity;
use crate::{contact, motion, robustness, stability, statics};
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;
use std::{fs, io};

/// One measured property of a finger.
struct Row {
    what: &'static str,
    /// The goal at 1000 Hz and above.
    goal: &'static str,
    measure: fn(&Case) -> String,
}

/// The results of one controller at one rate.
pub struct Column {
    name: String,
    cells: Vec<(&'static Row, String)>,
}

static ROWS: [Row; 22] = [
    Row {
        what: "apparent stiffness at 1 mm, worst direction, no friction, quantised and noisy sensors: error",
        goal: "<= 0.3 %",
        measure: |case| fidelity(statics::apparent_stiffness(case, Senses::Counts)),
    },
    Row {
        what: "the same with exact sensors",
        goal: "",
        measure: |case| fidelity(statics::apparent_stiffness(case, Senses::Exact)),
    },
    Row {
        what: "triangular wave of force, +-Kx times 2 mm in 3 s, with friction: error of the slope at Kx 3 / at the \
               bound",
        goal: "<= 3 %",
        measure: |case| at_both(case, statics::triangle),
    },
    Row {
        what: "pushed from rest by a force of Kx times 2 mm, with friction: error of the stiffness at Kx 3 / at the \
               bound",
        goal: "<= 5 %",
        measure: |case| {
            at_both(case, |case, stiffness| statics::pushed_from_rest(case, Friction::Default, stiffness, 0.2))
        },
    },
    Row {
        what: "pushed from rest by a force of Kx times 1 mm, harsh joint friction: error of the stiffness at Kx 3",
        goal: "<= 50 %",
        measure: |case| percent(statics::pushed_from_rest(case, Friction::Harsh, 3.0, 0.1)),
    },
    Row {
        what: "5 mm step at Kx 3: settling time to 5 %, worst / median; overshoot",
        goal: "<= 150 ms; <= 10 %",
        measure: |case| {
            let steps = motion::steps(case, 3.0, 0.0);
            format!("{}; {}", times(&steps), percent(steps.overshoot))
        },
    },
    Row {
        what: "30 mm reach in 200 ms at Kx 3, with friction: largest error from 100 ms after its end; least true \
               tension",
        goal: "<= 0.3 mm; >= 4 N",
        measure: |case| {
            let (error, least) = motion::reach(case);
            format!("{:.2} mm; {least:.2} N", 10.0 * error)
        },
    },
    Row {
        what: "5 mm step at the bound: least true / commanded tension",
        goal: ">= 2.5 N / 5 N",
        measure: |case| {
            let steps = motion::steps(case, case.bound(), 0.0);
            format!("{:.2} N / {:.2} N", steps.least_true, steps.least_commanded)
        },
    },
    Row {
        what: "against walls of 30, 100, 300 N/cm at Kx 3: poses not at rest after 2 s; residual motion",
        goal: "0",
        measure: |case| walls(case, 3.0),
    },
    Row { what: "the same at the bound", goal: "0", measure: |case| walls(case, case.bound()) },
    Row {
        what: "over-limit torque against a stop: largest tension minus t_max, at rest / on the way there; angle \
               between commanded and applied torque",
        goal: "<= 0.1 N; 0",
        measure: |case| {
            let found = contact::over_limit(case);
            assert!(found.scale < 1.0, "no torque exceeded the limits, so nothing was measured");
            format!("{:+.2} / {:+.2} N; {:.2} degrees", found.excess, found.excess_on_the_way, found.turned)
        },
    },
    Row {
        what: "motor constants off by 20 %: error of the stiffness at Kx 3 / at the bound",
        goal: "no effect",
        measure: |case| {
            fidelity_at_both(case, |case, stiffness| {
                robustness::motor_constants(case, stiffness, &robustness::MOTOR_CONSTANTS)
            })
        },
    },
    Row {
        what: "motor constants off by 20 %: settling time of a 5 mm step at Kx 3, worst / median; overshoot",
        goal: "no effect",
        measure: |case| {
            let steps = motion::steps_of(case, 3.0, 0.0, |finger| {
                finger.simulation.motor_constant_ratio = robustness::MOTOR_CONSTANTS[2];
            });
            format!("{}; {}", times(&steps), percent(steps.overshoot))
        },
    },
    Row {
        what: "tendon stiffness off by 10 %: error of the stiffness at Kx 3 / at the bound",
        goal: "",
        measure: |case| {
            fidelity_at_both(case, |case, stiffness| {
                robustness::tendon_stiffness(case, stiffness, &robustness::TENDONS)
            })
        },
    },
    Row {
        what: "tendon stiffness off by 10 %, identified: error of the identified value; error of the stiffness at \
               Kx 3 / at the bound",
        goal: "<= 2 %; <= 1 %",
        measure: |case| match robustness::identified_tendons(case, [3.0, case.bound()], &robustness::TENDONS) {
            Ok((found, [soft, stiff])) => format!("{}; {} / {}", percent(found), fidelity(soft), fidelity(stiff)),
            Err(obstacle) => format!("not found: {obstacle}"),
        },
    },
    Row {
        what: "5 % of the replies lost: settling time of a 5 mm step at Kx 3, worst / median; increase of the median",
        goal: "<= +3 %",
        measure: |case| {
            let (whole, lossy) = (motion::steps(case, 3.0, 0.0), motion::steps(case, 3.0, 0.05));
            format!("{}; {:+.1} %", times(&lossy), 100.0 * (lossy.median / whole.median - 1.0))
        },
    },
    Row {
        what: "stability, random poses in the joint ranges of the other rows, Kx up to the bound, loads that deflect \
               by up to 1 mm: unstable samples; largest eigenvalue",
        goal: "0; < 1",
        measure: |case| eigenvalue(&stability::usual(case)),
    },
    Row {
        what: "the same anywhere within the joint limits",
        goal: "0; < 1",
        measure: |case| eigenvalue(&stability::anywhere(case)),
    },
    Row {
        what: "the same in the joint ranges of the other rows, against walls of 30, 100, 300 N/cm",
        goal: "0; < 1",
        measure: |case| eigenvalue(&stability::against_walls(case)),
    },
    Row {
        what: "at rest at Kx 3, with friction: change of the commands per cycle; motion of the tip",
        goal: "",
        measure: |case| {
            let (change, motion) = motion::at_rest(case, 3.0);
            format!("{change:.2} N; {:.1} um rms", 1e4 * motion)
        },
    },
    Row {
        what: "at rest at the bound, with friction: change of the commands per cycle; motion of the tip",
        goal: "",
        measure: |case| {
            let (change, motion) = motion::at_rest(case, case.bound());
            format!("{change:.2} N; {:.1} um rms", 1e4 * motion)
        },
    },
    Row {
        what: "5 mm step at the bound: settling time to 5 %, worst / median; overshoot",
        goal: "",
        measure: |case| {
            let steps = motion::steps(case, case.bound(), 0.0);
            format!("{}; {}", times(&steps), percent(steps.overshoot))
        },
    },
];

fn percent(part: f64) -> String {
    format!("{:.2} %", 100.0 * part)
}

/// Formats the error relative to the reported stiffness, and the reported stiffness if it is less than Kx.
fn fidelity(found: Fidelity) -> String {
    let error = percent(found.error);
    if found.scale < 1.0 {
        format!("{error} of the reported stiffness, which is at least {:.3} Kx", found.scale)
    } else {
        error
    }
}

fn fidelity_at_both(case: &Case, measure: fn(&Case, f64) -> Fidelity) -> String {
    format!("{} / {}", fidelity(measure(case, 3.0)), fidelity(measure(case, case.bound())))
}

/// Measures at Kx 3 and at the bound.
fn at_both(case: &Case, measure: fn(&Case, f64) -> f64) -> String {
    format!("{} / {}", percent(measure(case, 3.0)), percent(measure(case, case.bound())))
}

fn times(steps: &Steps) -> String {
    format!("{:.0} / {:.0} ms", 1e3 * steps.worst, 1e3 * steps.median)
}

fn walls(case: &Case, stiffness: f64) -> String {
    let (restless, motion) = contact::against_walls(case, stiffness);
    format!("{restless} of {}; {:.1} um rms", case.poses, 1e4 * motion)
}

fn eigenvalue(found: &stability::Stability) -> String {
    format!("{} of {}; {:.4}", found.unstable, found.samples, found.largest)
}

impl Column {
    /// Measures the rows whose names contain one of the texts in `only`. Semicolons separate these texts.
    pub fn measure(case: &Case, only: &str) -> Self {
        let measured = |row: &'static Row| {
            let begun = Instant::now();
            let cell = (row.measure)(case);
            eprintln!("  {}: {cell} [{:.1} s]", row.what, begun.elapsed().as_secs_f64());
            (row, cell)
        };
        Self {
            name: case.name(),
            cells: ROWS
                .iter()
                .filter(|row| only.split(";").any(|only| row.what.contains(only)))
                .map(measured)
                .collect(),
        }
    }
}

/// Returns the table with one row per measurement, and one column per controller and rate.
pub fn markdown(columns: &[Column]) -> String {
    let mut text = String::from("| worst over poses and Kx unless stated otherwise | goal |");
    for column in columns {
        let _ = write!(text, " {} |", column.name);
    }
    text.push_str("\n|---|---|");
    text.push_str(&"---|".repeat(columns.len()));
    text.push('\n');
    for row in 0..columns.first().map_or(0, |column| column.cells.len()) {
        let Row { what, goal, .. } = columns[0].cells[row].0;
        let _ = write!(text, "| {what} | {goal} |");
        for column in columns {
            let _ = write!(text, " {} |", column.cells[row].1);
        }
        text.push('\n');
    }
    text
}

const BEGIN: &str = "<!-- table: begin -->\n";
const END: &str = "<!-- table: end -->";

/// Writes the table, and the command that made it, between the two marks in a file.
pub fn replace_in(file: &Path, command: &str, table: &str) -> io::Result<()> {
    let text = fs::read_to_string(file)?;
    let missing = || {
        let (file, begin) = (file.display(), BEGIN.trim_end());
        io::Error::other(format!("{file} needs the line {begin} and after it the line {END}: add what is missing"))
    };
    let begin = text.find(BEGIN).ok_or_else(missing)? + BEGIN.len();
    let end = text.find(END).filter(|&end| end >= begin).ok_or_else(missing)?;
    fs::write(file, format!("{}`{command}`\n\n{table}{}", &text[..begin], &text[end..]))
}
