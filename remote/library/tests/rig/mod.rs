//! A server with a simulated hand, and planners compiled against libsun2xp.

#![allow(dead_code, reason = "each test program uses a part")]

#[path = "../../../../tests/common/cargo.rs"]
mod cargo;
#[path = "../../../../tests/common/free_port.rs"]
mod free_port;

use cargo::cargo;
use free_port::free_port;
use std::env;
use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use tempfile::TempDir;

/// How a planner reaches a hand.
#[derive(Clone, Copy, Debug)]
pub enum Way {
    /// The simulated hand of the planner's process.
    Local,
    /// The hand of the server: `[remote]` in the configuration, with libsun2xp.
    Configured,
    /// The hand of the server: the same configuration, with libsun2xp_remote in place of libsun2xp.
    Path,
}

/// The configuration of the hand. The planner's process and the server use the same one.
const HAND: &str = "[finger]\nport = \"simulated\"\n";

/// The name of the hand.
const NAME: &str = "left";

/// A configuration for a planner.
pub fn remote(endpoint: &str) -> String {
    format!("[remote]\nendpoint = \"{endpoint}\"\nhand = \"{NAME}\"\nclient = \"planner\"\n")
}

/// A folder with configurations, and with links to the libraries of this build.
pub struct Loading {
    folder: TempDir,
}

impl Loading {
    /// `remote` is the configuration for [`Way::Configured`] and [`Way::Path`].
    pub fn new(remote: &str) -> Self {
        let loading = Self { folder: tempfile::tempdir().expect("a folder") };
        fs::write(loading.place("local.toml"), HAND).expect("a file");
        fs::write(loading.place("remote.toml"), remote).expect("a file");
        for name in ["library", "library/sun2xp-remote", "path"] {
            fs::create_dir(loading.place(name)).expect("a folder");
        }
        let (local, remote) = (built("libsun2xp.so"), built("libsun2xp_remote.so"));
        for (file, name) in [
            (&local, "library/libsun2xp.so"),
            (&local, "library/libsun2xp.so.0"),
            (&remote, "library/sun2xp-remote/libsun2xp_remote.so.0"),
            (&remote, "path/libsun2xp.so.0"),
        ] {
            symlink(file, loading.place(name)).expect("a link");
        }
        loading
    }

