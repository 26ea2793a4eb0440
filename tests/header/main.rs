//! The committed headers equal the ones generated from the exports. A build script must not write into the source
//! folder, so this test compares them, and writes the headers if SUN2XP_WRITE_HEADER is set.

mod shields;

use shields::{names, shields};
use std::fmt::Write;
use std::path::Path;
use std::{env, fs};
use sun2xp::finger::FaultKind;
use sun2xp::finger::events::EventKind;

/// The file with the five calls of 1990, their forms for arrays of double, and HandError.
const FILES_OF_1990: &[&str] = &["calls.rs"];

/// The sections of sun2xp.h: heading and files.
const SECTIONS: &[(&str, &str)] = &[
    ("ERRORS", "error_calls.rs"),
    ("MESSAGES", "log_calls.rs"),
    ("VERSIONS", "version_calls.rs"),
    ("OPENING AND CLOSING", "opening_calls.rs"),
    ("HARDWARE OF THE PROGRAM", "io_structs.rs io_calls.rs"),
    ("JOINT ANGLES AND STIFFNESS", "position_calls.rs"),
    ("FINGERTIPS", "fingertip_struct.rs fingertip_calls.rs"),
    ("SPRINGS IN JOINT ANGLES", "spring_calls.rs"),
    ("GROUPS AND WAITING", "group_calls.rs"),
    ("PATHS", "path_calls.rs"),
    ("KINEMATICS AND GRAVITY", "kinematics_calls.rs"),
    ("LIMITS", "limits_struct.rs limits_calls.rs"),
    ("TOUCH", "touch_calls.rs"),
    ("SIMULATION", "object_calls.rs"),
    ("ADJUSTMENT", "adjustment_calls.rs"),
    ("STATUS", "status_struct.rs status_calls.rs"),
    ("TIMING", "timing_calls.rs"),
    ("FAULTS", "fault_struct.rs fault_calls.rs"),
    ("STOP AND RECOVERY", "recovery_calls.rs"),
    ("CALIBRATION", "calibration_calls.rs"),
    ("EVENTS", "event_struct.rs event_calls.rs"),
    ("REFLEXES", "reflex_calls.rs"),
    ("BLACK BOX", "black_box_calls.rs"),
];

/// Files of constants at the beginning of sun2xp.h.
const CONSTANTS: &[&str] = &["fingers.rs", "error_numbers.rs"];

/// The column in which the comments beside constants and members begin. Most constants and members end before it.
const COMMENT_COLUMN: usize = 44;

/// A constant for each fault.
fn faults() -> String {
    let line = |kind: &FaultKind| {
        let description = kind.description();
        constant("SUN2XP_FAULT_", description.constant, kind.number().into(), description.name)
    };
    FaultKind::ALL.iter().map(line).collect()
}

/// A constant for each kind of event.
fn events() -> String {
    let line = |kind: &EventKind| {
        let description = kind.description();
        constant("SUN2XP_EVENT_", description.constant, kind.number().into(), description.name)
    };
    EventKind::ALL.iter().map(line).collect()
}

fn constant(prefix: &str, name: &str, number: u32, meaning: &str) -> String {
    beside(&format!("#define {:<35} {number:>2}", format!("{prefix}{name}")), meaning)
}

/// The chapters of the manual as a C comment.
fn manual(text: &str) -> String {
    let lines: Vec<_> =
        text.lines().map(|line| if line.is_empty() { "\n".into() } else { format!("   {line}\n") }).collect();
    format!("/* {} */\n", lines.concat().trim())
}

/// The output of cbindgen for some files of src/capi.
fn declarations(config: cbindgen::Config, files: &[&str]) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/capi");
    let builder = cbindgen::Builder::new().with_config(config);
    let builder = files.iter().fold(builder, |builder, file| builder.with_src(folder.join(file)));
    let mut made = Vec::new();
    builder.generate().expect("the exports can be parsed").write(&mut made);
    let made = String::from_utf8(made).expect("declarations are text");
    let lines: Vec<_> = made.lines().map(str::to_string).collect();
    with_comments_beside(&lines)
}

