//! `sun2xp schedule` with a file of costs.

use std::process::{Command, Output};

fn schedule(configuration: &str, costs: &str) -> Output {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        path
    };
    Command::new(env!("CARGO_BIN_EXE_sun2xp"))
        .args(["schedule", "--sensor-bytes", "10", "--sensor-compute", "50", "--config"])
        .arg(file("sun2xp.toml", configuration))
        .arg("--costs")
        .arg(file("costs.toml", costs))
        .output()
        .expect("the tool runs")
}

const COSTS: &str = "wake_up = 100\nwrite = 10\nread = 5\ncompute = 15\n";

#[test]
fn a_hand_that_meets_its_deadlines() {
    let output = schedule("[finger.1]\ncore = 0\n[finger.2]\ncore = 1\n[finger.3]\ncore = 2\n", COSTS);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{output:?}");
    for part in [
        "| 3 | 3 | 2 | 80 | 3.0 % | 55 % | 660 us | 680 us | met |",
        "| 3 | 3 | 2 | 80 | 8.0 % | 65 % | 760 us | 830 us | met |",
        "met up to 1454 Hz: above that, the line is too busy, thread 1",
        // 100 + 10 + 650 + 70 us.
        "With the sensor, every deadline is met up to 1204 Hz: above that, a cycle may end too late, thread 1",
    ] {
        assert!(text.contains(part), "{part:?} is not in:\n{text}");
    }
}

#[test]
fn without_an_argument_the_tool_uses_the_file_of_open_hand() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("sun2xp.toml"), "[hand]\nrate = 640\n").expect("written");
    std::fs::write(folder.path().join("costs.toml"), COSTS).expect("written");
    let output = Command::new(env!("CARGO_BIN_EXE_sun2xp"))
        .args(["schedule", "--costs", "costs.toml"])
        .current_dir(folder.path())
        .env_remove("SUN2XP_CONFIG")
        .output()
        .expect("the tool runs");
    assert!(String::from_utf8_lossy(&output.stdout).contains("640 Hz:"), "{output:?}");
}

#[test]
fn a_hand_that_may_miss_a_deadline_and_invalid_costs() {
    let output = schedule("[finger]\ncore = 0\n", &COSTS.replace("15", "150"));
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stdout).contains("a cycle may end too late"), "{output:?}");
    assert!(String::from_utf8_lossy(&output.stderr).contains("lower hand.rate"), "{output:?}");
    for (wrong, part) in [
        ("compute = -1", "costs.toml:4: compute: -1 is not"),
        ("compute = nan", "costs.toml:4: compute: NaN is not"),
        ("compute = [1, 2]", "costs.toml:4: compute: must be a number"),
        ("compute = 1\nsleep = 2", "costs.toml:5: unknown key `sleep`"),
        ("compute = 1\n\"a\\n\\u001b\" = 2", "costs.toml:5: unknown key `a\\n\\u{1b}`"),
        ("compute = ", "costs.toml:4: "),
        ("", "`compute` is missing"),
    ] {
        let output = schedule("", &COSTS.replace("compute = 15", wrong));
        assert_eq!(output.status.code(), Some(1));
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(said.contains(part) && said.lines().count() == 1, "{wrong}: {said}");
    }
}
