//! The header in every dialect of C and C++ that planners use: it must cause no warning, and must accept only arrays of
//! float or double.

#[allow(dead_code)]
mod c;

use c::{
    Bench, C_STANDARDS as C, CPP_STANDARDS as CPP, STRICT, c_compiler, c_compilers, cpp_compiler, cpp_compilers, root,
};
use std::fs;

/// Both element types of a planner's arrays, each without and with SUN2XP_NO_GENERIC.
const CHOICES: &[&[&str]] = &[
    &["-DREAL=float"],
    &["-DREAL=double"],
    &["-DREAL=float", "-DSUN2XP_NO_GENERIC"],
    &["-DREAL=double", "-DSUN2XP_NO_GENERIC"],
];

fn with<'a>(parts: &[&[&'a str]]) -> Vec<&'a str> {
    parts.concat()
}

#[test]
fn the_header_alone_is_free_of_warnings_and_may_come_twice() {
    let bench = Bench::new();
    for choice in [&[][..], &["-DSUN2XP_REAL=float"], &["-DSUN2XP_REAL=double"]] {
        for (compilers, standards, source) in
            [(c_compilers(), C, "header_twice.c"), (cpp_compilers(), CPP, "header_twice.cpp")]
        {
            for compiler in compilers {
                for standard in standards {
                    bench
                        .check(compiler, &with(&[STRICT, choice, &[standard]]), source)
                        .unwrap_or_else(|e| panic!("{e}"));
                }
            }
        }
    }
}

/// Checks that `sun2xp.h` compiles without a warning, may be included twice, and gives its structs the same layout even
/// after `#pragma pack`.
#[test]
fn the_header_with_handles_compiles_in_every_dialect_with_its_layout() {
    let bench = Bench::new();
    let layout = fs::read_to_string(root().join("tests/c/layout.c")).expect("the source");
    let layout = format!("#pragma pack(1)\n#include \"Sun2Xp.h\"\n#include \"sun2xp.h\"\n{layout}");
    for (compilers, standards, name) in [(c_compilers(), C, "layout.c"), (cpp_compilers(), CPP, "layout.cpp")] {
        let source = bench.write(name, &layout);
        for compiler in compilers {
            for standard in standards {
                bench.check(compiler, &with(&[STRICT, &[standard]]), &source).unwrap_or_else(|e| panic!("{e}"));
            }
        }
    }
}

/// Every struct of the header must be in tests/c/layout.c, with every member.
#[test]
fn the_layout_is_complete() {
    let read = |name: &str| fs::read_to_string(root().join(name)).expect("a source");
    let (header, layout) = (read("include/sun2xp.h"), read("tests/c/layout.c"));
    let structs: Vec<_> = header.split("\nstruct ").skip(1).filter_map(|text| text.split_once(" {\n")).collect();
    assert!(structs.len() > 10, "{} structs", structs.len());
    for (name, members) in structs {
        assert!(layout.contains(&format!("BYTES({name}, ")), "tests/c/layout.c should have {name}");
        let members = members.split_once("\n};").expect("a struct ends").0;
        // Lines that continue a comment are indented further.
        let declares = |line: &&str| line.strip_prefix("    ").is_some_and(|rest| !rest.starts_with(' '));
        for member in members.lines().filter(declares).filter_map(|line| line.split_once(';')).map(|(member, _)| member)
        {
            // A pointer to a function has its name in parentheses.
            let pointer = member.split_once("(*").and_then(|(_, rest)| rest.split(')').next());
            let member = pointer.or_else(|| member.rsplit([' ', '*']).next()?.split('[').next()).expect("a name");
            let assertion = format!("AT({name}, {member}, ");
            assert!(layout.contains(&assertion), "tests/c/layout.c should have {name}.{member}");
        }
    }
}

#[test]
fn a_planner_compiles_in_every_dialect_of_c() {
    let bench = Bench::new();
    for compiler in c_compilers() {
        for standard in C {
            for choice in CHOICES {
                bench
                    .check(compiler, &with(&[STRICT, choice, &[standard]]), "reach.c")
                    .unwrap_or_else(|e| panic!("{e}"));
            }
            bench.check(compiler, &with(&[STRICT, &[standard]]), "null.c").unwrap_or_else(|e| panic!("{e}"));
        }
        for standard in C.iter().filter(|standard| !standard.contains("89") && **standard != "-ansi") {
            bench.check(compiler, &with(&[STRICT, &[standard]]), "once.c").unwrap_or_else(|e| panic!("{e}"));
        }
    }
}

#[test]
fn a_planner_compiles_in_every_dialect_of_cpp() {
    let bench = Bench::new();
    for compiler in cpp_compilers() {
        for standard in CPP {
            for source in ["reach.cpp", "inside_extern_c.cpp"] {
                bench.check(compiler, &with(&[STRICT, &[standard]]), source).unwrap_or_else(|e| panic!("{e}"));
            }
        }
    }
}

