//! The pages and their blocks.

use std::fs;
use std::path::{Path, PathBuf};

/// A page of the documentation.
pub struct Page {
    pub name: String,
    text: String,
}

/// A block between lines with three backquotes.
pub struct Block<'page> {
    pub page: &'page str,
    /// The word after the first backquotes. If it is `hex`, the name of the frame follows it on the same line.
    pub language: &'page str,
    pub text: &'page str,
}

/// Returns README.md, python/README.md and the pages of docs.
pub fn pages() -> Vec<Page> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = fs::read_dir(root.join("docs")).expect("a folder").map(|file| file.expect("a file").path());
    let pages = docs.filter(|path| path.extension().is_some_and(|end| end == "md"));
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        Page { name: path.strip_prefix(root).unwrap_or(&path).display().to_string(), text }
    };
    [root.join("README.md"), root.join("python/README.md")].into_iter().chain(pages).map(read).collect()
}

impl Page {
    pub fn blocks(&self) -> impl Iterator<Item = Block<'_>> {
        self.text.split("\n```").skip(1).step_by(2).map(|block| {
            let (first, text) = block.split_once('\n').unwrap_or_else(|| panic!("{}: a block without end", self.name));
            let language = first.split_whitespace().next().unwrap_or_default();
            Block { page: &self.name, language, text }
        })
    }

    /// The lines of indented blocks.
    pub fn indented(&self) -> impl Iterator<Item = &str> {
        self.text.split("\n```").step_by(2).flat_map(str::lines).filter_map(|line| line.strip_prefix("    "))
    }
}

/// Returns the blocks in a language, each with the name of its page.
pub fn in_language<'page>(pages: &'page [Page], language: &str) -> Vec<Block<'page>> {
    pages.iter().flat_map(Page::blocks).filter(|block| block.language == language).collect()
}
