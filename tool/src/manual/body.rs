//! Text of comments as roff: lines that begin with a space are preformatted, and all others form paragraphs.

use clap_mangen::roff::{Roff, bold, roman};

/// Appends a section with this title, unless the text is empty.
pub fn section(page: &mut Roff, title: &str, lines: &[&str]) {
    if lines.iter().any(|line| !line.trim().is_empty()) {
        page.control("SH", [title]);
        body(page, lines);
    }
}

/// Appends the text.
pub fn body(page: &mut Roff, lines: &[&str]) {
    for paragraph in lines.split(|line| line.trim().is_empty()).filter(|paragraph| !paragraph.is_empty()) {
        page.control("PP", []);
        // A line of prose, for example "Returns 0, or -1 with", may introduce preformatted lines.
        for run in paragraph.chunk_by(|left, right| left.starts_with(' ') == right.starts_with(' ')) {
            if run[0].starts_with(' ') {
                preformatted(page, run);
            } else {
                page.text([roman(run.join("\n"))]);
            }
        }
    }
}

/// Appends lines that keep their breaks and spaces.
pub fn preformatted(page: &mut Roff, lines: &[&str]) {
    page.control("nf", []);
    for line in lines {
        page.text([roman(*line)]);
    }
    page.control("fi", []);
}

/// Appends lines that keep their breaks but not their indentation, in bold type.
pub fn prototype(page: &mut Roff, lines: &[&str]) {
    page.control("nf", []);
    for line in lines {
        page.text([bold(line.trim_start())]);
    }
    page.control("fi", []);
}
