//! Tests that numbers in CSV files have the recorded bits, and that a refused or failed export leaves the folder as it
//! was.

use crate::damage::damaged;
use crate::recorded::{done, recorded, tool};
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Read};
use std::process::{Command, Stdio};

/// Returns the header of a CSV file, and each row as a map from column names to fields. No field may contain a line
/// feed.
fn table(text: &str) -> (Vec<&str>, Vec<BTreeMap<&str, String>>) {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let rows = lines.map(|line| {
        let fields = fields(line);
        assert_eq!(fields.len(), header.len(), "{line}");
        header.iter().copied().zip(fields).collect()
    });
    let rows = rows.collect();
    (header, rows)
}

/// The fields of a line. Some fields may be quoted.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut quoted) = (vec![String::new()], false);
    for letter in line.chars() {
        match letter {
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            letter => fields.last_mut().expect("a field").push(letter),
        }
    }
    fields
}

#[test]
fn numbers_of_a_csv_file_have_the_recorded_bits() {
    let recorded = recorded();
    let folder = tempfile::tempdir().expect("a folder");
    let output = folder.path().to_str().expect("a name");
    let reported = done(folder.path(), &["export", recorded.file().to_str().expect("a name"), "--output", output]);
    assert_eq!(reported.lines().count(), 2, "{reported}");
    let text = fs::read_to_string(folder.path().join("finger-2-finger2.csv")).expect("a file");
    let (header, rows) = table(&text);
    assert!(
        header[0] == "time_s" && header.contains(&"tension_4_N") && header.contains(&"kx_xz_N_per_cm"),
        "{header:?}"
    );
    let cycles = &recorded.recording.cycles;
    assert_eq!(rows.len(), cycles.len());
    let bits = |row: &BTreeMap<&str, String>, name: &str| row[name].parse::<f64>().map(f64::to_bits).ok();
    for (row, cycle) in rows.iter().zip(cycles) {
        assert_eq!((&row["cycle"], &row["began_ns"]), (&cycle.cycle.to_string(), &cycle.began.to_string()));
        assert_eq!((&row["stage"], row["reply"] == "1"), (&cycle.stage, cycle.feedback.is_some()));
        let count = cycle.feedback.map_or(String::new(), |feedback| feedback.gauge_counts[2].to_string());
        assert_eq!(row["gauge_3_count"], count);
        let Some(control) = &cycle.control else { continue };
        for part in 0..4 {
            let number = part + 1;
            assert_eq!(bits(row, &format!("tension_{number}_N")), Some(control.report.tensions[part].to_bits()));
            let wanted = control.report.desired_tensions[part].to_bits();
            assert_eq!(bits(row, &format!("tension_desired_{number}_N")), Some(wanted));
        }
        for joint in 0..3 {
            assert_eq!(bits(row, &format!("joint_{joint}_rad")), Some(control.report.joints[joint].to_bits()));
            let rate = control.report.joint_rates[joint].to_bits();
            assert_eq!(bits(row, &format!("joint_rate_{joint}_rad_per_s")), Some(rate));
        }
        assert_eq!(bits(row, "stiffness_scale"), Some(control.report.stiffness_scale.to_bits()));
    }

    let events = fs::read_to_string(folder.path().join("finger-2-events.csv")).expect("a file");
    let (_, events) = table(&events);
    let faults: Vec<_> = events.iter().filter(|event| event["kind"] == "fault").collect();
    assert!(faults.len() == 1 && faults[0]["text"].starts_with("faulted: "), "{events:?}");
    assert_eq!(faults[0]["finger"], "2");
}

#[test]
fn the_long_format_has_one_value_in_a_row() {
    let recorded = recorded();
    let file = recorded.file();
    let long = done(recorded.folder.path(), &["export", file.to_str().expect("a name"), "--output", "-"]);
    let (header, rows) = table(&long);
    assert_eq!(header, ["time_s", "finger", "cycle", "name", "unit", "value"]);
    let cycle = &recorded.recording.cycles[100];
    let of_cycle = |name: &str| {
        let mut rows = rows.iter().filter(|row| row["cycle"] == cycle.cycle.to_string());
        rows.find(|row| row["name"] == name).unwrap_or_else(|| panic!("no {name}"))
    };
    let tension = of_cycle("tension_1");
    let recorded = cycle.control.expect("computed").report.tensions[0];
    assert_eq!((tension["unit"].as_str(), tension["finger"].as_str()), ("N", "2"));
    assert_eq!(tension["value"].parse::<f64>().map(f64::to_bits), Ok(recorded.to_bits()));
}

