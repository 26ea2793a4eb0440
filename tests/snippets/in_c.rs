//! The snippets in C. The test makes a complete program of each snippet. The program must not fail.

use crate::c::{Bench, C_STANDARDS, STRICT, c_compiler, c_compilers, said};
use crate::pages::{Block, in_language, pages};
use std::process::Command;

/// Returns a program that consists of the snippet and what it needs. It fails if a call of the snippet is refused.
fn program(block: &Block) -> String {
    let (includes, statements): (Vec<&str>, Vec<&str>) = block.text.lines().partition(|line| line.starts_with('#'));
    let (opening, closing) = if statements.iter().any(|line| line.contains("OpenHand()")) {
        ("", "HandError()[0] != '\\0' || CloseHand() != 0")
    } else {
        (
            "sun2xp_hand *hand; if (sun2xp_open(NULL, &hand) != 0) return 2;",
            "sun2xp_error_text(NULL)[0] != '\\0' || sun2xp_close(hand) != 0",
        )
    };
    let header = if opening.is_empty() { "" } else { "#include \"sun2xp.h\"\n" };
    format!(
        "#include <stddef.h>\n{header}{}\nint main(void)\n{{\n{opening}\n{{\n{}\n}}\nreturn {closing};\n}}\n",
        includes.join("\n"),
        statements.join("\n"),
    )
}

#[test]
fn every_snippet_in_c_compiles_and_runs() {
    let pages = pages();
    let blocks = in_language(&pages, "c");
    assert!(blocks.len() >= 3, "{} snippets were found", blocks.len());
    let bench = Bench::new();
    bench.write("sun2xp.toml", "[finger]\nport = \"simulated\"\n");
    for block in blocks {
        let text = program(&block);
        let source = bench.write("snippet.c", &text);
        for compiler in c_compilers() {
            for standard in [C_STANDARDS[0], C_STANDARDS[C_STANDARDS.len() - 1]] {
                let checked = bench.check(compiler, &[STRICT, &[standard]].concat(), &source);
                checked.unwrap_or_else(|messages| panic!("{}:\n{messages}\n{text}", block.page));
            }
        }
        let run = bench.run(Command::new(bench.build(c_compiler(), STRICT, &[&source])));
        assert!(run.status.success(), "{}: {}\n{}\n{text}", block.page, run.status, said(&run));
    }
}
