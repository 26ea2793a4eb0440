//! Limits on the length of files, functions and lines. Lines with comments count too.

use std::fs;
use std::path::{Path, PathBuf};

/// Maximum number of lines of a file.
const FILE: usize = 300;
/// Maximum number of lines of a function, from its name to its last brace.
const FUNCTION: usize = 60;
/// Maximum number of columns of a line.
const LINE: usize = 120;

/// Folders whose files are not the project's: build products, libraries of the web page, and a crate of Zenoh that
/// keeps the layout of its upstream code.
const FOREIGN: [&str; 4] = ["target", "build", "vendor", "zenoh-link-tls"];

/// Endings of the names of source files.
const ENDINGS: [&str; 9] = [".rs", ".c", ".h", ".cpp", ".py", ".pyi", ".js", ".css", ".html"];

/// Returns the source files of the project below a folder.
pub fn source_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if path.is_dir() && !name.starts_with('.') && !FOREIGN.contains(&name) {
            files.extend(source_files(&path));
        } else if ENDINGS.iter().any(|ending| name.ends_with(ending)) {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// Returns a text for every limit that a source file exceeds.
pub fn exceeded(path: &Path, text: &str) -> Vec<String> {
    let name = path.display();
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    if lines.len() > FILE {
        found.push(format!("{name}: {} lines", lines.len()));
    }
    for (index, line) in lines.iter().enumerate() {
        let columns = line.chars().count();
        if columns > LINE {
            found.push(format!("{name}:{}: {columns} columns", index + 1));
        }
        let begins = match path.extension().and_then(|ending| ending.to_str()) {
            Some("rs") => is_rust_function(line),
            Some("c" | "h" | "cpp" | "js") => is_c_function(line),
            _ => false,
        };
        let length = if begins { function_length(&lines[index..]) } else { 0 };
        if length > FUNCTION {
            found.push(format!("{name}:{}: a function of {length} lines", index + 1));
        }
    }
    found
}

fn is_rust_function(line: &str) -> bool {
    let qualifies =
        |word: &str| word.starts_with("pub") || ["const", "async", "unsafe", "extern", "\"C\""].contains(&word);
    line.split_once("fn ").is_some_and(|(before, _)| before.split_whitespace().all(qualifies))
}

/// Returns whether a C function begins on this line: in the first column, with a type before the name.
fn is_c_function(line: &str) -> bool {
    line.starts_with(|first: char| first.is_ascii_alphabetic())
        && line.split_once('(').is_some_and(|(start, _)| start.contains(' ') && !start.contains('='))
}

/// Counts the lines up to the closing brace, which has the same indentation as the function's first line. Returns 0 for
/// a declaration and for a function on one line.
fn function_length(lines: &[&str]) -> usize {
    let signature_end = lines.iter().find(|line| line.ends_with(['{', '}', ';']));
    if !signature_end.is_some_and(|line| line.ends_with('{')) {
        return 0;
    }
    let indentation = &lines[0][..lines[0].len() - lines[0].trim_start().len()];
    lines.iter().position(|line| line.strip_prefix(indentation) == Some("}")).map_or(0, |last| last + 1)
}
