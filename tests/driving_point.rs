//! Tests of the driving-point admittance of a fingertip: it predicts how the tip of the simulated finger moves under a
//! sinusoidal force, and it shows which controller is passive.

use nalgebra::{Complex, Matrix3, Vector3, Vector4};
use std::f64::consts::TAU;
use sun2xp::control::{Activity, Controller, Feedback, Law, SetPoint};
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};
use sun2xp::plant::{PLANT_STEP_SECONDS, Plant, Sensors};
use sun2xp::stability::{OneCycleMap, Rest};

const RATE: f64 = 1000.0;

const STEPS: usize = 10;

/// Stiffness of the springs, N/cm.
const STIFFNESS: f64 = 6.0;

fn finger(scheme: Scheme) -> ConfiguredFinger {
    let mut finger = ConfiguredFinger::default();
    finger.controller.scheme = Some(scheme);
    // Friction does not act as an admittance: its force does not grow with the velocity.
    finger.friction.motor_coulomb = [0.0; 4];
    finger.friction.conduit = [0.0; 4];
    finger.friction.joint_coulomb = [0.0; 3];
    finger.simulation.motor_coulomb_friction = [0.0; 4];
    finger.simulation.shaft_friction = 0.0;
    finger.simulation.joint_coulomb_friction = [0.0; 3];
    finger.simulation.gauge_noise = 0.0;
    finger
}

fn rest() -> Rest {
    let joints = Vector3::new(0.1, 0.5, 1.0);
    let kx = Matrix3::identity() * STIFFNESS;
    Rest { law: Law::Exact, ..Rest::hard_finger(joints, Vector3::new(0.01, 0.01, 0.01), &kx) }
}

/// Returns the velocity of the tip, m/s per N, that a sinusoidal force of `amplitude` N along `direction` causes. The
/// controller works with counts, as with a board.
fn measured(scheme: Scheme, frequency: f64, direction: &Vector3<f64>, amplitude: f64) -> Vector3<Complex<f64>> {
    let mut finger = finger(scheme);
    let rest = rest();
    finger.simulation.start_degrees = rest.joints.map(f64::to_degrees).into();
    let links = finger.links();
    let controller = Controller::new(&finger, RATE).unwrap();
    let mut plant = Plant::new(&finger, Vector3::zeros()).unwrap();
    plant.release_brake();
    let mut sensors = Sensors::new(&finger);
    let (motor_counts, gauge_counts) = sensors.read(&plant);
    let mut state = controller.start(&Feedback { motor_counts, gauge_counts });
    let kx = Matrix3::identity() * STIFFNESS;
    let set_point = SetPoint { law: Law::Exact, ..SetPoint::hard_finger(rest.joints + rest.deflection, kx) };
    let load = kx * (links.tip(&rest.joints) - links.tip(&set_point.joints));
    // The force begins after the finger has come to rest. The velocity is measured after the response has settled.
    let periods = (0.5 * frequency).ceil().max(3.0);
    let cycle = |seconds: f64| (seconds * RATE).round() as usize;
    let (begin, settled) = (cycle(0.5), cycle(0.5) + cycle(2.0 * periods / frequency).max(2000));
    let cycles = settled + cycle(periods / frequency);
    let radius = Vector4::from(finger.geometry.motor_radius) * 0.01;
    let mut torques: [f64; 4] = plant.tensions().component_mul(&radius).into();
    let (mut before, mut now) = (plant.tip(), plant.tip());
    let mut sum: Vector3<Complex<f64>> = Vector3::zeros();
    for number in 0..cycles {
        let (motor_counts, gauge_counts) = sensors.read(&plant);
        let feedback = Feedback { motor_counts, gauge_counts };
        for step in 0..STEPS {
            let phase = TAU * frequency * (number * STEPS + step) as f64 * PLANT_STEP_SECONDS;
            let force = if number < begin { 0.0 } else { amplitude * phase.cos() };
            plant.set_external_force(load + direction * force);
            plant.step(torques);
            if number >= settled {
                // The velocity at the instant of `now`, at which the force acts.
                let velocity = (plant.tip() - before) * (0.01 / (2.0 * PLANT_STEP_SECONDS));
                sum += velocity.map(|part| Complex::from(part) * Complex::from_polar(1.0, -phase));
            }
            (before, now) = (now, plant.tip());
        }
        let (command, _) = controller.cycle(&mut state, Some(&feedback), &Activity::Follow(set_point));
        torques = (command.motor_torques * 0.01).into();
    }
    sum * Complex::from(2.0 / (amplitude * ((cycles - settled) * STEPS) as f64))
}

#[test]
fn a_sinusoidal_force_moves_the_tip_as_its_admittance_predicts() {
    for scheme in [Scheme::Figure10, Scheme::StateFeedback] {
        let map = OneCycleMap::new(&finger(scheme), RATE).unwrap();
        // Forces that move the tip by some tenths of a millimetre, far above the resolution of the sensors.
        let cases = [(3.0, 0.1), (20.0, 0.3), (150.0, 1.0)];
        let found = map.admittances(&rest(), &cases.map(|(frequency, _)| frequency)).expect("the finger is stable");
        for (admittance, (frequency, amplitude)) in found.iter().zip(cases) {
            let direction = Vector3::new(0.6, -0.48, 0.64);
            let predicted = admittance.matrix * direction.map(Complex::from);
            let measured = measured(scheme, frequency, &direction, amplitude);
            let error = (measured - predicted).norm() / predicted.norm();
            assert!(error < 0.02, "{scheme:?} at {frequency} Hz: {error}, {measured} instead of {predicted}");
        }
    }
}

#[test]
fn state_feedback_is_passive_and_figure_10_is_not() {
    let frequencies: Vec<f64> = (0..=16).map(|step| 400f64.powf(f64::from(step) / 16.0)).collect();
    let least = |scheme| {
        let map = OneCycleMap::new(&finger(scheme), RATE).unwrap();
        let found = map.admittances(&rest(), &frequencies).expect("the finger is stable");
        let passivities = found.iter().map(|admittance| (admittance.passivity(), admittance.frequency));
        passivities.min_by(|one, other| one.0.total_cmp(&other.0)).expect("there are frequencies")
    };
    let (state_feedback, _) = least(Scheme::StateFeedback);
    assert!(state_feedback > -0.01, "{state_feedback}");
    let (figure_10, frequency) = least(Scheme::Figure10);
    assert!(figure_10 < -0.02 && frequency < 20.0, "{figure_10} at {frequency} Hz");
}

/// In the direction in which a finger with the controller of Figure 10 is least passive, its tip gives energy to a
/// sinusoidal force of low frequency. The tip of a finger with state feedback takes energy from the same force.
#[test]
fn a_tip_that_is_not_passive_gives_energy_to_a_force() {
    let frequency = 3.0;
    let map = OneCycleMap::new(&finger(Scheme::Figure10), RATE).unwrap();
    let found = map.admittances(&rest(), &[frequency]).expect("the finger is stable");
    let resistance = found[0].matrix.map(|part| part.re);
    let eigen = (resistance + resistance.transpose()).symmetric_eigen();
    let worst = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
    let power = |scheme| measured(scheme, frequency, &worst, 0.1).map(|part| part.re).dot(&worst);
    let (figure_10, state_feedback) = (power(Scheme::Figure10), power(Scheme::StateFeedback));
    assert!(figure_10 < 0.0 && state_feedback > 0.0, "{figure_10}, {state_feedback}");
}
