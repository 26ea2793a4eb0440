//! The wheel, and virtual environments in which it is installed.

use crate::cargo::without_package;
use crate::tools;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The root of the source.
pub const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

/// Runs a program and returns its output. The test fails if the program does.
pub fn run(program: &mut Command) -> String {
    let run = program.output().unwrap_or_else(|error| panic!("{program:?}: {error}"));
    let said = format!("{}{}", String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
    assert!(run.status.success(), "{program:?}:\n{said}");
    said
}

/// Returns the folder `name` of this test, without the files of an earlier run.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python-package").join(name);
    let _ = fs::remove_dir_all(&folder);
    folder
}

/// Returns the path of the wheel, which the first caller builds with the profile of the tests.
fn wheel(python: &Path) -> &'static Path {
    static WHEEL: OnceLock<PathBuf> = OnceLock::new();
    WHEEL.get_or_init(|| {
        let folder = folder("wheel");
        let maturin = python.with_file_name("maturin");
        let mut build = Command::new(format!("{ROOT}/packaging/wheel"));
        build.arg(&folder).env("MATURIN", maturin).env("PROFILE", "dev").env("CARGO_NET_OFFLINE", "true");
        without_package(&mut build);
        run(&mut build);
        let files = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
        let wheels: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|end| end == "whl")).collect();
        assert_eq!(wheels.len(), 1, "{wheels:?}");
        wheels[0].clone()
    })
}

/// A virtual environment with the wheel.
pub struct Environment {
    /// The folder of the environment. It is not the folder of the sources, so that the installed package is tested.
    pub folder: PathBuf,
    /// The downloaded packages.
    wheels: PathBuf,
}

impl Environment {
    /// Makes an environment with the wheel and the packages that the file `list` names. `tests/run` has downloaded them
    /// into the folder `downloaded`. If they are not there, returns `None` and lists the test as skipped under `name`.
    pub fn new(name: &str, list: &str, downloaded: &str) -> Option<Self> {
        let python = tools::python(name)?;
        let wheels = python.ancestors().nth(2).expect("the folder of the environment").join(downloaded);
        let wanted = fs::read_to_string(Path::new(ROOT).join(list)).expect("the list of packages");
        if !fs::read_to_string(wheels.join("requirements.txt")).is_ok_and(|list| list == wanted) {
            tools::skip(name, &format!("the packages of {list} are not downloaded (tests/run downloads them)"));
            return None;
        }
        let wheel = wheel(&python);
        let environment = Self { folder: folder(downloaded), wheels };
        fs::create_dir_all(&environment.folder).expect("a folder");
        run(Command::new(&python).args(["-m", "venv"]).arg(environment.folder.join("environment")));
        environment.install(&["--requirement", environment.wheels.join("requirements.txt").to_str().expect("a name")]);
        environment.install(&["--no-deps", wheel.to_str().expect("a plain name")]);
        run(Command::new(environment.python()).args(["-m", "pip", "check"]));
        Some(environment)
    }

    /// The interpreter of the environment.
    pub fn python(&self) -> PathBuf {
        self.folder.join("environment/bin/python")
    }

    /// Installs packages without the network.
    pub fn install(&self, packages: &[&str]) {
        let mut install = Command::new(self.python());
        install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-index", "--find-links"]);
        run(install.arg(&self.wheels).args(packages));
    }

    /// Deletes the environment, which takes some hundreds of megabytes. The environment of a failed test stays.
    pub fn delete(self) {
        let _ = fs::remove_dir_all(self.folder.join("environment"));
    }
}