#[test]
fn no_file_is_replaced_without_force_and_other_fingers_are_left_out() {
    let recorded = recorded();
    let folder = tempfile::tempdir().expect("a folder");
    let (file, output) = (recorded.file(), folder.path().to_str().expect("a name"));
    let file = file.to_str().expect("a name");
    let export = |more: &[&str]| tool(folder.path(), &[&["export", file, "--output", output], more].concat());
    assert!(export(&["--finger", "1"]).status.success());
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0, "the recording has finger 2 only");
    assert!(export(&[]).status.success());
    let refused = export(&[]);
    assert_eq!(refused.status.code(), Some(2), "{refused:?}");
    assert!(String::from_utf8_lossy(&refused.stderr).contains("--force"), "{refused:?}");
    assert!(export(&["--force"]).status.success());

    for entry in fs::read_dir(folder.path()).expect("a folder") {
        let file = entry.expect("an entry").path();
        fs::remove_file(&file).and_then(|()| fs::create_dir(&file)).expect("a folder in place of the file");
    }
    let refused = export(&[]);
    let text = String::from_utf8_lossy(&refused.stderr);
    assert!(text.contains("not a regular file") && !text.contains("--force"), "{text}");
}

#[test]
fn a_refused_or_failed_export_leaves_the_folder_as_it_was() {
    let recorded = recorded();
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let names = || {
        let entries = fs::read_dir(folder.path()).expect("a folder");
        let mut names: Vec<_> = entries.map(|entry| entry.expect("an entry").file_name()).collect();
        names.sort();
        names
    };
    // The recording has cycles of the finger before the first event. So the tool has already begun the file of the
    // cycles when it finds the old file of the events.
    fs::write(path("finger-2-events.csv"), "old").expect("written");
    let output = folder.path().to_str().expect("a name");
    let refused = tool(folder.path(), &["export", recorded.file().to_str().expect("a name"), "--output", output]);
    assert_eq!(refused.status.code(), Some(2), "{refused:?}");
    assert_eq!(names(), ["finger-2-events.csv"]);

    // The recording has cycles of the finger before the damage. So the tool has already begun the file of the cycles
    // when it finds the damage.
    fs::copy(recorded.file(), path("box.jsonl")).expect("copied");
    let recording = ["record", "--from-black-box", "box.jsonl", "-o", "hand.mcap"];
    done(folder.path(), &recording);
    let whole = fs::read(path("hand.mcap")).expect("read");
    fs::write(path("hand.mcap"), damaged(&whole)).expect("written");
    fs::write(path("hand-finger2.csv"), "old").expect("written");
    let before = names();
    let failed = tool(folder.path(), &["export", "hand.mcap", "--force"]);
    assert_eq!(failed.status.code(), Some(1), "{failed:?}");
    assert_eq!(names(), before);
    assert_eq!(fs::read_to_string(path("hand-finger2.csv")).expect("read"), "old");
}

/// A limit on the size of files acts like a full disk.
#[test]
fn a_full_disk_is_named_with_the_folder() {
    let recorded = recorded();
    let folder = tempfile::tempdir().expect("a folder");
    let script = "trap '' XFSZ; ulimit -f 16; exec \"$0\" export \"$1\" --output csv";
    fs::create_dir(folder.path().join("csv")).expect("made");
    let mut shell = Command::new("sh");
    shell.args(["-c", script, env!("CARGO_BIN_EXE_sun2xp")]).arg(recorded.file()).current_dir(folder.path());
    let run = shell.output().expect("the shell runs");
    let reported = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.code() == Some(1) && reported.contains("cannot write into csv: "), "{reported}");
    assert_eq!(fs::read_dir(folder.path().join("csv")).expect("there").count(), 0);
}

/// The pipe at standard output has no reader, so the tool cannot print the names of the files.
#[test]
fn finished_work_succeeds_even_if_nobody_reads_the_printed_names() {
    let recorded = recorded();
    let folder = tempfile::tempdir().expect("a folder");
    let file = recorded.file();
    let file = file.to_str().expect("a name");
    let output = folder.path().to_str().expect("a name");
    for (arguments, made) in [
        (&["export", file, "--output", output][..], "finger-2-finger2.csv"),
        (&["plot", file, "--output", "step.svg"], "step.svg"),
        (&["record", "--from-black-box", file, "-o", "hand.mcap"], "hand.mcap"),
    ] {
        let (reader, writer) = io::pipe().expect("a pipe");
        drop(reader);
        let mut tool = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
        let status = tool.args(arguments).current_dir(folder.path()).stdout(writer).status().expect("the tool runs");
        assert!(status.code() == Some(0) && folder.path().join(made).exists(), "{arguments:?}: {status}");
    }
}

/// An export removes its unfinished files when it returns, so a signal must not end the process at once. A full pipe
/// stops the tool until it is interrupted.
#[test]
fn an_interrupted_export_returns() {
    let recorded = recorded();
    let mut tool = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
    tool.arg("export").arg(recorded.file()).args(["--output", "-"]).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut tool = tool.spawn().expect("the tool runs");
    let mut output = tool.stdout.take().expect("a pipe");
    output.read_exact(&mut [0]).expect("the first byte");
    // SAFETY: the process has not been waited for, so the number is still its own.
    assert_eq!(unsafe { libc::kill(tool.id() as libc::pid_t, libc::SIGINT) }, 0);
    io::copy(&mut output, &mut io::sink()).expect("the rest");
    let ended = tool.wait_with_output().expect("the tool ends");
    assert_eq!(ended.status.code(), Some(1), "{ended:?}");
    assert!(String::from_utf8_lossy(&ended.stderr).contains("interrupted"), "{ended:?}");
}
