//! The files that a page of the documentation names in backticks.

use std::collections::BTreeSet;
use std::path::Path;

/// Returns the paths that the page names: words in backticks that contain a slash and no space.
pub fn named(page: &str) -> BTreeSet<&str> {
    let quoted = page.lines().flat_map(|line| line.split('`').skip(1).step_by(2));
    quoted.filter(|word| word.contains('/') && !word.contains(' ')).collect()
}

/// Returns the named paths that exist neither below the root nor below `src/`.
pub fn missing<'a>(root: &Path, page: &'a str) -> Vec<&'a str> {
    let exists = |path: &str| root.join(path).exists() || root.join("src").join(path).exists();
    named(page).into_iter().filter(|path| !exists(path)).collect()
}
