//! Compiles and runs every example of the manual as it stands.

use super::c::{
    Bench, C_STANDARDS, CPP_STANDARDS, STRICT, available, c_compiler, c_compilers, cpp_compilers, root, said,
};
use super::manual::{Example, HANDLES, Manual, OF_1990};
use std::process::Command;

/// The headers for the examples that are only statements.
const INCLUDED: &[&str] = &["errno.h", "poll.h", "signal.h", "stdio.h", "stdlib.h", "unistd.h"];

/// For some examples: the call that the example belongs to, statements that run before it to prepare it, and statements
/// that run after it to check that it worked.
const AROUND: &[(&str, &str, &str)] = &[
    (
        "sun2xp_stop_all",
        "",
        "struct sun2xp_fault found; found.size = sizeof found;
        if (raise(SIGINT) != 0) return 4;
        do if (sun2xp_fault(hand, 1, &found) != 0) return 5;
        while (found.number != SUN2XP_FAULT_EMERGENCY_STOP_CALL);",
    ),
    (
        "sun2xp_recover",
        "struct sun2xp_fault found; found.size = sizeof found;
        sun2xp_stop_all();
        do if (sun2xp_fault(hand, 1, &found) != 0) return 4;
        while (found.number != SUN2XP_FAULT_EMERGENCY_STOP_CALL);",
        "double at[3]; if (sun2xp_position(hand, 1, at) != 0) return 5;",
    ),
    ("sun2xp_open", "", "sun2xp_close(other);"),
    ("sun2xp_write_black_box", "", "if (access(\"finger-1.jsonl\", R_OK) != 0) return 4;"),
];

impl Example {
    fn is_program(&self) -> bool {
        self.text.contains("int main(")
    }

    fn is_configuration(&self) -> bool {
        self.text.starts_with('[')
    }

    fn is_command(&self) -> bool {
        self.text.starts_with("cc ")
    }

    /// Makes a whole program of the statements of an example. The program fails if one of their calls is refused.
    /// Static functions at the start of the example are placed before main.
    fn program(&self) -> String {
        if self.is_program() {
            return self.text.clone();
        }
        let defines = self.text.starts_with("static ").then(|| self.text.rfind("\n}\n").map(|end| end + 3)).flatten();
        let (functions, statements) = self.text.split_at(defines.unwrap_or_default());
        let (_, before, after) = AROUND.iter().find(|(call, ..)| *call == self.place).unwrap_or(&("", "", ""));
        let included: String = INCLUDED.iter().map(|name| format!("#include <{name}>\n")).collect();
        let (opening, closing) = match self.header {
            OF_1990 if statements.contains("OpenHand()") => ("", "HandError()[0] != '\\0' || CloseHand() != 0"),
            OF_1990 => ("if (OpenHand() != 0) return 2;", "HandError()[0] != '\\0' || CloseHand() != 0"),
            _ => (
                "sun2xp_hand *hand; if (sun2xp_open(NULL, &hand) != 0) return 2;",
                "sun2xp_error_text(NULL)[0] != '\\0' || sun2xp_close(hand) != 0",
            ),
        };
        // In C89, declarations come first in a block, so parts that declare variables get blocks of their own.
        let blocks = format!("{{ {before} }}\n{{\n{statements}{}}}\n", self.inside(after));
        format!(
            "{included}#include \"{}\"\n\n{functions}\nint main(void)\n{{\n    {opening}\n{{\n{blocks}}}\n\
             return {closing};\n}}\n",
            self.header
        )
    }

    /// Returns the statements that follow the example. After the example of sun2xp_open, they use the example's
    /// variables, so they stand in its block. After other examples, they get a block of their own.
    fn inside(&self, after: &str) -> String {
        if self.place == "sun2xp_open" { after.to_string() } else { format!("}}\n{{ {after} ") }
    }
}

fn programs() -> Vec<Example> {
    let mut examples: Vec<_> = Manual::both().iter().flat_map(Manual::examples).collect();
    examples.retain(|example| !example.is_configuration() && !example.is_command());
    examples
}

fn only(header: &'static str, kind: impl Fn(&Example) -> bool) -> Example {
    let mut found: Vec<_> = Manual::read(header).examples().into_iter().filter(kind).collect();
    assert_eq!(found.len(), 1);
    found.remove(0)
}

