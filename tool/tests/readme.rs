//! Tests that the first commands of README work as they are printed there.

#[allow(dead_code)]
#[path = "../../tests/common/pauses.rs"]
mod pauses;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use sun2xp::hand::Hand;
use sun2xp::model::configuration::{Configuration, RealTime};

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

#[test]
fn the_first_commands_of_readme_work() {
    pauses::name_pauses();
    let name = format!("test-readme-{}", std::process::id());
    let mut configuration = Configuration::default();
    configuration.telemetry.name.clone_from(&name);
    configuration.hand.real_time = RealTime::Ignore;
    let hand = Hand::open(configuration).expect("the simulated hand");
    hand.send_position(1, [0.1, 0.6, 1.2]).expect("sent");

    let folder = tempfile::tempdir().expect("a folder");
    let mut used = Vec::new();
    for command in commands() {
        let Some(arguments) = command.strip_prefix(TOOL) else {
            let show = command.strip_prefix("make ").unwrap_or_else(|| panic!("an unknown command: {command}"));
            let run = Command::new("make").arg("-n").args(show.split(' ')).current_dir(root()).output().expect("make");
            let told = String::from_utf8_lossy(&run.stdout);
            assert!(run.status.success() && told.contains("build/Show"), "{run:?}");
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

#[test]
fn the_pictures_of_readme_exist() {
    let pictures: Vec<&str> =
        README.split("](docs/").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0)).collect();
    let pictures = pictures.iter().filter(|name| name.ends_with(".png") || name.ends_with(".svg"));
    let count = pictures.map(|name| root().join("docs").join(name)).inspect(|path| assert!(path.is_file(), "{path:?}"));
    assert!(count.count() >= 3);
}
