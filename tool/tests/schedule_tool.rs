//! Tests `sun2xp schedule` with costs from a file, and with measured costs.

use serde_json::{Value, json};
use std::process::{Command, Output};

fn schedule(configuration: &str, costs: &str) -> Output {
    schedule_with(configuration, costs, &[])
}

fn schedule_with(configuration: &str, costs: &str, options: &[&str]) -> Output {
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
        .args(options)
        .output()
        .expect("the tool runs")
}

const COSTS: &str = "wake_up = 100\nwrite = 10\nread = 5\ncompute = 15\n";

#[test]
fn the_schedule_of_a_hand_that_meets_its_deadlines_is_printed() {
    let output = schedule("[finger.1]\ncore = 0\n[finger.2]\ncore = 1\n[finger.3]\ncore = 2\n", COSTS);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{output:?}");
    for part in [
        "thread  fingers  core  priority  computing  line busy  replies by  done by  deadlines\n",
        "\n1000 Hz with an additional sensor on each finger: it adds 10 bytes to the reply and 50 us to the computing \
         time of the finger\n",
        "\n3       3        2           80      3.0 %       55 %      660 us   680 us  met\n",
        "\n3       3        2           80      8.0 %       65 %      760 us   830 us  met\n",
        "\nThe highest rate at which every deadline is met is 1454 Hz: at 1455 Hz, the line is too busy (thread 1).\n",
        // With the sensor, the longest cycle takes 100 + 10 + 650 + 70 = 830 us.
        "\nWith the sensor, the highest rate at which every deadline is met is 1204 Hz: at 1205 Hz, a cycle may end \
         too late (thread 1).\n",
    ] {
        assert!(text.contains(part), "{part:?} is not in:\n{text}");
    }
    // A pipe receives neither Markdown nor escape sequences. The text does not mention virtual machines, because the
    // costs are given.
    assert!(!text.contains('|') && !text.contains('\u{1b}') && !text.contains("virtual"), "{text}");
}

#[test]
fn a_rate_below_the_lowest_that_can_be_configured_is_not_proposed() {
    let output = schedule("[finger]\ncore = 0\n", &COSTS.replace("100", "1600"));
    let text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1));
    let parts = [
        "\nNo rate that can be configured meets every deadline: at 500 Hz, a cycle may end too late (thread 1).\n",
        "\nWith the sensor, no rate that can be configured meets every deadline: at 500 Hz, ",
    ];
    assert!(parts.iter().all(|part| text.contains(part)), "{text}");
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(error.contains("raise finger.baud") && !error.contains("lower hand.rate"), "{error}");
    assert!(error.contains("may be missed, because a cycle may end too late: "), "{error}");
}

/// At 1000 Hz, thread 1 fetches a tactile event. Its cycle takes 100 + 10 + 550 + 200 + 5 + 150 + 5 = 1020 us, which is
/// more than a period. From 1067 Hz up, no time is left for the event, and the cycle takes 100 + 10 + 550 + 5 + 150 =
/// 815 us. With the sensor, no time is left at 1000 Hz either, and the cycle takes 100 + 10 + 650 + 5 + 150 + 50 =
/// 965 us.
#[test]
fn a_deadline_that_only_a_higher_rate_meets_is_explained() {
    let touch = "[finger.1.touch]\nelements = [{ position = [0, 0, 0], normal = [0, 0, 1] }]\n";
    let hand = format!("[finger.1]\ncore = 0\n{touch}[finger.2]\ncore = 1\n[finger.3]\ncore = 2\n");
    let output = schedule(&hand, &COSTS.replace("compute = 15", "compute = 150"));
    let text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    for part in [
        "\nThe highest rate at which every deadline is met is 1226 Hz: at 1227 Hz, a cycle may end too late (thread \
         1). At 1000 Hz a deadline may be missed: at this lower rate the line has time for more tactile events, and \
         fetching them makes the cycle longer.\n",
        "\nWith the sensor, the highest rate at which every deadline is met is 1036 Hz: at 1037 Hz, a cycle may end \
         too late (thread 1).\n",
    ] {
        assert!(text.contains(part), "{part:?} is not in:\n{text}");
    }
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(error.contains("raise hand.rate to 1226"), "{error}");
}

