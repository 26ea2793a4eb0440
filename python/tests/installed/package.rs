//! The tests of the package: python/tests.

use crate::environment::{Environment, run};
use std::process::Command;

#[test]
fn the_wheel_works_in_an_empty_environment() {
    let Some(environment) = Environment::new("the Python package", "python/tests/requirements.txt", "wheels") else {
        return;
    };
    let mut pytest = Command::new(environment.python());
    pytest.args(["-m", "pytest", "-p", "no:cacheprovider", concat!(env!("CARGO_MANIFEST_DIR"), "/tests")]);
    pytest.current_dir(&environment.folder).env("PYTHONDONTWRITEBYTECODE", "1").env_remove("SUN2XP_CONFIG");
    // Cargo builds the C library with the dependencies of this test.
    let here = std::env::current_exe().expect("the path of this test");
    pytest.env("SUN2XP_LIBRARY", here.with_file_name("libsun2xp.so"));
    println!("{}", run(&mut pytest));
    environment.delete();
}
