//! The committed header is what cbindgen makes of the exports. A build script must not write into the source, so a test
//! compares, and writes when asked to.

use std::path::Path;
use std::{env, fs};
use sun2xp::finger::FaultKind;

/// A constant for each fault.
fn faults() -> String {
    let line = |kind: &FaultKind| {
        let told = kind.description();
        format!("#define FAULT_{:<22} {:>2} /* {} */", told.constant, kind.number(), told.name)
    };
    FaultKind::ALL.iter().map(line).collect::<Vec<_>>().join("\n")
}

#[test]
fn the_committed_header_is_the_one_of_the_exports() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("cbindgen.toml can be used");
    let mut made = Vec::new();
    cbindgen::Builder::new()
        .with_config(config)
        .with_src(root.join("src/capi/calls.rs"))
        .with_src(root.join("src/capi/status_calls.rs"))
        .with_src(root.join("src/capi/timing_calls.rs"))
        .with_src(root.join("src/capi/fingertip_calls.rs"))
        .with_src(root.join("src/capi/black_box_calls.rs"))
        .with_src(root.join("src/capi/calibration_calls.rs"))
        .with_src(root.join("src/capi/fault_calls.rs"))
        .with_src(root.join("src/capi/recovery_calls.rs"))
        .generate()
        .expect("the exports can be parsed")
        .write(&mut made);
    let made = String::from_utf8(made).expect("the header is text").replace("@FAULTS@", &faults());

    let committed = root.join("include/Sun2Xp.h");
    if env::var_os("SUN2XP_WRITE_HEADER").is_some() {
        fs::write(&committed, &made).expect("include/Sun2Xp.h can be written");
    }
    assert!(
        fs::read_to_string(&committed).is_ok_and(|text| text == made),
        "include/Sun2Xp.h is stale. To renew it: SUN2XP_WRITE_HEADER=1 cargo test --test header"
    );
}
