//! Writes the vectors as JSON, with one object on each line, so that a C program without a JSON parser can read the
//! file line by line.

/// Writes an object of `"name": value` pairs. The values must already be JSON.
pub fn object(pairs: &[(&str, String)]) -> String {
    let pairs: Vec<String> = pairs.iter().map(|(name, value)| format!("\"{name}\": {value}")).collect();
    format!("{{{}}}", pairs.join(", "))
}

pub fn text(text: &str) -> String {
    serde_json::to_string(text).expect("a text can be JSON")
}

pub fn hex(bytes: &[u8]) -> String {
    let digits: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    text(&digits)
}

pub fn from_hex(digits: &str) -> Vec<u8> {
    let pair = |at| u8::from_str_radix(&digits[at..at + 2], 16).expect("hex digits");
    (0..digits.len()).step_by(2).map(pair).collect()
}

pub fn list(values: impl IntoIterator<Item = String>) -> String {
    let values: Vec<String> = values.into_iter().collect();
    format!("[{}]", values.join(", "))
}

/// Writes a number with so many digits that no bit is lost. Writes NaN, which JSON does not have, as null.
pub fn number(number: f64) -> String {
    if number.is_nan() { "null".into() } else { format!("{number:?}") }
}

pub fn numbers(numbers: &[f64]) -> String {
    list(numbers.iter().map(|&one| number(one)))
}

/// Writes a value, or null if there is none.
pub fn option<T>(value: Option<T>, write: impl FnOnce(T) -> String) -> String {
    value.map_or_else(|| "null".into(), write)
}
