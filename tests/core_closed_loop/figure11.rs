//! Figure 11: what its motor model learns, where the model stops learning, and why it must stay out of the kinematics.

use super::rig::{Loop, finger_with, poses, spring};
use nalgebra::{Vector3, Vector4};
use sun2xp::control::{Activity, Controller, Feedback, Measured, MotorCommand, Report};
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant, Sensors};

const RATES: [f64; 3] = [500.0, 1000.0, 2000.0];

fn finger() -> ConfiguredFinger {
    finger_with(Scheme::Figure11)
}

fn frictionless(ratio: [f64; 4]) -> ConfiguredFinger {
    let mut finger = finger();
    finger.simulation.joint_coulomb_friction = [0.0; 3];
    finger.simulation.motor_coulomb_friction = [0.0; 4];
    finger.simulation.shaft_friction = 0.0;
    finger.simulation.motor_constant_ratio = ratio;
    finger
}

/// The estimates of the motor model while the motors are at rest: the desired tension of each tendon divided by the
/// pull that is commanded for it.
fn estimates(report: &Report) -> Vector4<f64> {
    report.desired_tensions.component_div(&(report.motor_torques / 0.0475))
}

#[test]
fn the_motor_model_finds_motors_that_are_a_fifth_off() {
    for rate in RATES {
        for ratio in [[1.2; 4], [0.8; 4], [1.2, 0.8, 1.1, 0.9]] {
            for pose in poses().into_iter().step_by(6) {
                let mut servo = Loop::new(&frictionless(ratio), rate);
                let target = spring(pose, 3.0);
                servo.run(1.5, &target);
                let (mut mean, mut missed) = (Vector4::zeros(), Vector4::zeros());
                for _ in 0..500 {
                    servo.cycle(&target);
                    mean += estimates(&servo.report) / 500.0;
                    missed += (servo.plant.tensions() - servo.report.desired_tensions) / 500.0;
                }
                let error = (mean - Vector4::from(ratio)).amax();
                assert!(error < 0.01, "{rate} Hz, {ratio:?}: {:?}", mean.as_slice());
                assert!(missed.amax() < 0.1, "{rate} Hz, {ratio:?}: {:?} N", missed.as_slice());
                assert!((servo.plant.joints() - pose).amax() < 0.01, "{rate} Hz, {ratio:?}");
            }
        }
    }
}

#[test]
fn with_friction_the_tensions_are_right_at_rest_and_the_model_stays_within_its_bounds() {
    for rate in RATES {
        for pose in poses().into_iter().step_by(4) {
            let mut finger = finger();
            finger.simulation.motor_constant_ratio = [1.2, 0.8, 1.1, 0.9];
            let mut servo = Loop::new(&finger, rate);
            let target = spring(pose, 3.0);
            servo.run(2.5, &target);
            let (mut mean, mut least, mut most) = (Vector4::zeros(), f64::INFINITY, 0.0f64);
            for _ in 0..200 {
                servo.cycle(&target);
                mean += (servo.plant.tensions() - servo.report.desired_tensions) / 200.0;
                least = least.min(estimates(&servo.report).min());
                most = most.max(estimates(&servo.report).max());
            }
            assert!(mean.amax() < 0.5, "{rate} Hz: off by {:?} N", mean.as_slice());
            assert!(least > 0.35 && most < 2.2, "{rate} Hz: {least} to {most}");
        }
    }
}

/// A finger that is stuck: its tensions stay the same whatever is commanded.
struct Stuck {
    controller: Controller,
    state: sun2xp::control::State,
    wanted: Activity,
}

const WANTED: f64 = 12.0;

impl Stuck {
    fn new(finger: &ConfiguredFinger, at: f64) -> Self {
        let controller = Controller::new(finger, 1000.0).unwrap();
        let state = controller.start(&showing(at));
        Self { controller, state, wanted: Activity::Tense(Vector4::repeat(WANTED)) }
    }

    /// The estimate of the first motor after the given number of cycles with the gauges at `tension`.
    fn estimate(&mut self, cycles: usize, tension: Option<f64>) -> f64 {
        let feedback = tension.map(showing);
        let cycle = |_| self.controller.cycle(&mut self.state, feedback.as_ref(), &self.wanted).0;
        let command: MotorCommand = (0..cycles).map(cycle).last().unwrap();
        WANTED / (command.motor_torques[0] / 0.0475)
    }
}

fn showing(tension: f64) -> Feedback {
    Feedback { motor_counts: [0; 4], gauge_counts: [(tension * 4095.0 / 100.0).round() as u16; 4] }
}

