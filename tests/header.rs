//! The committed header equals the one generated from the exports. A build script must not write into the source
//! folder, so this test compares the two, and writes the header if SUN2XP_WRITE_HEADER is set.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;
use std::{env, fs};
use sun2xp::finger::FaultKind;
use sun2xp::finger::events::EventKind;

/// The five calls of 1990 and HandError.
const CALLS_OF_1990: &[&str] = &["calls.rs"];

/// All other calls, in the order of the manual.
const OTHER_CALLS: &[&str] = &[
    "status_calls.rs",
    "timing_calls.rs",
    "fingertip_calls.rs",
    "spring_calls.rs",
    "group_calls.rs",
    "object_calls.rs",
    "touch_calls.rs",
    "kinematics_calls.rs",
    "path_calls.rs",
    "black_box_calls.rs",
    "calibration_calls.rs",
    "fault_calls.rs",
    "recovery_calls.rs",
    "reflex_calls.rs",
    "event_calls.rs",
];

/// Keywords of C and C++ that the header uses outside of the declarations.
const KEYWORDS_OF_AFTER: &[&str] =
    &["class", "extern", "inline", "reinterpret_cast", "return", "sizeof", "template", "typedef", "volatile"];

/// Three of these are macros of the header itself, so it cannot restore a planner's macro of the same name. These
/// macros use the other three.
const MACROS: &[&str] = &["GetPos", "GetPosD", "SendKx", "SendKxD", "SendPos", "SendPosD"];

/// The column of the comments beside constants and members: behind the longest of them.
const COMMENT_COLUMN: usize = 36;

/// Headings of the two groups of constants.
const HEADINGS: &[(&str, &str)] = &[
    ("FINGER_", "State of a finger (FingerStatus.State, FingerRecord.State)"),
    ("WHEN_", "Condition of a reflex (Reflex.Condition)"),
    ("THEN_", "Reaction of a reflex (Reflex.Reaction)"),
    ("WAIT_", "Condition of a wait (WaitFingers)"),
    ("TIMING_", "Stage of a cycle (GetTiming, FingerTiming.Stage)"),
];

/// A constant for each fault.
fn faults() -> String {
    let line = |kind: &FaultKind| {
        let description = kind.description();
        format!("#define FAULT_{:<22} {:>2} /* {} */", description.constant, kind.number(), description.name)
    };
    FaultKind::ALL.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// A constant for each kind of event.
fn events() -> String {
    let line = |kind: &EventKind| {
        let description = kind.description();
        format!("#define EVENT_{:<22} {:>2} /* {} */", description.constant, kind.number(), description.name)
    };
    EventKind::ALL.iter().map(line).collect::<Vec<_>>().join("\n")
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
    let lines: Vec<_> = made.lines().map(without_parameter_names).collect();
    with_comments_beside(&lines)
}

/// Moves the comment above each constant and member to its right: each of these takes one line then, or a few.
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
                rest.next().filter(|line| line.is_empty()).expect("an empty line follows each constant");
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
    let mut line = format!("{declaration:<COMMENT_COLUMN$}/*");
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
/// the declaration has them.
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

/// Every name that the declarations use, and the C keywords around them.
fn names(code: &str) -> BTreeSet<&str> {
    let lines = code.lines().filter(|line| !line.starts_with('#'));
    let words = lines.flat_map(|line| line.split(|letter: char| !letter.is_alphanumeric() && letter != '_'));
    let names = words.filter(|word| word.starts_with(|letter: char| letter.is_alphabetic()));
    names.filter(|name| !MACROS.contains(name)).chain(KEYWORDS_OF_AFTER.iter().copied()).collect()
}

/// Checks that do not compile if a 64-bit compiler lays out a struct differently than the library.
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
                // With LP64 a pointer has 64 bits.
                _ if rest.starts_with('*') => 8,
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
        "/* These do not compile if the compiler lays out structs differently than the library. */\n\
             #ifdef __LP64__\n{lines}#endif\n"
    )
}

/// Directives that save the planner's macros, and directives that restore them.
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
        "/* Macros of the planner whose names are used below are saved here and restored at the end. */\n\
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
    let part = |name| fs::read_to_string(root.join("src/capi/header").join(name)).expect("a part of the header");
    let calls_of_1990 = declarations(config.clone(), CALLS_OF_1990);
    let others = HEADINGS.iter().fold(declarations(config, OTHER_CALLS), |text, (prefix, heading)| {
        let first = format!("#define {prefix}");
        text.replacen(&first, &format!("\n/* {heading} */\n{first}"), 1)
    });
    let sizes = sizes(&code(&others));
    let body = format!(
        "{calls_of_1990}\n\n\
         #ifndef SUN2XP_FIVE_CALLS\n\n\
         /* The faults (chapter 10). Numbers never change. */\n{}\n\n\
         /* The kinds of events (docs/events.md). Numbers never change. */\n{}\n{others}\n\n{sizes}\n\
         #endif /* SUN2XP_FIVE_CALLS */\n",
        faults(),
        events()
    );
    let (shield, unshield) = shields(&names(&code(&format!("{calls_of_1990}{others}"))));
    let (before, after) =
        (part("before.h").replace("@SHIELD@", &shield), part("after.h").replace("@UNSHIELD@", &unshield));
    let made = format!("{}\n{before}\n{body}\n{after}", manual(&part("manual.txt")));

    let committed = root.join("include/Sun2Xp.h");
    if env::var_os("SUN2XP_WRITE_HEADER").is_some() {
        fs::write(&committed, &made).expect("include/Sun2Xp.h can be written");
    }
    assert!(
        fs::read_to_string(&committed).is_ok_and(|text| text == made),
        "include/Sun2Xp.h is stale. To renew it: SUN2XP_WRITE_HEADER=1 cargo test --test header"
    );
}
