//! `include/sun2xp.hpp`: it compiles without a warning in every dialect from C++17 on, and its example runs.

#[allow(dead_code)]
mod c;

use c::{Bench, cpp_compiler, cpp_compilers, root, said};
use std::process::Command;

const STRICT: &[&str] = &["-Wall", "-Wextra", "-Wpedantic", "-Werror"];

fn example() -> String {
    root().join("c_examples/Spring.cpp").to_str().expect("the path is text").to_string()
}

#[test]
fn the_example_compiles_in_every_dialect() {
    let bench = Bench::new();
    for compiler in cpp_compilers() {
        for standard in ["-std=c++17", "-std=c++20", "-std=c++2b"] {
            let flags = [STRICT, &[standard]].concat();
            bench.check(compiler, &flags, &example()).unwrap_or_else(|messages| panic!("{messages}"));
        }
    }
}

#[test]
fn the_example_moves_two_hands() {
    let bench = Bench::new();
    let Some(compiler) = cpp_compiler() else { return };
    let program = bench.build(compiler, &[STRICT, &["-std=c++17"]].concat(), &[&example()]);
    let run = bench.run(Command::new(program));
    assert!(run.status.success(), "{}", said(&run));
    assert!(said(&run).contains("as expected: error"), "{}", said(&run));
}

/// The program has its own versions of some calls, which the header then uses.
#[test]
fn the_header_survives_late_callbacks_and_refused_closes() {
    let Some(compiler) = cpp_compiler() else { return };
    let bench = Bench::new();
    let program = bench.build(compiler, &[STRICT, &["-std=c++17"]].concat(), &["late.cpp"]);
    let run = bench.run(Command::new(program));
    assert!(run.status.success(), "{}", said(&run));
}

/// Uses events, groups, paths and reflexes, and moves a hand to another variable.
#[test]
fn every_part_of_the_header_works() {
    let Some(compiler) = cpp_compiler() else { return };
    let bench = Bench::new();
    let program = bench.build(compiler, &[STRICT, &["-std=c++17"]].concat(), &["parts.cpp"]);
    let run = bench.run(Command::new(program));
    assert!(run.status.success(), "{}", said(&run));
}
