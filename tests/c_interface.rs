//! The C interface as C programs see it: they are compiled, linked against the shared library, and move the simulated hand.

#[allow(dead_code)]
mod c;

use c::board::Board;
use c::{Bench, STRICT, c_compiler, library, root, said};
use std::fs;
use std::process::Command;
use std::time::{Duration, Instant};

fn succeed(flags: &[&str], sources: &[&str]) {
    Bench::new().succeed(flags, sources);
}

fn strict<'a>(flags: &[&'a str]) -> Vec<&'a str> {
    [STRICT, flags].concat()
}

#[test]
fn a_planner_with_float_arrays_arrives() {
    succeed(&strict(&["-ansi", "-DREAL=float"]), &["reach.c"]);
}

#[test]
fn a_planner_with_double_arrays_arrives() {
    succeed(&strict(&["-std=c17", "-DREAL=double"]), &["reach.c"]);
}

#[test]
fn a_planner_arrives_where_the_compiler_has_no_generic() {
    succeed(&strict(&["-ansi", "-DREAL=double", "-DSUN2XP_NO_GENERIC"]), &["reach.c"]);
}

#[test]
fn a_planner_in_k_and_r_c_without_include_arrives_with_float_and_with_double() {
    succeed(&["-std=gnu89", "-DREAL=float"], &["old.c"]);
    let double = ["-std=gnu89", "-DREAL=double", "-DSendPos=SendPosD", "-DSendKx=SendKxD", "-DGetPos=GetPosD"];
    succeed(&double, &["old.c"]);
}

#[test]
fn a_planner_in_cpp_arrives() {
    for standard in ["-std=c++98", "-std=c++17"] {
        succeed(&strict(&[standard]), &["reach.cpp"]);
    }
}

#[test]
fn a_header_inside_extern_c_serves() {
    succeed(&strict(&[]), &["inside_extern_c.cpp"]);
}

#[test]
fn own_declarations_and_addresses_are_served() {
    succeed(&strict(&["-DSUN2XP_REAL=float", "-DREAL=float"]), &["own.c"]);
    succeed(&strict(&["-DSUN2XP_REAL=double", "-DREAL=double"]), &["own.c"]);
    succeed(&strict(&["-DSUN2XP_H", "-DANSI_DECLARATIONS", "-DREAL=float"]), &["own.c"]);
}

#[test]
fn two_files_may_include_the_c_file_of_1990() {
    succeed(&strict(&[]), &["two_files.c", "two_files_other.c"]);
}

#[test]
fn arguments_are_evaluated_once() {
    succeed(&strict(&["-std=c99"]), &["once.c"]);
    succeed(&strict(&["-std=c99", "-DSUN2XP_NO_GENERIC"]), &["once.c"]);
}

#[test]
fn arrays_of_variable_length_are_what_their_elements_are() {
    succeed(&strict(&["-std=c99"]), &["variable_length.c"]);
    succeed(&strict(&["-std=c99", "-DSUN2XP_NO_GENERIC"]), &["variable_length.c"]);
}

#[test]
fn null_pointers_are_refused() {
    succeed(&strict(&["-ansi"]), &["null.c"]);
}

#[test]
fn refusals_have_their_errno_and_text_and_change_nothing() {
    succeed(&strict(&["-std=c99"]), &["refusals.c"]);
}

#[test]
fn without_a_hand_calls_are_refused_and_close_is_done() {
    succeed(&strict(&["-std=c99"]), &["closed.c"]);
}

#[test]
fn a_forked_child_is_refused() {
    succeed(&strict(&[]), &["forked.c"]);
}

#[test]
fn the_alarms_of_a_planner_are_its_own() {
    succeed(&strict(&[]), &["signals.c"]);
}

#[test]
fn threads_may_call_at_once() {
    succeed(&strict(&[]), &["threads.c"]);
}

#[test]
fn a_planner_without_standard_descriptors_keeps_its_ports_to_itself() {
    succeed(STRICT, &["bare.c"]);
}

#[test]
fn dlclose_leaves_the_hand() {
    succeed(&strict(&[]), &["loaded.c"]);
}

#[test]
fn a_finger_is_zeroed() {
    succeed(&strict(&[]), &["zero.c"]);
}

#[test]
fn a_finger_reads_what_it_does() {
    succeed(&strict(&[]), &["states.c"]);
}

#[test]
fn a_signal_handler_stops_the_hand_and_the_planner_recovers_it() {
    succeed(&strict(&[]), &["stopped.c"]);
}

#[test]
fn a_black_box_is_written_and_replayed() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), &strict(&[]), &["black_box.c"]);
    let file = bench.path().join("finger-1.jsonl");
    let mut command = Command::new(&program);
    command.arg(&file);
    let run = bench.run(command);
    assert!(run.status.success(), "{}", said(&run));
    let run = Command::new(c::tool()).arg("replay").arg(&file).output().expect("the tool runs");
    assert!(run.status.success() && said(&run).contains("the same to the last bit"), "{}", said(&run));
}

