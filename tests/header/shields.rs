//! The directives of `Sun2Xp.h` that keep its names apart from the macros of a planner.

use std::collections::BTreeSet;
use std::fmt::Write;

/// Keywords of C and C++ in `src/capi/header/after.h`, the part of the header after the declarations. `_Generic` and
/// `default` are not listed: they stand only in macros of the header, which are expanded after the planner's macros
/// have been restored.
const KEYWORDS_OF_AFTER: &[&str] = &[
    "char",
    "class",
    "const",
    "double",
    "extern",
    "float",
    "inline",
    "int",
    "long",
    "reinterpret_cast",
    "return",
    "sizeof",
    "struct",
    "template",
    "typedef",
    "void",
    "volatile",
];

/// Names whose macros are neither saved nor restored. SendPos, SendKx and GetPos can be macros of the header itself, so
/// the header cannot restore a planner's macros with these names. The macros of the header expand to the other three
/// names, so a restored macro with such a name would change the calls.
const MACROS: &[&str] = &["GetPos", "GetPosD", "SendKx", "SendKxD", "SendPos", "SendPosD"];

/// Returns all [`KEYWORDS_OF_AFTER`], and every name in `code` (the declarations) that is not one of [`MACROS`].
pub fn names(code: &str) -> BTreeSet<&str> {
    let lines = code.lines().filter(|line| !line.starts_with('#'));
    let words = lines.flat_map(|line| line.split(|letter: char| !letter.is_alphanumeric() && letter != '_'));
    let names = words.filter(|word| word.starts_with(|letter: char| letter.is_alphabetic()));
    names.filter(|name| !MACROS.contains(name)).chain(KEYWORDS_OF_AFTER.iter().copied()).collect()
}

/// Directives that save the planner's macros, and directives that restore them.
pub fn shields(names: &BTreeSet<&str>) -> (String, String) {
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
