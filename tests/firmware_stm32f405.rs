//! The firmware for a board with an STM32F405. No emulator supports this processor completely, so the image runs on
//! models of the registers. The tests also compute the timing of the image, and analyze the sources.

#[allow(dead_code)]
#[path = "common/tools.rs"]
mod tools;

use std::path::Path;
use std::process::Command;

const FIRMWARE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/firmware");
const README: &str = include_str!("../firmware/stm32f405/README.md");

/// Runs make in firmware/ and places the products in `folder`. Returns what it prints.
fn make(folder: &Path, arguments: &[&str]) -> String {
    let build = format!("BUILD={}", folder.display());
    let output =
        Command::new("make").args(["--silent", "-C", FIRMWARE, &build]).args(arguments).output().expect("make runs");
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{arguments:?}:\n{printed}{}", String::from_utf8_lossy(&output.stderr));
    printed
}

#[test]
fn the_page_has_the_pins_of_the_source() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let table = make(folder.path(), &["pins"]);
    assert!(README.contains(&table), "firmware/stm32f405/README.md must contain this table:\n{table}");
}

#[test]
fn no_analyzer_finds_anything() {
    let part = "the static analysis of the firmware";
    if !["arm-none-eabi-gcc", "clang"].iter().all(|tool| tools::available(tool, part)) {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    make(folder.path(), &["analyze"]);
}

#[test]
fn the_image_drives_its_pins_and_answers_in_time() {
    let part = "the image on models of its registers";
    if !tools::available("arm-none-eabi-gcc", part) {
        return;
    }
    let Some(python) = tools::python(part) else { return };
    let folder = tempfile::tempdir().expect("a scratch folder");
    let python = format!("PYTHON={}", python.display());
    print!("{}", make(folder.path(), &["model", &python]));
    print!("{}", make(folder.path(), &["timing", &python]));
}
