//! Compares the table of `docs/faults.md` with the library's.

use std::path::Path;
use std::{env, fs};
use sun2xp::finger::{FaultKind, Severity};

const BEGIN: &str = "<!-- From src/finger/faults/table.rs: SUN2XP_WRITE_FAULTS=1 cargo test --test faults_page -->\n";
const END: &str = "<!-- End of the table -->";

fn table() -> String {
    let mut table = String::from(
        "| number | `FAULT_` | what becomes of the finger | part, value | what | likely cause | remedy |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for kind in FaultKind::ALL {
        let told = kind.description();
        let fate = match told.severity {
            Severity::Fault => "stops",
            Severity::Warning => "goes on",
            Severity::Refusal => "OpenHand refuses",
        };
        let place: Vec<&str> = told.part.word().into_iter().chain(told.quantity.words()).collect();
        table += &format!(
            "| {} | `{}` | {fate} | {} | {}: {} | {} | {} |\n",
            kind.number(),
            told.constant,
            place.join(", "),
            told.name,
            told.text,
            told.cause,
            told.remedy
        );
    }
    table
}

#[test]
fn the_page_has_the_table_of_the_library() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/faults.md");
    let page = fs::read_to_string(&file).expect("docs/faults.md");
    let (before, rest) = page.split_once(BEGIN).expect("the beginning of the table");
    let (written, after) = rest.split_once(END).expect("the end of the table");
    let made = table();
    if env::var_os("SUN2XP_WRITE_FAULTS").is_some() {
        fs::write(&file, format!("{before}{BEGIN}{made}{END}{after}")).expect("written");
        return;
    }
    assert!(written == made, "stale. To renew it: SUN2XP_WRITE_FAULTS=1 cargo test --test faults_page");
}

#[test]
fn there_are_thirty_and_more_and_old_numbers_stand() {
    assert!(FaultKind::ALL.len() >= 30);
    // Some of the numbers that compiled programs may contain. The page and the header fix the others.
    for (kind, number) in [(FaultKind::BrokenTendon, 2), (FaultKind::Watchdog, 16), (FaultKind::WarmMotor, 45)] {
        assert_eq!(kind.number(), number);
    }
}
