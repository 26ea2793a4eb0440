//! Faults and warnings that the finger's servo detects itself. tests/fault_injection tests most faults and warnings
//! of tendons, gauges, encoders and motors. tests/hand_ports tests the errors when a port is opened.

use crate::rig::{Bench, MILLISECOND, TARGET};
use nalgebra::Vector3;
use std::io;
use sun2xp::board::protocol::{Frame, Kind, Reason, Refused, Status, Stop};
use sun2xp::board::{PortError, Transport};
use sun2xp::calibration::{Calibration, Task};
use sun2xp::finger::{Adjustable, CalibrationRun, Fault, FaultKind, Order, Stage};
use sun2xp::model::FingerNumber;
use sun2xp::model::Part;
use sun2xp::model::configuration::Configuration;
use sun2xp::simulated::{Defect, LineFault};

#[test]
fn a_joint_that_is_pushed_beyond_its_limit_is_reported_at_its_stop() {
    let mut bench = Bench::with(|configuration| {
        // The stop is close: 3 degrees beyond the limit.
        (configuration.fingers[0].joints.minimum_degrees[0], configuration.fingers[0].joints.maximum_degrees[0]) =
            (-60.0, 5.0);
    });
    assert_eq!(bench.warning(), None);
    bench.with_finger(|finger| finger.plant().set_external_force(Vector3::new(5.0, 0.0, 0.0)));
    let warning = bench.warns(FaultKind::JointAtStop);
    assert!(warning.part == Part::Joint(0) && warning.value > 7.0, "{warning}");
    bench.with_finger(|finger| finger.plant().set_external_force(Vector3::zeros()));
    bench.cycles(3000);
    assert_eq!((bench.stage(), bench.warning()), (Stage::Running, None), "it went on, and the warning went away");
}

/// Returns a finger whose tendon 3 has just been without tension for a moment, and the warning of this.
fn warned_of_slack() -> (Bench, Fault) {
    let mut bench = Bench::new();
    bench.with_finger(|finger| finger.inject(&Defect::SlippingTendon { tendon: 3, grip: 0.0 }));
    bench.cycles(6);
    bench.with_finger(|finger| finger.repair());
    let warning = bench.warns(FaultKind::SlackInMotion);
    (bench, warning)
}

/// The monitors of a faulted finger do not run, but its warnings become older.
#[test]
fn a_warning_ends_a_second_after_its_cause_although_the_finger_is_faulted() {
    let (mut bench, warning) = warned_of_slack();
    bench.mailbox.stop();
    bench.faults(FaultKind::FingerStopCall);
    bench.cycles(900);
    assert_eq!(bench.warning(), Some(warning));
    bench.cycles(200);
    assert_eq!(bench.warning(), None);
    bench.faults(FaultKind::FingerStopCall);
}

#[test]
fn a_finger_that_reads_an_angle_it_cannot_have_does_not_become_a_spring() {
    let mut bench = Bench::believing(
        |_| {},
        |configuration| {
            configuration.fingers[0].encoder.zero = configuration.fingers[0].encoder.zero.map(|zero| zero + 40_000)
        },
    );
    let fault = bench.faults(FaultKind::ImpossiblePose);
    let read = bench.report().cycle.joints[usize::from(fault.part.number())].to_degrees();
    assert!(fault.value == read && fault.value.abs() > 90.0, "{fault}");
}

#[test]
fn a_tendon_that_is_without_tension_for_a_moment_is_no_fault() {
    let (mut bench, warning) = warned_of_slack();
    assert!(warning.part == Part::Tendon(3) && warning.value < 0.5, "{warning}");
    bench.cycles(3000);
    assert_eq!((bench.stage(), bench.warning()), (Stage::Running, None));
}

#[test]
fn a_line_that_loses_some_replies_is_reported_as_noisy() {
    let mut bench = Bench::new();
    bench.with_cable(|cable| cable.inject(LineFault::Drop, 0.05, u64::MAX, 3));
    let warning = bench.warns(FaultKind::LineNoise);
    assert!((2.0..10.0).contains(&warning.value), "{warning}");
    bench.with_cable(|cable| cable.clear());
    bench.cycles(10_000);
    assert_eq!((bench.stage(), bench.warning()), (Stage::Running, None));
}

#[test]
fn a_board_that_another_program_has_stopped_is_reported() {
    let mut bench = Bench::new();
    bench.another_program_sends(Frame::Stop(Stop));
    let fault = bench.faults(FaultKind::BoardStopped);
    assert!(Status(fault.value as u16).has(Status::ENDED), "{fault}");
}

#[test]
fn a_board_that_refuses_this_fingers_frames_is_reported_with_the_reason() {
    let mut bench = Bench::new();
    let reason = Reason::UnknownFrame;
    bench.answer_with(Frame::Refused(Refused { request: Kind::Command as u8, reason, detail: 9 }));
    let fault = bench.faults(FaultKind::CommandRefused);
    assert_eq!(fault.value, f64::from(reason.number()));
    bench.cycles(3);
    assert!(bench.with_finger(|finger| finger.status().has(Status::ENDED)), "the board must have ended");
}

