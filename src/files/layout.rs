//! Keeps the layout of a text file whose content is changed.

/// Some editors put this at the beginning of a file.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// Returns `changed` with the byte order mark and the line ends of `before`. TOML parsers drop both.
pub fn with_line_ends_of(before: &str, mut changed: String) -> String {
    if before.contains("\r\n") && before.matches("\r\n").count() == before.matches('\n').count() {
        changed = changed.replace("\r\n", "\n").replace('\n', "\r\n");
    }
    match before.strip_prefix(BYTE_ORDER_MARK) {
        Some(_) if !changed.starts_with(BYTE_ORDER_MARK) => format!("{BYTE_ORDER_MARK}{changed}"),
        _ => changed,
    }
}
