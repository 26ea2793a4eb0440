//! The error for a file that has values which no hand records.

use crate::failure::Failure;
use std::path::Path;
use sun2xp::finger::{ALTERED, without_remedy};
use sun2xp::model::ShownPath;
use sun2xp::model::configuration::Unusable;

/// Returns the failure for a file that cannot be used, with the cause and the remedy. `library` is the version of the
/// library that has written the file.
pub fn unusable(path: &Path, library: &str, reason: &str) -> Failure {
    format!("{} cannot be used: {reason}. {ALTERED}{}", ShownPath(path), or_by(library)).into()
}

/// Returns the unusable key of a recorded configuration, and the reason. The remedy of the check is for a person who
/// writes a configuration, so it is left out.
pub fn named(wrong: &Unusable) -> String {
    format!("{}: {}", wrong.key, without_remedy(&wrong.reason))
}

/// If a library of another version has written the file, returns a second remedy as the end of a sentence: libraries of
/// other versions may permit other values. Otherwise returns an empty text.
pub fn or_by(library: &str) -> String {
    match env!("CARGO_PKG_VERSION") {
        own if own == library => String::new(),
        _ => format!(", or use the sun2xp program of version {library}, which wrote the file"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_file_of_another_library_has_the_second_remedy() {
        let text = |library: &str| unusable(Path::new("hand.mcap"), library, "rate: 0 Hz is too low").to_string();
        assert!(text(env!("CARGO_PKG_VERSION")).ends_with("copy it again"));
        assert!(
            text("0.0.9").ends_with("copy it again, or use the sun2xp program of version 0.0.9, which wrote the file")
        );
    }
}
