//! Planners in hostile surroundings: descriptors that the planner closes without the library's knowledge, limits of the
//! system, sandboxes, and names with control sequences for terminals.

#[allow(dead_code)]
mod c;

use c::{Bench, STRICT, c_compiler, said};
use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::process::{Command, Output};

/// Exit status of a program if the system does not permit what it tests.
const NOT_PERMITTED: i32 = 77;

fn strict<'a>(flags: &[&'a str]) -> Vec<&'a str> {
    [STRICT, flags].concat()
}

#[test]
fn a_planner_that_closes_the_descriptors_up_to_255_keeps_its_hand() {
    // The library's descriptors have higher numbers.
    closes_descriptors("1024", "255");
}

#[test]
fn a_planner_that_closes_every_descriptor_gets_a_fault_and_keeps_its_files_intact() {
    closes_descriptors("1024", "1023");
}

#[test]
fn a_planner_with_few_descriptors_that_closes_all_gets_a_fault_and_keeps_its_files_intact() {
    // With this limit, all descriptors of the library are below 60. So the planner also closes these descriptors.
    closes_descriptors("60", "255");
}

fn closes_descriptors(limit: &str, highest: &str) {
    let bench = Bench::new();
    // With reconnection, the planner's new pseudo-terminals must not be taken for the lost ports.
    fs::write(bench.path().join("named.toml"), "[finger]\nreconnect = true\n").expect("a configuration file");
    let program = bench.build(c_compiler(), &strict(&["-D_XOPEN_SOURCE=600"]), &["closes_descriptors.c"]);
    let mut command = Command::new(&program);
    command.args([limit, highest]);
    let run = bench.run(command);
    assert!(run.status.success(), "{highest} of {limit}: {}\n{}", run.status, said(&run));
}

#[test]
fn limits_of_the_system_are_reported_with_their_remedy_and_leave_nothing_behind() {
    Bench::new().succeed(&strict(&[]), &["limits.c"]);
}

#[test]
fn a_sandbox_that_forbids_a_system_call_is_named_as_the_cause() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), &strict(&[]), &["sandbox.c"]);
    let run = bench.run(Command::new(program));
    if run.status.code() == Some(NOT_PERMITTED) {
        let reason = "the system does not permit seccomp filters: use a kernel with them, or a container whose profile \
                      permits prctl";
        return c::skip("a sandbox", reason);
    }
    assert!(run.status.success(), "{}\n{}", run.status, said(&run));
    assert!(!said(&run).contains("panicked"), "{}", said(&run));
}

#[test]
fn a_planner_under_sched_deadline_is_refused_with_the_flag_that_its_threads_need() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), &strict(&[]), &["deadline.c"]);
    let run = bench.run(Command::new(program));
    if run.status.code() == Some(NOT_PERMITTED) {
        return c::skip("SCHED_DEADLINE", "the system does not permit it: run as root, not in a container");
    }
    assert!(run.status.success(), "{}\n{}", run.status, said(&run));
}

/// Names that break lines, clear the screen, reverse the direction of writing, are not UTF-8, or are long.
fn hostile_names() -> [Vec<u8>; 4] {
    [
        b"two\nlines".to_vec(),
        "\u{1b}[2J\u{1b}]0;title\u{7}\u{9b}31m\u{202e}".into(),
        b"no\xfftext\r\x08".to_vec(),
        [b"/begin/".to_vec(), b"x/".repeat(5000), b"end".to_vec()].concat(),
    ]
}

/// Asserts that `text` is a single line that begins with `beginning`, is shown unchanged by a terminal, and has a
/// readable length.
fn assert_one_line(text: &str, beginning: &str) {
    let line = text.strip_suffix('\n').unwrap_or(text);
    assert!(line.len() < 900, "{} bytes: {:?}", line.len(), line.chars().take(200).collect::<String>());
    assert!(line.starts_with(beginning), "{line:?} does not begin with {beginning:?}");
    let visible = |character: char| !character.is_control() && !('\u{202a}'..='\u{202e}').contains(&character);
    assert!(line.chars().all(visible), "{line:?}");
}