#[test]
fn whatever_the_gauges_show_the_model_cannot_run_away() {
    let low = Stuck::new(&finger(), WANTED).estimate(5000, Some(3.0));
    let high = Stuck::new(&finger(), WANTED).estimate(5000, Some(99.0));
    assert!((low - 0.4).abs() < 1e-6 && (high - 2.0).abs() < 1e-6, "{low}, {high}");
}

#[test]
fn the_model_keeps_its_estimate_while_tensions_carry_no_information() {
    let learnt = |finger: &ConfiguredFinger| {
        let mut stuck = Stuck::new(finger, WANTED);
        let learnt = stuck.estimate(100, Some(9.0));
        assert!(learnt < 0.9, "{learnt}: nothing learnt that could be forgotten");
        (stuck, learnt)
    };
    // The tensions carry no information while the tendons are slack, and while replies are lost.
    let (mut stuck, before) = learnt(&finger());
    assert!((stuck.estimate(2000, Some(0.5)) - before).abs() < 1e-3);
    assert!((stuck.estimate(2000, None) - before).abs() < 1e-3);
    assert!(stuck.estimate(100, Some(9.0)) < before - 0.05, "the model must learn again afterwards");

    // The command of a motor at its limit does not depend on the estimate. The command shows the estimate only when a
    // smaller tension is wanted again.
    let mut weak = finger();
    weak.motor.torque_limit = [0.0475 * 30.0; 4];
    let (mut stuck, before) = learnt(&weak);
    stuck.wanted = Activity::Tense(Vector4::repeat(40.0));
    stuck.estimate(2000, Some(9.0));
    stuck.wanted = Activity::Tense(Vector4::repeat(WANTED));
    // In the next cycle the pull that acted is still at the limit, so the model does not learn from it.
    let after = stuck.estimate(1, Some(9.0));
    assert!((after - before).abs() < 0.03, "{before}, {after}");
}

/// Sends a finger to a pose for 2 s, with exact sensors. Its motors give 1.2 times the commanded torque. Returns the
/// final error of the joints, rad, and their largest speed in the last 0.5 s, rad/s. `geometry` selects whether the
/// adapted motor model M also converts motor angles to joint angles.
fn with_adapted_kinematics(pose: Vector3<f64>, geometry: bool) -> (f64, f64) {
    let finger = frictionless([1.2; 4]);
    let mut plant = Plant::new(&finger, Vector3::zeros()).unwrap();
    plant.release_brake();
    let (motor_counts, gauge_counts) = Sensors::new(&finger).read(&plant);
    let controller = Controller::new(&finger, 1000.0).unwrap();
    let mut state = controller.start(&Feedback { motor_counts, gauge_counts });
    let (mut torques, mut ratio) = (plant.tensions() * 0.0475, Vector4::repeat(1.0));
    let mut fastest: f64 = 0.0;
    for cycle in 0..2000 {
        let tensions = plant.tensions();
        ratio += (tensions.component_div(&(torques / 0.0475)) - ratio) * 0.02;
        // M converts motor torques to tensions: t = M m_tau. A motor that gives g (`ratio`) times its commanded torque
        // makes the tension t = g m_tau / r, so the adapted M is g / r. (RM)^-T converts motor angles to joint angles.
        // With the adapted M, the radius of a motor in this conversion is r / g instead of r.
        let radius =
            if geometry { ratio.map(|ratio: f64| ratio.clamp(0.4, 2.0).recip()) } else { Vector4::repeat(1.0) };
        let measured = Measured { motor_angles: plant.motor_angles().component_mul(&radius), tensions };
        (0..(1e-3 / PLANT_STEP_SECONDS).round() as usize).for_each(|_| plant.step((torques * 0.01).into()));
        torques = controller.cycle_measured(&mut state, Some(&measured), &spring(pose, 3.0)).0.motor_torques;
        if cycle >= 1500 {
            fastest = fastest.max(plant.joint_rates().amax());
        }
    }
    ((plant.joints() - pose).amax(), fastest)
}

#[test]
fn the_adapted_model_in_the_kinematics_displaces_the_finger() {
    for pose in poses().into_iter().step_by(6) {
        let (off, fastest) = with_adapted_kinematics(pose, false);
        assert!(off < 0.005 && fastest < 0.1, "{off} rad off, {fastest} rad/s");
        let (off, fastest) = with_adapted_kinematics(pose, true);
        assert!(off > 0.1 || fastest > 1.0, "the error must be visible: {off} rad off, {fastest} rad/s");
    }
}
