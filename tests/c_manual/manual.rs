//! Splits the manuals of the two headers into chapters and entries.

use super::c::root;
use std::fs;

/// The header of the five calls of 1990.
pub const OF_1990: &str = "Sun2Xp.h";

/// The header of the calls with handles.
pub const HANDLES: &str = "sun2xp.h";

/// The comments of a header.
pub struct Manual {
    /// The name of the header.
    pub name: &'static str,
    /// The comment at the top of the header.
    chapters: String,
    /// The entry of each call.
    pub entries: Vec<Entry>,
    header: String,
}

/// A block below a line such as "Example, softer along z:", indented by four blanks.
pub struct Example {
    /// The name of the header.
    pub header: &'static str,
    /// The number of the chapter, or the name of the call.
    pub place: String,
    pub text: String,
}

/// The manual's entry of a call.
pub struct Entry {
    pub call: String,
    /// The declaration below the entry.
    pub declaration: String,
    /// The text without the blank at the beginning of each line.
    pub text: String,
}

impl Manual {
    pub fn both() -> [Self; 2] {
        [Self::read(OF_1990), Self::read(HANDLES)]
    }

    pub fn read(name: &'static str) -> Self {
        let header = fs::read_to_string(root().join("include").join(name)).expect("the header");
        let (opening, rest) = header.split_once("*/").expect("the header begins with a comment");
        let mut entries = Vec::new();
        for after in rest.split("\n/*\n").skip(1) {
            let (text, after) = after.split_once("\n */\n").expect("every comment ends");
            let declaration = after.lines().next().unwrap_or_default();
            let callee = declaration.split_once('(').and_then(|(call, _)| call.rsplit([' ', '*']).next());
            let is_call = declaration.ends_with(");") && !declaration.starts_with("typedef");
            let Some(call) = callee.filter(|_| is_call) else { continue };
            let text = text.lines().map(|line| line.strip_prefix(' ').unwrap_or(line)).collect::<Vec<_>>().join("\n");
            entries.push(Entry { call: call.to_string(), declaration: declaration.to_string(), text });
        }
        Self { name, chapters: opening.to_string(), entries, header }
    }

    /// The text of a chapter in one line.
    pub fn chapter(&self, number: usize) -> String {
        let heading = |number: usize| format!("\n\n\n   {number}. ");
        let (_, text) = self.chapters.split_once(&heading(number)).expect("the manual has the chapter");
        in_one_line(text.split_once(&heading(number + 1)).map_or(text, |(text, _)| text))
    }

    /// All examples.
    pub fn examples(&self) -> Vec<Example> {
        let chapters = self.chapters.split("\n\n\n").skip(1).flat_map(|chapter| {
            let place = chapter.trim_start().split('.').next().unwrap_or_default();
            examples(self.name, place, chapter)
        });
        chapters.chain(self.entries.iter().flat_map(|entry| examples(self.name, &entry.call, &entry.text))).collect()
    }

    /// Every line that looks like part of a program but is in no example and no synopsis.
    pub fn stray_code(&self) -> Vec<String> {
        let mut stray = Vec::new();
        for text in [&self.chapters].into_iter().chain(self.entries.iter().map(|entry| &entry.text)) {
            let examples: String = examples(self.name, "", text).into_iter().map(|example| example.text).collect();
            let shown: Vec<_> = examples.lines().map(str::trim).collect();
            let indented = text.lines().filter(|line| indentation(line) >= 4).map(str::trim);
            stray.extend(indented.filter(|line| looks_like_code(line) && !shown.contains(line)).map(str::to_string));
        }
        stray
    }

    /// The comment above a struct, in one line.
    pub fn comment(&self, structure: &str) -> String {
        let end = format!("\n */\nstruct {structure} {{\n");
        let (before, _) = self.header.split_once(&end).expect("the struct");
        in_one_line(before.rsplit_once("/*\n").expect("every comment begins").1)
    }

    /// The entry of a call, in one line.
    pub fn entry(&self, call: &str) -> String {
        in_one_line(&self.entries.iter().find(|entry| entry.call == call).expect("the entry").text)
    }

    /// The comment beside a member of a struct, in one line.
    pub fn member(&self, structure: &str, member: &str) -> String {
        let (_, rest) = self.header.split_once(&format!("\nstruct {structure} {{\n")).expect("the struct");
        let (members, _) = rest.split_once("\n};\n").expect("every struct ends");
        let (_, after) = members.split_once(&format!(" {member};")).expect("the member");
        let comment = after.trim_start().strip_prefix("/*").expect("every member has a comment");
        in_one_line(comment.split_once("*/").expect("every comment ends").0)
    }
}

impl Entry {
    /// The errnos of an entry, in the order of its list. If several of them apply to a call, it reports the first of
    /// these. A line of the list begins with one errno or with several.
    pub fn errnos(&self) -> Vec<&str> {
        let Some((_, list)) =
            self.text.split_once("or -1 with\n").or(self.text.split_once("or a negative number with\n"))
        else {
            return Vec::new();
        };
        // Other lines of the list are indented further.
        let lines = list.lines().take_while(|line| !line.is_empty());
        let lines = lines.filter_map(|line| line.strip_prefix("  ").filter(|line| line.starts_with('E')));
        let errno = |word: &&str| word.starts_with('E') && word.chars().all(|letter| letter.is_ascii_uppercase());
        lines.flat_map(|line| line.split([' ', ',']).filter(|word| !word.is_empty()).take_while(errno)).collect()
    }

    /// The paragraph that begins with "Threads:", in one line.
    pub fn threads(&self) -> String {
        let (_, threads) = self.text.split_once("\nThreads: ").unwrap_or_default();
        in_one_line(threads.split_once("\n\n").map_or(threads, |(threads, _)| threads))
    }
}

/// Returns whether a line is C, a command or TOML, but no synopsis.
fn looks_like_code(line: &str) -> bool {
    let calls = line.match_indices('(').any(|(at, _)| line[..at].ends_with(|letter: char| letter.is_alphanumeric()));
    let code = (calls && line.contains(");")) || line.ends_with(['{', '}']);
    let synopsis = line.starts_with("int ") || line.starts_with("const char *");
    (code && !synopsis) || line.starts_with("cc ") || line.starts_with('[')
}

fn indentation(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

fn examples(header: &'static str, place: &str, text: &str) -> Vec<Example> {
    let lines: Vec<_> = text.lines().collect();
    let mut examples = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        if !(line.trim_start().starts_with("Example") && line.ends_with(':')) {
            continue;
        }
        let margin = indentation(line) + 4;
        let block = lines[index + 1..].iter().take_while(|line| line.is_empty() || indentation(line) >= margin);
        let text = block.map(|line| line.get(margin..).unwrap_or_default()).collect::<Vec<_>>().join("\n");
        examples.push(Example { header, place: place.to_string(), text: text.trim_matches('\n').to_string() + "\n" });
    }
    examples
}

pub fn in_one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The names of calls in a list such as "A, B and C".
pub fn listed(text: &str) -> Vec<&str> {
    text.split([' ', ',']).filter(|word| !word.is_empty() && *word != "and" && *word != "or").collect()
}
