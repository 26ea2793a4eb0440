//! The headers compile in planners that have macros of their own. Sun2Xp.h compiles even if its names or keywords of C
//! and C++ are macros, and these macros are still defined after it.

#[allow(dead_code)]
mod c;

use c::{Bench, C_STANDARDS, CPP_STANDARDS, STRICT, c_compilers, cpp_compilers, root};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;

/// Keywords of C and C++. A separate test makes macros of them.
const WORDS: &[&str] = &[
    "auto",
    "case",
    "char",
    "class",
    "const",
    "default",
    "do",
    "double",
    "else",
    "enum",
    "extern",
    "float",
    "for",
    "if",
    "inline",
    "int",
    "long",
    "namespace",
    "operator",
    "private",
    "public",
    "register",
    "reinterpret_cast",
    "return",
    "short",
    "signed",
    "sizeof",
    "static",
    "struct",
    "switch",
    "template",
    "this",
    "typedef",
    "typename",
    "union",
    "unsigned",
    "void",
    "volatile",
    "while",
    "_Generic",
    "__inline",
];

/// Macros of the header itself and the calls that they use. A planner that defines one of them gets a compiler message,
/// or replaces the call.
const MACROS_OF_THE_HEADER: &[&str] = &["SendPos", "SendKx", "GetPos", "SendPosD", "SendKxD", "GetPosD"];

fn words(text: &str) -> impl Iterator<Item = &str> {
    let within = |letter: char| letter.is_alphanumeric() || letter == '_';
    text.split(move |letter| !within(letter)).filter(|word| word.starts_with(|letter: char| letter.is_alphabetic()))
}

/// The names in the declarations of the header, and in the declarations at the heads of the entries of its manual.
/// Keywords, [`MACROS_OF_THE_HEADER`] and names that begin with SUN2XP are left out.
fn names() -> BTreeSet<String> {
    let header = fs::read_to_string(root().join("include/Sun2Xp.h")).expect("the header");
    let mut names = BTreeSet::new();
    let (mut manual, mut continued) = (false, false);
    for line in header.lines() {
        let entry = line.starts_with("     int ") || line.starts_with("     const char *");
        let directive = continued || line.starts_with('#');
        if (manual && entry) || (!manual && !directive) {
            let code = line.split("/*").next().unwrap_or_default();
            let declaration = code.split_once(';').map_or(code, |(declaration, _)| declaration);
            names.extend(words(declaration).map(str::to_string));
        }
        continued = directive && line.ends_with('\\');
        manual = (manual || line.contains("/*")) && !line.contains("*/");
    }
    let own = |name: &String| {
        let name = name.as_str();
        name == "C"
            || WORDS.contains(&name)
            || MACROS_OF_THE_HEADER.contains(&name)
            || name.to_uppercase().starts_with("SUN2XP")
    };
    names.retain(|name| !own(name));
    names
}

#[test]
fn every_name_of_the_header_may_be_a_macro() {
    let names = names();
    assert!(["Pos", "Kx", "i", "OpenHand", "CloseHand", "HandError"].iter().all(|n| names.contains(*n)));
    may_be_macros(names.iter().map(String::as_str), &[&[], &["-DSUN2XP_REAL=float"], &["-DSUN2XP_NO_GENERIC"]]);
}

#[test]
fn every_word_of_c_may_be_a_macro() {
    // In C++ clang warns about every such macro, wherever it is defined.
    let allowed = "-Wno-keyword-macro";
    may_be_macros(WORDS.iter().copied(), &[&[allowed], &[allowed, "-DSUN2XP_NO_GENERIC"]]);
}

/// The planner's calls compile while keywords of C are macros. Planners use such macros to remove keywords that a
/// compiler does not know, such as `const`, or to turn every `float` into `double`.
#[test]
fn calls_compile_where_words_of_c_are_macros() {
    let bench = Bench::new();
    let sources = [bench.write("words.c", WORDS_AT_CALLS), bench.write("words.cpp", WORDS_AT_CALLS)];
    for mode in [&["-Wno-keyword-macro"][..], &["-Wno-keyword-macro", "-DSUN2XP_NO_GENERIC"]] {
        in_every_dialect(&bench, mode, &sources);
    }
}