fn printed(run: &Output) -> (String, String) {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("UTF-8");
    (text(&run.stdout), text(&run.stderr))
}

#[test]
fn a_configuration_file_with_a_hostile_name_is_refused_in_one_line() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), STRICT, &["opens.c"]);
    for name in hostile_names() {
        for (content, errno) in
            [(None, "No such file or directory: "), (Some("[hand]\nrat = 1\n"), "Invalid argument: ")]
        {
            let path = bench.path().join(OsStr::from_bytes(&name));
            let errno = match content.map(|content| fs::write(&path, content)) {
                Some(Err(_)) | None if name.len() > 255 => "File name too long: ",
                _ => errno,
            };
            let mut command = Command::new("env");
            command.arg([b"SUN2XP_CONFIG=", &name[..]].concat().as_os_str()).arg(&program);
            let run = bench.run(command);
            assert_eq!(run.status.code(), Some(2), "{}", said(&run));
            let (message, line) = printed(&run);
            assert_one_line(&message, &format!("{errno}OpenHand: "));
            assert_one_line(&line, "sun2xp: OpenHand: ");
        }
    }
}

#[test]
fn a_black_box_with_a_hostile_name_is_refused_in_one_line() {
    let bench = Bench::new();
    let program = bench.build(c_compiler(), &strict(&[]), &["hostile_name.c"]);
    for name in hostile_names() {
        let mut command = Command::new(&program);
        command.arg([b"no/folder/", &name[..]].concat().as_os_str());
        let run = bench.run(command);
        assert!(run.status.success(), "{}", said(&run));
        let (message, lines) = printed(&run);
        assert_one_line(&message, "sun2xp_write_black_box: ");
        assert_one_line(lines.lines().nth(1).expect("after the announcement"), "sun2xp: sun2xp_write_black_box: ");
    }
}

#[test]
fn tools_print_hostile_names_in_one_line() {
    let run_with_status = |status: i32, arguments: &[&OsStr]| {
        let run = Command::new(c::tool()).args(arguments).output().expect("the tool runs");
        assert_eq!(run.status.code(), Some(status), "{}", said(&run));
        assert_one_line(&printed(&run).1, "sun2xp: ");
    };
    let run = |arguments: &[&OsStr]| run_with_status(1, arguments);
    let folder = tempfile::tempdir().expect("a folder");
    for name in hostile_names() {
        let name = name.as_os_str();
        run(&["replay".as_ref(), name]);
        run(&["schedule".as_ref(), "--costs".as_ref(), name]);
        run(&["bound".as_ref(), "--config".as_ref(), name]);
        run(&["calibrate".as_ref(), "--config".as_ref(), name]);
        run(&["board".as_ref(), "--config".as_ref(), name]);
        if name.to_str().is_some() {
            // An unknown order to `sun2xp board` is wrong usage.
            run_with_status(2, &["board".as_ref(), "--order".as_ref(), name]);
        }
        let costs = folder.path().join("costs");
        fs::write(&costs, [b"'", name.as_bytes(), b"' = 1\n"].concat()).expect("written");
        run(&["schedule".as_ref(), "--costs".as_ref(), costs.as_os_str()]);
        let link = folder.path().join(name);
        if fs::write(&link, "a file").is_ok() {
            run(&["board".as_ref(), "--link".as_ref(), link.as_os_str()]);
            run(&["replay".as_ref(), link.as_os_str()]);
        }
    }
}

trait AsOsStr {
    fn as_os_str(&self) -> &OsStr;
}

impl AsOsStr for Vec<u8> {
    fn as_os_str(&self) -> &OsStr {
        OsStr::from_bytes(self)
    }
}
