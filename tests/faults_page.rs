//! `docs/faults.md` contains the table of faults of the library, with the remedies as sun2xp_fault_text returns them.

use std::ffi::{CStr, c_char, c_int};
use std::path::Path;
use std::{env, fs};
use sun2xp::finger::{FaultKind, Severity};

const BEGIN: &str = "<!-- From src/finger/faults/table.rs: SUN2XP_WRITE_FAULTS=1 cargo test --test faults_page -->\n";
const END: &str = "<!-- End of the table -->";
const HEAD: &str = "| number | `SUN2XP_FAULT_` | effect on the finger | part, value | what | likely cause | remedy |\n\
                    |---|---|---|---|---|---|---|\n";

unsafe extern "C" {
    safe fn sun2xp_fault_text(number: c_int) -> *const c_char;
}

/// The remedy of a kind of fault as sun2xp_fault_text returns it: with the names of the C calls.
fn remedy(kind: FaultKind) -> String {
    // SAFETY: sun2xp_fault_text returns a string that is valid as long as the process runs.
    let text = unsafe { CStr::from_ptr(sun2xp_fault_text(kind.number().into())) }.to_str().expect("UTF-8");
    let row = kind.description();
    let before = format!("{}: {}. Likely cause: {}. ", row.name, row.text, row.cause);
    text.strip_prefix(&before).unwrap_or_else(|| panic!("{text:?} does not begin with {before:?}")).to_string()
}

fn table() -> String {
    let mut table = String::from(HEAD);
    for &kind in FaultKind::ALL {
        let row = kind.description();
        let effect = match row.severity {
            Severity::Fault => "stops",
            Severity::Warning => "continues",
            Severity::Refusal => "OpenHand fails",
            other => panic!("the table has no word for {other:?}"),
        };
        let place: Vec<&str> = row.part.word().into_iter().chain(row.quantity.words()).collect();
        table += &format!(
            "| {} | `{}` | {effect} | {} | {}: {} | {} | {} |\n",
            kind.number(),
            row.constant,
            place.join(", "),
            row.name,
            row.text,
            row.cause,
            remedy(kind)
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
    let generated = table();
    if env::var_os("SUN2XP_WRITE_FAULTS").is_some() {
        fs::write(&file, format!("{before}{BEGIN}{generated}{END}{after}")).expect("written");
        return;
    }
    assert!(written == generated, "the table is stale: run SUN2XP_WRITE_FAULTS=1 cargo test --test faults_page");
}

/// sun2xp_fault_text promises a cause and a remedy. A reader who has only this text cannot follow a reference to
/// another text.
#[test]
fn causes_and_remedies_are_not_only_references_to_another_text() {
    for kind in FaultKind::ALL {
        let row = kind.description();
        assert!(!row.cause.starts_with("the cause that"), "{kind:?}: {}", row.cause);
        assert!(!row.remedy.starts_with("Follow "), "{kind:?}: {}", row.remedy);
    }
}

#[test]
fn numbers_of_faults_never_change() {
    assert!(FaultKind::ALL.len() >= 49);
    // Three numbers that programs may have been compiled with. The committed page and header contain the other numbers.
    for (kind, number) in [(FaultKind::BrokenTendon, 2), (FaultKind::Watchdog, 16), (FaultKind::WarmMotor, 45)] {
        assert_eq!(kind.number(), number);
    }
}
