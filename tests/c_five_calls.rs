//! A planner that knows only the calls of `Sun2Xp.h`: the five calls of 1990, their forms for arrays of double, and
//! HandError. Its own functions, types and constants have names that a library for a hand could use too, such as
//! `GetFault`.

#[allow(dead_code)]
mod c;

use c::{Bench, C_STANDARDS, STRICT, c_compiler, c_compilers, library, root, said};
use std::process::Command;

/// The symbols of the library that such a planner uses.
const KNOWN: &[&str] =
    &["CloseHand", "GetPos", "GetPosD", "HandError", "OpenHand", "SendKx", "SendKxD", "SendPos", "SendPosD"];

/// All other symbols of the library.
fn later_symbols() -> Vec<String> {
    let run = Command::new("nm").args(["-D", "--defined-only"]).arg(library()).output().expect("nm can be started");
    let listing = said(&run);
    let exported = listing.lines().filter_map(|line| line.split_whitespace().nth(2));
    exported.filter(|name| !KNOWN.contains(name)).map(str::to_string).collect()
}

fn uses(text: &str, name: &str) -> bool {
    text.split(|letter: char| !letter.is_alphanumeric() && letter != '_').any(|word| word == name)
}

#[test]
fn all_later_names_have_the_prefix() {
    let later = later_symbols();
    assert!(later.iter().any(|name| name == "sun2xp_stop_all"), "{later:?}");
    assert!(later.iter().all(|name| name.starts_with("sun2xp_")), "{later:?}");
}

#[test]
fn the_names_of_the_planner_compile_in_every_dialect() {
    let bench = Bench::new();
    for compiler in c_compilers() {
        for standard in C_STANDARDS {
            bench.check(compiler, &[STRICT, &[standard]].concat(), "five_calls.c").unwrap_or_else(|e| panic!("{e}"));
        }
    }
}

#[test]
fn the_shared_library_does_not_call_functions_of_the_planner() {
    Bench::new().succeed(STRICT, &["five_calls.c"]);
    // If the library called one of its own exported functions by name, the dynamic linker would bind this call to the
    // planner's function with the same name.
    let run = Command::new("readelf").args(["-r", "-W"]).arg(library()).output().expect("readelf can be started");
    let relocations = said(&run);
    assert!(run.status.success() && uses(&relocations, "pthread_create"), "{relocations}");
    for name in later_symbols() {
        assert!(
            !uses(&relocations, &name),
            "the library refers to its own {name} by name, so the dynamic linker could bind this to a function of the \
             planner. Call the Rust function that {name} calls"
        );
    }
}

#[test]
fn the_static_library_links_beside_functions_of_the_planner() {
    let bench = Bench::new();
    let program = bench.path().join("static");
    let mut compiler = Command::new(c_compiler());
    compiler.arg("-I").arg(root().join("include")).args(["-D_DEFAULT_SOURCE", "-o"]).arg(&program);
    compiler.arg(root().join("tests/c/five_calls.c")).arg(library().with_extension("a"));
    let built = compiler.args(["-lpthread", "-ldl", "-lm"]).output();
    let built = built.expect("the compiler can be started");
    assert!(built.status.success(), "{}", said(&built));
    let run = bench.run(Command::new(&program));
    assert!(run.status.success(), "{}", said(&run));
}
