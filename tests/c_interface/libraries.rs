//! The shared library and the static library.

use crate::c::{Bench, STRICT, c_compiler, library, root, said};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

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

fn exported_functions() -> Vec<String> {
    let run = Command::new("nm").args(["-D", "--defined-only"]).arg(library()).output().expect("nm can be started");
    said(&run).lines().filter_map(|line| line.split_whitespace().nth(2)).map(str::to_owned).collect()
}

#[test]
fn the_library_exports_the_calls_and_nothing_else() {
    let mut exported = exported_functions();
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

fn check_frames(library: &Path) -> Output {
    let mut script = Command::new(root().join("packaging/check-frames"));
    script.arg(library).output().expect("the script can be started")
}

/// The optimizer decides which frames have a landing pad, so .ci/run makes the same check with the library that has
/// been built with optimization.
#[test]
fn no_frame_of_a_call_has_a_landing_pad() {
    let calls = exported_functions().len();
    let run = check_frames(&library());
    let checked = said(&run).contains(&format!("No frame of the {calls} functions"));
    assert!(run.status.success() && calls > 50 && checked, "{calls} calls: {}", said(&run));
}

#[test]
fn a_frame_with_a_landing_pad_is_found() {
    let bench = Bench::new();
    let library = bench.path().join("landing_pad.so");
    for (flag, landing_pad) in [("-fno-exceptions", false), ("-fexceptions", true)] {
        let mut compiler = Command::new(c_compiler());
        compiler.args(["-shared", "-fPIC", "-fasynchronous-unwind-tables", flag, "-o"]).arg(&library);
        let built = compiler.arg(root().join("tests/c/landing_pad.c")).output().expect("the compiler can be started");
        assert!(built.status.success(), "{}", said(&built));
        let run = check_frames(&library);
        let named = said(&run).contains("landing pads in the frames of: call.");
        assert_eq!((run.status.success(), named), (!landing_pad, landing_pad), "{flag}: {}", said(&run));
    }
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
