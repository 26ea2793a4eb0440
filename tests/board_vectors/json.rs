//! Writes JSON for any language. Each vector, and each step of a conversation, is on a line of its own, so that a C
//! program needs no JSON parser.

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
