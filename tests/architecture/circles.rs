//! Finds files that import each other in a circle.

use crate::imports::Import;
use std::collections::{BTreeMap, BTreeSet};

/// Returns one text for each set of files that all reach each other, listing the imports between them.
pub fn find(imports: &BTreeSet<Import>) -> Vec<String> {
    let mut next: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for import in imports {
        next.entry(&import.from).or_default().insert(&import.to);
    }
    let reached: BTreeMap<&str, BTreeSet<&str>> = next.keys().map(|&file| (file, reach(file, &next))).collect();
    let tied = |one: &str, other: &str| {
        reached.get(one).is_some_and(|files| files.contains(other))
            && reached.get(other).is_some_and(|files| files.contains(one))
    };
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    for &file in reached.keys() {
        if !tied(file, file) || !seen.insert(file) {
            continue;
        }
        let circle: BTreeSet<&str> = reached.keys().copied().filter(|other| tied(file, other)).collect();
        seen.extend(&circle);
        let ties = imports.iter().filter(|import| circle.contains(&*import.from) && circle.contains(&*import.to));
        found.push(ties.map(ToString::to_string).collect::<Vec<_>>().join("\n"));
    }
    found
}

/// All files that the file `from` imports, directly or through other files.
fn reach<'a>(from: &'a str, next: &BTreeMap<&'a str, BTreeSet<&'a str>>) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut open = vec![from];
    while let Some(file) = open.pop() {
        open.extend(next.get(file).into_iter().flatten().copied().filter(|file| reached.insert(*file)));
    }
    reached
}
