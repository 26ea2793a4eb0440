//! `sun2xp model`: the hand that other programs see has the kinematics and the dynamics of the simulated hand.

#[allow(dead_code)]
#[path = "../../../tests/common/tools.rs"]
mod tools;

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use serde::Deserialize;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use sun2xp::hand::read_configuration;
use sun2xp::model::configuration::Configuration;
use sun2xp::model::{FingerNumber, LinkDynamics};
use sun2xp::nalgebra::{Isometry3, Matrix3, Point3, Translation3, UnitQuaternion, Vector3};
use tempfile::TempDir;

/// A configuration in which the lengths, masses, moment arms, stop margin and gravity differ from their defaults.
const HAND: &str = r#"
[hand]
gravity = [1.0, -2.0, -9.0]
simulated_object = { shape = { box = { size = [4.0, 3.0, 5.0] } }, position = [0.0, 1.0, 9.0], table = 12.0 }
[finger.geometry]
links = [3.3, 5.2, 4.1]
[finger.simulation]
masses = [0.07, 0.05, 0.03, 0.01]
held_mass = 0.02
link_radii = [0.010, 0.009, 0.006]
moment_arm_ratio = [[1.02, 0.98, 1.01, 0.99], [0.98, 1.01, 0.99, 1.02], [1.0, 0.99, 1.02, 1.0]]
stop_margin_degrees = 4.0
[finger.1]
base = [3.0, 4.0, 0.5]
turn_degrees = 20.0
[finger.2]
base = [-3.5, 3.0, -0.5]
turn_degrees = -30.0
[finger.3.geometry]
links = [3.0, 4.5, 3.5]
"#;

const POSES: usize = 100;

/// What `load.py` prints.
#[derive(Deserialize)]
struct Loaded {
    answers: Vec<Answer>,
    stops: Vec<[f64; 2]>,
    actuators: Vec<String>,
    gravity: [f64; 3],
}

#[derive(Deserialize)]
struct Answer {
    tips: [[f64; 3]; 3],
    inertia: [[f64; 9]; 9],
    bias: [f64; 9],
}

/// Nine joint angles, rad, and their rates, rad/s.
type Motion = ([f64; 9], [f64; 9]);

fn tool(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_sun2xp")).arg("model").args(arguments).output().expect("the tool starts")
}

fn written(folder: &TempDir, format: &str) -> PathBuf {
    let configuration = folder.path().join("hand.toml");
    std::fs::write(&configuration, HAND).expect("written");
    let file = folder.path().join(format.trim_start_matches('-'));
    let [configuration, output] = [&configuration, &file].map(|path| path.to_str().expect("a plain name"));
    let run = tool(&[format, "--configuration", configuration, "--output", output]);
    assert!(run.status.success() && run.stdout.is_empty(), "{run:?}");
    file
}

fn configuration() -> Configuration {
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), HAND).expect("written");
    read_configuration(file.path()).expect("usable")
}

/// Random motions, with poses within the stops of all fingers.
fn motions(configuration: &Configuration) -> Vec<Motion> {
    let mut random = Pcg64Mcg::seed_from_u64(14);
    let mut unit = move || random.next_u64() as f64 / u64::MAX as f64;
    let one = |_| {
        let pose = std::array::from_fn(|joint| {
            let (lower, upper) = configuration.fingers[joint / 3].joint_limits();
            lower[joint % 3] + (upper - lower)[joint % 3] * unit()
        });
        (pose, std::array::from_fn(|_| 10.0 * unit() - 5.0))
    };
    (0..POSES).map(one).collect()
}

fn of_finger(values: &[f64; 9], finger: FingerNumber) -> Vector3<f64> {
    Vector3::from_fn(|joint, _| values[3 * finger.index() + joint])
}

/// The tip of a finger in the palm's frame, cm.
fn tip(configuration: &Configuration, finger: FingerNumber, pose: &[f64; 9]) -> Vector3<f64> {
    let tip = configuration.fingers[finger.index()].links().tip(&of_finger(pose, finger));
    (configuration.finger_to_palm(finger) * Point3::from(tip)).coords
}

fn dynamics(configuration: &Configuration, finger: FingerNumber, gravity: bool) -> LinkDynamics {
    let configured = &configuration.fingers[finger.index()];
    let simulation = &configured.simulation;
    let [link_0, link_1, link_2, tip] = simulation.masses;
    let masses = [link_0, link_1, link_2, tip + simulation.held_mass];
    let gravity = if gravity { configuration.gravity(finger) } else { Vector3::new(0.0, 0.0, 0.0) };
    LinkDynamics::new(configured.links(), masses, simulation.link_radii, gravity)
}

/// What the rotors add to the inertia of the joints if the tendons do not stretch, kg m^2.
fn rotors(configuration: &Configuration, finger: FingerNumber) -> Matrix3<f64> {
    let configured = &configuration.fingers[finger.index()];
    let tendons = configured.true_tendons().expect("usable");
    let one = |tendon: usize| {
        let per_angle = tendons.r.column(tendon) / configured.geometry.motor_radius[tendon];
        per_angle * per_angle.transpose() * configured.simulation.rotor_inertia[tendon]
    };
    (0..4).map(one).sum()
}