#[test]
fn a_port_that_fails_is_reported_with_its_errno_and_its_board_is_stopped() {
    let mut bench = Bench::new();
    bench.fail_port(PortError::Failed(io::Error::from_raw_os_error(libc::EIO)));
    let fault = bench.faults(FaultKind::PortFailed);
    assert_eq!(fault.value, f64::from(libc::EIO));
    bench.cycles(3);
    assert!(bench.with_finger(|finger| finger.status().has(Status::ENDED) && finger.motor_torques().amax() == 0.0));
}

#[test]
fn a_late_servo_gives_a_warning() {
    let mut bench = Bench::new();
    for _ in 0..100 {
        bench.cycles(19);
        // Other work on the machine takes three and a half periods.
        bench.with_cable(|cable| {
            let later = cable.now() + 7 * MILLISECOND / 2;
            cable.advance_to(later);
        });
    }
    let warning = bench.warns(FaultKind::Overrun);
    assert!((2.0..10.0).contains(&warning.value), "{warning}");
    // The periods that are skipped in the last round are counted only in the next cycle.
    assert!(bench.report().losses.skipped_periods >= 99, "{}", bench.report().losses.skipped_periods);
}

#[test]
fn a_board_that_clips_torques_is_reported() {
    let mut bench = Bench::believing(
        |configuration| configuration.fingers[0].motor.torque_limit = [1.0; 4],
        |configuration| configuration.fingers[0].motor.torque_limit = [4.75; 4],
    );
    bench.opens();
    assert_eq!(bench.warning(), None);
    bench.with_finger(|finger| finger.plant().set_external_force(Vector3::new(0.0, 0.0, -4.0)));
    bench.warns(FaultKind::CurrentLimit);
}

#[test]
fn a_torque_beyond_the_tension_limits_is_reported() {
    let mut bench = Bench::with(|configuration| configuration.fingers[0].tendon.maximum = 12.0);
    bench.with_finger(|finger| finger.plant().set_external_force(Vector3::new(0.0, 0.0, -1.5)));
    bench.mailbox.send(|set_point| set_point.joints = TARGET * 1.3).expect("not faulted");
    let warning = bench.warns(FaultKind::TorqueNotAdmitted);
    assert!((0.0..100.0).contains(&warning.value), "{warning}");
}

#[test]
fn a_calibration_that_gives_up_leaves_its_warning() {
    let mut bench = Bench::new();
    let mut configuration = Configuration::default();
    let calibration = Calibration::new(Task::Zero, &configuration.fingers[0], 1000.0).expect("a calibration");
    configuration.fingers[0] = Calibration::controlled(&configuration.fingers[0], configuration.hand.rate);
    let adjustable =
        Adjustable { number: 1, ..Adjustable::new(&configuration, FingerNumber::ONE).expect("a controller") };
    let order = Order::Calibrate(CalibrationRun { calibration, adjustable });
    assert_eq!(bench.mailbox.order(order), Ok(Some(1)));
    // Until the routine takes over, the finger is a spring whose monitors would detect the fault.
    bench.until("taken over", |bench| bench.report().cycle.desired_tensions.min() < 0.0);
    bench.with_finger(|finger| finger.inject(&Defect::DeadGauge { gauge: 2, count: Some(2000) }));
    bench.warns(FaultKind::CalibrationFailed);
    assert_eq!(bench.stage(), Stage::Limp);
    bench.cycles(3000);
    assert_eq!(
        bench.warning().map(|warning| warning.kind),
        Some(FaultKind::CalibrationFailed),
        "as long as it is limp"
    );
}

/// The library detects the overload from the torques that it commands. The board reports nothing.
#[test]
fn a_motor_above_its_continuous_torque_is_limited_and_then_stopped() {
    let mut bench = Bench::with(|configuration| {
        configuration.fingers[0].motor.continuous_torque = [0.8; 4];
        configuration.fingers[0].motor.thermal_time = 0.5;
    });
    bench.with_finger(|finger| finger.plant().set_external_force(Vector3::new(0.0, 0.0, -2.5)));
    let warm = bench.warns(FaultKind::WarmMotor);
    let fault = bench.faults(FaultKind::OverheatedMotor);
    assert!(fault.part == warm.part && fault.value > 95.0, "{warm}; {fault}");
    bench.cycles(2);
    assert!(bench.with_finger(|finger| finger.status().has(Status::ENDED)));
}

/// The windings stay warm while the finger recovers, and cool during a long pause.
#[test]
fn a_motor_stays_warm_over_a_recovery() {
    let mut bench = Bench::with(|configuration| {
        configuration.fingers[0].motor.continuous_torque = [0.8; 4];
        configuration.fingers[0].motor.thermal_time = 1.0;
    });
    let periods_to_the_fault = |bench: &mut Bench| {
        let begin = bench.report().losses.cycles;
        let push = |bench: &Bench, force: f64| {
            bench.with_finger(|finger| finger.plant().set_external_force(Vector3::new(0.0, 0.0, force)));
        };
        push(bench, -2.5);
        bench.faults(FaultKind::OverheatedMotor);
        push(bench, 0.0);
        bench.report().losses.cycles - begin
    };
    periods_to_the_fault(&mut bench);
    bench.repair();
    bench.opens();
    let warm = periods_to_the_fault(&mut bench);
    bench.cycles(10_000);
    bench.repair();
    bench.opens();
    let cooled = periods_to_the_fault(&mut bench);
    assert!(4 * warm < 3 * cooled, "{warm} and {cooled} periods");
}
