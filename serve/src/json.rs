//! JSON strings and arrays for the configuration of Zenoh.

/// Returns a text as a JSON string.
#[must_use]
pub fn string(text: &str) -> String {
    let mut quoted = String::with_capacity(text.len() + 2);
    quoted.push('"');
    for character in text.chars() {
        match character {
            '"' | '\\' => quoted.extend(['\\', character]),
            control if control < ' ' => quoted.push_str(&format!("\\u{:04x}", control as u32)),
            other => quoted.push(other),
        }
    }
    quoted.push('"');
    quoted
}

/// Returns texts as a JSON array of strings.
pub fn strings(texts: impl IntoIterator<Item = impl AsRef<str>>) -> String {
    let quoted: Vec<String> = texts.into_iter().map(|text| string(text.as_ref())).collect();
    format!("[{}]", quoted.join(","))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_and_controls_are_escaped() {
        assert_eq!(string("C:\\a \"b\"\n"), "\"C:\\\\a \\\"b\\\"\\u000a\"");
        assert_eq!(strings(["a", "b"]), "[\"a\",\"b\"]");
        assert_eq!(strings([""; 0]), "[]");
    }
}
