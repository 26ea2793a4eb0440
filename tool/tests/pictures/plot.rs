//! Pictures: their curves have the recorded values, and they are not blank.

use crate::recorded::{done, recorded, tool};
use resvg::tiny_skia::Pixmap;
use std::fs;
use std::path::{Path, PathBuf};
use sun2xp::control::Activity;

const KINDS: [&str; 5] = ["step", "tensions", "stiffness", "timing", "faults"];

/// Environment variable with a folder in which the pictures are kept. Without it they are deleted.
const KEPT: &str = "SUN2XP_PICTURES";

fn folder() -> (Option<tempfile::TempDir>, PathBuf) {
    match std::env::var_os(KEPT) {
        Some(folder) => (None, folder.into()),
        None => {
            let folder = tempfile::tempdir().expect("a folder");
            let path = folder.path().to_path_buf();
            (Some(folder), path)
        }
    }
}

fn plot(folder: &Path, kind: &str, name: &str, options: &[&str]) -> Vec<u8> {
    let file = recorded().file();
    let file = file.to_str().expect("a name");
    let reported = done(folder, &[&["plot", file, "--kind", kind, "--output", name], options].concat());
    assert_eq!(reported.trim(), name);
    fs::read(folder.join(name)).expect("a picture")
}

/// An attribute of an element.
fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    let begin = element.split_once(&format!(" {name}=\"")).unwrap_or_else(|| panic!("no {name}: {element}")).1;
    begin.split_once('"').expect("a quote").0
}

fn numbers(text: &str) -> Vec<f64> {
    text.split_whitespace().map(|word| word.parse().expect("a number")).collect()
}

/// The points of a curve of an SVG, converted from pixels to the units of the axes.
fn curve(svg: &str, name: &str) -> Vec<[f64; 2]> {
    let (before, _) = svg.split_once(&format!("data-name=\"{name}\"")).unwrap_or_else(|| panic!("no curve {name}"));
    let panel = before.rsplit_once("class=\"panel\"").expect("a panel").1;
    let (frame, x, y) = (
        numbers(attribute(panel, "data-frame")),
        numbers(attribute(panel, "data-x")),
        numbers(attribute(panel, "data-y")),
    );
    let path = svg.lines().find(|line| line.contains(&format!("data-name=\"{name}\""))).expect("a line");
    let points = attribute(path, "d").split(['M', 'L']).filter(|point| !point.is_empty()).map(numbers);
    let place = |point: Vec<f64>| {
        let (across, down) = ((point[0] - frame[0]) / frame[2], (point[1] - frame[1]) / frame[3]);
        [x[0] + across * (x[1] - x[0]), y[1] - down * (y[1] - y[0])]
    };
    points.map(place).collect()
}

#[test]
fn curves_have_the_recorded_values() {
    let (_kept, folder) = folder();
    let recorded = recorded();
    let step = String::from_utf8(plot(&folder, "step", "step.svg", &[])).expect("text");
    let tensions = String::from_utf8(plot(&folder, "tensions", "tensions.svg", &[])).expect("text");
    let measured = curve(&step, "joint 2");
    let tension = curve(&tensions, "tension 3");
    assert_eq!((measured.len(), tension.len()), (recorded.computed(), recorded.computed()));
    let cycles: Vec<_> = recorded.recording.cycles.iter().filter(|cycle| cycle.control.is_some()).collect();
    let start = recorded.recording.cycles[0].began;
    for ((joint, tension), cycle) in measured.iter().zip(&tension).zip(&cycles) {
        let report = cycle.control.as_ref().expect("computed").report;
        let seconds = (cycle.began - start) as f64 * 1e-9;
        // Coordinates are rounded to 0.01 pixels. The panels are at least 190 pixels high and some 500 pixels wide.
        assert!((joint[0] - seconds).abs() < 2e-3 && (joint[1] - report.joints[2].to_degrees()).abs() < 0.02);
        assert!((tension[1] - report.tensions[2]).abs() < 0.02, "{tension:?} {}", report.tensions[2]);
    }
    let follows = |cycle: &&&sun2xp::finger::CycleRecord<String>| {
        matches!(cycle.control.as_ref().expect("computed").input.activity, Activity::Follow(_))
    };
    assert_eq!(curve(&step, "joint 0 set point").len(), cycles.iter().filter(follows).count());
    assert!(step.contains("time, s") && step.contains("degrees") && step.contains("cm"), "labels have units");
    assert!(tensions.contains("tension, N") && tensions.contains("t_min"));
}

