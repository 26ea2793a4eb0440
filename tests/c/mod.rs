//! Compiles the C programs of this folder against the header and the library of the same build, and runs them in an
//! environment where no configuration of the machine can be found.

pub mod board;
#[allow(dead_code)]
#[path = "../common/pauses.rs"]
pub mod pauses;
#[allow(dead_code)]
#[path = "../common/tool.rs"]
mod tool;
#[path = "../common/tools.rs"]
pub mod tools;

#[allow(unused_imports)]
pub use tool::tool;
#[allow(unused_imports)]
pub use tools::{available, not_permitted, python, skip};

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::TempDir;

/// Compiler flags for programs that must compile without a warning.
pub const STRICT: &[&str] = &["-pedantic", "-Wall", "-Wextra", "-Werror"];

/// The dialects of C that planners use.
pub const C_STANDARDS: &[&str] =
    &["-ansi", "-std=c89", "-std=gnu89", "-std=c99", "-std=gnu99", "-std=c11", "-std=c17", "-std=c2x", "-std=gnu2x"];

/// The dialects of C++ that planners use.
pub const CPP_STANDARDS: &[&str] =
    &["-std=c++98", "-std=c++11", "-std=c++14", "-std=c++17", "-std=c++20", "-std=c++2b", "-std=gnu++2b"];

/// The C compiler for tests that need only one: gcc, or else the compiler with which Rust links.
pub fn c_compiler() -> &'static str {
    if tools::available("gcc", "under gcc") { "gcc" } else { "cc" }
}

/// All C compilers that the tests know. If clang is missing, the report lists what was skipped.
pub fn c_compilers() -> Vec<&'static str> {
    let clang = tools::available("clang", "under clang").then_some("clang");
    [c_compiler()].into_iter().chain(clang).collect()
}

/// The C++ compiler for tests that need only one. Without it the test is skipped.
pub fn cpp_compiler() -> Option<&'static str> {
    tools::available("g++", "C++").then_some("g++")
}

/// All C++ compilers that the tests know. If one is missing, the report lists what was skipped.
pub fn cpp_compilers() -> Vec<&'static str> {
    let clang = tools::available("clang++", "C++ under clang++").then_some("clang++");
    cpp_compiler().into_iter().chain(clang).collect()
}

/// A scratch folder that holds the library under the names that programs look for. Only one exists at a time: three
/// servo threads and their boards need the machine to themselves.
pub struct Bench {
    folder: TempDir,
    _turn: MutexGuard<'static, ()>,
}

impl Bench {
    pub fn new() -> Self {
        static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
        pauses::name_pauses();
        let turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
        let folder = tempfile::tempdir().expect("a scratch folder");
        for name in ["libsun2xp.so", "libsun2xp.so.0"] {
            std::os::unix::fs::symlink(library(), folder.path().join(name)).expect("a link to the library");
        }
        Self { folder, _turn: turn }
    }

    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Writes a source file into the scratch folder and returns its path, which the functions below accept as a source.
    pub fn write(&self, name: &str, text: &str) -> String {
        let path = self.path().join(name);
        fs::write(&path, text).expect("a source file");
        path.to_str().expect("the path is text").to_string()
    }

    /// Compiles without linking. Returns the compiler's messages if it fails.
    pub fn check(&self, compiler: &str, flags: &[&str], source: &str) -> Result<(), String> {
        let mut command = self.compiler(compiler, flags);
        outcome(command.arg("-c").args(["-o", "/dev/null"]).arg(source_file(source)))
    }

    /// Compiles and links. Returns the path of the program.
    pub fn build(&self, compiler: &str, flags: &[&str], sources: &[&str]) -> PathBuf {
        let name = source_file(sources[0]).file_name().expect("a file").to_string_lossy().replace('.', "_");
        let program = self.path().join(name);
        let mut command = self.compiler(compiler, flags);
        command.args(sources.iter().map(|source| source_file(source))).arg("-o").arg(&program);
        command.arg("-L").arg(self.path()).arg(format!("-Wl,-rpath,{}", self.path().display()));
        let built = outcome(command.args(["-lsun2xp", "-lpthread", "-ldl", "-lm"]));
        built.unwrap_or_else(|messages| panic!("{messages}"));
        program
    }

    fn compiler(&self, compiler: &str, flags: &[&str]) -> Command {
        let mut command = Command::new(compiler);
        // _DEFAULT_SOURCE keeps POSIX names visible under -ansi.
        command.args(flags).args(["-O1", "-g", "-D_DEFAULT_SOURCE", "-I"]).arg(root().join("include"));
        command
    }

    /// Compiles, links and runs one program that must exit with 0. A C++ program is skipped if there is no C++
    /// compiler.
    pub fn succeed(&self, flags: &[&str], sources: &[&str]) {
        let compiler = if sources[0].ends_with("cpp") { cpp_compiler() } else { Some(c_compiler()) };
        let Some(compiler) = compiler else { return };
        let program = self.build(compiler, flags, sources);
        let run = self.run(Command::new(&program));
        assert!(run.status.success(), "{sources:?} {flags:?}: {}\n{}", run.status, said(&run));
    }

    /// Runs a program in the scratch folder, with the configuration `named.toml` if it exists.
    pub fn run(&self, command: Command) -> Output {
        self.start(command).wait_with_output().expect("the program ends")
    }

    /// Starts a program as [`Bench::run`] does.
    pub fn start(&self, mut command: Command) -> Child {
        let nowhere = self.path().join("nowhere");
        command.current_dir(self.path()).env_remove("SUN2XP_CONFIG");
        command.env("HOME", &nowhere).env("XDG_CONFIG_HOME", &nowhere).env("XDG_CONFIG_DIRS", &nowhere);
        let named = self.path().join("named.toml");
        if named.exists() {
            command.env("SUN2XP_CONFIG", named);
        }
        let process =
            command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program can be started");
        pauses::name_pauses().also(process.id(), pauses::Part::Servo);
        process
    }
}

/// The output and error texts of a program.
pub fn said(run: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr))
}

/// The shared library of this build, which lies beside the test's executable.
pub fn library() -> PathBuf {
    let executable = env::current_exe().expect("the test has a path");
    let library = executable.with_file_name("libsun2xp.so");
    assert!(library.exists(), "{} is missing: cargo test builds it", library.display());
    library
}

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Returns the path of a source file of this folder. An absolute path is returned as it is.
fn source_file(source: &str) -> PathBuf {
    root().join("tests/c").join(source)
}

fn outcome(command: &mut Command) -> Result<(), String> {
    let run = command.output().expect("the compiler can be started");
    if run.status.success() { Ok(()) } else { Err(format!("{command:?}\n{}", said(&run))) }
}
