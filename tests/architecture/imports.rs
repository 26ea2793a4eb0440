//! Finds the imports of each file.

use crate::crate_tree::{CrateTree, SourceFile, for_tests, from_root, paths};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use syn::visit::{self, Visit};
use syn::{Attribute, Item, ItemFn, ItemMod, ItemUse, Visibility};

/// An import of one file from another.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Import {
    /// The module of the file that imports.
    pub from: String,
    /// The module of the file that defines the name.
    pub to: String,
    /// The path before re-exports are resolved.
    pub path: String,
}

impl fmt::Display for Import {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} -> {} ({})", self.from, self.to, self.path)
    }
}

/// Every import between files of the library. A re-export alone is no import: the import belongs to the file that uses
/// the name.
pub fn all(tree: &CrateTree) -> BTreeSet<Import> {
    tree.files().flat_map(|file| of(file, tree)).collect()
}

fn of(file: &SourceFile, tree: &CrateTree) -> Vec<Import> {
    let mut reader = Reader { module: &file.module, brought: BTreeMap::new(), found: BTreeSet::new() };
    // The imported names are collected first, because a path in the code may begin with one of them.
    for item in &file.items {
        if let Item::Use(import) = item {
            reader.brought.extend(paths(&import.tree, &file.module));
        }
    }
    file.items.iter().for_each(|item| reader.visit_item(item));
    let import = |path: Vec<String>| {
        let to = tree.resolve(&path)?;
        (to != file.module).then(|| Import { from: file.module.join("::"), to: to.join("::"), path: path.join("::") })
    };
    reader.found.into_iter().filter_map(import).collect()
}

struct Reader<'a> {
    module: &'a [String],
    /// Names that the file's `use` lines import.
    brought: BTreeMap<String, Vec<String>>,
    found: BTreeSet<Vec<String>>,
}

impl<'a> Visit<'a> for Reader<'_> {
    fn visit_item_use(&mut self, import: &'a ItemUse) {
        if matches!(import.vis, Visibility::Inherited) {
            // A `use` of a module counts as an import of the module's file. A path such as `module::Name` counts as an
            // import of the file that defines `Name`. That is another file if the module only re-exports `Name`.
            self.found.extend(paths(&import.tree, self.module).into_iter().map(|(_, path)| path));
        }
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        let first = names[0].as_str();
        if matches!(first, "crate" | "super" | "self") {
            self.found.insert(from_root(&names, self.module));
        } else if let Some(brought) = self.brought.get(first) {
            self.found.insert([brought, &names[1..]].concat());
        } else if names.len() > 1 {
            self.found.insert(from_root(&names, self.module));
        }
        visit::visit_path(self, path);
    }

    fn visit_attribute(&mut self, _: &'a Attribute) {}

    // `pub(in ...)` names a module but imports nothing from it.
    fn visit_visibility(&mut self, _: &'a Visibility) {}

    fn visit_item_mod(&mut self, module: &'a ItemMod) {
        if !for_tests(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_item_fn(&mut self, function: &'a ItemFn) {
        if !for_tests(&function.attrs) {
            visit::visit_item_fn(self, function);
        }
    }
}
