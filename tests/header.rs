//! The committed header is what cbindgen makes of the exports. A build script must not write into the source, so a test
//! compares, and writes when asked to.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;
use std::{env, fs};
use sun2xp::finger::FaultKind;

/// The five calls of 1990 and HandError.
const CALLS_OF_1990: &[&str] = &["calls.rs"];

/// Everything else, in the order of the manual.
const OTHER_CALLS: &[&str] = &[
    "status_calls.rs",
    "timing_calls.rs",
    "fingertip_calls.rs",
    "black_box_calls.rs",
    "calibration_calls.rs",
    "fault_calls.rs",
    "recovery_calls.rs",
];

/// Words of C and C++ that stand in the header outside of the declarations.
const WORDS_OF_THE_TRAILER: &[&str] =
    &["class", "extern", "inline", "reinterpret_cast", "return", "sizeof", "template", "typedef", "volatile"];

/// The header makes macros of three of these itself, so it cannot give back a planner's macro of the same name. Those
/// macros use the other three.
const MACROS: &[&str] = &["GetPos", "GetPosD", "SendKx", "SendKxD", "SendPos", "SendPosD"];

/// A constant for each fault.
fn faults() -> String {
    let line = |kind: &FaultKind| {
        let told = kind.description();
        format!("#define FAULT_{:<22} {:>2} /* {} */", told.constant, kind.number(), told.name)
    };
    FaultKind::ALL.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// What cbindgen makes of some files of src/capi, without header and trailer.
fn declarations(mut config: cbindgen::Config, files: &[&str]) -> String {
    (config.header, config.trailer) = (None, None);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/capi");
    let builder = cbindgen::Builder::new().with_config(config);
    let builder = files.iter().fold(builder, |builder, file| builder.with_src(folder.join(file)));
    let mut made = Vec::new();
    builder.generate().expect("the exports can be parsed").write(&mut made);
    let made = String::from_utf8(made).expect("declarations are text");
    made.lines().map(|line| without_parameter_names(line) + "\n").collect()
}

/// A planner may have macros named like parameters. The synopsis above each declaration names them.
fn without_parameter_names(line: &str) -> String {
    let call = line.starts_with("int ") || line.starts_with("const char *");
    let Some((call, parameters)) = line.strip_suffix(");").filter(|_| call).and_then(|line| line.split_once('('))
    else {
        return line.to_string();
    };
    let kind = |parameter: &str| {
        let kind = parameter.trim_end_matches(|letter: char| letter.is_alphanumeric() || letter == '_');
        if parameter == "void" { parameter.to_string() } else { kind.trim_end().to_string() }
    };
    format!("{call}({});", parameters.split(", ").map(kind).collect::<Vec<_>>().join(", "))
}

/// The declarations without their comments.
fn code(declarations: &str) -> String {
    let mut code = Vec::new();
    let mut rest = declarations;
    while let Some((before, comment)) = rest.split_once("/*") {
        code.push(before);
        rest = comment.split_once("*/").expect("every comment ends").1;
    }
    code.push(rest);
    code.concat()
}

/// Every name that the declarations use, and the words of C around them.
fn names(code: &str) -> BTreeSet<&str> {
    let lines = code.lines().filter(|line| !line.starts_with('#'));
    let words = lines.flat_map(|line| line.split(|letter: char| !letter.is_alphanumeric() && letter != '_'));
    let names = words.filter(|word| word.starts_with(|letter: char| letter.is_alphabetic()));
    names.filter(|name| !MACROS.contains(name)).chain(WORDS_OF_THE_TRAILER.iter().copied()).collect()
}

/// Stops a compiler for 64 bits that lays a struct out in another way than the library.
fn sizes(code: &str) -> String {
    let mut lines = String::new();
    for declaration in code.split("\nstruct ").skip(1) {
        let (name, members) = declaration.split_once('{').expect("a struct has members");
        let members = members.split_once('}').expect("the members end").0;
        let (mut size, mut alignment) = (0, 1);
        for member in members.split(';').map(str::trim).filter(|member| !member.is_empty()) {
            let (kind, rest) = member.rsplit_once(' ').expect("a member has a type and a name");
            let part = match kind {
                "int" | "unsigned int" => 4,
                "double" | "unsigned long" => 8,
                _ => panic!("the size of {kind} is not known here"),
            };
            let parts: usize = rest.split(['[', ']']).filter_map(|part| part.parse::<usize>().ok()).product();
            size = usize::next_multiple_of(size, part) + part * parts;
            alignment = alignment.max(part);
        }
        let (name, size) = (name.trim(), size.next_multiple_of(alignment));
        writeln!(lines, "typedef char Sun2Xp{name}Size[sizeof(struct {name}) == {size} ? 1 : -1];")
            .expect("a String grows");
    }
    format!(
        "/* Where these do not compile, the compiler packs structs in another way than the library. */\n\
             #ifdef __LP64__\n{lines}#endif\n"
    )
}

/// Sets the planner's macros aside, and takes them up again.
fn shields(names: &BTreeSet<&str>) -> (String, String) {
    let pragmas = |pragma: &str| {
        let mut lines = Vec::<String>::new();
        for name in names {
            let next = format!("_Pragma(\"{pragma}_macro(\\\"{name}\\\")\")");
            match lines.last_mut() {
                Some(last) if last.len() + next.len() < 120 => write!(last, " {next}").expect("a String grows"),
                _ => lines.push(next),
            }
        }
        lines.join("\n")
    };
    let undefine: String = names.iter().map(|name| format!("#undef {name}\n")).collect();
    let shield = format!(
        "/* Macros of the planner that are named like something below are set aside until the end of this file. */\n\
         #if defined(__clang__) || (defined(__GNUC__) && (__GNUC__ > 4 || (__GNUC__ == 4 && __GNUC_MINOR__ >= 6)))\n\
         #define SUN2XP_SETS_MACROS_ASIDE\n#endif\n\n\
         #ifdef SUN2XP_SETS_MACROS_ASIDE\n{}\n{undefine}#endif\n",
        pragmas("push")
    );
    (shield, format!("#ifdef SUN2XP_SETS_MACROS_ASIDE\n{}\n#endif\n", pragmas("pop")))
}

#[test]
fn the_committed_header_is_the_one_of_the_exports() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("cbindgen.toml can be used");
    let part = |part: &Option<String>| part.clone().expect("cbindgen.toml has header and trailer");
    let (header, trailer) = (part(&config.header), part(&config.trailer));
    let calls_of_1990 = declarations(config.clone(), CALLS_OF_1990);
    let others = declarations(config, OTHER_CALLS);
    let sizes = sizes(&code(&others));
    let body = format!(
        "{calls_of_1990}\n\n\
         #ifndef SUN2XP_FIVE_CALLS\n\n\
         /* The faults (chapter 10). Numbers never change. */\n{}\n\n\n{others}\n\n{sizes}\n\
         #endif /* SUN2XP_FIVE_CALLS */\n",
        faults()
    );
    let (shield, unshield) = shields(&names(&code(&format!("{calls_of_1990}{others}"))));
    let (header, trailer) = (header.replace("@SHIELD@", &shield), trailer.replace("@UNSHIELD@", &unshield));
    let made = format!("{header}\n{body}\n{trailer}");

    let committed = root.join("include/Sun2Xp.h");
    if env::var_os("SUN2XP_WRITE_HEADER").is_some() {
        fs::write(&committed, &made).expect("include/Sun2Xp.h can be written");
    }
    assert!(
        fs::read_to_string(&committed).is_ok_and(|text| text == made),
        "include/Sun2Xp.h is stale. To renew it: SUN2XP_WRITE_HEADER=1 cargo test --test header"
    );
}