/// The declarations without the names of their parameters.
fn without_names(declarations: &str) -> String {
    declarations.lines().map(|line| without_parameter_names(line) + "\n").collect()
}

/// Moves the comment above each constant and member to its right, so that a constant or member takes one line or a few.
fn with_comments_beside(lines: &[String]) -> String {
    let mut rest = lines.iter();
    let mut text = String::new();
    while let Some(line) = rest.next() {
        if line.trim() != "/*" {
            text += &(line.clone() + "\n");
            continue;
        }
        let comment: Vec<_> = rest.by_ref().take_while(|line| line.trim() != "*/").map(String::as_str).collect();
        let declaration = rest.next().expect("every comment is above a declaration");
        if declaration.starts_with("#define ") || declaration.starts_with("    ") {
            text += &beside(declaration, &comment.join(" "));
            if declaration.starts_with("#define ") {
                assert!(rest.next().is_none_or(String::is_empty), "an empty line follows each constant");
            }
            continue;
        }
        if text.ends_with(" */\n") {
            text += "\n";
        }
        text += &match comment[..] {
            [line] => format!("/*{line} */\n{declaration}\n"),
            _ => format!("/*\n{}\n */\n{declaration}\n", comment.join("\n")),
        };
    }
    text
}

/// A declaration with its comment to the right, wrapped.
fn beside(declaration: &str, comment: &str) -> String {
    let mut line = format!("{declaration:<0$} /*", COMMENT_COLUMN - 1);
    let mut text = String::new();
    for word in comment.split_whitespace() {
        if line.len() + 1 + word.len() + " */".len() > 120 {
            text += &(line + "\n");
            line = " ".repeat(COMMENT_COLUMN + 2);
        }
        line += &format!(" {word}");
    }
    text + &line + " */\n"
}

/// Removes the parameter names of a declaration, because a planner may have macros with these names. The synopsis above
/// the declaration shows the names.
fn without_parameter_names(line: &str) -> String {
    let call = line.starts_with("int ") || line.starts_with("const char *");
    let line = without_name_of_function(line);
    let Some((call, parameters)) = line.strip_suffix(");").filter(|_| call).and_then(|line| line.split_once('('))
    else {
        return line;
    };
    let kind = |parameter: &str| {
        let kind = parameter.trim_end_matches(|letter: char| letter.is_alphanumeric() || letter == '_');
        if parameter == "void" { parameter.to_string() } else { kind.trim_end().to_string() }
    };
    format!("{call}({});", parameters.split(", ").map(kind).collect::<Vec<_>>().join(", "))
}

/// Removes the name of a parameter that is a pointer to a function.
fn without_name_of_function(line: &str) -> String {
    let named = line.split_once("(*").and_then(|(before, rest)| Some((before, rest.split_once(')')?.1)));
    named.map_or_else(|| line.to_string(), |(before, after)| format!("{before}(*){after}"))
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

/// Returns C code that does not compile if a 64-bit compiler lays out a struct differently than the library.
fn sizes(code: &str) -> String {
    let mut lines = String::new();
    for declaration in code.split("\nstruct ").skip(1) {
        let (name, members) = declaration.split_once('{').expect("a struct has members");
        let members = members.split_once('}').expect("the members end").0;
        let (mut size, mut alignment) = (0, 1);
        for member in members.split(';').map(str::trim).filter(|member| !member.is_empty()) {
            let (kind, rest) = match member.contains("(*") {
                true => ("pointer to a function", "*"),
                false => member.rsplit_once(' ').expect("a member has a type and a name"),
            };
            let part = match kind {
                "int" | "unsigned int" => 4,
                "double" | "unsigned long" | "size_t" => 8,
                // With LP64 a pointer has 64 bits.
                _ if rest.starts_with('*') => 8,
                _ => panic!("the size of {kind} is not known here: add it to `sizes`"),
            };
            let parts: usize = rest.split(['[', ']']).filter_map(|part| part.parse::<usize>().ok()).product();
            size = usize::next_multiple_of(size, part) + part * parts;
            alignment = alignment.max(part);
        }
        let (name, size) = (name.trim(), size.next_multiple_of(alignment));
        writeln!(lines, "typedef char {name}_size[sizeof(struct {name}) == {size} ? 1 : -1];").expect("a String grows");
    }
    format!(
        "/* These do not compile if the compiler lays out structs differently than the library. */\n\
             #ifdef __LP64__\n{lines}#endif\n"
    )
}

#[test]
fn the_committed_header_is_the_one_of_the_exports() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).expect("cbindgen.toml can be used");
    let part = |name| fs::read_to_string(root.join("src/capi/header").join(name)).expect("a part of the header");
    let calls = without_names(&declarations(config, FILES_OF_1990));
    let (shield, unshield) = shields(&names(&code(&calls)));
    let (before, after) =
        (part("before.h").replace("@SHIELD@", &shield), part("after.h").replace("@UNSHIELD@", &unshield));
    let made = format!("{}\n{before}\n{calls}\n\n{after}", manual(&part("manual.txt")));
    assert_committed("Sun2Xp.h", &made);
}

