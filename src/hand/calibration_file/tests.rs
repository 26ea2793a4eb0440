//! Tests of storing results in a file.

use super::*;
use crate::calibration::{Findings, Identified, IdentifiedArms, Signs, Tolerances, Zeros};
use crate::model::FingerNumber;
use nalgebra::{Vector3, Vector4};
use std::fs;

/// Stores `found` in a file that contains `text`, and returns the text of the file afterwards.
fn try_to_store(text: &str, found: &[Found]) -> Result<String, ConfigurationError> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hand.toml");
    fs::write(&path, text).expect("written");
    let stored = store_findings(&path, found);
    let files = fs::read_dir(folder.path()).expect("a folder").count();
    assert_eq!(files, 1, "no temporary file is left");
    let after = fs::read_to_string(&path).expect("there");
    assert!(stored.is_ok() || after == text, "the results were refused, but the file has changed");
    stored.map(|()| after)
}

fn stored(text: &str, found: &[Found]) -> String {
    let after = try_to_store(text, found).unwrap_or_else(|error| panic!("{error}"));
    parse(&after, FingersWithIo::default()).expect("still usable");
    // Storing again changes nothing.
    assert_eq!(try_to_store(&after, found).expect("stored"), after);
    after
}

fn zeros(finger: FingerNumber, encoder: [i32; 4], gauge: f64) -> Found {
    let findings =
        Findings::Zeros(Zeros { encoder, gauge: [gauge; 4], joint_error: Vector3::zeros(), range_error: None });
    Found::by_calibration(&findings, finger, &Configuration::default())
}

fn signs(finger: FingerNumber, motor: [i8; 4], gauge: [i8; 4]) -> Found {
    let findings = Findings::Signs(Signs { motor, encoder: [1; 4], gauge });
    Found::by_calibration(&findings, finger, &Configuration::default())
}

fn friction(stiffness: [f64; 4], conduit: f64) -> Identified {
    Identified {
        tendon_stiffness: stiffness.into(),
        stiffness_tolerance: 0.03,
        travel_residual: 0.0,
        tolerances: Tolerances { friction: 0.2, moment_arms: None, gauges: 0.05 },
        motor_coulomb: [0.07; 4].into(),
        conduit: [conduit; 4].into(),
        pulley: [0.0; 4].into(),
        gauge_gain: [1.0; 4].into(),
        motor_ratio: [1.0; 4].into(),
        joint_coulomb: Vector3::repeat(0.05),
        joint_viscous: Vector3::repeat(0.05),
        rotor_inertia: None,
        moment_arms: None,
    }
}

fn identified(finger: FingerNumber, stiffness: [f64; 4], conduit: f64) -> Found {
    by_identification(finger, friction(stiffness, conduit))
}

fn by_identification(finger: FingerNumber, found: Identified) -> Found {
    let findings = Findings::Identified(found);
    let mut configuration = Configuration::default();
    findings.apply(&mut configuration.fingers[finger.index()]);
    Found::by_calibration(&findings, finger, &configuration)
}