#[test]
fn the_status_tells_of_the_servo() {
    succeed(&strict(&[]), &["status.c"]);
}

#[test]
fn a_planner_that_packs_structs_and_redefines_words_of_c_is_served() {
    succeed(&strict(&["-std=c99", "-Wno-keyword-macro"]), &["packed.c"]);
    succeed(&strict(&["-std=c99", "-DSUN2XP_NO_GENERIC"]), &["packed.c"]);
}

#[test]
fn the_timing_tells_where_the_time_goes() {
    succeed(&strict(&["-std=c99"]), &["timing.c"]);
}

#[test]
fn a_fingertip_is_sent_read_and_made_a_contact() {
    succeed(&strict(&["-ansi"]), &["tip.c"]);
}

#[test]
fn a_finger_whose_board_dies_is_faulted() {
    succeed_while_the_board_dies("faulted.c");
}

#[test]
fn faults_are_told_by_number_and_in_words() {
    succeed_while_the_board_dies("faults.c");
}

fn succeed_while_the_board_dies(source: &str) {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), &strict(&["-std=c99"]), &[source]);
    let board = Board::start(&bench);
    let mut command = Command::new(&program);
    command.arg(board.id().to_string());
    let run = bench.run(command);
    assert!(run.status.success(), "{}", said(&run));
}

/// `release`: however the planner ends, the tendons go slack but for the friction of the motors.
#[test]
fn a_planner_that_leaves_without_closing_lets_the_tendons_go() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), STRICT, &["leaves.c"]);
    for (way, status) in
        [("return", Some(3)), ("exit", Some(3)), ("handler", Some(3)), ("thread", Some(3)), ("killed", None)]
    {
        let mut board = Board::start(&bench);
        let mut command = Command::new(&program);
        command.arg(way);
        let run = bench.run(command);
        assert_eq!(run.status.code(), status, "{way}: {}", said(&run));
        let end = Instant::now() + Duration::from_secs(3);
        while board.tension() > 3.0 {
            assert!(Instant::now() < end, "{way}: {} N three seconds later", board.tension());
        }
    }
}

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

/// Runs `opens.c` with a configuration file.
fn opened_with(configuration: &str) -> (Option<i32>, String, String) {
    let bench = Bench::new();
    fs::write(bench.path().join("named.toml"), configuration).expect("a configuration file");
    let program = bench.build(c_compiler(), STRICT, &["opens.c"]);
    let run = bench.run(Command::new(&program));
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (run.status.code(), text(&run.stdout), text(&run.stderr))
}

#[test]
fn the_first_refusal_of_each_kind_prints_one_line() {
    let (status, _, printed) = opened_with("");
    assert_eq!(status, Some(0), "{printed}");
    let refusals: Vec<_> = printed.lines().filter(|line| line.contains("SendPos")).collect();
    // Out of limits, no such finger, no hand: each was refused several times.
    assert_eq!(refusals.len(), 3, "{printed}");
    assert!(refusals.iter().all(|line| line.starts_with("sun2xp: SendPos: ")), "{printed}");
}

#[test]
fn refusals_can_be_silent() {
    let (status, _, printed) = opened_with("[hand]\nprint_refusals = false\n");
    assert_eq!(status, Some(0), "{printed}");
    assert!(!printed.contains("SendPos"), "{printed}");
}

#[test]
fn clamping_is_not_refusing() {
    let (status, _, printed) = opened_with("[hand]\nout_of_range = \"clamp\"\n");
    assert_eq!(status, Some(0), "{printed}");
    assert!(!printed.contains("SendPos: Pos["), "{printed}");
}

#[test]
fn a_configuration_that_cannot_be_used_is_told_with_its_line() {
    for (configuration, line, word) in [
        ("[hand]\nrat = 1000.0\n", 2, "rat"),
        ("[finger.2]\n\nbaud = \"fast\"\n", 3, "fast"),
        ("[hand]\nrate = 1.0\n", 2, "rate"),
        (
            "[finger.geometry]\nr = [[-1.09, 0.62, 0.62, -1.09], [1.09, 0.62, -0.62, 1.09], [0.0, 0.62, -0.62, 0.0]]\n",
            2,
            "report misprints",
        ),
        (
            "[finger.geometry]\nr = [[0.0, 0.0, 0.0, 0.0], [1.09, 0.62, -0.62, -1.09], [0.0, 0.62, -0.62, 0.0]]\n",
            2,
            "singular",
        ),
    ] {
        let (status, told, printed) = opened_with(configuration);
        assert_eq!(status, Some(2), "{configuration}: {told}{printed}");
        assert!(told.starts_with("Invalid argument: OpenHand: "), "{told}");
        assert!(told.contains(&format!("named.toml:{line}: ")), "{configuration}: {told}");
        assert!(told.contains(word), "{configuration}: {told}");
    }
}

