//! The shared library and the static library.

use crate::c::{Bench, STRICT, c_compiler, library, root, said};
use std::collections::HashMap;
use std::fs;
use std::process::Command;

#[test]
fn the_static_library_serves_too() {
    let bench = Bench::new();
    let archive = library().with_extension("a");
    let program = bench.path().join("static");
    let mut compiler = Command::new(c_compiler());
    compiler.arg("-I").arg(root().join("include")).args(["-D_DEFAULT_SOURCE", "-o"]).arg(&program);
    compiler.arg(root().join("tests/c/closed.c")).arg(&archive).args(["-lpthread", "-ldl", "-lm"]);
    let built = compiler.output().expect("the compiler can be started");
    assert!(built.status.success(), "{}", said(&built));
    let run = bench.run(Command::new(&program));
    assert!(run.status.success(), "{}", said(&run));
}

/// Returns the addresses and names of what the library exports. Several names may have one address.
fn exported_functions() -> Vec<(u64, String)> {
    let run = Command::new("nm").args(["-D", "--defined-only"]).arg(library()).output().expect("nm can be started");
    let listed = |line: &str| {
        let mut words = line.split_whitespace();
        let address = u64::from_str_radix(words.next()?, 16).ok()?;
        Some((address, words.nth(1)?.to_owned()))
    };
    said(&run).lines().filter_map(listed).collect()
}

#[test]
fn the_library_exports_the_calls_and_nothing_else() {
    let mut exported: Vec<_> = exported_functions().into_iter().map(|(_, name)| name).collect();
    exported.sort_unstable();
    // The headers declare every call at the beginning of a line.
    let read = |name: &str| fs::read_to_string(root().join("include").join(name)).expect("a header");
    let headers = read("Sun2Xp.h") + &read("sun2xp.h");
    let called = |line: &str| {
        let types = ["int ", "const char *", "unsigned int ", "sun2xp_hand *"];
        let declared = types.into_iter().find_map(|of| line.strip_prefix(of))?;
        declared.split_once('(').map(|(name, _)| name.to_string())
    };
    let mut calls: Vec<_> = headers.lines().filter_map(called).collect();
    calls.sort_unstable();
    assert!(
        ["CloseHand", "GetPos", "OpenHand", "SendKx", "SendPos"]
            .iter()
            .all(|call| exported.iter().any(|name| name == call))
    );
    assert_eq!(exported, calls);
}

/// A thread with asynchronous cancellation may be unwound from the frame of the call that it has made. If this frame
/// had a landing pad, the unwinder would end the process. The FDE of a function gives the place of its landing pads, or
/// 0 if it has none.
#[test]
fn no_frame_of_a_call_has_a_landing_pad() {
    let calls: HashMap<u64, String> = exported_functions().into_iter().collect();
    let mut readelf = Command::new("readelf");
    readelf.args(["-W", "--debug-dump=frames"]).arg(library()).env("LC_ALL", "C");
    let run = readelf.output().expect("readelf can be started");
    let frames = String::from_utf8_lossy(&run.stdout).into_owned();
    let (mut seen, mut with_landing_pad, mut call) = (0, Vec::new(), None);
    for line in frames.lines() {
        if let Some((_, range)) = line.split_once(" FDE cie=").and_then(|(_, rest)| rest.split_once("pc=")) {
            let begin = range.split_once("..").and_then(|(begin, _)| u64::from_str_radix(begin, 16).ok());
            call = begin.and_then(|begin| calls.get(&begin));
            seen += usize::from(call.is_some());
        } else if line.contains(" CIE") {
            call = None;
        } else if let (Some(call), Some(data)) = (call, line.trim().strip_prefix("Augmentation data:"))
            && data.bytes().any(|digit| digit.is_ascii_hexdigit() && digit != b'0')
        {
            with_landing_pad.push(call);
        }
    }
    assert!(seen > 50 && seen == calls.len(), "{seen} calls of {}", calls.len());
    assert!(with_landing_pad.is_empty(), "{with_landing_pad:?}");
}

#[test]
fn the_library_has_its_name_and_stays_loaded() {
    let run = Command::new("readelf").args(["-d", "-W"]).arg(library()).output().expect("readelf can be started");
    let dynamic = said(&run);
    assert!(dynamic.contains("[libsun2xp.so.0]"), "{dynamic}");
    assert!(dynamic.contains("NODELETE"), "{dynamic}");
}

/// The calls of libsun2xp_remote that `stub_remote.c` does not have, and that `stub_planner.c` does not need.
const UNUSED: [&str; 17] = [
    "error",
    "open",
    "send_position",
    "send_stiffness",
    "send_tip",
    "send_damping",
    "tip",
    "status",
    "limits",
    "fault",
    "stop",
    "recover",
    "zero",
    "identify",
    "wait",
    "next_event",
    "wait_event",
];

#[test]
fn calls_for_a_hand_of_another_machine_reach_the_loaded_library() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), &[STRICT, &["-std=c99"]].concat(), &["stub_planner.c"]);
    let unused = UNUSED.map(|call| format!("int sun2xp_{call}(void) {{ return -1; }}\n")).concat();
    let unused = bench.write("unused.c", &unused);
    fs::create_dir(bench.path().join("sun2xp-remote")).expect("a folder");
    let mut compiler = Command::new(c_compiler());
    compiler.args(["-shared", "-fPIC", "-I"]).arg(root().join("include"));
    compiler.arg("-o").arg(bench.path().join("sun2xp-remote/libsun2xp_remote.so.0"));
    let built = compiler.arg(root().join("tests/c/stub_remote.c")).arg(unused).output().expect("the compiler runs");
    assert!(built.status.success(), "{}", said(&built));
    let run = bench.run(Command::new(&program));
    assert!(run.status.success(), "{}", said(&run));
}