#[test]
fn every_kind_is_drawn_as_png_of_the_right_size() {
    let (_kept, folder) = folder();
    for kind in KINDS {
        let name = format!("{kind}.png");
        let picture = Pixmap::decode_png(&plot(&folder, kind, &name, &["--width", "1200"])).expect("a PNG");
        assert_eq!(picture.width(), 1200, "{kind}");
        assert!((300..2000).contains(&picture.height()), "{kind}: {}", picture.height());
        let paper = picture.pixel(0, 0).expect("a pixel");
        let drawn = picture.pixels().iter().filter(|&&pixel| pixel != paper).count() as f64;
        let part = drawn / picture.pixels().len() as f64;
        assert!((0.01..0.8).contains(&part), "{kind}: {part}");
        let dark = |pixel: &resvg::tiny_skia::PremultipliedColorU8| pixel.red() < 90 && pixel.green() < 90;
        // The title consists of dark pixels near the upper edge, so the embedded font was found.
        let title = picture.pixels()[..1200 * 45].iter().filter(|pixel| dark(pixel)).count();
        assert!(title > 200, "{kind}: {title}");
    }
    let twice = Pixmap::decode_png(&plot(&folder, "step", "step-2400.png", &["--width", "2400"])).expect("a PNG");
    let once = Pixmap::decode_png(&fs::read(folder.join("step.png")).expect("a picture")).expect("a PNG");
    assert_eq!((twice.width(), twice.height()), (2400, 2 * once.height()));
}

#[test]
fn the_time_line_names_the_fault_and_the_lost_replies() {
    let (_kept, folder) = folder();
    let svg = String::from_utf8(plot(&folder, "faults", "faults.svg", &[])).expect("text");
    assert!(svg.contains(">running<") && svg.contains("faulted: ") && svg.contains("lost replies"), "{svg}");
    assert!(svg.contains("#d55e00"), "a lost reply or a fault has its colour");
}

#[test]
fn a_part_of_the_time_is_drawn_and_wrong_requests_are_refused() {
    let (_kept, folder) = folder();
    let between = |from: &str, to: &str| {
        let part = plot(&folder, "tensions", "part.svg", &["--from", from, "--to", to]);
        curve(&String::from_utf8(part).expect("text"), "tension 1")
    };
    let (points, wider) = (between("0.5", "0.7"), between("0.4", "0.8"));
    assert!(points.iter().all(|point| (0.499..=0.701).contains(&point[0])));
    // 0.2 s at 500 Hz are 100 cycles, or fewer if the machine is busy and the servo skips periods. Coordinates are
    // rounded.
    let expected = wider.iter().filter(|point| (0.5..=0.7).contains(&point[0])).count();
    assert!((20..=105).contains(&points.len()) && points.len().abs_diff(expected) <= 2, "{} {expected}", points.len());
    assert!(wider.len() > points.len() + 20, "{} {}", wider.len(), points.len());
    let file = recorded().file();
    let file = file.to_str().expect("a name");
    for (arguments, status, part) in [
        (["--output", "x.pdf"], 2, ".svg or .png"),
        (["--from", "1000"], 1, "no cycle"),
        (["--finger", "3"], 1, "the controller of this finger ran"),
    ] {
        let output = tool(&folder, &[&["plot", file], arguments.as_slice()].concat());
        assert_eq!(output.status.code(), Some(status), "{output:?}");
        assert!(String::from_utf8_lossy(&output.stderr).contains(part), "{output:?}");
    }
}