    pub fn place(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Replaces libsun2xp_remote with a library that is compiled from this C source.
    pub fn replace_library(&self, source: &str) {
        let (file, library) = (self.place("other.c"), self.place("library/sun2xp-remote/libsun2xp_remote.so.0"));
        fs::write(&file, source).expect("a file");
        fs::remove_file(&library).expect("it was there");
        let built = Command::new("gcc").args(["-shared", "-fPIC", "-o"]).arg(&library).arg(&file).status();
        assert!(built.expect("gcc runs").success());
    }

    /// Compiles a planner of the folder `planners`.
    pub fn compile(&self, planner: &str, flags: &[&str]) -> PathBuf {
        let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
        let program = self.place(planner.trim_end_matches(".c"));
        let library = self.place("library");
        let mut compiler = Command::new("gcc");
        compiler.args(flags).args(["-O1", "-g", "-D_DEFAULT_SOURCE", "-I"]).arg(manifest.join("../../include"));
        compiler.arg(manifest.join("tests/planners").join(planner)).arg("-o").arg(&program);
        compiler.arg("-L").arg(&library).arg(format!("-Wl,-rpath,{}", library.display()));
        let built = compiler.args(["-lsun2xp", "-lpthread", "-lm"]).output().expect("gcc runs");
        assert!(built.status.success(), "{planner}: {}", String::from_utf8_lossy(&built.stderr));
        program
    }

    /// Compiles and runs a planner that must exit with 0. Returns what it printed.
    pub fn said(&self, planner: &str, way: Way) -> String {
        let (status, said) = self.run(&self.compile(planner, &["-std=gnu99"]), way);
        assert!(status.success(), "{planner}: {status}\n{said}");
        said
    }

    /// Runs a planner, and returns how it ended and what it printed.
    pub fn run(&self, program: &Path, way: Way) -> (ExitStatus, String) {
        // A planner that hangs would hang the tests.
        let mut command = Command::new("timeout");
        command.args(["--signal=KILL", "120"]).arg(program).current_dir(self.folder.path());
        command.env_remove("LD_LIBRARY_PATH").env("HOME", self.place("nowhere"));
        let configuration = if matches!(way, Way::Local) { "local.toml" } else { "remote.toml" };
        command.env("SUN2XP_CONFIG", self.place(configuration));
        if matches!(way, Way::Path) {
            command.env("LD_LIBRARY_PATH", self.place("path"));
        }
        let run = command.output().expect("the planner runs");
        eprintln!("{program:?} {way:?}: {}", String::from_utf8_lossy(&run.stderr));
        (run.status, String::from_utf8_lossy(&run.stdout).into_owned())
    }
}

/// A server with a simulated hand, and the folder of its planners. Only one exists at a time: three servo threads and
/// their boards need the machine to themselves.
pub struct Rig {
    pub planners: Loading,
    /// Where the server listens.
    pub endpoint: String,
    server: Child,
    _turn: MutexGuard<'static, ()>,
}

impl Rig {
    /// Starts a server, and waits until it has said that it is ready.
    pub fn start() -> Self {
        static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
        let turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
        let port = free_port();
        let endpoint = format!("tcp/127.0.0.1:{port}");
        let planners = Loading::new(&remote(&endpoint));
        let serve = format!("[serve]\nname = \"{NAME}\"\nlisten = [\"{endpoint}\"]\n");
        let clients = "[serve.clients]\nplanner = \"command\"\nanother = \"command\"\n";
        fs::write(planners.place("server.toml"), format!("{serve}{clients}{HAND}")).expect("a file");
        let server = serve_until_ready(&planners.place("server.toml"));
        Self { planners, endpoint, server, _turn: turn }
    }
}

impl Drop for Rig {
    fn drop(&mut self) {
        // The server is a child for which nothing has waited yet, so no other process can have its process id.
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

fn serve_until_ready(configuration: &Path) -> Child {
    let mut command = Command::new(program());
    command.arg("--config").arg(configuration).stdout(Stdio::piped());
    let mut server = command.spawn().expect("the server starts");
    let output = BufReader::new(server.stdout.take().expect("a pipe"));
    let ready = output.lines().map_while(Result::ok).any(|line| line == "ready");
    assert!(ready, "the server says that it is ready");
    server
}

/// The folder with the libraries and the test programs of this build.
fn deps() -> PathBuf {
    env::current_exe().expect("the test has a path").parent().expect("a folder").to_path_buf()
}

/// A library of this build.
pub fn built(name: &str) -> PathBuf {
    let library = deps().join(name);
    assert!(library.exists(), "{} is missing: cargo test builds it", library.display());
    library
}

/// Builds the program `sun2xp-serve` if it is out of date, and returns its path. The build includes an example, because
/// Cargo then selects the same features as for `cargo test --workspace`. With these features Zenoh is compiled already.
fn program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let deps = deps();
        let folder = deps.parent().expect("the profile's folder");
        let mut cargo = cargo();
        cargo.args(["build", "--quiet", "--locked", "--workspace", "--bin", "sun2xp-serve"]);
        cargo.args(["--example", "spring", "--manifest-path"]);
        cargo.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../Cargo.toml"));
        cargo.arg("--target-dir").arg(folder.parent().expect("the target folder"));
        if folder.ends_with("release") {
            cargo.arg("--release");
        }
        assert!(cargo.status().expect("cargo runs").success(), "the server is not built");
        folder.join("sun2xp-serve")
    })
}
