//! Builds the wheel, installs it into an empty virtual environment without the network, and runs pytest there.

#[allow(dead_code)]
#[path = "../../tests/common/tools.rs"]
mod tools;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The packages beside the wheel. `tests/run` downloads them.
const REQUIREMENTS: &str = include_str!("requirements.txt");

/// Runs a program and returns its output. The test fails if the program does.
fn run(program: &mut Command) -> String {
    let run = program.output().unwrap_or_else(|error| panic!("{program:?}: {error}"));
    let said = format!("{}{}", String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
    assert!(run.status.success(), "{program:?}:\n{said}");
    said
}

/// Builds the wheel with the profile of the tests, and returns its path.
fn wheel(python: &Path, folder: &Path) -> PathBuf {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../packaging/wheel");
    let maturin = python.with_file_name("maturin");
    let mut build = Command::new(script);
    build.arg(folder).env("MATURIN", maturin).env("PROFILE", "dev").env("CARGO_NET_OFFLINE", "true");
    run(&mut build);
    let files = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let wheels: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|end| end == "whl")).collect();
    assert_eq!(wheels.len(), 1, "{wheels:?}");
    wheels[0].clone()
}

#[test]
fn the_wheel_works_in_an_empty_environment() {
    let Some(python) = tools::python("the Python package") else { return };
    let wheels = python.ancestors().nth(2).expect("the folder of the environment").join("wheels");
    if !fs::read_to_string(wheels.join("requirements.txt")).is_ok_and(|list| list == REQUIREMENTS) {
        let reason = "the packages of python/tests/requirements.txt are not downloaded (tests/run downloads them)";
        return tools::skip("the Python package", reason);
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python-package");
    let _ = fs::remove_dir_all(&folder);
    let wheel = wheel(&python, &folder.join("wheel"));
    let environment = folder.join("environment");
    run(Command::new(&python).args(["-m", "venv"]).arg(&environment));
    let installed = environment.join("bin/python");
    let mut install = Command::new(&installed);
    install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-index", "--find-links"]);
    install.arg(&wheels).arg("--requirement").arg(wheels.join("requirements.txt")).arg(&wheel);
    run(&mut install);
    // Away from the sources, so that the installed package is tested.
    let mut pytest = Command::new(&installed);
    pytest.args(["-m", "pytest", "-p", "no:cacheprovider", concat!(env!("CARGO_MANIFEST_DIR"), "/tests")]);
    pytest.current_dir(&folder).env("PYTHONDONTWRITEBYTECODE", "1").env_remove("SUN2XP_CONFIG");
    // Cargo builds the C library with the dependencies of this test.
    let here = std::env::current_exe().expect("the path of this test");
    pytest.env("SUN2XP_LIBRARY", here.with_file_name("libsun2xp.so"));
    println!("{}", run(&mut pytest));
}
