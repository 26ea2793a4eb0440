//! Tests the public interface of the crate: docs/abi/rust-names lists all names that the crate exports without the
//! feature `internals`, and the example of the crate's page runs. To renew the list:
//! SUN2XP_WRITE_NAMES=1 cargo test --test public_face

use std::fs;
use std::path::{Path, PathBuf};
use syn::{Item, UseTree, Visibility};

/// The file with the committed list of the exported names.
const LIST: &str = "docs/abi/rust-names";

/// Largest number of names that the crate exports without the feature `internals`.
const NAMES: usize = 60;

/// Largest number of names that a public module of one topic exports.
const NAMES_OF_TOPIC: usize = 15;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).into()
}

/// The items of the crate's root, src/lib.rs.
fn items() -> Vec<Item> {
    let page = fs::read_to_string(root().join("src/lib.rs")).expect("the crate's page");
    syn::parse_file(&page).expect("Rust").items
}

/// The names that an item of a topic's module exports.
fn names_of_topic(item: &Item) -> Vec<String> {
    match item {
        Item::Use(item) => names(&item.tree),
        _ => panic!("a module of a topic only re-exports names"),
    }
}

fn names(tree: &UseTree) -> Vec<String> {
    match tree {
        UseTree::Path(path) => names(&path.tree),
        UseTree::Group(group) => group.items.iter().flat_map(names).collect(),
        UseTree::Name(name) => vec![name.ident.to_string()],
        UseTree::Rename(name) => vec![name.rename.to_string()],
        UseTree::Glob(_) => panic!("what a glob exports cannot be listed"),
    }
}

/// The names of the crate's root, and those of the modules of topics, each with its module.
fn exported() -> (Vec<String>, Vec<String>) {
    let (mut at_root, mut of_topics) = (Vec::new(), Vec::new());
    for item in items() {
        match item {
            Item::Use(item) if matches!(item.vis, Visibility::Public(_)) => at_root.extend(names(&item.tree)),
            // A module with a file of its own is public only with the feature. A module in src/lib.rs itself
            // re-exports the names of one topic.
            Item::Mod(item) if matches!(item.vis, Visibility::Public(_)) => match &item.content {
                None => assert!(
                    item.attrs.iter().any(|attribute| attribute.path().is_ident("cfg")),
                    "{} is exported",
                    item.ident
                ),
                Some((_, items)) => {
                    let exported: Vec<String> = items.iter().flat_map(names_of_topic).collect();
                    let count = exported.len();
                    assert!((1..=NAMES_OF_TOPIC).contains(&count), "{}: {count} names", item.ident);
                    of_topics.extend(exported.iter().map(|name| format!("{}::{name}", item.ident)));
                }
            },
            _ => {}
        }
    }
    (at_root, of_topics)
}

#[test]
fn the_public_interface_is_small() {
    let (at_root, _) = exported();
    assert!((20..=NAMES).contains(&at_root.len()), "{} names", at_root.len());
}

#[test]
fn the_public_interface_is_the_listed_one() {
    let (at_root, of_topics) = exported();
    let mut names = [at_root, of_topics].concat();
    names.sort_unstable();
    let names = names.join("\n") + "\n";
    let list = root().join(LIST);
    if std::env::var_os("SUN2XP_WRITE_NAMES").is_some() {
        fs::write(&list, &names).expect("the list can be written");
    }
    let listed = fs::read_to_string(&list).expect("the list");
    assert_eq!(
        names, listed,
        "write a line into CHANGELOG.md, and run SUN2XP_WRITE_NAMES=1 cargo test --test public_face"
    );
}

mod spring {
    include!("../examples/spring.rs");

    pub fn run() -> Result<(), Box<dyn Error>> {
        main()
    }
}

#[test]
fn the_example_of_the_crate_page_runs() {
    spring::run().expect("the simulated hand moves");
}
