//! The rules of docs/architecture.md: imports run downward only, no files import each other in a circle, not even
//! through re-exports, and files, functions and lines are short. tests/tools.txt lists the programs that tests start.

mod c_names;
mod circles;
mod crate_tree;
mod imports;
mod limits;
mod named_files;
mod programs;
mod set_point;

use crate_tree::CrateTree;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The folders of the library from the top down. A file imports from its own folder and from lower ones.
const LAYERS: [&[&str]; 10] = [
    &["capi"],
    &["hand"],
    &["telemetry"],
    &["finger"],
    &["calibration", "simulated", "stability"],
    &["board", "control"],
    &["plant"],
    &["realtime"],
    &["files"],
    &["model"],
];

fn library() -> CrateTree {
    CrateTree::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"))
}

#[test]
fn every_folder_is_in_a_layer() {
    let tree = library();
    let folders: BTreeSet<&str> = tree.files().filter_map(|file| file.module.first().map(String::as_str)).collect();
    assert_eq!(folders, LAYERS.concat().into_iter().collect());
}

#[test]
fn only_the_c_interface_uses_its_names() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let names = c_names::exported(&source.join("capi"));
    let of_every_kind = ["OpenHand", "sun2xp_recover", "SUN2XP_WAIT_SETTLED"];
    assert!(of_every_kind.iter().all(|name| names.contains(*name)), "{names:?}");
    let found = c_names::used(&names, &source, &source.join("capi"));
    assert!(found.is_empty(), "names of the C interface in the Rust layers:\n{}", found.join("\n"));
    assert!(!c_names::used(&names, &source, &source.join("hand")).is_empty(), "the C interface uses its own names");
}

#[test]
fn imports_run_downward() {
    let layer = |folder: &str| LAYERS.iter().position(|layer| layer.contains(&folder)).expect("it is in a layer");
    let upward: Vec<String> = imports::all(&library())
        .into_iter()
        .filter_map(|import| {
            let (from, to) = (import.from.split("::").next()?, import.to.split("::").next()?);
            let allowed = from.is_empty() || to.is_empty() || from == to || layer(from) < layer(to);
            (!allowed).then(|| import.to_string())
        })
        .collect();
    assert!(upward.is_empty(), "imports that do not run downward:\n{}", upward.join("\n"));
}

#[test]
fn the_core_imports_only_the_model() {
    let imports = imports::all(&library());
    let of_core = imports.iter().filter(|import| import.from.starts_with("control::"));
    let others: Vec<String> = of_core
        .filter(|import| !["control", "model"].contains(&import.to.split("::").next().unwrap_or_default()))
        .map(ToString::to_string)
        .collect();
    assert!(others.is_empty(), "imports of the core from other layers:\n{}", others.join("\n"));
}

#[test]
fn every_file_that_the_page_names_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("docs/architecture.md")).expect("the page");
    assert!(named_files::named(&page).len() > 80, "the page names its files in backticks");
    let missing = named_files::missing(root, &page);
    assert!(missing.is_empty(), "docs/architecture.md names files that do not exist:\n{}", missing.join("\n"));
    assert_eq!(
        named_files::missing(root, "`src/nowhere.rs`, `nowhere/`, `hand/root.rs`"),
        ["nowhere/", "src/nowhere.rs"]
    );
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let found = circles::find(&imports::all(&library()));
    assert!(found.is_empty(), "circles of files:\n{}", found.join("\n\n"));
}

/// The generated headers do not count as source files. Markdown, TOML and other texts do not count either.
#[test]
fn files_functions_and_lines_are_short() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let found: Vec<String> = limits::source_files(root)
        .into_iter()
        .filter(|path| !["include/Sun2Xp.h", "include/sun2xp.h"].iter().any(|header| path.ends_with(header)))
        .flat_map(|path| {
            let text = fs::read_to_string(&path).expect("a source file");
            limits::exceeded(path.strip_prefix(root).expect("it is below the root"), &text)
        })
        .collect();
    assert!(found.is_empty(), "beyond the limits:\n{}", found.join("\n"));
}

#[test]
fn a_file_a_function_or_a_line_beyond_its_limit_is_found() {
    let found = |name: &str, text: &str| limits::exceeded(Path::new(name), text);
    assert!(found("one.rs", &"// A line.\n".repeat(300)).is_empty());
    assert_eq!(found("one.rs", &"// A line.\n".repeat(301)), ["one.rs: 301 lines"]);
    assert!(found("one.c", &"x".repeat(120)).is_empty());
    assert_eq!(found("one.c", &"x".repeat(121)), ["one.c:1: 121 columns"]);
    assert_eq!(found("one.py", &"x".repeat(121)), ["one.py:1: 121 columns"]);
    for (name, begin, indentation) in [
        ("one.rs", "    pub(crate) const unsafe extern \"C\" fn long(\n        x: X,\n    ) {", "    "),
        ("one.rs", "async fn long() {", ""),
        ("one.c", "static int long(int one,\n                int other)\n{", ""),
    ] {
        let function = |lines: usize| {
            format!("\n{begin}\n{}{indentation}}}\n", "        x;\n".repeat(lines - begin.lines().count() - 1))
        };
        assert!(found(name, &function(60)).is_empty(), "{begin}");
        assert_eq!(found(name, &function(61)), [format!("{name}:2: a function of 61 lines")], "{begin}");
    }
}

