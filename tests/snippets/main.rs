//! Every snippet of README and of the pages in docs is tested. The files beside this one compile and run the snippets
//! in C and Rust, and read the snippets in TOML as the library reads a configuration. Other tests run the snippets in
//! Python (python/tests/test_examples.py, ros/tests/test_node.py), and the snippets of docs/remote.md in Rust and
//! Python (serve/tests/network/snippets.rs, python/tests/test_remote_serve.py). `LANGUAGES` names the tests of the
//! blocks that are not code.

#[allow(dead_code)]
#[path = "../c/mod.rs"]
mod c;
mod in_c;
mod in_rust;
mod in_toml;
mod pages;

use pages::{Page, pages};

/// The languages of the fenced blocks. `hex` blocks are frames of the board protocol (tests/board_protocol_page.rs),
/// and `text` blocks quote errors (tests/faq.rs).
const LANGUAGES: [&str; 6] = ["c", "hex", "python", "rust", "text", "toml"];

/// Texts that only code contains. Commands do not contain them, so commands may be indented, as in the section `See it
/// move` of README (tool/tests/readme.rs).
const CODE: [&str; 6] = ["#include", "let ", "?;", "import ", "if (", "sun2xp_send"];

#[test]
fn every_block_has_a_language_and_code_is_in_a_block() {
    let pages = pages();
    let languages: Vec<&str> = pages.iter().flat_map(Page::blocks).map(|block| block.language).collect();
    for language in LANGUAGES {
        assert!(languages.contains(&language), "no block in {language} was found");
    }
    let unknown: Vec<_> = languages.iter().filter(|language| !LANGUAGES.contains(language)).collect();
    assert!(unknown.is_empty(), "no test reads blocks in {unknown:?}");
    for page in &pages {
        let code = page.indented().find(|line| CODE.iter().any(|code| line.contains(code)));
        assert_eq!(code, None, "{}: put this code into a block with its language", page.name);
    }
}