#[test]
fn own_declarations_compile_with_the_type_named() {
    let bench = Bench::new();
    for compiler in c_compilers() {
        for (named, arrays) in [("-DSUN2XP_REAL=float", "-DREAL=float"), ("-DSUN2XP_REAL=double", "-DREAL=double")] {
            for standard in C.iter().filter(|standard| **standard != "-std=c2x") {
                let flags = with(&[STRICT, &[named, arrays, standard]]);
                bench.check(compiler, &flags, "own.c").unwrap_or_else(|e| panic!("{e}"));
            }
            // In C23 `int SendPos();` declares a function without arguments.
            let flags = with(&[STRICT, &[named, arrays, "-std=c2x", "-DNO_DECLARATIONS"]]);
            bench.check(compiler, &flags, "own.c").unwrap_or_else(|e| panic!("{e}"));
        }
        for standard in C {
            let flags = with(&[STRICT, &["-DSUN2XP_H", "-DANSI_DECLARATIONS", "-DREAL=float", standard]]);
            bench.check(compiler, &flags, "own.c").unwrap_or_else(|e| panic!("{e}"));
        }
    }
}

/// Statements in C89 that must not compile: the argument is not an array of float or double, its rows do not have three
/// elements, or GetPos would write to a const array. A C++ compiler reports each pair of template and type only once,
/// so no pair occurs twice.
const WRONG: &[&str] = &[
    "static int Wrong[3]; SendPos(1, Wrong);",
    "static void *Wrong; SendPos(1, Wrong);",
    "static const void *Wrong; SendPos(1, Wrong);",
    "SendKx(1, (void *)5);",
    "static void *Wrong; GetPos(1, Wrong);",
    "static char Wrong[36]; SendPos(1, Wrong);",
    "static long double Wrong[3]; SendPos(1, Wrong);",
    "static float Wrong[4][4]; SendKx(1, Wrong);",
    "static double Wrong[4][4]; SendKx(1, Wrong);",
    "static float *Wrong[3]; SendKx(1, Wrong);",
    "static double **Wrong; SendKx(1, Wrong);",
    "static float Wrong; SendPos(1, Wrong);",
    "static int Wrong; SendPos(1, Wrong);",
    "static long Wrong; SendPos(1, Wrong);",
    "static const float Wrong[3] = {0, 0, 0}; GetPos(1, Wrong);",
    "SendPos(1, 5);",
    "SendPos(1, 5L);",
    "SendPos(1, 0.5);",
    "GetPos(1, -1);",
];

/// Statements that must not compile even without `_Generic`, where the header can check only the size of an element.
const WRONG_BY_SIZE: &[&str] = &[
    "SendPos(1, (void *)5);",
    "static void *Wrong; GetPos(1, Wrong);",
    "static char Wrong[36]; SendPos(1, Wrong);",
    "static int Wrong; SendPos(1, Wrong);",
    "SendPos(1, 5);",
    "SendPos(1, 0.5);",
];

#[test]
fn other_arguments_do_not_compile() {
    let bench = Bench::new();
    let refuses = |mode: &[&str], wrong: &[&str]| {
        let statements: Vec<_> = wrong.iter().map(|statements| format!("{{ {statements} }}\n")).collect();
        let planner = format!("#include \"Sun2Xp.h\"\nvoid planner(void) {{\n{}}}\n", statements.concat());
        for (compilers, standards, name) in [(c_compilers(), C, "wrong.c"), (cpp_compilers(), CPP, "wrong.cpp")] {
            let source = bench.write(name, &planner);
            for compiler in compilers {
                // By default, clang stops at the twentieth error.
                let all: &[&str] = if compiler.starts_with("clang") { &["-ferror-limit=0"] } else { &[] };
                for standard in standards {
                    let flags = with(&[mode, all, &[standard, "-w", "-fsyntax-only"]]);
                    let messages = bench.check(compiler, &flags, &source).err().unwrap_or_default();
                    for (index, statements) in wrong.iter().enumerate() {
                        let refused = messages.contains(&format!("{name}:{}:", index + 3));
                        assert!(refused, "{compiler} {flags:?} takes: {statements}\n{messages}");
                    }
                }
            }
        }
    };
    refuses(&[], WRONG);
    refuses(&["-DSUN2XP_NO_GENERIC"], WRONG_BY_SIZE);
}

#[test]
fn arrays_of_variable_length_compile() {
    let bench = Bench::new();
    for compiler in c_compilers() {
        for standard in C.iter().filter(|standard| !standard.contains("89") && **standard != "-ansi") {
            for choice in [&[][..], &["-DSUN2XP_NO_GENERIC"]] {
                bench
                    .check(compiler, &with(&[STRICT, choice, &[standard]]), "variable_length.c")
                    .unwrap_or_else(|e| panic!("{e}"));
            }
        }
        bench
            .check(compiler, &["-Wall", "-Werror", "-std=gnu89"], "variable_length.c")
            .unwrap_or_else(|e| panic!("{e}"));
    }
}

#[test]
fn only_float_and_double_can_be_named() {
    let bench = Bench::new();
    for value in ["-DSUN2XP_REAL", "-DSUN2XP_REAL=", "-DSUN2XP_REAL=int"] {
        let cpp = cpp_compiler().map(|compiler| (compiler, "header_twice.cpp"));
        for (compiler, source) in [(c_compiler(), "header_twice.c")].into_iter().chain(cpp) {
            let refused = bench.check(compiler, &[value], source).expect_err("an unusable type is taken");
            assert!(refused.contains("SUN2XP_REAL must be float or double"), "{refused}");
        }
    }
}
