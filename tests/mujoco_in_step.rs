//! The example `examples/mujoco`: a hand whose fingers are simulated by MuJoCo in another process, in step with the
//! servo. The fingers must settle where the built-in simulated fingers settle.

#[allow(dead_code)]
#[path = "c/mod.rs"]
mod c;

use c::{Bench, STRICT, c_compiler, python, root, said, tool};
use std::process::{Command, Stdio};

/// Largest difference between a joint angle and the angle at which the built-in simulated joint rests, rad.
const TOLERANCE: f64 = 0.01;

/// Where a finger rests at a pose: the numbers of pose and finger, and joint angles, rad.
type Rest = (Vec<u32>, Vec<f64>);

/// Reads the lines that the program mujoco_hand prints.
fn rests(output: &[u8]) -> Vec<Rest> {
    let lines = str::from_utf8(output).expect("numbers").lines();
    let rest = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let numbers = words[..2].iter().map(|word| word.parse().expect("a number")).collect();
        (numbers, words[2..].iter().map(|word| word.parse().expect("an angle")).collect())
    };
    lines.map(rest).collect()
}

#[test]
fn fingers_in_mujoco_settle_where_the_built_in_ones_do() {
    let Some(python) = python("MuJoCo in step") else { return };
    let bench = Bench::new();
    let (model, memory) = (bench.path().join("hand.xml"), bench.path().join("memory"));
    bench.write("simulated.toml", "[finger]\nport = \"simulated\"\n");
    let mut write = Command::new(tool());
    write.args(["model", "--mjcf", "--config"]).arg(bench.path().join("simulated.toml")).arg("--output").arg(&model);
    let written = write.output().expect("the tool runs");
    assert!(written.status.success(), "{}", said(&written));

    let source = root().join("examples/mujoco/mujoco_hand.c");
    let source = source.to_str().expect("the path is text");
    let program = bench.build(c_compiler(), &[STRICT, &["-std=c11"]].concat(), &[source]);
    let mut simulation = Command::new(python);
    simulation.arg(root().join("examples/mujoco/simulation.py")).args([&model, &memory]);
    let mut simulation = simulation.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("Python starts");
    let mut hand = Command::new(&program);
    hand.arg(&memory);
    let in_mujoco = bench.run(hand);
    if !in_mujoco.status.success() {
        // The simulation may wait for a program that has died.
        simulation.kill().expect("the simulation can be killed");
    }
    let simulated = simulation.wait_with_output().expect("the simulation ends");
    assert!(in_mujoco.status.success(), "{}\n{}", said(&in_mujoco), said(&simulated));
    assert!(simulated.status.success(), "{}", said(&simulated));
    let built_in = bench.run(Command::new(&program));
    assert!(built_in.status.success(), "{}", said(&built_in));

    let (in_mujoco, built_in) = (rests(&in_mujoco.stdout), rests(&built_in.stdout));
    assert_eq!((in_mujoco.len(), built_in.len()), (9, 9), "three poses of three fingers");
    for ((place, angles), (same_place, expected)) in in_mujoco.iter().zip(&built_in) {
        assert_eq!((place, angles.len(), expected.len()), (same_place, 6, 3));
        // The first three angles are those that the hand measures, and the others are those of MuJoCo.
        for (joint, angle) in angles.iter().enumerate() {
            let error = (angle - expected[joint % 3]).abs();
            assert!(error < TOLERANCE, "pose and finger {place:?}: {angles:?} instead of {expected:?}");
        }
    }
}
