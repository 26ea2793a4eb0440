//! The files of a crate: the module of each, the items it defines, and the names it re-exports.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use syn::{Attribute, Item, UseTree, Visibility};

/// One source file.
pub struct SourceFile {
    /// Path of the file's module, from the root of the crate.
    pub module: Vec<String>,
    /// The items, without those that are compiled for tests only.
    pub items: Vec<Item>,
    /// Names of the defined items.
    defined: Vec<String>,
    /// Names of the re-exported items, with the paths that they stand for.
    exported: BTreeMap<String, Vec<String>>,
}

/// All source files of a crate, by module.
pub struct CrateTree(BTreeMap<Vec<String>, SourceFile>);

impl CrateTree {
    /// Reads every file below the folder of the crate's root.
    pub fn read(root: &Path) -> Self {
        let modules = rust_files(root).into_iter().map(|path| {
            let module = module_of(path.strip_prefix(root).expect("it is below the root"));
            (module.clone(), SourceFile::read(&path, module))
        });
        Self(modules.collect())
    }

    /// The files in the order of their modules.
    pub fn files(&self) -> impl Iterator<Item = &SourceFile> {
        self.0.values()
    }

    /// Resolves re-exports and returns the module that defines the item at a path from the crate's root. A path to
    /// another crate resolves to the module of the file that contains the path (see [`from_root`]). If this file is the
    /// crate's root, the path resolves to `None`.
    pub fn resolve(&self, path: &[String]) -> Option<Vec<String>> {
        let depth = (0..=path.len()).rev().find(|&depth| self.0.contains_key(&path[..depth]))?;
        let file = &self.0[&path[..depth]];
        match path.get(depth) {
            None => Some(file.module.clone()),
            Some(name) if file.defined.contains(name) => Some(file.module.clone()),
            Some(name) => match file.exported.get(name) {
                Some(target) => self.resolve(&[target, &path[depth + 1..]].concat()),
                None => (depth > 0).then(|| file.module.clone()),
            },
        }
    }
}

impl SourceFile {
    fn read(path: &Path, module: Vec<String>) -> Self {
        let text = fs::read_to_string(path).expect("a source file");
        let syntax = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let items: Vec<Item> = syntax.items.into_iter().filter(|item| !for_tests(attributes(item))).collect();
        let mut exported = BTreeMap::new();
        for item in &items {
            if let Item::Use(import) = item
                && !matches!(import.vis, Visibility::Inherited)
            {
                for (name, target) in paths(&import.tree, &module) {
                    exported.insert(name, target);
                }
            }
        }
        let defined = items.iter().filter_map(name_of).collect();
        Self { module, items, defined, exported }
    }
}

/// The names that a `use` in `module` imports, with their paths from the crate's root. A path to another crate cannot
/// be distinguished from a path below `module`, so it gets the path of `module` in front.
pub fn paths(tree: &UseTree, module: &[String]) -> Vec<(String, Vec<String>)> {
    fn walk(tree: &UseTree, before: &[String], found: &mut Vec<(String, Vec<String>)>) {
        let with = |name: &dyn ToString| [before, &[name.to_string()]].concat();
        match tree {
            UseTree::Path(path) => walk(&path.tree, &with(&path.ident), found),
            UseTree::Name(name) if name.ident == "self" => {
                found.push((before.last().expect("a path").clone(), before.to_vec()));
            }
            UseTree::Name(name) => found.push((name.ident.to_string(), with(&name.ident))),
            UseTree::Rename(name) => found.push((name.rename.to_string(), with(&name.ident))),
            UseTree::Glob(_) => found.push(("*".into(), before.to_vec())),
            UseTree::Group(group) => group.items.iter().for_each(|tree| walk(tree, before, found)),
        }
    }
    let mut found = Vec::new();
    walk(tree, &[], &mut found);
    found.into_iter().map(|(name, path)| (name, from_root(&path, module))).collect()
}

/// Converts a path, as it is written in the file of `module`, to a path from the crate's root. A path that begins with
/// neither `crate`, `super` nor `self` may name a module below `module`, so it is resolved from `module`.
pub fn from_root(path: &[String], module: &[String]) -> Vec<String> {
    let mut at = module.to_vec();
    for (place, name) in path.iter().enumerate() {
        match name.as_str() {
            "crate" => at.clear(),
            "super" => drop(at.pop()),
            "self" => {}
            _ => return [&at, &path[place..]].concat(),
        }
    }
    at
}

/// The Rust files below a folder, without build products.
pub fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() && !path.ends_with("target") {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// Returns whether an item is compiled for tests only.
pub fn for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute.meta.require_list().is_ok_and(|list| list.tokens.to_string() == "test")
    })
}

fn module_of(path: &Path) -> Vec<String> {
    let mut parts: Vec<String> =
        path.with_extension("").iter().map(|part| part.to_str().expect("ASCII").to_owned()).collect();
    if matches!(parts.last().map(String::as_str), Some("mod" | "lib" | "main")) {
        parts.pop();
    }
    parts
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Mod(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        _ => &[],
    }
}

fn name_of(item: &Item) -> Option<String> {
    let name = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Macro(item) => item.ident.as_ref()?,
        _ => return None,
    };
    Some(name.to_string())
}