/// The versions as constants.
fn versions() -> String {
    let version = env!("CARGO_PKG_VERSION");
    let parts: Vec<u32> = version.split(['.', '-', '+']).take(3).map(|part| part.parse().expect("a number")).collect();
    let number = parts.iter().fold(0, |number, part| number * 100 + part);
    format!(
        "/* The version of this header. Compare with sun2xp_version_number. */\n\
         #define SUN2XP_VERSION \"{version}\"\n#define SUN2XP_VERSION_MAJOR {}\n#define SUN2XP_VERSION_MINOR {}\n\
         #define SUN2XP_VERSION_PATCH {}\n#define SUN2XP_VERSION_NUMBER {number}\n",
        parts[0], parts[1], parts[2]
    )
}

#[test]
fn the_committed_header_with_handles_is_the_one_of_the_exports() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(root.join("cbindgen-handles.toml")).expect("the file can be used");
    let part = |name| fs::read_to_string(root.join("src/capi/header").join(name)).expect("a part of the header");
    let mut declared = declarations(config.clone(), CONSTANTS);
    for (heading, file) in SECTIONS {
        let constants = match *heading {
            "FAULTS" => format!("/* Faults (docs/faults.md). Numbers never change. */\n{}", faults()),
            "EVENTS" => format!("/* Kinds of events (docs/events.md). Numbers never change. */\n{}", events()),
            _ => String::new(),
        };
        let section = declarations(config.clone(), &file.split(' ').collect::<Vec<_>>());
        let rule = "-".repeat(108 - heading.len());
        write!(declared, "\n\n/* ---- {heading} {rule} */\n\n{constants}{}", section.trim_start_matches('\n'))
            .expect("a String grows");
    }
    let sizes = sizes(&code(&declared));
    let (before, after) = (part("handles-before.h"), part("handles-after.h"));
    let made = format!("{}\n{before}\n{}\n{declared}\n{sizes}\n{after}", manual(&part("handles.txt")), versions());
    assert_committed("sun2xp.h", &made);
}

#[test]
fn the_abi_has_one_number() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |path: &str| fs::read_to_string(root.join(path)).expect("a source file");
    let number = |path: &str, before: &str| {
        let text = read(path);
        let (_, rest) =
            text.split_once(before).unwrap_or_else(|| panic!("{path} does not contain {before:?}: correct this test"));
        rest.split([';', '\n']).next().map(str::to_string).expect("a number")
    };
    let of_build = number("build.rs", "const ABI: u32 = ");
    assert_eq!(of_build, number("src/capi/version_calls.rs", "const SUN2XP_ABI_VERSION: c_uint = "));
    assert_eq!(
        of_build,
        number("include/sun2xp.h", "#define SUN2XP_ABI_VERSION").split_whitespace().next().expect("a number")
    );
}

fn assert_committed(name: &str, made: &str) {
    let committed = Path::new(env!("CARGO_MANIFEST_DIR")).join("include").join(name);
    if env::var_os("SUN2XP_WRITE_HEADER").is_some() {
        fs::write(&committed, made).expect("the header can be written");
    }
    assert!(
        fs::read_to_string(&committed).is_ok_and(|text| text == made),
        "include/{name} is stale. To renew it: SUN2XP_WRITE_HEADER=1 cargo test --test header"
    );
}
