//! The header in every dialect of C and C++ that planners are written in: no warning, and only arrays of float or double.

#[allow(dead_code)]
mod c;

use c::{Bench, STRICT, c_compiler, c_compilers, cpp_compiler, cpp_compilers};

const C: &[&str] = &["-ansi", "-std=c89", "-std=gnu89", "-std=c99", "-std=gnu99", "-std=c11", "-std=c17", "-std=c2x"];
const CPP: &[&str] = &["-std=c++98", "-std=c++11", "-std=c++14", "-std=c++17", "-std=c++20"];

/// Every way of telling the header what the arrays are.
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
            // In C23 `int SendPos();` says that there is no argument.
            let flags = with(&[STRICT, &[named, arrays, "-std=c2x", "-DNO_DECLARATIONS"]]);
            bench.check(compiler, &flags, "own.c").unwrap_or_else(|e| panic!("{e}"));
        }
        for standard in C {
            let flags = with(&[STRICT, &["-DSUN2XP_H", "-DANSI_DECLARATIONS", "-DREAL=float", standard]]);
            bench.check(compiler, &flags, "own.c").unwrap_or_else(|e| panic!("{e}"));
        }
    }
}

#[test]
fn other_element_types_do_not_compile() {
    let bench = Bench::new();
    for (compilers, standards, source) in [(c_compilers(), C, "wrong_type.c"), (cpp_compilers(), CPP, "wrong_type.cpp")]
    {
        for compiler in compilers {
            for standard in standards {
                let refused = bench.check(compiler, &[standard], source);
                assert!(refused.is_err(), "{compiler} {standard} takes an array of int");
            }
        }
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
