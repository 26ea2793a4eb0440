//! Lists what this run of `cargo test` has left out because tools are missing. Test programs run in alphabetical order,
//! so this one is the last. It does not use libtest: a filter of test names would skip it, and its output would be
//! captured.

#[allow(dead_code)]
#[path = "common/tools.rs"]
mod tools;

fn main() {
    // nextest queries the tests of every program. This one has none.
    if std::env::args().any(|argument| argument == "--list") {
        return;
    }
    let left_out = tools::take_left_out(std::os::unix::process::parent_id());
    if left_out.is_empty() {
        println!("\nNo test was left out because of a missing tool.\n");
        return;
    }
    println!("\nLeft out, because tools are missing (tests/run installs them and leaves nothing out):\n");
    for line in left_out {
        println!("    {line}");
    }
    println!();
}
