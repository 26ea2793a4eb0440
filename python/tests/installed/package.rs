//! Runs the tests of the Python package, which are in python/tests, with the installed wheel.

use crate::cargo::cargo;
use crate::environment::{Environment, ROOT, run};
use std::path::PathBuf;
use std::process::Command;

#[test]
fn the_wheel_works_in_an_empty_environment() {
    let Some(environment) = Environment::new("the Python package", "python/tests/requirements.txt", "wheels") else {
        return;
    };
    let mut pytest = Command::new(environment.python());
    pytest.args(["-m", "pytest", "-p", "no:cacheprovider", concat!(env!("CARGO_MANIFEST_DIR"), "/tests")]);
    pytest.current_dir(&environment.folder).env("PYTHONDONTWRITEBYTECODE", "1").env_remove("SUN2XP_CONFIG");
    // This test depends on the package sun2xp, so Cargo has built the C library into the folder of the test.
    let here = std::env::current_exe().expect("the path of this test");
    pytest.env("SUN2XP_LIBRARY", here.with_file_name("libsun2xp.so"));
    pytest.env("SUN2XP_SERVE", server());
    println!("{}", run(&mut pytest));
    environment.delete();
}

/// Returns the path of `sun2xp-serve`, for the tests of `sun2xp.remote`. Cargo builds it here, because it belongs to
/// another package. The build includes an example, because Cargo then selects the same features as for
/// `cargo test --workspace`. With these features Zenoh is compiled already.
fn server() -> PathBuf {
    let mut build = cargo();
    build.args(["build", "--quiet", "--offline", "--workspace", "--bin", "sun2xp-serve"]);
    build.args(["--example", "spring"]).current_dir(ROOT);
    run(&mut build);
    // This test is in the folder deps. The programs are in the folder that contains deps.
    let here = std::env::current_exe().expect("the path of this test");
    here.ancestors().nth(2).expect("the folder of the profile").join("sun2xp-serve")
}
