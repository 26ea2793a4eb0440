//! Lists what this run of `cargo test` has skipped, for example because a tool is missing. Cargo runs the test programs
//! of a package in alphabetical order, so this program runs last. The library and the tool both have it. Each copy
//! lists the tests that were skipped since the other copy ran. This program does not use libtest: a filter of test
//! names would skip it, and its output would be captured.

#[allow(dead_code)]
#[path = "common/tools.rs"]
mod tools;

fn main() {
    // nextest queries the tests of every program. This one has none.
    if std::env::args().any(|argument| argument == "--list") {
        return;
    }
    let skipped = tools::take_skipped(std::os::unix::process::parent_id());
    let package = env!("CARGO_PKG_NAME");
    if skipped.is_empty() {
        println!("\nNo test of {package} was skipped.\n");
        return;
    }
    println!("\nSkipped in {package} (tests/run installs missing tools):\n");
    for line in skipped {
        println!("    {line}");
    }
    println!();
}