#[test]
fn moment_arms_are_stored_with_the_zeros_that_belong_to_them() {
    let r = ConfiguredFinger::default().r() * 1.02;
    let zero = [5, 6, 7, 8];
    let moment_arms = Some(IdentifiedArms { r, encoder_zero: zero });
    let friction = by_identification(FingerNumber::TWO, Identified { moment_arms, ..friction([300.0; 4], 0.05) });
    let file = "[finger.2.geometry]\n\
                # Measured.\n\
                r = [ # joints\n  \
                  [-1.09, 0.62, 0.62, -1.09], # 0\n  \
                  [1.09, 0.62, -0.62, -1.09],\n  \
                  [0.0, 0.62, -0.62, 0.000]\n\
                ] # report\n";
    // These zeros were found with the new moment arms, before the moment arms were stored.
    let mut later = Configuration::default();
    later.fingers[1].geometry.r = std::array::from_fn(|row| std::array::from_fn(|column| r[(row, column)]));
    let zeros = Zeros { encoder: zero, gauge: [0.0; 4], joint_error: Vector3::zeros(), range_error: None };
    let mut both = friction.clone();
    both.add(Found::by_calibration(&Findings::Zeros(zeros), FingerNumber::TWO, &later));
    for found in [friction, both] {
        let text = stored(file, &[found]);
        let rows = "# Measured.\nr = [ # joints\n  \
                      [-1.1118, 0.6324, 0.6324, -1.1118], # 0\n  \
                      [1.1118, 0.6324, -0.6324, -1.1118],\n  \
                      [0.0, 0.6324, -0.6324, 0.000]\n\
                    ] # report\n";
        assert!(text.contains(rows) && text.contains("zero = [5, 6, 7, 8]"), "{text}");
    }
}

#[test]
fn an_inertia_is_stored_only_if_it_differs() {
    let same = stored(FILE_OF_TWO, &[by_identification(FingerNumber::TWO, friction([300.0; 4], 0.05))]);
    assert!(!same.contains("inertia"), "{same}");
    let rotor_inertia = Some(Vector4::new(9e-7, 6e-7, 8.5e-7, 7e-7));
    let other = by_identification(FingerNumber::TWO, Identified { rotor_inertia, ..friction([300.0; 4], 0.05) });
    let read = parse(&stored(FILE_OF_TWO, &[other]), FingersWithIo::default()).expect("usable");
    assert_eq!(read.fingers[1].motor.inertia, [9e-7, 6e-7, 8.5e-7, 7e-7]);
}

/// The open hand keeps the moment arms and the friction with all digits, and the file has them rounded to six digits.
/// This difference does not count as a change of the file.
#[test]
fn results_that_follow_stored_results_are_stored_too() {
    let r = ConfiguredFinger::default().r() * 1.021_234_567_8;
    let moment_arms = Some(IdentifiedArms { r, encoder_zero: [5; 4] });
    let findings = Findings::Identified(Identified { moment_arms, ..friction([301.234_567_8; 4], 0.051_234_567_8) });
    let mut present = Configuration::default();
    findings.apply(&mut present.fingers[1]);
    let text = stored(FILE_OF_TWO, &[Found::by_calibration(&findings, FingerNumber::TWO, &present)]);
    let zeros = Zeros { encoder: [9; 4], gauge: [0.0; 4], joint_error: Vector3::zeros(), range_error: None };
    let zeros = Found::by_calibration(&Findings::Zeros(zeros), FingerNumber::TWO, &present);
    let text = stored(&text, &[zeros, Found::bound(7.5, FingerNumber::TWO, &present)]);
    assert!(text.contains("zero = [9, 9, 9, 9]") && text.contains("bound = 7.5"), "{text}");
    // Arms that somebody has changed by more than the rounding are still noticed.
    present.fingers[1].geometry.r[0][0] *= 1.001;
    let error = try_to_store(&text, &[Found::bound(7.5, FingerNumber::TWO, &present)]).expect_err("other arms");
    assert!(error.to_string().contains("finger.2.geometry.r"), "{error}");
}

const FILE_OF_TWO: &str = "[finger.2]\nport = \"simulated\"\n";

fn bound(finger: FingerNumber, bound: f64) -> Found {
    Found::bound(bound, finger, &Configuration::default())
}

const FILE: &str = "# The hand in the corner.\n\n[hand]\nrate = 500 # slow cable\n\n[finger.encoder]\n\
     zero = [1, 2, 3, 4]\n\n[finger.2]\nport = \"simulated\"   # for now\n[finger.2.tendon]\n\
     # As measured in May:\nstiffness = [ 300.0, 300, # new\n  310.0, 300.0 ] # N/cm\n";

