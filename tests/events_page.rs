//! `docs/events.md` contains the library's table of event kinds.

use std::path::Path;
use std::{env, fs};
use sun2xp::finger::events::EventKind;

const BEGIN: &str = "<!-- From src/finger/events/table.rs: SUN2XP_WRITE_EVENTS=1 cargo test --test events_page -->\n";
const END: &str = "<!-- End of the table -->";
const HEAD: &str = "| number | `SUN2XP_EVENT_`, Rust | part | values | when it occurs |\n|---|---|---|---|---|\n";

fn table() -> String {
    let mut table = String::from(HEAD);
    for &kind in EventKind::ALL {
        let row = kind.description();
        let values: Vec<&str> = row.values.iter().map(|value| value.words()).collect();
        table += &format!(
            "| {} | `{}`, `{kind:?}` | {} | {} | {} |\n",
            kind.number(),
            row.constant,
            row.part.unwrap_or_default(),
            values.join("; "),
            row.text
        );
    }
    table
}

#[test]
fn the_page_has_the_table_of_the_library() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/events.md");
    let page = fs::read_to_string(&file).expect("docs/events.md");
    let (before, rest) = page.split_once(BEGIN).expect("the beginning of the table");
    let (written, after) = rest.split_once(END).expect("the end of the table");
    let generated = table();
    if env::var_os("SUN2XP_WRITE_EVENTS").is_some() {
        fs::write(&file, format!("{before}{BEGIN}{generated}{END}{after}")).expect("written");
        return;
    }
    assert!(written == generated, "the table is stale: run SUN2XP_WRITE_EVENTS=1 cargo test --test events_page");
}

#[test]
fn numbers_of_events_never_change() {
    assert!(EventKind::ALL.len() >= 17);
    // Programs may have been compiled with the number of any kind. This test checks three numbers. A change of another
    // number also changes the committed page and header.
    for (kind, number) in [(EventKind::Contact, 5), (EventKind::Settled, 12), (EventKind::Fault, 13)] {
        assert_eq!(kind.number(), number);
    }
}