#[test]
fn a_set_point_passes_through_few_files_and_changes_its_shape_twice() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (text, stations) = set_point::read(root);
    for set_point::Station { file, function, .. } in &stations {
        let source = fs::read_to_string(root.join("src").join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
        let defined = [format!("fn {function}("), format!("fn {function}<")];
        assert!(defined.iter().any(|definition| source.contains(definition)), "{file} has no function {function}");
    }
    let files: BTreeSet<&str> = stations.iter().map(|station| station.file.as_str()).collect();
    let changes = stations.windows(2).filter(|pair| pair[0].shape != pair[1].shape).count();
    assert!((10..=20).contains(&files.len()) && changes <= 2, "{} files, {changes} changes of shape", files.len());
    let counted = format!("passes through {} files and changes its shape {changes} times", files.len());
    assert!(text.contains(&counted), "the page does not say that a set point {counted}");
}

#[test]
fn no_field_is_left_out_of_a_message() {
    // Messages of telemetry contain types from all folders of the library. The format of the messages, postcard, has no
    // names of fields, so a field that is left out makes the rest unreadable.
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let found: Vec<String> = limits::source_files(&source)
        .into_iter()
        .filter(|path| fs::read_to_string(path).expect("a source file").contains("skip_serializing"))
        .map(|path| path.display().to_string())
        .collect();
    assert!(found.is_empty(), "skip_serializing in {found:?}");
}

/// `tests/run` installs only the programs that are listed. A test that needs another program fails on a bare machine.
/// Benchmarks may need more programs.
#[test]
fn every_program_that_a_test_starts_is_listed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let listed = programs::listed(include_str!("../tools.txt"));
    let mut started = BTreeSet::new();
    let mut missing = Vec::new();
    for path in limits::source_files(root) {
        let file = path.strip_prefix(root).expect("it is below the root").display();
        if path.extension().is_none_or(|end| end != "rs") || path.iter().any(|folder| folder == "benches") {
            continue;
        }
        let programs = programs::started(&fs::read_to_string(&path).expect("a source file"));
        let known = |program: &str| listed.contains(program) || programs::ALWAYS_THERE.contains(&program);
        missing.extend(programs.iter().filter(|program| !known(program)).map(|program| format!("{file}: {program}")));
        started.extend(programs);
    }
    assert!(missing.is_empty(), "not in tests/tools.txt:\n{}", missing.join("\n"));
    let useless: Vec<_> = programs::ALWAYS_THERE.iter().filter(|program| !started.contains(**program)).collect();
    assert!(useless.is_empty(), "no test starts {useless:?}");
    let found = ["chromedriver", "gcc", "ip", "make", "qemu-system-arm", "readelf", "spin", "tmux"];
    assert!(found.iter().all(|program| started.contains(*program)), "{started:?}");
}

#[test]
fn programs_are_found_wherever_a_source_names_them() {
    for source in [
        "fn start() { std::process::Command::new(\"prog\").spawn(); }",
        "fn start() { assert!(Command::new(\"prog\").status().is_ok(), \"text\"); }",
        "fn start() { let run = Program::new(\"/bin/prog\"); }",
        "const NAME: &str = \"prog\"; fn start() { Command::new(NAME); }",
        "fn run(name: &str) { Command::new(name); } fn start() { run(\"prog\"); }",
        "fn start() { let run = |name: &str, more: u8| Command::new(&name); run(\"prog\", 1); }",
        "impl X { fn run(&self, more: u8, name: &str) { Command::new(name); } \
         fn go(&self, name: &str) { self.run(1, name); } } fn start(x: X) { x.go(\"prog\"); }",
    ] {
        assert_eq!(programs::started(source), BTreeSet::from(["prog".to_owned()]), "{source}");
    }
    let other =
        "fn start(path: &Path) { Command::new(path).arg(\"word\"); FingerCommand::new(\"word\"); run(\"word\"); }";
    assert_eq!(programs::started(other), BTreeSet::new());
    let tools = "# name | packages | probe\none | package | one -V && two -V\n";
    assert_eq!(programs::listed(tools), BTreeSet::from(["one".to_owned(), "two".to_owned()]));
}