#[test]
fn all_code_stands_in_examples() {
    for (manual, expected) in Manual::both().iter().zip([
        &["1", "7", "OpenHand", "SendKx", "GetPos"][..],
        &["1", "sun2xp_open", "sun2xp_record", "sun2xp_stop_all", "sun2xp_recover", "sun2xp_error"],
    ]) {
        let examples = manual.examples();
        assert!(examples.iter().all(|example| example.text.len() > 10), "an example without text");
        let places: Vec<_> = examples.iter().map(|example| example.place.as_str()).collect();
        for place in expected {
            assert!(places.contains(place), "no example in {place}: {places:?}");
        }
        assert_eq!(manual.stray_code(), Vec::<String>::new());
    }
}

#[test]
fn every_example_compiles_in_c_and_cpp() {
    let bench = Bench::new();
    for example in programs() {
        let (c, cpp) = (C_STANDARDS, CPP_STANDARDS);
        for (compilers, standards, end) in [(c_compilers(), c, "c"), (cpp_compilers(), cpp, "cpp")] {
            let source = bench.write(&format!("example.{end}"), &example.program());
            for compiler in compilers {
                for standard in [standards[0], standards[standards.len() - 1]] {
                    let checked = bench.check(compiler, &[STRICT, &[standard]].concat(), &source);
                    checked.unwrap_or_else(|messages| panic!("{}:\n{messages}\n{}", example.place, example.program()));
                }
            }
        }
    }
}

#[test]
fn every_example_runs() {
    let bench = Bench::new();
    // The example of sun2xp_object needs an object, and that of sun2xp_touch an element. The object is out of reach, so
    // that it does not disturb the other examples.
    let object = "[finger]\nport = \"simulated\"\n[hand.simulated_object]\nposition = [0, 0, 50]\n\
                  [finger.touch]\nelements = [{ position = [0, 0, 0], normal = [0, 0, 1] }]\n";
    bench.write("sun2xp.toml", object);
    for example in programs() {
        let source = bench.write("example.c", &example.program());
        let program = bench.build(c_compiler(), &[STRICT, &["-std=c89"]].concat(), &[&source]);
        let run = bench.run(Command::new(program));
        assert!(run.status.success(), "{}: {}\n{}\n{}", example.place, run.status, said(&run), example.text);
    }
}

/// Runs the command of each quick start in a folder with its program as `planner.c`. pkg-config finds the library of
/// this build. The finger must arrive.
#[test]
fn the_quick_starts_are_compiled_and_run_by_their_commands() {
    if !available("pkg-config", "the commands of the quick starts") {
        return;
    }
    for header in [OF_1990, HANDLES] {
        let bench = Bench::new();
        bench.write("planner.c", &only(header, Example::is_program).text);
        let (headers, library) = (root().join("include"), bench.path());
        let flags = format!("Cflags: -I{}\nLibs: -L{} -lsun2xp\n", headers.display(), library.display());
        bench.write("sun2xp.pc", &format!("Name: sun2xp\nDescription: this build\nVersion: 0\n{flags}"));
        let mut shell = Command::new("sh");
        shell.args(["-e", "-c", &only(header, Example::is_command).text]);
        shell.env("PKG_CONFIG_PATH", library).env("LD_LIBRARY_PATH", library);
        let run = bench.run(shell);
        assert!(run.status.success(), "{}", said(&run));
        let words = str::from_utf8(&run.stdout).expect("angles").split_whitespace();
        let arrived: Vec<f64> = words.map(|angle| angle.parse().expect("an angle")).collect();
        let near = arrived.iter().zip([0.0, 0.5, 0.8]).all(|(angle, sent)| (angle - sent).abs() < 0.03);
        assert!(arrived.len() == 3 && near, "{}", said(&run));
    }
}

/// The example of a configuration names a port of its reader's machine, so the port is the only permitted reason to
/// refuse the example.
#[test]
fn the_configuration_is_refused_only_for_its_port() {
    let bench = Bench::new();
    let configuration = only(OF_1990, Example::is_configuration).text;
    assert!(configuration.contains("\"/dev/ttyUSB0\""), "{configuration}");
    bench.write("named.toml", &configuration.replace("/dev/ttyUSB0", "/dev/no-such-port"));
    let program = bench.build(c_compiler(), STRICT, &["opens.c"]);
    let run = bench.run(Command::new(program));
    assert_eq!(run.status.code(), Some(2), "{}", said(&run));
    assert!(said(&run).contains("No such file or directory") && said(&run).contains("no-such-port"), "{}", said(&run));
}