#[test]
fn values_that_are_present_change_nothing() {
    assert_eq!(stored(FILE, &[]), FILE);
    assert_eq!(
        stored(FILE, &[zeros(FingerNumber::ONE, [1, 2, 3, 4], 0.0), signs(FingerNumber::THREE, [1; 4], [1; 4])]),
        FILE
    );
}

#[test]
fn results_replace_their_numbers_and_nothing_else() {
    let text = stored(FILE, &[identified(FingerNumber::TWO, [330.0, 301.123_456_789, 310.0, 300.0], 0.05)]);
    let expected = FILE.replace("[ 300.0, 300,", "[ 330.0, 301.123,");
    assert_eq!(text, expected + "stiffness_tolerance = 0.03\n");
}

#[test]
fn shared_values_are_overridden_for_one_finger() {
    let text =
        stored(FILE, &[zeros(FingerNumber::ONE, [5, 6, 7, -8], 0.0), signs(FingerNumber::ONE, [1, -1, 1, 1], [1; 4])]);
    assert!(text.starts_with(FILE), "{text}");
    assert!(text.contains("[finger.1.encoder]\nzero = [5, 6, 7, -8]"), "{text}");
    assert!(text.contains("[finger.1.motor]\nsign = [1, -1, 1, 1]"), "{text}");
}

#[test]
fn results_are_stored_in_inline_tables_too() {
    let text = "finger.3 = { encoder = { zero = [0, 0, 0, 0] } }\n";
    let text = stored(
        text,
        &[zeros(FingerNumber::THREE, [9, 0, 0, 0], 0.0), identified(FingerNumber::THREE, [300.0; 4], 0.07)],
    );
    assert!(text.contains("zero = [9, 0, 0, 0]"), "{text}");
    assert!(text.contains("conduit = [0.07, 0.07, 0.07, 0.07]"), "{text}");
}

#[test]
fn a_single_number_keeps_its_comment_or_is_added() {
    let file = "[finger.1.stiffness]\nbound = 4.0 # N/cm, by hand\n";
    let text = stored(file, &[bound(FingerNumber::ONE, 8.300000001), bound(FingerNumber::THREE, 7.0)]);
    let expected = "[finger.1.stiffness]\nbound = 8.3 # N/cm, by hand\n\n[finger.3.stiffness]\nbound = 7.0\n";
    assert_eq!(text, expected);
}

#[test]
fn results_of_other_fingers_stay() {
    // All results were found before any of them was stored.
    let (first, second) =
        (zeros(FingerNumber::ONE, [5, 6, 7, 8], 200.0), zeros(FingerNumber::TWO, [9, 9, 9, 9], 190.0));
    let bound = Found::bound(7.5, FingerNumber::ONE, &parse(FILE, FingersWithIo::default()).expect("usable"));
    let text = stored(&stored(FILE, &[first]), &[second, bound]);
    let hand = parse(&text, FingersWithIo::default()).expect("usable");
    assert_eq!(hand.fingers.each_ref().map(|finger| finger.encoder.zero[0]), [5, 9, 1]);
    assert_eq!(hand.fingers.each_ref().map(|finger| finger.gauge.zero[0]), [200.0, 190.0, 0.0]);
    assert_eq!(hand.fingers.each_ref().map(|finger| finger.stiffness.bound), [Some(7.5), None, None]);
}

#[test]
fn signs_are_applied_to_the_magnitudes_in_the_file() {
    let file = "[finger.1.gauge]\nnewton_per_count = [0.0312345678, 0.02, -0.03, 0.04] # measured\n";
    let text = stored(file, &[signs(FingerNumber::ONE, [1; 4], [1, -1, -1, 1])]);
    assert_eq!(text, file.replace("0.02,", "-0.02,"));
}