fn load(python: &Path, model: &Path, motions: &[Motion]) -> Loaded {
    let mut program = Command::new(python);
    program.arg(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/model/load.py")).arg(model);
    let mut program = program.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("Python starts");
    let poses = serde_json::to_vec(motions).expect("numbers");
    program.stdin.take().expect("a pipe").write_all(&poses).expect("read");
    let run = program.wait_with_output().expect("it ends");
    assert!(run.status.success(), "{run:?}");
    serde_json::from_slice(&run.stdout).expect("the answers")
}

#[test]
fn mujoco_has_the_same_hand() {
    let Some(python) = tools::python("MuJoCo") else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let configuration = configuration();
    let motions = motions(&configuration);
    for format in ["--urdf", "--mjcf"] {
        // MuJoCo determines the format by the content.
        let loaded = load(&python, &written(&folder, format), &motions);
        let mjcf = format == "--mjcf";
        for (answer, (pose, rates)) in loaded.answers.iter().zip(&motions) {
            for finger in FingerNumber::ALL {
                let error = Vector3::from(answer.tips[finger.index()]) * 100.0 - tip(&configuration, finger, pose);
                assert!(error.amax() < 1e-9, "{format}, finger {finger}: {:e} cm", error.amax());
                let dynamics = dynamics(&configuration, finger, mjcf);
                let (theta, rate) = (of_finger(pose, finger), of_finger(rates, finger));
                let inertia =
                    dynamics.inertia(&theta) + if mjcf { rotors(&configuration, finger) } else { Matrix3::repeat(0.0) };
                let first = 3 * finger.index();
                let error = Matrix3::from_fn(|row, column| answer.inertia[first + row][first + column]) - inertia;
                assert!(error.amax() < 1e-9 * inertia.amax(), "{format}, finger {finger}: {error:e} kg m^2");
                let bias = dynamics.coriolis(&theta, &rate) - dynamics.gravity_torque(&theta);
                // A URDF has no gravity, so MuJoCo uses its own.
                if mjcf {
                    let error = of_finger(&answer.bias, finger) - bias;
                    assert!(error.amax() < 1e-9 * bias.amax(), "finger {finger}: {error:e} N m");
                }
            }
        }
        assert_eq!(loaded.answers.len(), POSES);
        for (joint, stop) in loaded.stops.iter().enumerate() {
            let configured = &configuration.fingers[joint / 3];
            let (lower, upper) = configured.joint_limits();
            let margin = configured.simulation.stop_margin_degrees.to_radians();
            let expected = [lower[joint % 3] - margin, upper[joint % 3] + margin];
            assert!((Vector3::new(stop[0], stop[1], 0.0) - Vector3::new(expected[0], expected[1], 0.0)).amax() < 1e-12);
        }
        if mjcf {
            assert_eq!(loaded.actuators.len(), 12);
            assert_eq!(loaded.actuators[4], "finger2_tendon1");
            assert_eq!(loaded.gravity, configuration.hand.gravity);
        }
    }
}

#[test]
fn the_json_has_the_same_hand() {
    #[derive(Deserialize)]
    struct Hand {
        fingers: Vec<Finger>,
        object: serde_json::Value,
    }
    #[derive(Deserialize)]
    struct Finger {
        base: [f64; 3],
        turn: f64,
        links: [Link; 3],
        tip: [f64; 3],
    }
    #[derive(Deserialize)]
    struct Link {
        origin: [f64; 3],
        axis: [f64; 3],
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = written(&folder, "--json");
    let hand: Hand = serde_json::from_slice(&std::fs::read(file).expect("there")).expect("the geometry");
    assert_eq!(hand.object["shape"]["size"], serde_json::json!([4.0, 3.0, 5.0]));
    let configuration = configuration();
    for (pose, _) in motions(&configuration) {
        for (finger, number) in hand.fingers.iter().zip(FingerNumber::ALL) {
            let angles = of_finger(&pose, number);
            let mut frame = Isometry3::new(Vector3::from(finger.base), Vector3::new(0.0, 0.0, finger.turn));
            for (link, angle) in finger.links.iter().zip(angles.iter()) {
                let turned = UnitQuaternion::new(Vector3::from(link.axis) * *angle);
                frame *= Isometry3::from_parts(Translation3::from(link.origin), turned);
            }
            let error = (frame * Point3::from(finger.tip)).coords - tip(&configuration, number, &pose);
            assert!(error.amax() < 1e-12 * 20.0, "finger {number}: {:e} cm", error.amax());
        }
    }
}

#[test]
fn a_model_has_only_the_fingers_of_the_hand() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("hand.toml");
    std::fs::write(&file, "[hand]\nfingers = [2]\n[finger]\nport = \"simulated\"\n").expect("written");
    let file = file.to_str().expect("a plain name");
    for format in ["--urdf", "--mjcf", "--json"] {
        let run = tool(&[format, "--config", file]);
        let model = String::from_utf8_lossy(&run.stdout);
        assert!(run.status.success() && model.contains("finger2"), "{run:?}");
        assert!(!model.contains("finger1") && !model.contains("finger3"), "{format}: {model}");
    }
}

#[test]
fn a_format_must_be_chosen() {
    let run = tool(&[]);
    assert_eq!(run.status.code(), Some(2), "{run:?}");
    assert!(String::from_utf8_lossy(&run.stderr).contains("--urdf"), "{run:?}");
    assert_eq!(tool(&["--urdf", "--mjcf"]).status.code(), Some(2));
}

#[test]
fn a_model_that_cannot_be_written_says_what_failed() {
    let folder = tempfile::tempdir().expect("a folder");
    let configuration = folder.path().join("hand.toml");
    std::fs::write(&configuration, HAND).expect("written");
    let file = folder.path().join("none/hand.urdf");
    let [configuration, output] = [&configuration, &file].map(|path| path.to_str().expect("a plain name"));
    let run = tool(&["--urdf", "--config", configuration, "--output", output]);
    assert_eq!(run.status.code(), Some(1), "{run:?}");
    assert!(String::from_utf8_lossy(&run.stderr).contains(&format!("cannot write {output}: ")), "{run:?}");
}
