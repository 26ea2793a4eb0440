//! Writes one object a line: JSON for any language, and single lines for a C program without a JSON parser.

/// Writes an object of `"name": value` pairs. The values must already be JSON.
pub fn object(pairs: &[(&str, String)]) -> String {
    let pairs: Vec<String> = pairs.iter().map(|(name, value)| format!("\"{name}\": {value}")).collect();
    format!("{{{}}}", pairs.join(", "))
}

/// Quotes a text, which must not need escapes.
pub fn text(text: &str) -> String {
    assert!(!text.contains(['"', '\\']));
    format!("\"{text}\"")
}

pub fn hex(bytes: &[u8]) -> String {
    let digits: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    text(&digits)
}

pub fn list<T: ToString>(numbers: &[T]) -> String {
    let numbers: Vec<String> = numbers.iter().map(T::to_string).collect();
    format!("[{}]", numbers.join(", "))
}
