//! Tests the first commands of README. Other options or a replaced compiler shorten the commands that take long.

#[allow(dead_code)]
#[path = "../../tests/common/pauses.rs"]
mod pauses;

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Mutex, PoisonError};
use sun2xp::hand::Hand;
use sun2xp::model::configuration::Configuration;

const README: &str = include_str!("../../README.md");

/// The tool as README names it.
const TOOL: &str = "c_examples/build/sun2xp";

/// The indented lines of the section "See it move", without their comments.
fn commands() -> Vec<&'static str> {
    let (_, section) = README.split_once("\n## See it move\n").expect("the section");
    let section = section.split("\n## ").next().unwrap_or_default();
    let lines = section.lines().filter_map(|line| line.strip_prefix("    "));
    lines.map(|line| line.split_once(" #").map_or(line, |(command, _)| command).trim()).collect()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn tool(arguments: &[&str], folder: &Path) -> Output {
    let mut tool = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
    tool.args(arguments).current_dir(folder).output().expect("the tool starts")
}

/// Held by a test that starts programs. A child that one test forks while another test writes a program inherits the
/// open file, and a program that is open for writing cannot be started.
static TURN: Mutex<()> = Mutex::new(());

#[test]
fn the_first_commands_of_readme_work() {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    pauses::name_pauses();
    let name = format!("test-readme-{}", std::process::id());
    let mut configuration = Configuration::default();
    configuration.telemetry.name.clone_from(&name);
    let hand = Hand::open(configuration).expect("the simulated hand");
    hand.send_position(1, [0.1, 0.6, 1.2]).expect("sent");

    let folder = tempfile::tempdir().expect("a folder");
    let mut used = Vec::new();
    for command in commands() {
        let Some(arguments) = command.strip_prefix(TOOL) else {
            assert!(command.starts_with("make "), "an unknown command: {command}");
            continue;
        };
        let mut arguments: Vec<&str> = arguments.split_whitespace().collect();
        used.push(arguments[0]);
        match arguments[0] {
            // These commands do not end by themselves. With --help, the tool checks the other options and ends.
            "monitor" | "jog" => arguments.push("--help"),
            "record" => {
                let seconds = arguments.iter().position(|&argument| argument == "--seconds").expect("an end");
                arguments[seconds + 1] = "2";
                arguments.extend(["--hand", name.as_str()]);
            }
            _ => {}
        }
        let run = tool(&arguments, folder.path());
        assert!(run.status.success(), "{command}: {run:?}");
    }
    assert_eq!(used, ["monitor", "monitor", "record", "plot", "replay", "jog"]);
    for file in ["show.mcap", "step.png"] {
        assert!(folder.path().join(file).metadata().expect(file).len() > 1000, "{file}");
    }
}

/// In place of cargo: "builds" the packages that it is asked for, in the profile that it is asked for.
const CARGO: &str = r#"#!/bin/sh
profile=debug
while [ $# -gt 0 ]; do
    case $1 in
        --release) profile=release ;;
        --package) packages="$packages $2"; shift ;;
        --target-dir) folder=$2; shift ;;
    esac
    shift
done
mkdir -p "$folder/$profile"
for package in $packages; do
    case $package in
        sun2xp) : > "$folder/$profile/libsun2xp.so" ;;
        sun2xp-tool) ln -s "$BUILT_TOOL" "$folder/$profile/sun2xp" ;;
    esac
done
"#;

/// In place of the compiler: the program that it makes prints its name and its arguments.
const COMPILER: &str = r#"#!/bin/sh
while [ "$1" != -o ]; do shift; done
printf '#!/bin/sh\necho "runs $0 $*"\n' > "$2"
chmod +x "$2"
"#;

/// Runs the command with the real makefile in a folder of its own. Nothing there is compiled, because a build with
/// optimization takes minutes.
#[test]
fn the_first_command_of_readme_builds_the_tool_that_the_next_commands_use() {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["bin", "c_examples", "include"] {
        fs::create_dir(folder.path().join(name)).expect("a folder");
    }
    for file in ["c_examples/Makefile", "c_examples/Show.c", "include/Sun2Xp.h", "include/Sun2Xp.c", "include/sun2xp.h"]
    {
        fs::copy(root().join(file), folder.path().join(file)).expect("a copy");
    }
    for (name, script) in [("cargo", CARGO), ("cc", COMPILER)] {
        let program = folder.path().join("bin").join(name);
        fs::write(&program, script).expect("a program");
        fs::set_permissions(program, fs::Permissions::from_mode(0o755)).expect("executable");
    }
    let path = std::env::var("PATH").unwrap_or_default();
    let first = commands()[0].strip_prefix("make ").expect("the first command is make");
    let mut make = Command::new("make");
    make.args(first.split(' ')).current_dir(folder.path()).env("BUILT_TOOL", env!("CARGO_BIN_EXE_sun2xp"));
    make.env("PATH", format!("{}:{path}", folder.path().join("bin").display()));
    for name in ["CARGO_TARGET_DIR", "CC", "MAKEFLAGS"] {
        make.env_remove(name);
    }
    let run = make.output().expect("make starts");
    let printed = String::from_utf8_lossy(&run.stdout);
    assert!(run.status.success() && printed.contains("runs ./build/Show 600"), "{run:?}");
    assert!(folder.path().join("c_examples/build/lib/libsun2xp.so").exists(), "the library is linked");
    let version = Command::new(folder.path().join(TOOL)).arg("--version").output().expect("the tool starts");
    assert!(version.status.success() && version.stdout.starts_with(b"sun2xp "), "{version:?}");
}

#[test]
fn the_pictures_of_readme_exist() {
    let pictures: Vec<&str> =
        README.split("](docs/").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0)).collect();
    let pictures = pictures.iter().filter(|name| name.ends_with(".png") || name.ends_with(".svg"));
    let count = pictures.map(|name| root().join("docs").join(name)).inspect(|path| assert!(path.is_file(), "{path:?}"));
    assert!(count.count() >= 3);
}
