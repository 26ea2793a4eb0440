//! Pages of the C calls, from the comments of a header.

use super::body::{body, preformatted, prototype, section};
use super::{Header, Page};
use clap_mangen::roff::{Roff, roman};

/// A comment of the header that documents a call.
struct Comment<'a> {
    name: &'a str,
    purpose: &'a str,
    /// The declaration below the comment. A comment may begin with a declaration of its own, in which the parameters
    /// have other names. The page then shows the declaration in the comment.
    declaration: &'a str,
    /// The lines after the first, without the space with which they begin.
    lines: Vec<&'a str>,
}

/// Returns the pages of all calls.
pub fn pages(header: &Header) -> Vec<Page> {
    comments(&header.text).iter().map(|comment| page(comment, header)).collect()
}

/// Returns the page of the chapters that precede the calls.
pub fn chapters(header: &Header) -> Page {
    let mut text = Roff::new();
    let comment = header.text.strip_prefix("/*").and_then(|rest| rest.split_once("*/"));
    let comment = comment.map_or("", |(comment, _)| comment);
    // The first line is "NAME.h - PURPOSE".
    let purpose = comment.lines().next().and_then(|line| line.split_once(" - ")).map_or("C calls", |(_, rest)| rest);
    title(&mut text, &header.name, purpose);
    let lines: Vec<&str> = comment.lines().skip(1).map(|line| line.strip_prefix("   ").unwrap_or(line)).collect();
    let starts: Vec<usize> = (0..lines.len()).filter(|&index| is_chapter(lines[index])).collect();
    for (position, &start) in starts.iter().enumerate() {
        let end = starts.get(position + 1).copied().unwrap_or(lines.len());
        section(&mut text, lines[start], &lines[start + 1..end]);
    }
    let names: Vec<String> = comments(&header.text).iter().map(|comment| format!("{}(3)", comment.name)).collect();
    text.control("SH", ["SEE ALSO"]);
    text.text([roman(format!("{}, sun2xp(1), sun2xp.toml(5)", names.join(", ")))]);
    Page { name: header.name.clone(), section: 3, text }
}

/// Chapters have titles such as "2. RETURN VALUES, ERRNO".
fn is_chapter(line: &str) -> bool {
    let title = line.split_once(". ").filter(|(number, _)| number.parse::<u32>().is_ok()).map(|(_, title)| title);
    title.is_some_and(|title| title.len() > 2 && title == title.to_uppercase())
}

fn comments(header: &str) -> Vec<Comment<'_>> {
    header.split("\n/*\n").skip(1).filter_map(comment).collect()
}

fn comment(rest: &str) -> Option<Comment<'_>> {
    let (text, after) = rest.split_once("\n */\n")?;
    let declaration = after.lines().next()?;
    let mut lines = text.lines().map(|line| line.strip_prefix(' ').unwrap_or(line));
    let (name, purpose) = lines.next()?.split_once(" - ")?;
    Some(Comment { name, purpose, declaration, lines: lines.collect() })
}

fn page(comment: &Comment, header: &Header) -> Page {
    let mut text = Roff::new();
    title(&mut text, comment.name, comment.purpose);

    let after = |indent| comment.lines.iter().take_while(|line| line.is_empty() || line.starts_with(indent)).count();
    let (signature, parameters) = (after("    "), after("  "));
    let rest = &comment.lines[parameters..];
    text.control("SH", ["SYNOPSIS"]);
    prototype(&mut text, &[&format!("#include <{}.h>", header.name)]);
    text.control("PP", []);
    let mut declarations: Vec<&str> = comment.lines[..signature].to_vec();
    declarations.retain(|line| !line.is_empty());
    if declarations.is_empty() {
        declarations.push(comment.declaration);
    }
    prototype(&mut text, &declarations);
    section(&mut text, "PARAMETERS", &comment.lines[signature..parameters]);

    let begins =
        |index: usize, start: &str| rest[index].starts_with(start) && (index == 0 || rest[index - 1].is_empty());
    let find = |start: &str| (0..rest.len()).find(|&index| begins(index, start)).unwrap_or(rest.len());
    let examples = find("Example");
    let notes = find("Threads:").min(examples);
    // Paragraphs of the description may begin with "Returns" too, so only the last such paragraph counts.
    let returned = (0..notes).rfind(|&index| begins(index, "Returns")).unwrap_or(notes);
    section(&mut text, "DESCRIPTION", &rest[..returned]);
    section(&mut text, "RETURN VALUE", &rest[returned..notes]);
    section(&mut text, "NOTES", &rest[notes..examples]);
    let structs: Vec<&str> = declarations.iter().filter_map(|line| definition(&header.text, line)).collect();
    if !structs.is_empty() {
        text.control("SH", ["STRUCTURES"]);
        for definition in structs {
            preformatted(&mut text, &definition.lines().collect::<Vec<_>>());
        }
    }
    if examples < rest.len() {
        text.control("SH", ["EXAMPLES"]);
        // The word "Example" is left out, because the title of the section contains it.
        let first = rest[examples].trim_start_matches("Example").trim_start_matches([',', ' ', ':']);
        let lines: Vec<&str> = [first].into_iter().chain(rest[examples + 1..].iter().copied()).collect();
        body(&mut text, &lines);
    }
    text.control("SH", ["SEE ALSO"]);
    text.text([roman(format!("{}(3), sun2xp.toml(5)", header.name))]);
    Page { name: comment.name.into(), section: 3, text }
}

fn title(text: &mut Roff, name: &str, purpose: &str) {
    text.control("SH", ["NAME"]);
    // Programs that index manual pages look for this form.
    text.text([roman(name), roman(" - "), roman(purpose)]);
}

/// Returns the definition of the struct that a prototype names.
fn definition<'a>(header: &'a str, prototype: &str) -> Option<&'a str> {
    let name = prototype.split("struct ").nth(1)?.split([' ', '*']).next()?;
    let start = header.find(&format!("\nstruct {name} {{"))? + 1;
    let end = header[start..].find("\n};")? + start + "\n};".len();
    Some(&header[start..end])
}
