use super::*;
use crate::calibration::{Signs, Zeros};
use crate::model::configuration::BoardNumber;
use nalgebra::Vector3;

fn zeros() -> Findings {
    let joint_error = Vector3::zeros();
    Findings::Zeros(Zeros { encoder: [1, 2, 3, 4], gauge: [200.0; 4], joint_error, range_error: None })
}

fn keys(found: &Found) -> Vec<String> {
    found.values.iter().map(|value| format!("{}.{}", value.section, value.key)).collect()
}

#[test]
fn results_contain_only_the_keys_that_were_found() {
    let configuration = Configuration::default();
    let found = Found::by_calibration(&zeros(), FingerNumber::TWO, &configuration);
    assert_eq!(keys(&found), ["encoder.zero", "gauge.zero"]);
    let found = Found::bound(7.0, FingerNumber::TWO, &configuration);
    assert_eq!(keys(&found), ["stiffness.bound"]);
}

#[test]
fn later_results_are_added_key_by_key() {
    let configuration = Configuration::default();
    let mut found = Found::by_calibration(&zeros(), FingerNumber::ONE, &configuration);
    found.values.push(value("gauge", "newton_per_count", Numbers::Real(vec![1.0, 2.0, -3.0, 4.0])));
    let signs = Findings::Signs(Signs { motor: [1; 4], encoder: [-1; 4], gauge: [-1, 1, 1, -1] });
    found.add(Found::by_calibration(&signs, FingerNumber::ONE, &configuration));
    assert_eq!(keys(&found), ["encoder.zero", "gauge.zero", "gauge.newton_per_count", "motor.sign", "encoder.sign"]);
    assert_eq!(found.values[2].numbers, Numbers::Real(vec![-1.0, 2.0, 3.0, -4.0]));
}

/// The file names the board. The open hand has the port at which the board was found.
#[test]
fn the_board_matters_and_not_the_port_at_which_it_was_found() {
    let mut file = Configuration::default();
    file.fingers[1].board = Some(BoardNumber([7; 12]));
    let mut open = file.clone();
    open.fingers[1].port = "/dev/ttyACM3".into();
    let found = Found::by_calibration(&zeros(), FingerNumber::TWO, &open);
    assert_eq!(found.misfit(&file), None);
    file.fingers[1].board = Some(BoardNumber([8; 12]));
    assert_eq!(found.misfit(&file).expect("another board").key, "finger.2.board");
}

#[test]
fn what_findings_depend_on_is_compared() {
    let found = |configuration: &Configuration| {
        let calibration = Found::by_calibration(&zeros(), FingerNumber::TWO, configuration);
        [calibration, Found::bound(7.0, FingerNumber::TWO, configuration)]
    };
    type Change = fn(&mut Configuration);
    let changes: [(Change, Option<&str>, Option<&str>); 6] = [
        (|_| {}, None, None),
        (|hand| hand.fingers[0].geometry.motor_radius = [0.05; 4], None, None),
        (|hand| hand.fingers[1].encoder.zero = [9; 4], None, None),
        (
            |hand| hand.fingers[1].geometry.motor_radius[2] = 0.05,
            Some("finger.2.geometry.motor_radius"),
            Some("finger.2.geometry.motor_radius"),
        ),
        (|hand| hand.fingers[1].controller.dither = Some(1.0), None, Some("finger.2.controller.dither")),
        (|hand| hand.hand.rate = 500.0, None, Some("hand.rate")),
    ];
    for (change, calibration, bound) in changes {
        let mut changed = Configuration::default();
        let before = found(&changed);
        change(&mut changed);
        let misfits = before.map(|found| found.misfit(&changed).map(|misfit| misfit.key));
        assert_eq!(misfits.each_ref().map(Option::as_deref), [calibration, bound]);
    }
    let mut changed = Configuration::default();
    let [_, bound] = found(&changed);
    changed.fingers[1].controller.dither = Some(1.0);
    let misfit = bound.misfit(&changed).expect("a difference");
    assert_eq!((misfit.was.as_str(), misfit.is.as_str()), ("not set", "1.0"));
}
