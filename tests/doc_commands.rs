//! Checks the `cargo test` commands on the pages of the documentation: each command with `--test` or `--lib` runs at
//! least one test, so its test program and its filter exist.

use std::fs;
use std::path::{Path, PathBuf};

/// The folders of the workspace's packages. The first one is the root, which is the library.
const PACKAGES: [&str; 8] =
    ["", "models", "python", "remote/client", "remote/library", "remote/protocol", "serve", "tool"];

/// The folders whose pages are read. CHANGELOG.md is left out, because it may name tests that exist no more.
const FOLDERS: [&str; 10] =
    ["", "docs", "firmware", "firmware/stm32f405", "models", "protocol", "python", "remote", "serve", "tool"];

/// The arguments of a command `cargo test`.
#[derive(Debug, Default)]
struct Command {
    package: Option<String>,
    /// The program of `--test`; none for `--lib`.
    program: Option<String>,
    lib: bool,
    filter: String,
    /// Whether only tests that are marked `#[ignore]` run.
    only_ignored: bool,
    /// Whether tests that are marked `#[ignore]` run too.
    include_ignored: bool,
}

impl Command {
    fn read(text: &str) -> Self {
        let mut command = Self::default();
        let mut words = text.split_whitespace().take_while(|&word| word != "-->");
        while let Some(word) = words.next() {
            let mut value = || words.next().map(str::to_owned);
            match word {
                "-p" | "--package" => command.package = value(),
                "--test" => command.program = value(),
                "--lib" => command.lib = true,
                "--ignored" => command.only_ignored = true,
                "--include-ignored" => command.include_ignored = true,
                _ if word.starts_with('-') => {}
                filter => command.filter = filter.to_owned(),
            }
        }
        command
    }

    /// The tests of the program that the command names. Empty if there is no such package or program.
    fn tests(&self) -> Vec<Test> {
        let name = format!("\nname = \"{}\"\n", self.package.as_deref().unwrap_or("sun2xp"));
        let is_named =
            |folder: &PathBuf| fs::read_to_string(folder.join("Cargo.toml")).expect("a manifest").contains(&name);
        let Some(package) = PACKAGES.iter().map(|folder| root().join(folder)).find(is_named) else { return Vec::new() };
        let folder = match &self.program {
            None => package.join("src"),
            Some(program) => package.join("tests").join(program),
        };
        match folder.with_extension("rs") {
            file if file.is_file() => tests_in(&file, ""),
            _ if folder.is_dir() => tests_below(&folder, ""),
            _ => Vec::new(),
        }
    }

    fn runs(&self, test: &Test) -> bool {
        let permitted = self.include_ignored || test.ignored == self.only_ignored;
        permitted && test.path.contains(&self.filter)
    }
}

struct Test {
    /// The modules and the function, as filters see them.
    path: String,
    ignored: bool,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn tests_in(file: &Path, module: &str) -> Vec<Test> {
    let text = fs::read_to_string(file).expect("a source file");
    let tests = text.split("#[test]\n").skip(1).filter_map(|rest| {
        let (attributes, function) = rest.split_once("fn ")?;
        let path = format!("{module}{}", function.split('(').next()?);
        Some(Test { path, ignored: attributes.contains("#[ignore") })
    });
    tests.collect()
}

fn tests_below(folder: &Path, module: &str) -> Vec<Test> {
    let mut tests = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().and_then(|name| name.to_str()).expect("a name").to_owned();
        if path.is_dir() {
            tests.extend(tests_below(&path, &format!("{module}{name}::")));
        } else if path.extension().is_some_and(|end| end == "rs") {
            let own = if matches!(&*name, "main" | "lib" | "mod") { String::new() } else { format!("{name}::") };
            tests.extend(tests_in(&path, &format!("{module}{own}")));
        }
    }
    tests
}

fn pages() -> Vec<PathBuf> {
    let files = FOLDERS.iter().flat_map(|folder| fs::read_dir(root().join(folder)).expect("a folder"));
    let files = files.map(|file| file.expect("a file").path());
    let is_page = |path: &PathBuf| path.extension().is_some_and(|end| end == "md") && !path.ends_with("CHANGELOG.md");
    files.filter(is_page).collect()
}

/// Returns the commands of a page. A command in running text ends with a backquote and may continue on the next line.
/// Any other command ends with its line or with a comment.
fn commands(page: &str) -> Vec<Command> {
    let mut commands = Vec::new();
    for (place, begin) in page.match_indices("cargo test") {
        let (above, rest) = (&page[..place], &page[place + begin.len()..]);
        let line = above.rsplit('\n').next().unwrap_or_default();
        let ends: &[char] = if line.matches('`').count() % 2 == 1 { &['`'] } else { &['`', '#', '\n'] };
        commands.push(Command::read(rest.split(ends).next().unwrap_or_default()));
    }
    commands.retain(|command| command.lib || command.program.is_some());
    commands
}

#[test]
fn every_command_that_runs_tests_runs_at_least_one() {
    let (mut count, mut wrong) = (0, Vec::new());
    for page in pages() {
        for command in commands(&fs::read_to_string(&page).expect("a page")) {
            count += 1;
            if !command.tests().iter().any(|test| command.runs(test)) {
                wrong.push(format!("{}: {command:?} runs no test", page.display()));
            }
        }
    }
    assert!(count > 35, "{count} commands were found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Shows that the test above can fail: it finds a command whose program, filter or ignored test does not exist.
#[test]
fn a_command_that_runs_no_test_is_found() {
    let runs = |page: &str| {
        let found = commands(page);
        assert_eq!(found.len(), 1, "{page:?}: {found:?}");
        found[0].tests().iter().any(|test| found[0].runs(test))
    };
    assert!(runs("The test (`cargo test --test\ndoc_commands runs_no_test -- --nocapture`) is this one."));
    assert!(runs("    SUN2XP_X=1 cargo test -p sun2xp --test doc_commands    # this file\n"));
    assert!(!runs("`cargo test --test doc_commands runs_two_tests`"));
    assert!(!runs("`cargo test --test doc_commands -- --ignored`"));
    assert!(!runs("`cargo test --test no_such_program`"));
    assert!(!runs("`cargo test -p sun2xp-tool --test doc_commands`"));
    assert_eq!(commands("Plain `cargo test` installs nothing, and `cargo test -p sun2xp-models` is quick.").len(), 0);
}