#[test]
fn the_highest_rate_that_can_be_configured_is_named_if_it_meets_every_deadline() {
    let output = schedule("[finger]\nbaud = 12000000\n", "wake_up = 1\nwrite = 1\nread = 1\ncompute = 1\n");
    let text = String::from_utf8_lossy(&output.stdout);
    let part = "\nEvery deadline is met at the highest rate that can be configured, 5000 Hz.\n";
    assert!(output.status.success() && text.contains(part), "{output:?}");
}

#[test]
fn other_programs_receive_json() {
    let run = |costs: &str| -> (Option<i32>, Value) {
        let output = schedule_with("[finger.2]\ncore = 1\n", costs, &["--json"]);
        (output.status.code(), serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}")))
    };
    let (status, reported) = run(COSTS);
    assert_eq!((status, &reported["pass"], &reported["rate"]), (Some(0), &json!(true), &json!(1000.0)));
    assert_eq!(reported["costs"], json!({"wake_up": 100.0, "write": 10.0, "read": 5.0, "compute": 15.0}));
    assert_eq!((&reported["source"], &reported["virtual_machine"]), (&json!("file"), &json!(false)));
    let second = &reported["configured"]["threads"][1];
    assert_eq!((&second["thread"], &second["core"], &second["fingers"]), (&json!(2), &json!(1), &json!([2])));
    assert_eq!(second["limit"], Value::Null, "{second:#}");
    let fastest = reported["configured"]["fastest"]["rate"].as_u64().expect("a rate");
    assert!(reported["with_sensor"]["fastest"]["rate"].as_u64().is_some_and(|rate| rate < fastest), "{reported:#}");
    assert_eq!(reported["with_sensor"]["sensor"], json!({"bytes": 10, "compute": 50.0}));

    let (status, reported) = run(&COSTS.replace("100", "1600"));
    assert_eq!((status, &reported["pass"]), (Some(1), &json!(false)));
    let fastest = &reported["configured"]["fastest"];
    assert_eq!(fastest, &json!({"rate": null, "limit": {"missed": "cycle", "thread": 1}}));
}

/// The costs are measured. If this machine is virtual, and only then, the output describes the effect on the costs.
#[test]
fn a_virtual_machine_is_named_where_its_times_are_measured() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("sun2xp.toml"), "[hand]\nrate = 500\n").expect("written");
    let run = |options: &[&str]| {
        let mut tool = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
        tool.args(["schedule", "--measure", "1"]).args(options).current_dir(folder.path());
        tool.env_remove("SUN2XP_CONFIG").output().expect("the tool runs").stdout
    };
    let reported: Value = serde_json::from_slice(&run(&["--json"])).expect("JSON");
    let text = String::from_utf8(run(&["--p999"])).expect("text");
    assert!(text.starts_with("99.9 % values, us: wake-up "), "{text}");
    assert_eq!(reported["virtual_machine"], text.contains("This machine is virtual. Its host may pause it"), "{text}");
    let flag = std::fs::read_to_string("/proc/cpuinfo").expect("there").contains(" hypervisor");
    assert!(!flag || reported["virtual_machine"] == true, "the kernel knows a hypervisor: {reported:#}");
}

#[test]
fn without_config_the_tool_uses_the_file_of_open_hand() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("sun2xp.toml"), "[hand]\nrate = 640\n").expect("written");
    std::fs::write(folder.path().join("costs.toml"), COSTS).expect("written");
    let output = Command::new(env!("CARGO_BIN_EXE_sun2xp"))
        .args(["schedule", "--costs", "costs.toml"])
        .current_dir(folder.path())
        .env_remove("SUN2XP_CONFIG")
        .output()
        .expect("the tool runs");
    assert!(String::from_utf8_lossy(&output.stdout).contains("\n640 Hz\n"), "{output:?}");
}

#[test]
fn a_hand_that_may_miss_a_deadline_is_reported_and_invalid_costs_are_refused() {
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