/// The working directory's before the user's, the user's before the system's. None of them can be used, so the refusal names it.
#[test]
fn the_nearest_configuration_file_counts() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), STRICT, &["opens.c"]);
    let (user, system) = (bench.path().join("user"), bench.path().join("system"));
    let files = [bench.path().to_path_buf(), user.join("sun2xp"), system.join("sun2xp")];
    for folder in &files {
        fs::create_dir_all(folder).expect("a folder");
        fs::write(folder.join("sun2xp.toml"), "[hand]\nrat = 1\n").expect("a configuration file");
    }
    // A relative folder of the system's is to be ignored.
    fs::create_dir_all(bench.path().join("relative/sun2xp")).expect("a folder");
    fs::write(bench.path().join("relative/sun2xp/sun2xp.toml"), "[hand]\nrat = 1\n").expect("a configuration file");
    for (folder, named) in
        files.iter().zip(["sun2xp.toml:2: ", "user/sun2xp/sun2xp.toml:2: ", "system/sun2xp/sun2xp.toml:2: "])
    {
        let mut command = Command::new("env");
        command.args(["-u", "SUN2XP_CONFIG"]);
        command.arg(format!("XDG_CONFIG_HOME={}", user.display()));
        command.arg(format!("XDG_CONFIG_DIRS=relative:{}", system.display())).arg(&program);
        let told = said(&bench.run(command));
        assert!(told.contains(named), "{named}: {told}");
        fs::remove_file(folder.join("sun2xp.toml")).expect("removed");
    }
}

#[test]
fn a_named_configuration_must_exist() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), STRICT, &["opens.c"]);
    let mut command = Command::new("env");
    command.arg("SUN2XP_CONFIG=missing.toml").arg(&program);
    let run = bench.run(command);
    assert_eq!(run.status.code(), Some(2), "{}", said(&run));
    assert!(said(&run).contains("No such file or directory: OpenHand: "), "{}", said(&run));
    assert!(said(&run).contains("missing.toml"), "{}", said(&run));
}

#[test]
fn a_port_that_does_not_exist_is_told() {
    let (status, told, _) = opened_with("[finger.1]\nport = \"no/such/port\"\n");
    assert_eq!(status, Some(2), "{told}");
    assert!(told.starts_with("No such file or directory: OpenHand: ") && told.contains("no/such/port"), "{told}");
}

#[test]
fn the_simulated_hand_is_announced_in_one_line() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), STRICT, &["opens.c"]);
    let run = bench.run(Command::new(&program));
    let announced = said(&run).lines().filter(|line| line.contains("simulated")).count();
    assert_eq!(announced, 1, "{}", said(&run));
}

#[test]
fn fingers_that_no_file_gives_a_port_are_announced_in_one_line() {
    for (configuration, announced) in [
        ("", Some("for any finger: the whole hand is simulated")),
        ("[finger.1]\nport = \"simulated\"\n", Some("for fingers 2 and 3: they are simulated")),
        ("[finger]\nport = \"simulated\"\n", None),
    ] {
        let (status, _, printed) = opened_with(configuration);
        assert_eq!(status, Some(0), "{printed}");
        let lines: Vec<&str> = printed.lines().filter(|line| line.contains("simulated")).collect();
        assert_eq!(lines.len(), usize::from(announced.is_some()), "{configuration}: {printed}");
        for line in lines {
            assert!(
                line.contains("named.toml names no port ") && line.contains(announced.unwrap_or_default()),
                "{line}"
            );
        }
    }
}

#[test]
fn the_library_exports_the_calls_and_nothing_else() {
    let run = Command::new("nm").args(["-D", "--defined-only"]).arg(library()).output().expect("nm can be started");
    let listing = said(&run);
    let mut exported: Vec<_> = listing.lines().filter_map(|line| line.split_whitespace().nth(2)).collect();
    exported.sort_unstable();
    // The header declares every call at the beginning of a line.
    let header = fs::read_to_string("include/Sun2Xp.h").expect("the header");
    let called = |line: &str| {
        let declared = line.strip_prefix("int ").or(line.strip_prefix("const char *"))?;
        declared.split_once('(').map(|(name, _)| name.to_string())
    };
    let mut calls: Vec<_> = header.lines().filter_map(called).collect();
    calls.sort_unstable();
    assert!(["CloseHand", "GetPos", "OpenHand", "SendKx", "SendPos"].iter().all(|call| exported.contains(call)));
    assert_eq!(exported, calls);
}

#[test]
fn the_library_has_its_name_and_stays_loaded() {
    let run = Command::new("readelf").args(["-d", "-W"]).arg(library()).output().expect("readelf can be started");
    let dynamic = said(&run);
    assert!(dynamic.contains("[libsun2xp.so.0]"), "{dynamic}");
    assert!(dynamic.contains("NODELETE"), "{dynamic}");
}
