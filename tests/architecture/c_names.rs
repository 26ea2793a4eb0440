//! The names of the C interface and the files that use them.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// A function of the C interface whose name is also the name of a type of the Rust library.
const SHARED: &str = "HandError";

/// The constants of the C header, a name and a value in each line.
const CONSTANTS: &str = include_str!("../../docs/abi/constants");

/// Returns the names of the constants of the C header, and of the functions that `folder` exports to C.
pub fn exported(folder: &Path) -> BTreeSet<String> {
    let texts = files(folder).into_iter().map(|file| fs::read_to_string(file).expect("a source file"));
    let names = |text: String| {
        let after = text.split("extern \"C\" fn ").skip(1).map(|rest| rest.split(['(', '<']).next().map(str::to_owned));
        after.flatten().filter(|name| name != SHARED && is_of_c(name)).collect::<Vec<_>>()
    };
    let constants = CONSTANTS.lines().filter_map(|line| line.split(' ').next()).map(str::to_owned);
    texts.flat_map(names).chain(constants).collect()
}

/// Returns whether a function has a name of the C interface. `extern "C"` functions with other names are not exported.
fn is_of_c(name: &str) -> bool {
    name.starts_with(char::is_uppercase) || name.starts_with("sun2xp_")
}

/// Returns the uses of `names` in the files of `folder` except its subfolder `except`: file, line and name.
pub fn used(names: &BTreeSet<String>, folder: &Path, except: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for file in files(folder).into_iter().filter(|file| !file.starts_with(except)) {
        let text = fs::read_to_string(&file).expect("a source file");
        for (index, line) in text.lines().enumerate() {
            let words = line.split(|letter: char| !letter.is_alphanumeric() && letter != '_');
            let of_c = words.filter(|&word| names.contains(word));
            found.extend(of_c.map(|word| format!("{}:{}: {word}", file.display(), index + 1)));
        }
    }
    found
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let below = folders.iter().flat_map(|folder| self::files(folder));
    files.into_iter().filter(|file| file.extension().is_some_and(|end| end == "rs")).chain(below).collect()
}
