//! OpenHand with good and bad configuration files, and the messages that the library prints.

use crate::c::{Bench, STRICT, c_compiler, said};
use std::fs;
use std::process::Command;

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
    // opens.c gives three reasons for a refusal: joint angles beyond the limits, a finger that does not exist, and a
    // hand that is closed. Each reason occurs several times, and is printed once.
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
fn a_closed_handle_of_a_silent_hand_is_reported() {
    let bench = Bench::new();
    fs::write(bench.path().join("named.toml"), "[hand]\nprint_refusals = false\n").expect("a configuration file");
    bench.succeed(&[STRICT, &["-std=c89"]].concat(), &["silent_default.c"]);
}

#[test]
fn out_of_range_set_points_are_clamped_without_a_message() {
    let (status, _, printed) = opened_with("[hand]\nout_of_range = \"clamp\"\n");
    assert_eq!(status, Some(0), "{printed}");
    assert!(!printed.contains("SendPos: joint "), "{printed}");
}

#[test]
fn an_unusable_configuration_is_refused_with_its_line() {
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
        ("[finger.tendon]\nmaximum = 10.0\n", 2, "finger.1.tendon.maximum"),
    ] {
        let (status, output, printed) = opened_with(configuration);
        assert_eq!(status, Some(2), "{configuration}: {output}{printed}");
        assert!(output.starts_with("Invalid argument: OpenHand: "), "{output}");
        assert!(output.contains(&format!("named.toml:{line}: ")), "{configuration}: {output}");
        assert!(output.contains(word), "{configuration}: {output}");
    }
}

/// The working directory comes before the user's folder, and the user's before the system's. None of the files is
/// usable, so the error names the file that was chosen.
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
    // A relative path to the system's folder must be ignored.
    fs::create_dir_all(bench.path().join("relative/sun2xp")).expect("a folder");
    fs::write(bench.path().join("relative/sun2xp/sun2xp.toml"), "[hand]\nrat = 1\n").expect("a configuration file");
    for (folder, named) in
        files.iter().zip(["sun2xp.toml:2: ", "user/sun2xp/sun2xp.toml:2: ", "system/sun2xp/sun2xp.toml:2: "])
    {
        let mut command = Command::new("env");
        command.args(["-u", "SUN2XP_CONFIG"]);
        command.arg(format!("XDG_CONFIG_HOME={}", user.display()));
        command.arg(format!("XDG_CONFIG_DIRS=relative:{}", system.display())).arg(&program);
        let output = said(&bench.run(command));
        assert!(output.contains(named), "{named}: {output}");
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
fn a_port_that_does_not_exist_is_reported() {
    let (status, output, _) = opened_with("[hand]\nfingers = [1]\n[finger.1]\nport = \"no/such/port\"\n");
    assert_eq!(status, Some(2), "{output}");
    assert!(output.starts_with("No such file or directory: OpenHand: ") && output.contains("no/such/port"), "{output}");
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
fn fingers_without_a_configured_port_are_announced_in_one_line() {
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