const WORDS_AT_CALLS: &str = "
#define const
#define volatile
#define signed
#define unsigned
#define void char
#define long int
#define float double
#include \"Sun2Xp.h\"
int planner(int finger);
int planner(int finger)
{
    const float Pos[3] = {0, 0, 0}, Kx[3][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    volatile float Now[3] = {0, 0, 0};

    return SendPos(finger, Pos) + SendKx(finger, Kx) + SendKx(finger, Kx[0]) + GetPos(finger, Now);
}
";

/// The header must compile while all `names` are macros with useless definitions, and must restore each of these
/// macros.
fn may_be_macros<'a>(names: impl Iterator<Item = &'a str> + Clone, modes: &[&[&str]]) {
    let mut planner = String::new();
    for name in names.clone() {
        writeln!(planner, "#define {name} )this macro is in the way(").expect("a String grows");
    }
    planner.push_str("#include \"Sun2Xp.h\"\n");
    for name in names {
        writeln!(planner, "#ifndef {name}\n#error \"{name} is no macro any more\"\n#endif\n#undef {name}")
            .expect("a String grows");
    }
    planner.push_str("int planner(void);\nint planner(void)\n{\n    float Pos[3];\n");
    planner.push_str("    return OpenHand() + SendPos(1, Pos) + SendKx(1, Pos) + GetPos(1, Pos) + CloseHand();\n}\n");

    let bench = Bench::new();
    let sources = [bench.write("every.c", &planner), bench.write("every.cpp", &planner)];
    for mode in modes {
        in_every_dialect(&bench, mode, &sources);
    }
}

#[test]
fn a_planner_with_a_window_compiles() {
    compiles_with_a_window("x11");
}

#[test]
fn a_planner_with_a_window_and_handles_compiles() {
    compiles_with_a_window("x11_handles");
}

/// Compiles a planner that includes macros like those of X11 before the headers of the library, and again with the
/// macros after these headers.
fn compiles_with_a_window(planner: &str) {
    let bench = Bench::new();
    let folder = root().join("tests/c");
    let text = fs::read_to_string(folder.join(planner).with_extension("c")).expect("the planner");
    let folder = format!("-I{}", folder.display());
    let sources = ["c", "cpp"].map(|ending| bench.write(&format!("{planner}.{ending}"), &text));
    in_every_dialect(&bench, &[&folder], &sources);
    in_every_dialect(&bench, &[&folder, "-DWINDOW_LAST"], &sources);
}

/// Planners write the members of structs themselves, so sun2xp.h, unlike Sun2Xp.h, cannot hide its names from their
/// macros. The macros of X11, and planners' macros such as Pos, have capital letters. Other macros of planners, such as
/// i, have one letter.
#[test]
fn names_of_the_header_with_handles_are_lower_case_and_longer_than_a_letter() {
    let header = fs::read_to_string(root().join("include/sun2xp.h")).expect("the header");
    let code: String = header.split("/*").filter_map(|part| part.rsplit("*/").next()).collect();
    let names: BTreeSet<&str> = code.lines().filter(|line| !line.starts_with('#')).flat_map(words).collect();
    assert!(["sun2xp_send_position", "finger", "sun2xp_tip", "slide_speed"].iter().all(|name| names.contains(name)));
    // `extern "C"` has the name C.
    let like_macros = |name: &&&str| **name != "C" && (name.len() < 2 || name.contains(char::is_uppercase));
    let like_macros: Vec<_> = names.iter().filter(like_macros).collect();
    assert!(like_macros.is_empty(), "include/sun2xp.h has names that a planner's macros may have: {like_macros:?}");
}

/// `sources` holds the same program in C and in C++.
fn in_every_dialect(bench: &Bench, flags: &[&str], sources: &[String; 2]) {
    let languages = [(c_compilers(), C_STANDARDS), (cpp_compilers(), CPP_STANDARDS)];
    for ((compilers, standards), source) in languages.into_iter().zip(sources) {
        for compiler in compilers {
            for standard in standards {
                let flags = [STRICT, flags, &[standard]].concat();
                bench.check(compiler, &flags, source).unwrap_or_else(|messages| panic!("{messages}"));
            }
        }
    }
}