#[test]
fn byte_order_marks_and_line_ends_are_kept() {
    for file in [FILE.replace('\n', "\r\n"), format!("\u{feff}{FILE}")] {
        let text = stored(&file, &[zeros(FingerNumber::ONE, [5, 6, 7, 8], 0.0)]);
        assert!(text.starts_with(&file), "{text:?}");
        assert_eq!(text.contains("\nzero = [5, 6, 7, 8]\n"), !file.contains('\r'), "{text:?}");
    }
    let text = stored("[hand]\nrate = 1000 # no line end", &[zeros(FingerNumber::ONE, [5, 6, 7, 8], 0.0)]);
    assert_eq!(text, "[hand]\nrate = 1000 # no line end\n\n[finger.1.encoder]\nzero = [5, 6, 7, 8]\n");
}

#[test]
fn a_file_that_no_longer_fits_is_unchanged_and_the_reason_is_reported() {
    let radius = "[finger.1.geometry]\nmotor_radius = [0.05, 0.05, 0.05, 0.05]\n";
    let error = try_to_store(radius, &[zeros(FingerNumber::ONE, [5; 4], 0.0)]).expect_err("other motors").to_string();
    assert!(error.contains("finger.1.geometry.motor_radius is [0.05, 0.05, 0.05, 0.05] there"), "{error}");
    // The change does not affect finger 2.
    stored(radius, &[zeros(FingerNumber::TWO, [5; 4], 0.0)]);
    let error =
        try_to_store("[hand]\nrate = 500\n", &[bound(FingerNumber::TWO, 7.0)]).expect_err("another rate").to_string();
    assert!(error.contains("hand.rate is 500 there, and was 1000 during the calibration"), "{error}");
    for (text, line, reason) in
        [("[hand]\nrate = \n", Some(2), ""), ("\n[finger.3.tendon]\nmaximum = 8\n", Some(3), "for its pretension")]
    {
        match try_to_store(text, &[zeros(FingerNumber::ONE, [5; 4], 0.0)]).expect_err("unusable") {
            ConfigurationError::Invalid { line: found, reason: reported, .. } => {
                assert!(found == line && reported.contains(reason), "{found:?} {reported}");
            }
            other => panic!("{other}"),
        }
    }
    let error = try_to_store("", &[bound(FingerNumber::ONE, 1e9)]).expect_err("beyond its range").to_string();
    assert!(error.contains("with the new calibration, finger.1.stiffness.bound"), "{error}");
}

/// The program provides the hardware of finger 1, so that its port and board in the file do not matter.
#[test]
fn results_of_hardware_of_the_program_are_stored_whatever_port_the_file_names() {
    let mut open = Configuration::default();
    open.fingers[0].provide(FingerNumber::ONE);
    let zeros = Zeros { encoder: [5; 4], gauge: [8190.0; 4], joint_error: Vector3::zeros(), range_error: None };
    let found = Found::by_calibration(&Findings::Zeros(zeros), FingerNumber::ONE, &open);
    for text in [
        "",
        "[finger]\nport = 'simulated'\n",
        "[hand]\nfingers = [1]\n[finger.1]\nboard = '00 01 02 03 04 05 06 07 08 09 0a 0b'\n",
        "[finger.2]\nport = '/dev/a'\n[finger.3]\nport = '/dev/b'\n",
    ] {
        let after = try_to_store(text, std::slice::from_ref(&found)).unwrap_or_else(|error| panic!("{text}: {error}"));
        let finger = &parse(&after, found.with_io()).expect("usable").fingers[0];
        assert_eq!((finger.encoder.zero, finger.gauge.zero), ([5; 4], [8190.0; 4]), "{after}");
    }
    let error = try_to_store("[finger.1]\naddress = 5\n", &[found]).expect_err("another address").to_string();
    assert!(error.contains("finger.1.address"), "{error}");
}

#[test]
fn the_error_of_a_failed_storing_names_the_file() {
    let error = store_findings(Path::new("/proc/version"), &[]).expect_err("not the text of a configuration");
    assert!(error.to_string().contains("/proc/version"), "{error}");
}
