//! Tests that the library accepts the snippets of configuration files in the documentation.

use crate::pages::{in_language, pages};
use sun2xp::hand::Configured;

#[test]
fn every_snippet_of_a_configuration_is_accepted() {
    let pages = pages();
    let blocks = in_language(&pages, "toml");
    assert!(blocks.len() >= 15, "{} snippets were found", blocks.len());
    for block in blocks {
        if let Err(error) = Configured::from_text(block.text) {
            panic!("{}: {error}\n{}", block.page, block.text);
        }
    }
}
